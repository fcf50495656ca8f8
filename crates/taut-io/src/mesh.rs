//! Simplicial meshes on points, to files and back.
//!
//! *Idea.* A simplex is a row of ids, and an id is the number of a row of the points, from 0. So every point is written
//! as a vertex, in input order and copies too, and what is read back speaks of the same rows. Points of the plane get
//! the height 0 where a format wants three coordinates.
//! *Guarantee.* Coordinates and ids are read back to the same bits. What is read names no vertex that is not there.
//! *Trap.* A face of four corners is a quadrilateral in obj and off, never a tetrahedron: these two hold none.

mod format;
pub(crate) mod obj;
mod off;
#[cfg(feature = "arrow")]
mod parquet;
mod ply;
mod reading;
mod vtu;
mod writing;

pub use format::MeshFormat;
pub use reading::{Mesh, open_mesh, open_mesh_bytes};
pub use writing::{mesh_file, write_mesh};

/// The word for simplices of so many vertices.
pub(crate) fn nouns(width: usize) -> &'static str {
    match width {
        1 => "points",
        2 => "edges",
        3 => "triangles",
        _ => "tetrahedra",
    }
}
