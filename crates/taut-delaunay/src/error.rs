//! The errors of a triangulation.

use taut_points::{Cancelled, InputError, ReadError};

/// Why there is no triangulation.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Simplices are numbered with 30 bits in memory.
    #[error(
        "the triangulation has more than 2^30 simplices: too many for one triangulation in memory"
    )]
    TooManySimplices,
    /// An answer was asked for with other points than those the triangulation was built from.
    #[error(
        "the triangulation was built from {built} points, but {given} points were given with it"
    )]
    OtherPoints {
        /// Points it was built from.
        built: u64,
        /// Points given.
        given: u64,
    },
    /// Bytes that should hold the front of a node do not, or fronts do not fit together.
    #[error("a front is damaged: {what}")]
    DamagedFront {
        /// How that shows.
        what: &'static str,
    },
    /// Bytes that should hold a tile do not.
    #[error("a tile is damaged: {what}")]
    DamagedTile {
        /// How that shows.
        what: &'static str,
    },
    /// What is unfinished at a node does not fit into the memory that was allowed.
    #[error(
        "{sites} points must be triangulated at once, which takes {needed} bytes: allow more memory than {budget} bytes for that and resume"
    )]
    Memory {
        /// Points of the node.
        sites: u64,
        /// Bytes that they take.
        needed: u64,
        /// Bytes that there are for them.
        budget: u64,
    },
    /// A point of a stream lies where the stream said that no more points will come.
    #[error("point {row} {what}: the stream is not in the order that was promised")]
    OutsideStream {
        /// The point.
        row: u64,
        /// Where it lies.
        what: &'static str,
    },
    /// A stream leaves too much open for the memory that was allowed.
    #[error(
        "at point {row} of the stream, {waiting} points lie where more may come and {unfinished} earlier ones are unfinished: to go on takes {needed} bytes beside those that wait, more than the {budget} that are left; order the points better, close cells earlier, or allow more memory"
    )]
    Incoherent {
        /// The point that came last.
        row: u64,
        /// Points that wait for their cells to be closed.
        waiting: u64,
        /// Sites with simplices that are not final.
        unfinished: u64,
        /// Bytes that the next chunk takes.
        needed: u64,
        /// Bytes that there are for it.
        budget: u64,
    },
    /// The file system has less room than the work needs.
    #[error(
        "{folder}: {needed} bytes are needed, but {free} are free: make room or choose another folder"
    )]
    Space {
        /// The folder of the output.
        folder: String,
        /// Bytes that the work needs.
        needed: u64,
        /// Bytes that are free.
        free: u64,
    },
    /// The folder of the output has other files, or a triangulation that was begun.
    #[error("{folder} is not empty: resume what was begun there, or name a new folder")]
    FolderTaken {
        /// The folder.
        folder: String,
    },
    /// Another process works in the folder of the output.
    #[error("{folder}: another process works there")]
    FolderLocked {
        /// The folder.
        folder: String,
    },
    /// A file of a folder with tiles is not what was written.
    #[error("{path} is damaged: remove the folder and begin again")]
    DamagedFolder {
        /// The file.
        path: String,
    },
    /// A folder holds no triangulation that is complete.
    #[error("{folder}: no complete triangulation is there: resume what was begun, or begin again")]
    UnfinishedFolder {
        /// The folder.
        folder: String,
    },
    /// The links between tiles do not fit into the memory that was allowed.
    #[error(
        "the {links} facets between tiles take {needed} bytes: allow more memory than {budget} bytes for that"
    )]
    LinkMemory {
        /// Facets between tiles.
        links: u64,
        /// Bytes that they take.
        needed: u64,
        /// Bytes that there are for them.
        budget: u64,
    },
    /// The points are not those that the work was begun with.
    #[error("{folder}: the work there was begun with other points")]
    OtherInput {
        /// The folder.
        folder: String,
    },
    /// A file cannot be read or written.
    #[error("{path}: {source}")]
    File {
        /// Which file.
        path: String,
        /// The error of the system.
        source: std::io::Error,
    },
    /// Invalid points or options, a read error, or cancellation by the caller.
    #[error(transparent)]
    Input(#[from] InputError),
}

impl From<ReadError> for Error {
    fn from(error: ReadError) -> Self {
        Error::Input(error.into())
    }
}

impl From<Cancelled> for Error {
    fn from(cancelled: Cancelled) -> Self {
        Error::Input(cancelled.into())
    }
}
