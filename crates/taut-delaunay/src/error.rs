//! What a triangulation can refuse.

use taut_points::{Cancelled, ReadError};

/// Why there is no triangulation.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Points are neither of the plane nor of space, or not of the one that was asked for.
    #[error("points have {dim} coordinates: expected {expected}")]
    Dimension {
        /// Coordinates of a point.
        dim: usize,
        /// What would have been accepted.
        expected: &'static str,
    },
    /// A coordinate is NaN or infinite.
    #[error("coordinate {column} of point {row} is {value}: all coordinates must be finite")]
    NonFinite {
        /// Point, from 0.
        row: u64,
        /// Coordinate, from 0.
        column: usize,
        /// Its value.
        value: f64,
    },
    /// Points are numbered with 32 bits in memory.
    #[error("{points} points are more than the {most} that fit one triangulation in memory")]
    TooManyPoints {
        /// How many there are.
        points: u64,
        /// How many would have been accepted.
        most: u64,
    },
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
    /// An option is outside its range.
    #[error("option `{name}` is {value}: expected {expected}")]
    Option {
        /// The option.
        name: &'static str,
        /// What was given.
        value: String,
        /// What would have been accepted.
        expected: &'static str,
    },
    /// The points could not be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
