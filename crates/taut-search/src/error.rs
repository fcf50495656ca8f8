//! The errors of queries.

use taut_points::{InputError, ReadError, shown_number};

/// Why there is no answer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// There is nothing to search in.
    #[error("the point set is empty: there is nothing to search in")]
    Empty,
    /// A ball of the input has a negative radius.
    #[error(
        "ball {row} has radius {}: radii are the last column and must be at least 0",
        shown_number(*value)
    )]
    NegativeRadius {
        /// Ball, from 0.
        row: u64,
        /// Its radius.
        value: f64,
    },
    /// Balls were announced, but the rows have no room for a center and a radius.
    #[error("a ball needs a center and a radius, but rows have {columns} column")]
    NoRadius {
        /// Columns there are.
        columns: usize,
    },
    /// A ray without a direction.
    #[error(
        "ray {row} has no direction: rows are the coordinates of an origin, then of a direction other than 0"
    )]
    NoDirection {
        /// Ray, from 0.
        row: u64,
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
