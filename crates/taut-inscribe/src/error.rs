//! The errors of this crate.

use taut_points::{Cancelled, InputError, ReadError};

/// Why there is no largest circle.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The ring has too few vertices.
    #[error("the ring has {distinct} distinct vertices in a row: a polygon has at least 3")]
    TooFewVertices {
        /// Vertices that differ from the one before them.
        distinct: usize,
    },
    /// Two edges of the ring meet that are not neighbors, or two neighbors meet beyond their common vertex.
    #[error(
        "the edge from point {} to point {} meets the edge from point {} to point {}: a ring may neither cross nor touch itself",
        edge[0], edge[1], other[0], other[1]
    )]
    NotSimple {
        /// The rows of the ends of an edge, from 0.
        edge: [u64; 2],
        /// The rows of the ends of the other one.
        other: [u64; 2],
    },
    /// No point with coordinates in double precision was found that is provably inside.
    #[error(
        "the polygon is too thin: no point in double precision was found inside that is provably away from its edges; if it is \
         far from the origin, shift it there"
    )]
    TooThin,
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
