//! The errors of this crate.

use taut_points::{Cancelled, InputError, ReadError};

/// The reason why there is no largest shape, or no body in a mesh.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The third number of a row is no number of a ring.
    #[error(
        "the ring number of point {row} is {value:?}: expected 0 for the first point, and for each other point that of the point \
         before or one more"
    )]
    RingNumber {
        /// The row, from 0.
        row: u64,
        /// Its third number.
        value: f64,
    },
    /// A ring has too few vertices.
    #[error(
        "ring {ring} (from 0) has {distinct} distinct vertices in a row: a polygon has at least 3"
    )]
    TooFewVertices {
        /// The ring, from 0.
        ring: usize,
        /// Vertices that differ from the one before them.
        distinct: usize,
    },
    /// Two edges meet that are not neighbors in a ring, or two neighbors meet beyond their common vertex.
    #[error(
        "the edge from point {} to point {} meets the edge from point {} to point {}: rings may neither cross nor touch themselves or each other",
        edge[0], edge[1], other[0], other[1]
    )]
    NotSimple {
        /// The rows of the ends of an edge, from 0.
        edge: [u64; 2],
        /// The rows of the ends of the other one.
        other: [u64; 2],
    },
    /// The area of the shape, its radius or a half axis, or the bound proved for it, overflows or underflows.
    #[error(
        "the area of the shape, its radius or a half axis, or the bound proved for it, is out of the range of double precision: scale the \
         coordinates towards 1"
    )]
    Area,
    /// No point with coordinates in double precision was found that is provably inside.
    #[error(
        "the polygon is too thin: no point in double precision was found inside that is provably away from its edges; if it is \
         far from the origin, shift it to the origin"
    )]
    TooThin,
    /// A method that looks among samples found nothing that lies in the polygon.
    #[error(
        "method `{method}` found nothing in the polygon among its {samples} samples: take more samples, a larger angle, a smaller fatness, or the \
         default method"
    )]
    NoneAmongSamples {
        /// The method.
        method: &'static str,
        /// How many samples it took.
        samples: u64,
    },
    /// The mesh has a boundary: some edge belongs to an odd number of triangles.
    #[error(
        "the mesh is not closed: {edges} of its edges belong to an odd number of triangles, the first of them the edge from \
         {from:?} to {to:?} of triangle {row} (from 0); close the holes of the mesh, or let them be closed by triangles"
    )]
    Open {
        /// How many such edges there are.
        edges: u64,
        /// A triangle with such an edge, from 0.
        row: u64,
        /// One end of that edge.
        from: [f64; 3],
        /// The other end.
        to: [f64; 3],
    },
    /// The mesh has no inside in which a body was found.
    #[error(
        "the mesh has no inside in which a body was found: it is flat, has no triangles, is too thin for a grid of 2^-24 of its \
         longest side, or obstacles leave no room in it"
    )]
    NoInside,
    /// The holes of the mesh are so large that inside and outside cannot be told apart.
    #[error(
        "inside is ambiguous: wherever a body fits, the triangles that close the holes of the mesh fill at least a third of \
         the view; close the mesh where it is meant to be closed"
    )]
    Ambiguous,
    /// No body contains one of the points given.
    #[error("point {at} of those that bodies are to contain (from 0) {problem}")]
    At {
        /// Its position, from 0.
        at: usize,
        /// What is wrong with it.
        problem: &'static str,
    },
    /// The grid cannot hold the mesh.
    #[error(
        "the longest side of the mesh is {side:?}: expected from 1e-83 to 1e100, and no coordinate beyond 6.8e10 times that side; \
         scale the mesh, or shift it to the origin"
    )]
    Grid {
        /// The longest side of the bounding box.
        side: f64,
    },
    /// A point that bodies may not contain is too far from the mesh.
    #[error(
        "row {row}, the point {point:?}, is more than 2^29 units of the grid from the corner of the bounding box of the mesh, which is at least 32 \
         times its longest side: leave the point out, as no body comes near it"
    )]
    FarPoint {
        /// The row, from 0.
        row: u64,
        /// The point.
        point: [f64; 3],
    },
    /// An obstacle reaches so far beyond the mesh that the grid of both would be too coarse.
    #[error(
        "row {row} reaches so far that mesh and obstacles together are more than 32 times as long as the mesh: cut the obstacle off \
         there, as no body comes near it, and see whether both have one unit"
    )]
    FarObstacle {
        /// The row, from 0.
        row: u64,
    },
    /// The tenth number of a row is no number of a surface.
    #[error(
        "the surface of row {row} is {value:?}: expected 0 for the mesh, whose rows come first, 1, 2, … for solids, or -1 for walls and \
         points"
    )]
    Surface {
        /// The row, from 0.
        row: u64,
        /// Its tenth number.
        value: f64,
    },
    /// A solid is not closed.
    #[error(
        "solid {surface} is not closed: give its rows the number -1 of walls, or leave out what is no part of it"
    )]
    OpenSolid {
        /// The number of the solid.
        surface: i32,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {row} names vertex {vertex}, but there are {vertices} vertices")]
    NoVertex {
        /// The triangle, from 0.
        row: u64,
        /// The number that it names, from 0.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// Invalid points or options, a read error, or cancellation by the caller.
    #[error(transparent)]
    Input(#[from] InputError),
}

impl From<ReadError> for Error {
    fn from(error: ReadError) -> Self {
        Error::Input(error.into())
    }
}

impl From<Cancelled> for Error {
    fn from(cancelled: Cancelled) -> Self {
        Error::Input(cancelled.into())
    }
}
