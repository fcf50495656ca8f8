//! The verdicts and violations of checkers of files.

use std::fmt;
use std::io;

use taut_points::Cancelled;

/// Which of two files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhichFile {
    /// The one that was read.
    Input,
    /// The one that was written.
    Output,
}

impl fmt::Display for WhichFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            WhichFile::Input => "the input",
            WhichFile::Output => "the output",
        })
    }
}

/// Why a file is not what its answer says.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FileViolation {
    /// A number of the answer makes no sense.
    #[error("{what} is {value}: expected {expected}")]
    Number {
        /// The number in question.
        what: &'static str,
        /// Its value.
        value: String,
        /// The values that would have been accepted.
        expected: &'static str,
    },
    /// A file has another length than what it should hold.
    #[error("{file} has {found} bytes: expected {expected}")]
    Length {
        /// Which file.
        file: WhichFile,
        /// Its length.
        found: u64,
        /// The length that the answer asks for.
        expected: u128,
    },
    /// A file of numbers is shorter than so many can be.
    #[error("{file} has {found} bytes: {lines} lines of a number take {least} or more")]
    Short {
        /// Which file.
        file: WhichFile,
        /// Its length.
        found: u64,
        /// The lines that the answer asks for.
        lines: u64,
        /// Bytes that they take at least.
        least: u128,
    },
    /// Records are not in order.
    #[error("{file} is not sorted: record {record} (from 0) belongs before the one it follows")]
    Unsorted {
        /// Which file.
        file: WhichFile,
        /// The first record whose key is below the key before it.
        record: u64,
    },
    /// The content is not that of the certificate.
    #[error("{file} has hash {found}, the certificate speaks of {claimed}: other content")]
    Hash {
        /// Which file.
        file: WhichFile,
        /// Hash the certificate names.
        claimed: String,
        /// Hash of the file.
        found: String,
    },
    /// An element is not where the transpose has it.
    #[error(
        "{file} has another element in row {row}, column {column} than {0} in row {column}, column {row}",
        WhichFile::Input
    )]
    Element {
        /// The file that was written.
        file: WhichFile,
        /// Its row, from 0.
        row: u64,
        /// Its column, from 0.
        column: u64,
    },
    /// The header of an array does not say what the answer says.
    #[error("the header of {file} {problem}")]
    Header {
        /// Which file.
        file: WhichFile,
        /// The message.
        problem: String,
    },
    /// A line is not the number that the seed gives.
    #[error("line {line} of {file} is {found}: the seed gives {expected}")]
    Drawn {
        /// The file.
        file: WhichFile,
        /// The line, from 1.
        line: u64,
        /// The text found; "nothing" behind the last.
        found: String,
        /// The text expected; "nothing" behind the last.
        expected: String,
    },
}

/// Why a file was not confirmed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileCheckError {
    /// The file or its certificate is wrong.
    #[error(transparent)]
    Rejected(#[from] FileViolation),
    /// There is a file to compare with, but none was read.
    #[error("a sample is drawn from numbers, not from a file: name the file of the sample alone")]
    NoInput,
    /// A file could not be read.
    #[error("{file} could not be read: {source}")]
    Read {
        /// Which file.
        file: WhichFile,
        /// The error of the system.
        source: io::Error,
    },
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
