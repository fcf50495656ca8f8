//! What the parsers of bytes and of words need to refuse a file in the words of its format.

use crate::{Error, LONGEST_LINE, MeshPlace};

/// A file in the making, which knows its name and its format.
pub(crate) trait Refuse {
    /// The file as shown to people.
    fn path(&self) -> &str;

    /// Most bytes of a line of text.
    fn longest_line(&self) -> usize {
        LONGEST_LINE
    }

    /// The file is damaged, there and so.
    fn damaged(&self, place: MeshPlace, problem: impl Into<String>) -> Error;
}
