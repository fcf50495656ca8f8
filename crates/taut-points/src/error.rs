//! The errors of a point set before any geometry begins.

use std::path::PathBuf;

use crate::{Cancelled, ScalarKind, shown_number};

/// Why a view or a generator could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The dimension was zero.
    #[error("the dimension is 0: a point needs at least one coordinate")]
    ZeroDimension,
    /// The number of values is not a multiple of the dimension.
    #[error("{values} values do not make whole points of dimension {dim}: {rest} are left over")]
    Ragged {
        /// The number of values.
        values: usize,
        /// The dimension asked for.
        dim: usize,
        /// `values mod dim`.
        rest: usize,
    },
    /// A parameter of a generator is outside its range.
    #[error("`{name}` is {value}: expected {expected}")]
    Parameter {
        /// The parameter.
        name: &'static str,
        /// The value that was given.
        value: String,
        /// The values that would have been accepted.
        expected: &'static str,
    },
    /// A parameter was given that another distribution takes.
    #[error("`{name}` belongs to {owner}, not to {distribution}: leave it out")]
    Foreign {
        /// The parameter.
        name: &'static str,
        /// The distribution that takes it.
        owner: &'static str,
        /// The distribution that was asked for.
        distribution: String,
    },
    /// A drawn coordinate is beyond the largest number of its type.
    #[error(
        "coordinate {column} of point {row}, both counted from 0, is {}, and {kind} does not reach that far: choose smaller parameters or a wider type",
        shown_number(*value)
    )]
    Overflow {
        /// The point, from 0.
        row: u64,
        /// The coordinate, from 0.
        column: usize,
        /// The value as it was drawn.
        value: f64,
        /// The type it was to be rounded to.
        kind: ScalarKind,
    },
}

/// Why a block of points could not be delivered.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The operating system refused or the file ended early.
    #[error("{}: reading points {first} to {last}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// First point of the block.
        first: u64,
        /// Last point of the block.
        last: u64,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// The file does not hold as many points as it was said to.
    #[error("{}: {found} bytes, but {n} points of dimension {dim} need {needed}", path.display())]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Bytes it has.
        found: u64,
        /// Bytes it should have.
        needed: u64,
        /// Points it was said to hold.
        n: u64,
        /// Their dimension.
        dim: usize,
    },
    /// Points beyond the last were asked for.
    #[error("points {first}..{end} were asked for, but there are {n}")]
    OutOfRange {
        /// First point asked for.
        first: u64,
        /// One past the last point asked for.
        end: u64,
        /// Number of points.
        n: u64,
    },
    /// That many points at once are more than memory holds.
    #[error("{rows} points of dimension {dim} at once do not fit into memory")]
    TooLarge {
        /// The number of points.
        rows: u64,
        /// Their dimension.
        dim: usize,
    },
    /// A point could not be drawn.
    #[error(transparent)]
    Drawn(#[from] Error),
    /// The caller's [`Monitor`](crate::Monitor) asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Invalid points or options, a read error, or cancellation by the caller. The errors of the crates with algorithms wrap it, so
/// that a caller explains it once.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum InputError {
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
    /// Points have too few coordinates, or too many.
    #[error("points have {dim} coordinates: expected {expected}")]
    Dimension {
        /// Coordinates of a point.
        dim: usize,
        /// The values that would have been accepted.
        expected: &'static str,
    },
    /// More points than can be numbered in memory.
    #[error("{points} points are more than the {most} that fit in memory")]
    TooManyPoints {
        /// The number of them.
        points: u64,
        /// The largest number that would have been accepted.
        most: u64,
    },
    /// An option is outside its range.
    #[error("option `{name}` is {value}: expected {expected}")]
    Option {
        /// The option.
        name: &'static str,
        /// The value that was given.
        value: String,
        /// The values that would have been accepted.
        expected: &'static str,
    },
    /// The points could not be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl InputError {
    /// Tests whether the fault is in what the caller gave, not in reading it or in a wish to stop.
    pub fn is_fault_of_caller(&self) -> bool {
        !matches!(self, InputError::Read(_) | InputError::Cancelled(_))
    }
}
