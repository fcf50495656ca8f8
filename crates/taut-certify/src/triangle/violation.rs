//! What can be wrong with an inscribed triangle.

use crate::Fault;

/// Why an inscribed triangle or its certificate is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TriangleViolation {
    /// The corners are not in counterclockwise order.
    #[error("the corners are not in counterclockwise order, or on one line")]
    Orientation,
    /// The centroid is not inside the polygon, or too near to a side to tell.
    #[error("the centroid ({x:?}, {y:?}) is not provably inside the triangle and the polygon")]
    CentroidOutside {
        /// The first coordinate of the centroid.
        x: f64,
        /// The second one.
        y: f64,
    },
    /// The area is not that of the corners, or no normal number.
    #[error("the area is {claimed:?}, but the corners give {found:?}")]
    Area {
        /// What the answer says.
        claimed: f64,
        /// What the corners give.
        found: f64,
    },
    /// An edge enters the triangle.
    #[error("the edge that begins at point {row} enters the triangle")]
    EdgeInside {
        /// The row at which the edge begins, from 0.
        row: u64,
    },
    /// The list of touching edges is empty, or has an entry that does not belong there.
    #[error("entry {position} of the touching edges {problem}")]
    Touching {
        /// Position in the list, from 0.
        position: usize,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// The skew or the root is out of its range.
    #[error("{what} is out of its range")]
    Range {
        /// The number in question.
        what: &'static str,
    },
    /// The tree is no subdivision of all positions of the corners, or gives a reason that does not hold.
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
    /// The gap proved is larger than the gap claimed.
    #[error("the leaves prove a gap of {proved:e}, the certificate claims {claimed:e}")]
    Gap {
        /// What the certificate says.
        claimed: f64,
        /// What the checker finds.
        proved: f64,
    },
}

impl TriangleViolation {
    /// Returns what this violation blames.
    pub(crate) fn fault(&self) -> Fault {
        match *self {
            TriangleViolation::EdgeInside { row } => Fault::Row(row),
            _ => Fault::Answer,
        }
    }
}
