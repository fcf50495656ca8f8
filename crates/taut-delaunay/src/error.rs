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
