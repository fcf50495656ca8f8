//! Meshes: points, edges, triangles or tetrahedra on vertices, with the normals and colors that vertices have.
//!
//! *Idea.* One codec per format. A reader hands what it finds to one builder, which checks it: coordinates are finite, corners
//! are vertices. The caller says which content it wants. A *triangulation* has simplices of one dimension, and whatever else
//! the file holds is refused. A *surface* has triangles or vertices alone: a polygon of more than three corners becomes the fan
//! of triangles around its first corner, and edges, points, textures, materials, groups and opacity are passed over.
//! *Guarantee.* Vertices keep their order, used or not. Coordinates and ids of a triangulation are read back to the same bits;
//! the table of [`Format`](crate::Format) says what each format keeps of a surface. What a file says of its own length is
//! compared with what is there and never trusted: memory grows with what was read.
//! *Trap.* Normals and colors are kept where each vertex has one, and only one.

mod builder;
mod colors;
mod dxf;
mod gltf;
mod normal;
mod obj;
mod off;
#[cfg(feature = "arrow")]
mod parquet;
mod ply;
mod pov;
mod reading;
mod spooled;
mod stl;
mod triangles;
mod vrml;
mod vtu;
mod writing;
mod xyz;

use taut_mesh::TriangleMesh;
use taut_points::PointSource;

use crate::Error;

pub(crate) use builder::{MeshBuilder, printable};
pub(crate) use reading::read_stream;
pub use reading::{open_mesh, open_mesh_bytes};
pub use spooled::SpooledSimplices;
pub use triangles::open_triangles;
pub use writing::{Encoding, MeshOptions, mesh_bytes, mesh_file, write_mesh};

/// Simplices of one dimension on vertices, or vertices alone, as files hold them.
///
/// A mesh that was read is sound: all coordinates and normals are finite, and all ids are vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The vertices, used or not, in the order of the file; empty where the format has none.
    pub vertices: Vec<[f64; 3]>,
    /// Vertices of a simplex, 1 to 4; 3 of a surface.
    pub width: usize,
    /// The simplices: rows of `width` ids, each the number of a vertex, from 0. Empty of a point set.
    pub simplices: Vec<u32>,
    /// The normal of each vertex, of any length, as the file has it.
    pub normals: Option<Vec<[f64; 3]>>,
    /// Red, green and blue of each vertex.
    pub colors: Option<Vec<[u8; 3]>>,
}

impl Default for Mesh {
    /// A surface without vertices.
    fn default() -> Self {
        Mesh { vertices: Vec::new(), width: 3, simplices: Vec::new(), normals: None, colors: None }
    }
}

impl Mesh {
    /// A surface without normals and colors.
    pub fn of_triangles(vertices: Vec<[f64; 3]>, triangles: &[[u32; 3]]) -> Self {
        Mesh { vertices, simplices: triangles.as_flattened().to_vec(), ..Mesh::default() }
    }

    /// The triangles; none where simplices are of another dimension.
    pub fn triangles(&self) -> &[[u32; 3]] {
        if self.width == 3 { self.simplices.as_chunks().0 } else { &[] }
    }

    /// The surface as it is written. O(n).
    ///
    /// # Errors
    /// Those of [`TriangleMesh::new`]; a surface that was read has none of them.
    pub fn view(&self) -> Result<MeshView<'_>, taut_mesh::Error> {
        let mesh = TriangleMesh::new(&self.vertices, self.triangles())?;
        let (normals, colors) = (self.normals.as_deref(), self.colors.as_deref());
        Ok(MeshView { normals, colors, ..mesh.into() })
    }
}

/// A mesh, borrowed, as it is written: a surface from [`Mesh::view`] or a [`TriangleMesh`], or simplices
/// [on points](MeshView::on_points).
#[derive(Clone, Copy)]
pub struct MeshView<'a> {
    vertices: Vertices<'a>,
    width: usize,
    simplices: Simplices<'a>,
    normals: Option<&'a [[f64; 3]]>,
    colors: Option<&'a [[u8; 3]]>,
}

#[derive(Clone, Copy)]
enum Vertices<'a> {
    /// The rows of a point set, which may be larger than memory.
    Points(&'a dyn PointSource),
    /// Finite places in memory.
    Places(&'a [[f64; 3]]),
}

#[derive(Clone, Copy)]
enum Simplices<'a> {
    /// Rows of ids in memory.
    Ids(&'a [u32]),
    /// More than memory may hold.
    Stream(&'a dyn SimplexSource),
}

/// Simplices that are read piece by piece, in the same order as often as asked.
pub trait SimplexSource: Sync {
    /// The number of simplices.
    fn count(&self) -> u64;

    /// Hands all simplices to `put`, as rows of ids, some whole simplices at a time.
    ///
    /// # Errors
    /// Those of `put`, and what the medium says.
    fn read(&self, put: &mut dyn FnMut(&[u32]) -> Result<(), Error>) -> Result<(), Error>;
}

impl<'a> MeshView<'a> {
    /// A triangulation as [`on_points`](Self::on_points), of which memory need not hold the simplices.
    pub fn streamed(
        points: &'a dyn PointSource,
        simplices: &'a dyn SimplexSource,
        width: usize,
    ) -> Self {
        let vertices = Vertices::Points(points);
        let simplices = Simplices::Stream(simplices);
        MeshView { vertices, width, simplices, normals: None, colors: None }
    }

    /// A triangulation: rows of `width` ids, 1 to 4, of rows of `points`. All points are written as vertices, in order.
    pub fn on_points(points: &'a dyn PointSource, simplices: &'a [u32], width: usize) -> Self {
        let vertices = Vertices::Points(points);
        let simplices = Simplices::Ids(simplices);
        MeshView { vertices, width, simplices, normals: None, colors: None }
    }

    fn vertex_count(&self) -> u64 {
        match self.vertices {
            Vertices::Points(source) => source.len(),
            Vertices::Places(places) => places.len() as u64,
        }
    }

    fn simplex_count(&self) -> u64 {
        match self.simplices {
            Simplices::Ids(ids) => (ids.len() / self.width) as u64,
            Simplices::Stream(source) => source.count(),
        }
    }

    /// The ids, where memory holds them.
    fn ids(&self) -> &'a [u32] {
        match self.simplices {
            Simplices::Ids(ids) => ids,
            Simplices::Stream(_) => &[],
        }
    }

    /// The vertices of a surface.
    fn places(&self) -> &'a [[f64; 3]] {
        match self.vertices {
            Vertices::Points(_) => &[],
            Vertices::Places(places) => places,
        }
    }

    fn triangles(&self) -> &'a [[u32; 3]] {
        self.ids().as_chunks().0
    }
}

impl<'a> From<TriangleMesh<'a>> for MeshView<'a> {
    /// Without normals and colors.
    fn from(mesh: TriangleMesh<'a>) -> Self {
        MeshView {
            vertices: Vertices::Places(mesh.vertices()),
            width: 3,
            simplices: Simplices::Ids(mesh.triangles().as_flattened()),
            normals: None,
            colors: None,
        }
    }
}

/// The word for simplices of so many vertices.
pub(crate) fn nouns(width: usize) -> &'static str {
    match width {
        1 => "points",
        2 => "edges",
        3 => "triangles",
        _ => "tetrahedra",
    }
}
