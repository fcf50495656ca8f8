//! What can be wrong with inscribed bodies.

use crate::Fault;

/// Why inscribed bodies or their certificate are wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BodiesViolation {
    /// The rows are not triangles.
    #[error(
        "the rows have {dim} numbers: a triangle of space has 9, and 10 with the number of its surface"
    )]
    Triangles {
        /// Numbers of a row.
        dim: usize,
    },
    /// The tenth number of a row is no number of a surface.
    #[error("the surface of triangle {row} is {value:?}: expected a whole number of at least -1")]
    Surface {
        /// The triangle, from 0.
        row: u64,
        /// Its tenth number.
        value: f64,
    },
    /// The mesh with its caps, or a solid, has a boundary: an edge belongs to an odd number of its triangles.
    #[error(
        "the mesh is not closed: the edge from {from:?} to {to:?} of triangle {row} belongs to an odd number of triangles"
    )]
    Open {
        /// A triangle with this edge, from 0; caps count on from the rows.
        row: u64,
        /// One end of the edge.
        from: [f64; 3],
        /// The other end.
        to: [f64; 3],
    },
    /// The caps are not those of holes.
    #[error("the caps {problem}")]
    Caps {
        /// What is wrong with them.
        problem: &'static str,
    },
    /// The grid is out of range, or too far from a triangle.
    #[error("the grid does not fit the mesh: {problem}")]
    Grid {
        /// What is wrong with it.
        problem: &'static str,
    },
    /// The answer has no body.
    #[error("the answer has no body")]
    NoBody,
    /// A body or its proof is malformed.
    #[error("body {body} {problem}")]
    Body {
        /// Position of the body, from 0.
        body: usize,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// A facet of a body is malformed.
    #[error("facet {facet} of body {body} {problem}")]
    Facet {
        /// Position of the body, from 0.
        body: usize,
        /// Position of the facet, from 0.
        facet: usize,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// An entry of the combined facets of a proof is malformed.
    #[error("entry {entry} of the combined facets of body {body} {problem}")]
    Combined {
        /// Position of the body, from 0.
        body: usize,
        /// Position of the entry, from 0.
        entry: usize,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// A triangle may reach into a body.
    #[error("triangle {row} is not proved to stay out of body {body}")]
    Reaches {
        /// The triangle, from 0.
        row: u64,
        /// Position of the body, from 0.
        body: usize,
    },
    /// A cap may reach into a body.
    #[error("cap {cap} is not proved to stay out of body {body}")]
    CapReaches {
        /// The cap, from 0.
        cap: u64,
        /// Position of the body, from 0.
        body: usize,
    },
    /// A body does not contain the point given for it.
    #[error("body {body} is not proved to contain the point given for it")]
    At {
        /// Position of the body, from 0.
        body: usize,
    },
    /// A body is not inside the mesh.
    #[error("body {body} is not inside the mesh")]
    Outside {
        /// Position of the body, from 0.
        body: usize,
    },
    /// The volume of a body is not that of its half-spaces.
    #[error("the volume of body {body} is {claimed:?}, but its half-spaces give {found:?}")]
    Volume {
        /// Position of the body, from 0.
        body: usize,
        /// What the answer says.
        claimed: f64,
        /// What the checker finds.
        found: f64,
    },
    /// Two bodies are not proved to be disjoint.
    #[error("bodies {first} and {second} are not proved to be disjoint: {problem}")]
    Pair {
        /// Position of one body, from 0.
        first: usize,
        /// Position of the other body.
        second: usize,
        /// What is wrong with the proof.
        problem: &'static str,
    },
}

impl BodiesViolation {
    /// Returns what this violation blames.
    pub(crate) fn fault(&self) -> Fault {
        match *self {
            BodiesViolation::Triangles { .. } | BodiesViolation::Open { .. } => Fault::Points,
            BodiesViolation::Surface { row, .. } => Fault::Row(row),
            BodiesViolation::Reaches { row, .. } => Fault::Row(row),
            _ => Fault::Answer,
        }
    }
}
