//! What the parsers of bytes and of words need to refuse a file in the words of its format.

use crate::{Error, MeshPlace};

/// A file in the making, which knows its name and its format.
pub(crate) trait Refuse {
    /// The file as shown to people.
    fn path(&self) -> &str;

    /// The file is damaged, there and so.
    fn damaged(&self, place: MeshPlace, problem: impl Into<String>) -> Error;
}
