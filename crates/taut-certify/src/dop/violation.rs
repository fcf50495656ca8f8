//! What can be wrong with a bounding dop.

use crate::Fault;

/// Why a bounding dop or its certificate is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DopViolation {
    /// The rows are not points of space.
    #[error("the points have dimension {dim}: a bounding dop is one of points of space")]
    Space {
        /// Their dimension.
        dim: usize,
    },
    /// The half-spaces are malformed.
    #[error("facet {facet} {problem}")]
    Facet {
        /// Position of the facet, from 0; the number of facets where one is missing.
        facet: usize,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// The half-spaces have no volume that numbers hold.
    #[error(
        "the longest side is {side:?}: expected 0, or from 1e-76 to 1e105, as its cube must be a number"
    )]
    Range {
        /// The longest side along an axis.
        side: f64,
    },
    /// A point is not in the dop.
    #[error("point {row} is outside facet {facet}")]
    Outside {
        /// The row, from 0.
        row: u64,
        /// Position of the facet, from 0.
        facet: usize,
    },
    /// A facet does not touch the row that is said to touch it.
    #[error("facet {facet} does not touch point {row}: it could move inward")]
    Loose {
        /// Position of the facet, from 0.
        facet: usize,
        /// The row, from 0.
        row: u64,
    },
    /// A facet is said to touch a row that does not exist.
    #[error("facet {facet} is said to touch point {row}, which does not exist")]
    NoRow {
        /// Position of the facet, from 0.
        facet: usize,
        /// The row, from 0.
        row: u64,
    },
    /// The list of vertices is not that of the half-spaces.
    #[error("{problem} ({}, {}, {})", at[0], at[1], at[2])]
    Vertex {
        /// What is wrong with it.
        problem: &'static str,
        /// A vertex.
        at: [f64; 3],
    },
    /// The volume is not that of the half-spaces.
    #[error("the volume is {claimed:?}, but the half-spaces give {found:?}")]
    Volume {
        /// What the answer says.
        claimed: f64,
        /// What the checker finds.
        found: f64,
    },
}

impl DopViolation {
    /// Returns what this violation blames, given that there are `rows` points.
    pub(crate) fn fault(&self, rows: u64) -> Fault {
        match *self {
            DopViolation::Space { .. } => Fault::Points,
            DopViolation::Outside { row, .. } => Fault::Row(row),
            DopViolation::NoRow { row, .. } if row >= rows => Fault::Points,
            _ => Fault::Answer,
        }
    }
}
