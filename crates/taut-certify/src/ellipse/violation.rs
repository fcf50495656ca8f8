//! What can be wrong with an inscribed ellipse.

use crate::Fault;

/// Why an inscribed ellipse or its certificate is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EllipseViolation {
    /// The center is not inside the polygon.
    #[error("the center ({x:?}, {y:?}) is not inside the polygon")]
    CenterOutside {
        /// The first coordinate of the center.
        x: f64,
        /// The second one.
        y: f64,
    },
    /// The determinant of the axes is not provably above 0.
    #[error("the axes span no area: their determinant is not provably above 0")]
    Flat,
    /// The area is not that of the axes, or no normal number.
    #[error("the area is {claimed:?}, but the axes give {found:?}")]
    Area {
        /// What the answer says.
        claimed: f64,
        /// What the axes give.
        found: f64,
    },
    /// An edge enters the ellipse.
    #[error("the edge that begins at point {row} enters the ellipse")]
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
    /// The root or a direction is out of its range.
    #[error("{what} is out of its range")]
    Range {
        /// The number in question.
        what: &'static str,
    },
    /// The tree is no subdivision of all shapes and centers.
    #[error("letter {position} of the tree {problem}")]
    Tree {
        /// Position in the tree, from 0.
        position: usize,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// The reason for a cell is malformed.
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

impl EllipseViolation {
    /// Returns what this violation blames.
    pub(crate) fn fault(&self) -> Fault {
        match *self {
            EllipseViolation::EdgeInside { row } => Fault::Row(row),
            _ => Fault::Answer,
        }
    }
}
