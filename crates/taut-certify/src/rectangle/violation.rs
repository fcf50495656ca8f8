//! What can be wrong with an inscribed rectangle.

use crate::Fault;

/// Why an inscribed rectangle or its certificate is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RectangleViolation {
    /// The corners are not in order, or no number is between them.
    #[error("the rectangle has no inside along axis {axis}: it reaches from {low:?} to {high:?}")]
    Flat {
        /// The axis, from 0.
        axis: usize,
        /// The lower end.
        low: f64,
        /// The upper end.
        high: f64,
    },
    /// The rectangle is not inside the rings.
    #[error("the rectangle is outside the rings")]
    Outside,
    /// An edge enters the rectangle.
    #[error("the edge that begins at point {row} enters the rectangle")]
    EdgeInside {
        /// The row at which the edge begins, from 0.
        row: u64,
    },
    /// The area is not that of the sides, or no normal number.
    #[error("the area is {claimed:?}, but the sides give {found:?}")]
    Area {
        /// What the answer says.
        claimed: f64,
        /// What the sides give.
        found: f64,
    },
    /// The tree is no subdivision of all rectangles, or a reason in it does not hold.
    #[error("letter {position} of the tree {problem}")]
    Tree {
        /// Position in the tree, from 0.
        position: usize,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// An entry of the edges belongs to no cell.
    #[error("entry {position} of the edges belongs to no cell")]
    Edge {
        /// Position in the list, from 0.
        position: usize,
    },
    /// The gap proved is larger than the gap claimed.
    #[error("the cells prove a gap of {proved:e}, the certificate claims {claimed:e}")]
    Gap {
        /// What the certificate says.
        claimed: f64,
        /// What the checker finds.
        proved: f64,
    },
}

impl RectangleViolation {
    /// Returns what this violation blames.
    pub(crate) fn fault(&self) -> Fault {
        match *self {
            RectangleViolation::EdgeInside { row } => Fault::Row(row),
            _ => Fault::Answer,
        }
    }
}
