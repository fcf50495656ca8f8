//! The errors of a reconstruction.

use taut_points::{Cancelled, InputError, ReadError};

/// Why there is no curve or surface.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The points have no volume, so there is no surface around it.
    #[error("{}: a surface needs four points that are on no common plane", span.of(*points))]
    Flat {
        /// The number of them.
        points: u64,
        /// The affine hull that they have instead.
        span: Span,
    },
    /// The triangulation that a method stands on could not be built.
    #[error(transparent)]
    Triangulation(taut_delaunay::Error),
    /// Invalid points or options, a read error, or cancellation by the caller.
    #[error(transparent)]
    Input(#[from] InputError),
}

impl From<taut_delaunay::Error> for Error {
    fn from(error: taut_delaunay::Error) -> Self {
        match error {
            taut_delaunay::Error::Input(error) => Error::Input(error),
            other => Error::Triangulation(other),
        }
    }
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

/// The affine hull of points without a volume.
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
