//! The violations of a mesh before any geometry begins.

/// Why a mesh could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A corner of a triangle names a vertex that does not exist.
    #[error(
        "corner {corner} of triangle {triangle}, both counted from 0, is vertex {index}, but there are {vertices} vertices"
    )]
    Index {
        /// The triangle, from 0.
        triangle: usize,
        /// Its corner: 0, 1 or 2.
        corner: usize,
        /// The index that it names.
        index: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// A coordinate is infinite or not a number.
    #[error(
        "coordinate {column} of vertex {vertex}, both counted from 0, is {value}: all must be finite"
    )]
    NonFinite {
        /// The vertex, from 0.
        vertex: usize,
        /// The coordinate: 0, 1 or 2.
        column: usize,
        /// Its value.
        value: f64,
    },
    /// More triangles than can be numbered.
    #[error("{triangles} triangles are too many for one mesh: {most} is the most")]
    TooMany {
        /// The number of them.
        triangles: usize,
        /// The largest number that is accepted.
        most: usize,
    },
}
