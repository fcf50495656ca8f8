//! The errors of this crate.

use taut_points::{Cancelled, InputError, ReadError};

/// Why there is no largest shape.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The third number of a row is no number of a ring.
    #[error(
        "the ring number of point {row} is {value:?}: expected 0 for the first point, and for each other point that of the point \
         before or one more"
    )]
    RingNumber {
        /// The row, from 0.
        row: u64,
        /// Its third number.
        value: f64,
    },
    /// A ring has too few vertices.
    #[error(
        "ring {ring} (from 0) has {distinct} distinct vertices in a row: a polygon has at least 3"
    )]
    TooFewVertices {
        /// The ring, from 0.
        ring: usize,
        /// Vertices that differ from the one before them.
        distinct: usize,
    },
    /// Two edges meet that are not neighbors in a ring, or two neighbors meet beyond their common vertex.
    #[error(
        "the edge from point {} to point {} meets the edge from point {} to point {}: rings may neither cross nor touch themselves or each other",
        edge[0], edge[1], other[0], other[1]
    )]
    NotSimple {
        /// The rows of the ends of an edge, from 0.
        edge: [u64; 2],
        /// The rows of the ends of the other one.
        other: [u64; 2],
    },
    /// The area of the ellipse overflows or underflows.
    #[error(
        "the area of the ellipse is out of the range of double precision: scale the coordinates towards 1"
    )]
    Area,
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
