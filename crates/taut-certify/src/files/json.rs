//! Answers about files as JSON: the same document as of answers about points.

use std::io;

use super::{FileAnswer, FileSolution};
use crate::json::write_document;

impl<A: FileAnswer> FileSolution<A> {
    /// The document, in lines.
    ///
    /// # Panics
    /// Never: all parts are plain data with string keys.
    pub fn to_json(&self) -> String {
        let mut text = Vec::new();
        self.write_json(&mut text).expect("plain data always has a JSON form");
        String::from_utf8(text).expect("JSON is text")
    }

    /// Writes the document to `out`. It ends without a line feed.
    ///
    /// # Errors
    /// The error that `out` returns.
    pub fn write_json(&self, out: impl io::Write) -> io::Result<()> {
        write_document(A::KIND, (&self.answer, &self.certificate, &self.trace), None, out)
    }
}
