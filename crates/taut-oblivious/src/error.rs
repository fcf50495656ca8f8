//! The errors of a call.

/// Why an algorithm of this crate could not be run, or not to its end.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// An option or an argument is out of its range.
    #[error("option `{name}` is {value}: expected {expected}")]
    Option {
        /// Which one.
        name: &'static str,
        /// The value that was given.
        value: String,
        /// The values that would have been accepted.
        expected: &'static str,
    },
    /// A coordinate is NaN or infinite.
    #[error("coordinate {column} of point {row} is {value}: all coordinates must be finite")]
    NonFinite {
        /// The row of the point.
        row: u64,
        /// Which of its coordinates.
        column: usize,
        /// The value.
        value: f64,
    },
    /// Arrays of children are not those of one binary tree.
    #[error("node {node} {reason}: expected one binary tree, each node but the root a child once")]
    Tree {
        /// A node where that shows.
        node: u64,
        /// The reason for the refusal.
        reason: &'static str,
    },
    /// A file cannot be read or written.
    #[error("{path}: {}", said(source))]
    File {
        /// Which file.
        path: String,
        /// The error of the system.
        source: std::io::Error,
    },
    /// A file ends within a record.
    #[error("{path} has {bytes} bytes, which are no whole number of records of {width} bytes")]
    Partial {
        /// Which file.
        path: String,
        /// Its length behind what is no record.
        bytes: u64,
        /// Bytes of a record.
        width: usize,
    },
    /// Records came back from a file other than they were written to it.
    #[error("{path}: what was read back is not what was written: the disk or its memory fails")]
    ReadBack {
        /// Which file.
        path: String,
    },
    /// Runs that were kept in a file did not come back as they were written.
    #[error("{path}: the runs in it are not as they were written: remove the file and sort again")]
    DamagedRuns {
        /// The file to resume.
        path: String,
    },
    /// Records that another process sorted and left to be merged are not in order.
    #[error(
        "{path}: the records from byte {offset} on are not in order: remove the file and sort again"
    )]
    UnsortedRun {
        /// Which file.
        path: String,
        /// Where the run begins that is not in order.
        offset: u64,
    },
    /// A file is longer or shorter than what it should hold.
    #[error("{path} has {bytes} bytes: expected {expected}")]
    Length {
        /// Which file.
        path: String,
        /// Its bytes.
        bytes: u64,
        /// The size of the header and the elements.
        expected: u64,
    },
    /// A check found that a file does not hold what it should.
    #[error("{path} is not what it should be: {detail}")]
    Differs {
        /// Which file.
        path: String,
        /// The comparison that failed.
        detail: String,
    },
    /// Stopped on request.
    #[error(transparent)]
    Cancelled(#[from] taut_points::Cancelled),
}

/// Returns what the system said, in a sentence where it is one of the usual ones.
fn said(source: &std::io::Error) -> String {
    use std::io::ErrorKind;
    match source.kind() {
        ErrorKind::NotFound => "no such file or folder".to_owned(),
        ErrorKind::PermissionDenied => "no permission to read or write it".to_owned(),
        ErrorKind::IsADirectory => "this is a folder: name a file in it".to_owned(),
        _ => format!("reading or writing failed: {source}"),
    }
}
