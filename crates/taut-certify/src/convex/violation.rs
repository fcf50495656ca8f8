//! What can be wrong with a convex polygon.

use crate::Fault;

/// Why a convex polygon or its certificate is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConvexViolation {
    /// There are fewer than three corners.
    #[error("the polygon has {corners} corners: at least 3 are needed")]
    TooFewCorners {
        /// How many there are.
        corners: usize,
    },
    /// At a corner the border does not turn left.
    #[error(
        "the border does not turn left at corner {corner}: corners are counterclockwise, and no three of them on a line"
    )]
    NotConvex {
        /// The corner, from 0.
        corner: usize,
    },
    /// The border winds around more than once.
    #[error("the border winds around {turns} times")]
    Winding {
        /// How many times.
        turns: usize,
    },
    /// The point inside is not strictly inside the convex polygon.
    #[error("the point ({x:?}, {y:?}) is not strictly inside the convex polygon")]
    WitnessOutside {
        /// The first coordinate of the point.
        x: f64,
        /// The second one.
        y: f64,
    },
    /// The point inside is outside the outer polygon.
    #[error("the point ({x:?}, {y:?}) of the convex polygon is outside the rings")]
    Outside {
        /// The first coordinate of the point.
        x: f64,
        /// The second one.
        y: f64,
    },
    /// An edge enters the convex polygon.
    #[error("the edge that begins at point {row} enters the convex polygon")]
    EdgeInside {
        /// The row at which the edge begins, from 0.
        row: u64,
    },
    /// The area is not that of the corners, or no normal number.
    #[error("the area is {claimed:?}, but the corners give {found:?}")]
    Area {
        /// What the answer says.
        claimed: f64,
        /// What the corners give.
        found: f64,
    },
    /// The gap proved is larger than the gap claimed.
    #[error("a gap of {proved:e} is proved, the certificate claims {claimed:e}")]
    Gap {
        /// What the certificate says.
        claimed: f64,
        /// What the checker finds.
        proved: f64,
    },
}

impl ConvexViolation {
    /// Returns what this violation blames.
    pub(crate) fn fault(&self) -> Fault {
        match *self {
            ConvexViolation::EdgeInside { row } => Fault::Row(row),
            _ => Fault::Answer,
        }
    }
}
