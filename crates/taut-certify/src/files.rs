//! Answers about files: records in order, a matrix turned, numbers drawn; the checkers read the files.
//!
//! *Problem.* What is too large for memory is not points but bytes, and its answer is another file. The JSON holds what
//! the answer is about and its certificate; the file that was written is judged, with or without the one that was read.
//! *Guarantee.* Of two files a matrix and its transpose are compared byte by byte. Records are compared by a hash of 128
//! bits of their multiset. Without the file that was read, either is judged by that hash alone. Numbers are drawn again.
//! *Trap.* A length in JSON is nobody's memory: what is allocated is within a limit, or is there as bytes of a file.

mod bytes;
mod hash;
mod json;
mod npy;
mod sample;
mod sort;
mod transpose;
mod violation;

use serde::{Serialize, de::DeserializeOwned};
use taut_points::Monitor;

use crate::Trace;

pub use bytes::{Data, Files};
pub use hash::{Hash128, Hash128FormError};
pub use sample::{DrawnSample, SampleCertificate};
pub use sort::{KeyKind, SortCertificate, SortedFile};
pub use transpose::{ElementOrder, TransposeCertificate, TransposedFile};
pub use violation::{FileCheckError, FileViolation, WhichFile};

/// An answer that is a file, to be judged from its bytes and the certificate.
pub trait FileAnswer: Serialize + DeserializeOwned {
    /// The data that convince a third party.
    type Certificate: Serialize + DeserializeOwned;

    /// The word for it in JSON: `"sort"`.
    const KIND: &'static str;

    /// Judges the file that was written, and if it is there compares it with the one that was read.
    ///
    /// # Errors
    /// [`FileCheckError::Rejected`] with the first violation, [`FileCheckError::Read`] when a file cannot be read.
    fn check(
        &self,
        certificate: &Self::Certificate,
        files: Files<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<FileVerdict, FileCheckError>;
}

/// The contents of a file, their proof, and how they came about.
#[derive(Clone, Debug, PartialEq)]
pub struct FileSolution<A: FileAnswer> {
    /// The claim about the file.
    pub answer: A,
    /// Its proof.
    pub certificate: A::Certificate,
    /// Counters of the run.
    pub trace: Trace,
}

impl<A: FileAnswer> FileSolution<A> {
    /// A second opinion, with code that shares nothing with what made the file.
    ///
    /// # Errors
    /// As [`FileAnswer::check`].
    pub fn check(
        &self,
        files: Files<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<FileVerdict, FileCheckError> {
        self.answer.check(&self.certificate, files, monitor)
    }
}

/// The proved facts about a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct FileVerdict {
    /// Records, elements or numbers that were read, in each of the files.
    pub items: u64,
    /// True if the file that was read was compared, or the certificate's word taken for it.
    pub compared: bool,
}
