//! Names, lists and text of files as messages show them.

use std::fmt;
use std::path::Path;

use crate::{Content, Format};

pub(super) fn names(usable: impl Fn(Format) -> bool) -> String {
    let names = Format::all().filter(|&format| usable(format)).map(Format::name);
    names.collect::<Vec<_>>().join(", ")
}

/// Returns what is wrong with a value, and what to do about it.
pub(super) fn not_finite(value: &str) -> String {
    let is_missing = value.eq_ignore_ascii_case("nan");
    let more = if is_missing { ", or leave out such rows with --missing drop" } else { "" };
    format!(
        "the value is {value}, and all coordinates must be finite: repair or remove that row{more}"
    )
}

/// Returns what cannot be told of a file.
pub(super) fn format_of(content: Content) -> &'static str {
    match content {
        Content::Points => "format",
        Content::Triangulation | Content::Surface => "format of the mesh",
        Content::Curves => "format of the curves",
    }
}

/// Returns how to say the format: of points by a name, as an option takes one; of all else by an extension.
pub(super) fn names_or_extensions(content: Content, usable: impl Fn(Format) -> bool) -> String {
    if content == Content::Points {
        return format!("name it (one of {})", names(usable));
    }
    let usable = Format::all().filter(|&format| usable(format));
    let extensions = usable.map(|format| format!(".{}", format.extensions()[0]));
    format!("give it one of the extensions {}", extensions.collect::<Vec<_>>().join(", "))
}

/// A path as messages show it: control characters are escaped, so that no name of a file can speak to a terminal.
pub(crate) fn shown_path(path: &Path) -> String {
    Printable(&path.display().to_string()).to_string()
}

/// Text of a file without its control characters.
pub(super) struct Printable<'a>(pub(super) &'a str);

impl fmt::Display for Printable<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.chars().try_for_each(|c| match c.is_control() {
            true => write!(f, "{}", c.escape_default()),
            false => write!(f, "{c}"),
        })
    }
}

pub(super) fn columns(count: usize) -> String {
    format!("{count} column{}", if count == 1 { "" } else { "s" })
}

/// The first few of a list.
pub(super) struct Abbreviated<'a>(pub(super) &'a [String]);

impl fmt::Display for Abbreviated<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SHOWN_ITEMS_MAX: usize = 8;
        for (i, item) in self.0.iter().take(SHOWN_ITEMS_MAX).enumerate() {
            write!(f, "{}`{}`", if i == 0 { "" } else { ", " }, Printable(item))?;
        }
        match self.0.len() {
            n if n > SHOWN_ITEMS_MAX => write!(f, " and {} more", n - SHOWN_ITEMS_MAX),
            _ => Ok(()),
        }
    }
}

/// What this build has been left without.
pub(super) fn not_built(name: &str, feature: &str) -> String {
    format!(
        "this build of taut reads and writes no {name} files; build it with the feature `{feature}`"
    )
}
