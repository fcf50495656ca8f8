//! The violations of an inscribed circle.

use crate::Fault;

/// Why an inscribed circle or its certificate is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CircleViolation {
    /// The center is not inside the polygon.
    #[error("the center ({x:?}, {y:?}) is not inside the polygon")]
    CenterOutside {
        /// The first coordinate of the center.
        x: f64,
        /// The second one.
        y: f64,
    },
    /// An edge may enter the circle.
    #[error(
        "the edge that begins at point {row} is only proved to be {distance:?} from the center, less than the radius"
    )]
    EdgeInside {
        /// The row at which the edge begins, from 0.
        row: u64,
        /// A lower bound of its distance from the center.
        distance: f64,
    },
    /// The list of touching edges is empty, or has an entry that does not belong there.
    #[error("entry {position} of the touching edges {problem}")]
    Touching {
        /// Position in the list, from 0.
        position: usize,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// The subdivision is not one of the bounding box.
    #[error("letter {position} of the tree {problem}")]
    Tree {
        /// Position in the tree, from 0.
        position: usize,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// A cell is malformed.
    #[error("entry {leaf} of the leaves {problem}")]
    Leaf {
        /// Position in the list, from 0.
        leaf: usize,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// The gap proved is larger than the gap claimed.
    #[error("the leaves prove a gap of {proved:e}, the certificate claims {claimed:e}")]
    Gap {
        /// The value that the certificate claims.
        claimed: f64,
        /// The result of the checker.
        proved: f64,
    },
}

impl CircleViolation {
    /// Returns what this violation blames.
    pub(crate) fn fault(&self) -> Fault {
        match *self {
            CircleViolation::EdgeInside { row, .. } => Fault::Row(row),
            _ => Fault::Answer,
        }
    }
}
