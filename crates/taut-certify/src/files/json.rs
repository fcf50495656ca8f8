//! Answers about files as JSON: the same document as of answers about points.

use std::io;

use taut_points::Monitor;

use super::{
    DrawnSample, FileAnswer, FileCheckError, FileSolution, FileVerdict, Files, SortedFile,
    TransposedFile,
};
use crate::json::{kind_of, parse_document, without_mark, write_document};
use crate::{AnySolution, JsonError};

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
    /// What `out` says.
    pub fn write_json(&self, out: impl io::Write) -> io::Result<()> {
        write_document(A::KIND, &self.answer, &self.certificate, &self.trace, out)
    }
}

/// A solution about a file, of any kind, as read from its JSON.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyFileSolution {
    /// A file of records in order.
    Sort(FileSolution<SortedFile>),
    /// A matrix turned.
    Transpose(FileSolution<TransposedFile>),
    /// Numbers drawn.
    Sample(FileSolution<DrawnSample>),
}

impl AnyFileSolution {
    /// Reads a document.
    ///
    /// # Errors
    /// [`JsonError`]; [`JsonError::Kind`] for answers about points, which [`AnySolution`] reads.
    pub fn from_json(text: &str) -> Result<Self, JsonError> {
        let text = without_mark(text);
        Self::of_kind(kind_of(text)?, text)
    }

    fn of_kind(kind: String, text: &str) -> Result<Self, JsonError> {
        fn parsed<A: FileAnswer>(text: &str) -> Result<FileSolution<A>, JsonError> {
            let (answer, certificate, trace) = parse_document(text)?;
            Ok(FileSolution { answer, certificate, trace })
        }
        match kind.as_str() {
            SortedFile::KIND => parsed(text).map(AnyFileSolution::Sort),
            TransposedFile::KIND => parsed(text).map(AnyFileSolution::Transpose),
            DrawnSample::KIND => parsed(text).map(AnyFileSolution::Sample),
            _ => Err(JsonError::Kind { found: kind }),
        }
    }

    /// The document, as [`FileSolution::to_json`] writes it.
    pub fn to_json(&self) -> String {
        match self {
            AnyFileSolution::Sort(found) => found.to_json(),
            AnyFileSolution::Transpose(found) => found.to_json(),
            AnyFileSolution::Sample(found) => found.to_json(),
        }
    }

    /// Judges the file that was written, whatever the kind.
    ///
    /// # Errors
    /// As [`FileAnswer::check`].
    pub fn check(
        &self,
        files: Files<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<FileVerdict, FileCheckError> {
        match self {
            AnyFileSolution::Sort(found) => found.check(files, monitor),
            AnyFileSolution::Transpose(found) => found.check(files, monitor),
            AnyFileSolution::Sample(found) => found.check(files, monitor),
        }
    }
}

/// An answer of any kind, about points or about files.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyDocument {
    /// About points.
    Points(Box<AnySolution>),
    /// About files.
    Files(AnyFileSolution),
}

impl AnyDocument {
    /// Reads a document.
    ///
    /// # Errors
    /// [`JsonError`].
    pub fn from_json(text: &str) -> Result<Self, JsonError> {
        let text = without_mark(text);
        match AnyFileSolution::of_kind(kind_of(text)?, text) {
            Ok(found) => Ok(AnyDocument::Files(found)),
            Err(JsonError::Kind { found }) => {
                AnySolution::of_kind(found, text).map(|found| AnyDocument::Points(Box::new(found)))
            }
            Err(error) => Err(error),
        }
    }
}
