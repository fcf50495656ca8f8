//! Where in a file something stands.

use std::fmt;

use super::display::Printable;

/// Where a value stands in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file as shown to people.
    pub path: String,
    /// Number of the row of data, from 1; a header is not counted.
    pub row: u64,
    /// Line of a text file, from 1, where known.
    pub line: Option<u64>,
    /// Number of the column in the file, from 0 as in [`Columns`](crate::Columns).
    pub column: usize,
    /// Its name, where the file has names.
    pub name: Option<String>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}, column {}", self.path, Row(self.row, self.line), self.column)?;
        match &self.name {
            Some(name) => write!(f, " (`{}`)", Printable(name)),
            None => write!(f, " (counted from 0)"),
        }
    }
}

/// A row with its line, for messages.
pub(super) struct Row(pub(super) u64, pub(super) Option<u64>);

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.1 {
            Some(line) => write!(f, "row {} (line {line})", self.0),
            None => write!(f, "row {}", self.0),
        }
    }
}

/// Where in a file of a mesh something stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilePlace {
    /// Nowhere in particular.
    File,
    /// A line of text, from 1.
    Line(u64),
    /// An element of a binary file: its kind, and its number from 0.
    Element(&'static str, u64),
}

impl fmt::Display for FilePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FilePlace::File => Ok(()),
            FilePlace::Line(line) => write!(f, "line {line}: "),
            FilePlace::Element(kind, number) => write!(f, "{kind} {number}: "),
        }
    }
}
