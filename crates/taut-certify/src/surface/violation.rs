//! The violations of a surface.

use super::SurfaceDoubt;

/// Why a surface or its certificate is wrong. Triangles and components are counted from 0.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceViolation {
    /// The points are not of space.
    #[error("the points have {dim} coordinates: surfaces are of space, which has 3")]
    Space {
        /// Coordinates of a point.
        dim: usize,
    },
    /// There are more triangles than numbers of corners have room for.
    #[error("there are {triangles} triangles: a third of 2^32 is the most")]
    TooMany {
        /// The number of them.
        triangles: usize,
    },
    /// A corner is no row.
    #[error("corner {corner} of triangle {triangle} is point {row}, but there are {rows} points")]
    Corner {
        /// The triangle.
        triangle: usize,
        /// 0, 1 or 2.
        corner: usize,
        /// The row that it names.
        row: u32,
        /// Rows there are.
        rows: u64,
    },
    /// A triangle has a vertex twice.
    #[error("triangle {triangle} names point {row} twice")]
    Repeated {
        /// The triangle.
        triangle: usize,
        /// The row.
        row: u32,
    },
    /// Two triangles have the same three vertices.
    #[error("triangle {triangle} has the vertices of triangle {first}")]
    Twice {
        /// The later one.
        triangle: u32,
        /// The earlier one.
        first: u32,
    },
    /// An entry of a list of unused rows is wrong.
    #[error("entry {position} of the list of {list} names point {row}, {problem}")]
    Unused {
        /// The list.
        list: &'static str,
        /// Position in the list, from 0.
        position: usize,
        /// The row.
        row: u32,
        /// The reason for the refusal.
        problem: &'static str,
    },
    /// A row is neither the vertex of a triangle nor listed as unused.
    #[error("point {row} is the vertex of no triangle, nor listed as unused")]
    Missing {
        /// The first such row.
        row: u32,
    },
    /// A row is in the place of an earlier one, but not listed so.
    #[error("point {row} is in the place of point {first}, but not listed as its duplicate")]
    MissingDuplicate {
        /// The first such row.
        row: u32,
        /// The first row in that place.
        first: u32,
    },
    /// A row that is said to be inside the closed components is not.
    #[error("point {row} is said to be interior, but {problem}")]
    Interior {
        /// The first such row.
        row: u32,
        /// The problem.
        problem: &'static str,
    },
    /// A doubt about the topology names no row, or one that is no row.
    #[error("doubt {doubt} names {row}: expected at least one row, all below {rows}")]
    DoubtRows {
        /// The doubt, counted from 0.
        doubt: usize,
        /// What it names.
        row: String,
        /// Rows there are.
        rows: u64,
    },
    /// A number of the topology is wrong.
    #[error("the topology says that {what} is {claimed}, but it is {found}")]
    Topology {
        /// The number in question.
        what: String,
        /// The value that the answer claims.
        claimed: String,
        /// The value that the triangles give.
        found: String,
    },
    /// The surface is to be closed, but an edge has one triangle only.
    #[error("the surface is said to be closed, but the edge of rows {} and {} has one triangle only", edge[0], edge[1])]
    Open {
        /// The first such edge.
        edge: [u32; 2],
    },
    /// A triangle is larger than the radius of the mode allows.
    #[error("the circle of triangle {triangle} is larger than the radius {radius:?}, or none")]
    Radius {
        /// The first such triangle.
        triangle: usize,
        /// The radius claimed.
        radius: f64,
    },
    /// A triangle that is said to have an empty ball has no ball at all.
    #[error("triangle {triangle} is said to have an empty ball, but {problem}")]
    NoBall {
        /// The triangle.
        triangle: usize,
        /// Why there is none.
        problem: &'static str,
    },
    /// The ball of a triangle is not empty.
    #[error("the ball of triangle {triangle}, {ball}, holds point {row}")]
    Ball {
        /// The first such triangle.
        triangle: usize,
        /// Which ball.
        ball: &'static str,
        /// A row strictly inside.
        row: u32,
    },
    /// A triangle that is said to be a facet of the hull has points beyond it on both sides.
    #[error(
        "triangle {triangle} is said to be a facet of the hull, but rows {} and {} are not on one side of it",
        rows[0], rows[1]
    )]
    Hull {
        /// The triangle.
        triangle: usize,
        /// One beyond either side, or inside the circle.
        rows: [u32; 2],
    },
    /// The surface meets itself, though it is claimed not to.
    #[error("the surface is claimed to be embedded, but {doubt}")]
    NotEmbedded {
        /// Where.
        doubt: SurfaceDoubt,
    },
    /// The surface is claimed to meet itself, but does not.
    #[error("the surface is claimed not to be embedded, but it meets itself nowhere")]
    Embedded,
    /// The surface does not face outwards, though it is claimed to.
    #[error("the surface is claimed to face outwards, but {doubt}")]
    NotOutward {
        /// Where, or why that cannot be said of it.
        doubt: SurfaceDoubt,
    },
    /// The surface is claimed not to face outwards, but does.
    #[error("the surface is claimed not to face outwards, but every closed component does")]
    Outward,
    /// The largest distance of a vertex from its row is not as claimed.
    #[error("vertices are up to {found:e} from their rows, the certificate claims {claimed:e}")]
    Displacement {
        /// The value that the certificate claims.
        claimed: f64,
        /// The value found, rounded up.
        found: f64,
    },
}
