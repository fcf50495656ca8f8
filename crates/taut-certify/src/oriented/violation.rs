//! What can be wrong with an inscribed oriented rectangle.

use crate::Fault;

/// Why an inscribed oriented rectangle or its certificate is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OrientedRectangleViolation {
    /// The axis is too short for the arithmetic of the checker.
    #[error("the axis is too short beside the coordinates of the polygon")]
    Flat,
    /// The center is not inside the rings.
    #[error("the center of the rectangle is outside the rings")]
    Outside,
    /// An edge enters the rectangle, or comes too near to tell.
    #[error("the edge that begins at point {row} is not provably outside the rectangle")]
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
    /// The reason for a cell is malformed or does not hold.
    #[error("entry {leaf} of the leaves {problem}")]
    Leaf {
        /// Position in the list, from 0.
        leaf: usize,
        /// What is wrong with it.
        problem: &'static str,
    },
}

impl OrientedRectangleViolation {
    /// Returns what this violation blames.
    pub(crate) fn fault(&self) -> Fault {
        match *self {
            OrientedRectangleViolation::EdgeInside { row } => Fault::Row(row),
            _ => Fault::Answer,
        }
    }
}
