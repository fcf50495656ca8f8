//! Why the store refuses something. No message holds the name of a person.

use crate::Error;
use crate::hand::Side;

/// Why the store refuses something.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StoreError {
    /// The system refuses a file.
    #[error("{path}: {problem}")]
    Io {
        /// The file.
        path: String,
        /// What the system says.
        problem: String,
    },
    /// A file that is to be made is there already.
    #[error("{path} exists: name a new file, or delete it yourself")]
    Exists {
        /// The file.
        path: String,
    },
    /// Another process has the store open.
    #[error("{path} is in use by another process: try again when that has ended")]
    InUse {
        /// The store.
        path: String,
    },
    /// The file is no store.
    #[error("{path} is no store of hands")]
    NoStore {
        /// The file.
        path: String,
    },
    /// The store has a version that this release does not know.
    #[error("the store has version {found}, and this release reads version {known}")]
    Version {
        /// The version of the store.
        found: u32,
        /// The version that can be read.
        known: u32,
    },
    /// The key is not that of the store.
    #[error("the key does not fit this store, or the first records of the store were changed")]
    WrongKey,
    /// The key cannot be used.
    #[error("the key from {origin}: {problem}")]
    Key {
        /// The file, or the variable of the environment.
        origin: String,
        /// What is wrong with it.
        problem: String,
    },
    /// The file is damaged: truncated, or changed where SQLite keeps its own data.
    #[error("the store is damaged: {problem}; restore the latest copy")]
    Damaged {
        /// What is wrong.
        problem: String,
    },
    /// A record was changed, exchanged, added or removed without the key.
    #[error(
        "the store was tampered with: {record} was changed without the key; restore the latest copy"
    )]
    Tampered {
        /// Which record.
        record: String,
    },
    /// The store is older than the manifest that was kept elsewhere.
    #[error(
        "the store was rolled back: it has had {found} changes, and its manifest elsewhere says {expected} (equal numbers: other changes); \
         restore the latest copy"
    )]
    RolledBack {
        /// Changes of the store.
        found: u64,
        /// Changes of the manifest.
        expected: u64,
    },
    /// The manifest belongs to another store.
    #[error("the manifest is that of another store")]
    OtherStore,
    /// A text is no manifest.
    #[error(
        "this is no manifest of a store: expected `taut-manifest-1`, a number and two values in hexadecimal digits"
    )]
    NoManifest,
    /// Fewer scans than the error rates of the matcher were measured with: the threshold would accept too many.
    #[error(
        "{found} scans are too few: the error rates of the matcher are those of templates of {needed} scans or more"
    )]
    TooFewScans {
        /// Scans given.
        found: usize,
        /// Scans of a template, at least.
        needed: u64,
    },
    /// Two scans are one: a template of it is no better than one of a single scan.
    #[error("scan {scan} has the features of an earlier one: scan the hand again for each")]
    SameScan {
        /// Which scan, from 1.
        scan: usize,
    },
    /// An index does not fit the store.
    #[error(
        "the index is that of another store, or the person found was deleted or locked after it was made: make it again"
    )]
    OldIndex,
    /// A person is deleted, and the file is not compacted.
    #[error(
        "the person is deleted and the records are overwritten, but the file could not be compacted: {problem}"
    )]
    NotCompacted {
        /// What the system says.
        problem: String,
    },
    /// Nobody has this name.
    #[error("the store has no person of this name")]
    UnknownPerson,
    /// Somebody has this name.
    #[error("the store has a person of this name already: delete that one first")]
    NameTaken,
    /// The name cannot be stored.
    #[error(
        "a name has 1 to {bytes_max} bytes, no space at its ends, and no character that is invisible or turns text around; this one does not"
    )]
    Name {
        /// Bytes of a name, at most.
        bytes_max: usize,
    },
    /// Too many verifications failed.
    #[error(
        "this person is locked after {failures} failed verifications in sequence: unlock to try again"
    )]
    Locked {
        /// Failed verifications.
        failures: u32,
    },
    /// The probe shows the other hand.
    #[error("the scan shows a {} hand, and the {} one is enrolled", side_name(*.found), side_name(found.other()))]
    OtherHand {
        /// The hand of the probe.
        found: Side,
    },
    /// Scans of one person show both hands.
    #[error("scan {scan} shows the other hand than the first one")]
    TwoHands {
        /// The scan, from 1.
        scan: usize,
    },
    /// A scan is too far from the others of the same person.
    #[error(
        "scan {scan} differs from the others more than scans of one hand do: scan again, or leave it out"
    )]
    ScansDiffer {
        /// The scan, from 1.
        scan: usize,
    },
    /// Features, a matcher or a template are not as they should be.
    #[error(transparent)]
    Recognize(#[from] Error),
}

/// The hand in words.
fn side_name(side: Side) -> &'static str {
    match side {
        Side::Left => "left",
        Side::Right => "right",
    }
}

impl StoreError {
    /// An error of the system about a file.
    pub(super) fn io(path: &std::path::Path, error: impl std::fmt::Display) -> Self {
        StoreError::Io { path: path.display().to_string(), problem: error.to_string() }
    }

    /// Damage in words.
    pub(super) fn damaged(problem: impl std::fmt::Display) -> Self {
        StoreError::Damaged { problem: problem.to_string() }
    }
}
