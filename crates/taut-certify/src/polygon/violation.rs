//! What can keep points from being a polygon.

use crate::Fault;

/// Why points are no polygon.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonViolation {
    /// The points are neither of the plane nor rings.
    #[error(
        "the points have {dim} coordinates: the vertices of a polygon have 2, or 3 with the number of the ring"
    )]
    Plane {
        /// Coordinates of a point.
        dim: usize,
    },
    /// The third number of a row is no number of a ring.
    #[error(
        "the ring number of point {row} is {value:?}: expected that of the point before or one more, and 0 for the first"
    )]
    RingNumber {
        /// The row, from 0.
        row: u64,
        /// Its third number.
        value: f64,
    },
}

impl PolygonViolation {
    /// Returns what this violation blames.
    pub(crate) fn fault(&self) -> Fault {
        match *self {
            PolygonViolation::Plane { .. } => Fault::Points,
            PolygonViolation::RingNumber { row, .. } => Fault::Row(row),
        }
    }
}
