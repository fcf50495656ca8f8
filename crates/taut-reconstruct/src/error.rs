//! What a reconstruction can refuse.

use taut_points::{Cancelled, ReadError};

/// Why there is no curve or surface.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Points are not of the plane.
    #[error("points have {dim} coordinates: curves are sought in the plane, which has 2")]
    Dimension {
        /// Coordinates of a point.
        dim: usize,
    },
    /// Points are not of space.
    #[error("points have {dim} coordinates: surfaces are sought in space, which has 3")]
    SpaceDimension {
        /// Coordinates of a point.
        dim: usize,
    },
    /// The points have no volume, so there is no surface around it.
    #[error("{}: a surface needs four points that are on no common plane", span.of(*points))]
    Flat {
        /// How many there are.
        points: u64,
        /// What they have instead.
        span: Span,
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
    #[error("{points} points are more than the {most} that fit in memory")]
    TooManyPoints {
        /// How many there are.
        points: u64,
        /// How many would have been accepted.
        most: u64,
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
    /// The triangulation that a method stands on could not be built.
    #[error(transparent)]
    Triangulation(#[from] taut_delaunay::Error),
    /// The points could not be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// What points without a volume are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// There is none.
    Nothing,
    /// All are equal.
    Point,
    /// They are on one line.
    Line,
    /// They are on one plane.
    Plane,
}

impl Span {
    /// What so many points are.
    fn of(self, points: u64) -> String {
        match (self, points) {
            (Self::Nothing, _) => "there are no points".to_owned(),
            (Self::Point, 1) => "there is one point".to_owned(),
            (Self::Point, _) => format!("the {points} points are all equal"),
            (Self::Line, _) => format!("the {points} points are on one line"),
            (Self::Plane, _) => format!("the {points} points are on one plane"),
        }
    }
}
