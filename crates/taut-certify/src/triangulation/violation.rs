//! The violations of a triangulation.

use std::fmt;

/// Where a triangulation or its certificate is wrong. Simplices and facets of the hull are numbered from 0, as listed;
/// facet i of a simplex is the one opposite its vertex i.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshViolation {
    /// The answer is of another dimension than the points, or of one that is not 2 or 3.
    #[error(
        "the triangulation is of dimension {claimed}, but the points have dimension {found}: expected 2 or 3, and the same"
    )]
    Dimension {
        /// The value that the answer claims.
        claimed: u8,
        /// Dimension of the points.
        found: usize,
    },
    /// There are more rows than 32-bit ids can name.
    #[error("there are {rows} points: ids of triangulations have 32 bits")]
    TooMany {
        /// Number of rows.
        rows: u64,
    },
    /// The affine hull of the points has another dimension.
    #[error("the hull of the points is {}, but the answer says {}", Hull(*found), Hull(*claimed))]
    HullDimension {
        /// The value that the answer claims.
        claimed: Option<u8>,
        /// The value that the points have.
        found: Option<u8>,
    },
    /// A count of the certificate is wrong.
    #[error("the certificate counts {claimed} {what}, there are {found}")]
    Count {
        /// The objects that are counted.
        what: &'static str,
        /// The value that the certificate claims.
        claimed: u64,
        /// The value found.
        found: u64,
    },
    /// An id is no row of the points.
    #[error("{list} entry {position} names point {id}, but there are not so many")]
    Id {
        /// The list that has it.
        list: &'static str,
        /// Row of that list.
        position: usize,
        /// The id.
        id: u32,
    },
    /// A point is neither a vertex nor a duplicate.
    #[error("point {row} is a vertex of no simplex, nor listed as a duplicate")]
    Missing {
        /// The first such point.
        row: u32,
    },
    /// An entry of the duplicates is wrong.
    #[error("duplicate {position} says that point {row} equals point {first}: {problem}")]
    Duplicate {
        /// Position in the list, from 0.
        position: usize,
        /// The point.
        row: u32,
        /// The row that it is said to equal.
        first: u32,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// A simplex is flat or turned the wrong way round.
    #[error("simplex {simplex} is not positively oriented")]
    Orientation {
        /// The simplex.
        simplex: usize,
    },
    /// The neighbor named across a facet does not share it, or does not know of it.
    #[error("simplex {simplex} names simplex {neighbor} across facet {facet}: {problem}")]
    Neighbor {
        /// The simplex.
        simplex: usize,
        /// Its facet.
        facet: usize,
        /// The neighbor it names.
        neighbor: u32,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// A facet belongs to more than two simplices, or to two on the same side.
    #[error("facet {facet} of simplex {simplex} is one of more than two, or of two on one side")]
    Shared {
        /// The simplex.
        simplex: usize,
        /// Its facet.
        facet: usize,
    },
    /// A facet has a simplex on one side only, and is not listed on the hull.
    #[error("facet {facet} of simplex {simplex} has no other side, and is not listed on the hull")]
    Open {
        /// The simplex.
        simplex: usize,
        /// Its facet.
        facet: usize,
    },
    /// A listed facet of the hull is no facet with one side, or is listed twice.
    #[error("hull facet {position} is not a facet of one simplex alone, or is listed twice")]
    HullFacet {
        /// Its place in the list.
        position: usize,
    },
    /// The facets of the hull do not close up to surfaces, or to one cycle in the plane.
    #[error("the hull does not close up to {} at point {row}", if *.dimension == 3 { "a surface" } else { "one cycle" })]
    HullOpen {
        /// Dimension of the hull.
        dimension: u8,
        /// A point where it does not.
        row: u32,
    },
    /// Two facets of the hull meet in a dent, or are folded onto each other.
    #[error("the hull is not convex at point {row}, beyond the ridge or point {}", Ids(ridge))]
    HullDent {
        /// The ridge: a point in the plane, the two ends of an edge in space.
        ridge: Vec<u32>,
        /// The vertex beyond it that lies outside the facet before it.
        row: u32,
    },
    /// A point lies outside a facet of the hull, or the hull winds more than once around the points.
    #[error("the hull winds around the points more than once, or not at all: seen at point {row}")]
    HullWinding {
        /// Where this was seen.
        row: u32,
    },
    /// A point lies in the open circumsphere of a simplex, or on it where the perturbation puts it inside.
    #[error("{}", conflict(*simplex, *neighbor, *row, *tie))]
    Conflict {
        /// The simplex.
        simplex: usize,
        /// The simplex across a facet from it that has the point.
        neighbor: usize,
        /// The point.
        row: u32,
        /// True if the point lies on the sphere.
        tie: bool,
    },
    /// Simplex `position` of the chain of collinear points does not continue it.
    #[error("edge {position} of the chain is not from a point to the next in lexicographic order")]
    Chain {
        /// Place in the list.
        position: usize,
    },
    /// The simplices have another fingerprint than the certificate says.
    #[error("the simplices have fingerprint {found}, the certificate says {claimed}")]
    Fingerprint {
        /// The value that the certificate claims.
        claimed: super::Fingerprint,
        /// The value of the points.
        found: super::Fingerprint,
    },
}

/// The words for the hull of points.
struct Hull(Option<u8>);

impl fmt::Display for Hull {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            None => f.write_str("empty"),
            Some(0) => f.write_str("a point"),
            Some(1) => f.write_str("on a line"),
            Some(dimension) => write!(f, "of dimension {dimension}"),
        }
    }
}

struct Ids<'a>(&'a [u32]);

impl fmt::Display for Ids<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, id) in self.0.iter().enumerate() {
            write!(f, "{}{id}", if place == 0 { "" } else { "–" })?;
        }
        Ok(())
    }
}

fn conflict(simplex: usize, neighbor: usize, row: u32, tie: bool) -> String {
    match tie {
        false => format!(
            "point {row}, of simplex {neighbor}, lies inside the circumsphere of its neighbor, simplex {simplex}"
        ),
        true => format!(
            "point {row}, of simplex {neighbor}, lies on the circumsphere of its neighbor, simplex {simplex}, and the \
             perturbation puts it inside"
        ),
    }
}
