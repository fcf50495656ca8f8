//! Shapes: triangles on vertices, or vertices alone, with the normals and colours that vertices have.
//!
//! *Idea.* A reader hands what it finds to one builder, which checks it: coordinates are finite, corners are vertices.
//! Vertices keep their order, used or not. A polygon of more than three corners becomes the fan of triangles around its
//! first corner. What each format keeps is in the table of [`ShapeFormat`].
//! *Guarantee.* What a file says of its own length is compared with what is there and never trusted: memory grows with
//! what was read. A file that breaks its promises is refused with line or element, whatever its bytes.
//! *Trap.* Formats of polygons also hold what is no part of a shape (edges, textures, materials, groups, colours of faces,
//! opacity): it is passed over. Normals and colours are kept where each vertex has one, and only one.

mod building;
mod colors;
mod dxf;
mod format;
mod gltf;
mod normal;
mod obj;
mod off;
mod ply;
mod pov;
mod reading;
mod stl;
mod vrml;
mod writing;
mod xyz;

use taut_mesh::TriangleMesh;

pub use format::ShapeFormat;
pub(crate) use reading::read_stream;
pub use reading::{open_shape, open_shape_bytes};
pub use writing::{Encoding, ShapeOptions, shape_file, write_shape};

/// Triangles on vertices, or vertices alone, as files hold them.
///
/// A shape that was read is sound: all coordinates and normals are finite, and all corners are vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// The vertices, used or not, in the order of the file.
    pub vertices: Vec<[f64; 3]>,
    /// The triangles: numbers of vertices, from 0. Empty of a point set.
    pub triangles: Vec<[u32; 3]>,
    /// The normal of each vertex, of any length, as the file has it.
    pub normals: Option<Vec<[f64; 3]>>,
    /// Red, green and blue of each vertex.
    pub colors: Option<Vec<[u8; 3]>>,
}

/// A shape, borrowed, as it is written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeView<'a> {
    /// Vertices and triangles.
    pub mesh: TriangleMesh<'a>,
    /// A finite normal for each vertex.
    pub normals: Option<&'a [[f64; 3]]>,
    /// Red, green and blue of each vertex.
    pub colors: Option<&'a [[u8; 3]]>,
}

impl Shape {
    /// The shape as it is written. O(n).
    ///
    /// # Errors
    /// Those of [`TriangleMesh::new`]; a shape that was read has none of them.
    pub fn view(&self) -> Result<ShapeView<'_>, taut_mesh::Error> {
        Ok(ShapeView {
            mesh: TriangleMesh::new(&self.vertices, &self.triangles)?,
            normals: self.normals.as_deref(),
            colors: self.colors.as_deref(),
        })
    }
}

impl<'a> From<TriangleMesh<'a>> for ShapeView<'a> {
    /// Without normals and colours.
    fn from(mesh: TriangleMesh<'a>) -> Self {
        ShapeView { mesh, normals: None, colors: None }
    }
}
