//! The errors of the enclosing solvers.

use taut_points::{InputError, PartsError, ReadError, shown_number};

/// Why there is no answer.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// There is nothing to enclose.
    #[error("the point set is empty: an enclosing shape needs at least one point")]
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
    /// Weights were announced, but the rows have no room for a point and a weight.
    #[error(
        "a point with a weight needs a coordinate and a weight, but rows have {columns} column"
    )]
    NoWeight {
        /// Columns there are.
        columns: usize,
    },
    /// A weight of the input is not positive.
    #[error(
        "point {row} has weight {}: weights are the last column and must be more than 0",
        shown_number(*value)
    )]
    NonPositiveWeight {
        /// Point, from 0.
        row: u64,
        /// Its weight.
        value: f64,
    },
    /// Ellipsoids were announced, but no dimension has rows of that many numbers.
    #[error(
        "ellipsoids in dimension d have rows of d(d + 3)/2 numbers, 2, 5, 9, 14, …, but rows have {columns}"
    )]
    NoShape {
        /// Columns there are.
        columns: usize,
    },
    /// An ellipsoid of the input has a shape matrix with a negative eigenvalue.
    #[error("the shape matrix of ellipsoid {row} is not positive semidefinite")]
    NegativeShape {
        /// Ellipsoid, from 0.
        row: u64,
    },
    /// A half-space of the input has no normal.
    #[error(
        "half-space {row} has no normal: rows are the coordinates of a normal other than 0, then an offset"
    )]
    NoNormal {
        /// Half-space, from 0.
        row: u64,
    },
    /// Half-spaces of which rounding tells neither that they hold an ellipsoid nor that they do not.
    #[error(
        "rounding leaves open whether the polytope has an interior: its sides are nearly parallel, or of very different lengths"
    )]
    Undecided,
    /// A polytope that is unbounded.
    #[error(
        "the polytope is unbounded in the direction {direction:?}: an inscribed ellipsoid needs an end"
    )]
    Unbounded {
        /// Of length 1, with aᵢ′v at most d·2⁻⁴⁷ for every normal of length 1, in coordinates in which none stands out: as
        /// near to 0 or below as rounding the direction allows.
        direction: Vec<f64>,
    },
    /// Half-spaces that have no point in common, or no ball.
    #[error(
        "the polytope has no interior point: half-spaces {rows:?} leave no room for a ball of radius {radius:e} of its extent"
    )]
    NoInterior {
        /// Half-spaces, from 0.
        rows: Vec<u64>,
        /// λ for these, with normals of length 1: Σλᵢaᵢ = 0 and Σλᵢbᵢ ≤ 0, but for rounding.
        multipliers: Vec<f64>,
        /// The radius that they prove, with all roundings on the safe side: no ball in the polytope has a larger radius, in coordinates
        /// in which no axis stands out and the largest offset of a half-space is 1. 0 where there is no point in common.
        radius: f64,
    },
    /// A number of the answer, or a square on the way to it, exceeds the largest `f64` or vanishes.
    #[error(
        "the sizes of the input, or their squares, are beyond what double precision can hold: scale the coordinates towards 1"
    )]
    Overflow,
    /// The conic solver of the thesis' methods gave up on a core-set.
    #[error("the conic solver stopped with status {status} on a core-set of {points} points")]
    Conic {
        /// The status that it reported.
        status: String,
        /// Points it was given.
        points: usize,
    },
    /// One of many point sets cannot be solved.
    #[error("point set {set}: {error}")]
    Set {
        /// Which, from 0.
        set: u64,
        /// Why.
        error: Box<Error>,
    },
    /// Points in parts lie in a flat, and are to be solved in it, which is done where all of them are.
    #[error(
        "the points lie in a flat of dimension {rank} in {dim} dimensions: such an ellipsoid is found in memory or from a file, not in parts"
    )]
    FlatInParts {
        /// The dimension of the flat.
        rank: usize,
        /// That of the space.
        dim: usize,
    },
    /// About half of the points or more, in parts, lie in a flat, which robust ellipsoids are looked for where all of them are.
    #[error(
        "most of the points lie in a flat: such a robust ellipsoid is found in memory or from a file, not in parts"
    )]
    MostFlatInParts,
    /// Parts of a point set do not belong together, or their answers.
    #[error(transparent)]
    Parts(#[from] PartsError),
    /// Invalid points or options, a read error, or cancellation by the caller.
    #[error(transparent)]
    Input(#[from] InputError),
}

impl From<ReadError> for Error {
    fn from(error: ReadError) -> Self {
        Error::Input(error.into())
    }
}
