//! Names, lists and text of files as messages show them.

use std::fmt;
use std::path::Path;

use crate::{MeshFormat, ShapeFormat};

/// The names of the formats of meshes that `usable` says.
pub(super) fn meshes(usable: impl Fn(MeshFormat) -> bool) -> String {
    let names = MeshFormat::ALL.into_iter().filter(|&format| usable(format)).map(MeshFormat::name);
    names.collect::<Vec<_>>().join(", ")
}

/// The names of the formats of shapes that `usable` says.
pub(super) fn shapes(usable: impl Fn(ShapeFormat) -> bool) -> String {
    let names =
        ShapeFormat::ALL.into_iter().filter(|&format| usable(format)).map(ShapeFormat::name);
    names.collect::<Vec<_>>().join(", ")
}

/// A path as messages show it: control characters are escaped, so that no name of a file can speak to a terminal.
pub(crate) fn shown_path(path: &Path) -> String {
    Clean(&path.display().to_string()).to_string()
}

/// Text of a file without its control characters.
pub(super) struct Clean<'a>(pub(super) &'a str);

impl fmt::Display for Clean<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.chars().try_for_each(|c| match c.is_control() {
            true => write!(f, "{}", c.escape_default()),
            false => write!(f, "{c}"),
        })
    }
}

/// So many columns.
pub(super) fn columns(count: usize) -> String {
    format!("{count} column{}", if count == 1 { "" } else { "s" })
}

/// The first few of a list.
pub(super) struct Few<'a>(pub(super) &'a [String]);

impl fmt::Display for Few<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SHOWN_ITEMS_MAX: usize = 8;
        for (i, item) in self.0.iter().take(SHOWN_ITEMS_MAX).enumerate() {
            write!(f, "{}`{}`", if i == 0 { "" } else { ", " }, Clean(item))?;
        }
        match self.0.len() {
            n if n > SHOWN_ITEMS_MAX => write!(f, " and {} more", n - SHOWN_ITEMS_MAX),
            _ => Ok(()),
        }
    }
}
