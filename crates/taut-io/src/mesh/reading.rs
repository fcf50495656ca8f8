//! A mesh of a file, whatever its format.

use std::io::BufRead;
use std::path::Path;

use super::builder::MeshBuilder;
use super::{Mesh, obj, off, ply, stl, vtu, xyz};
use crate::cursor::Cursor;
use crate::error::shown_path;
use crate::input::Medium;
use crate::{Content, Error, Format};

/// Reads a mesh of `path` in the given format, or in that of the extension; `-` is standard input. What is compressed is
/// told by the extension or by the first bytes.
///
/// [`Content::Triangulation`] asks for simplices of one dimension, as [`write_mesh`](crate::write_mesh) writes them on points;
/// anything else in the file is refused.
///
/// [`Content::Surface`] asks for triangles and vertices. Vertices keep their order, used or not; of stl, corners with equal
/// coordinates are one vertex. A polygon of more than three corners becomes the fan of triangles around its first corner,
/// which is right where the polygon is convex. Normals and colors are kept where each vertex has one, and only one; all else
/// that files hold of edges, faces, textures, materials and opacity is passed over. Colors that are full at 1 are brought to
/// 255.
///
/// # Errors
/// [`Error::NotMesh`] of other content than these two; [`Error::UnknownFormat`] and [`Error::NotReadable`] of the format;
/// [`Error::Damaged`] and [`Error::Unsupported`], with
/// line or element, of what the file holds; [`Error::EmptyMesh`]; and those of opening a file.
pub fn open_mesh(path: &Path, content: Content, format: Option<Format>) -> Result<Mesh, Error> {
    let (medium, shown) = Medium::open(path)?;
    read(medium, path, content, format, &shown)
}

/// Reads the mesh of a file whose bytes are in memory; `name` tells the format as a path would.
///
/// ```
/// use taut_io::{Content, open_mesh_bytes};
///
/// let text = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n".to_vec();
/// let mesh = open_mesh_bytes(text, "triangle.off", Content::Surface, None)?;
/// assert_eq!((mesh.vertices[1], mesh.triangles()[0]), ([1.0, 0.0, 0.0], [0, 1, 2]));
/// # Ok::<(), taut_io::Error>(())
/// ```
///
/// # Errors
/// As [`open_mesh`].
pub fn open_mesh_bytes(
    bytes: Vec<u8>,
    name: &str,
    content: Content,
    format: Option<Format>,
) -> Result<Mesh, Error> {
    let shown = shown_path(name.as_ref());
    read(Medium::Bytes(bytes.into()), Path::new(name), content, format, &shown)
}

fn read(
    medium: Medium,
    name: &Path,
    content: Content,
    format: Option<Format>,
    shown: &str,
) -> Result<Mesh, Error> {
    let (named, compression) = Format::of_path(name);
    let path = || shown.to_owned();
    if !matches!(content, Content::Triangulation | Content::Surface) {
        return Err(Error::NotMesh { path: path(), content });
    }
    let format = format.or(named).ok_or_else(|| Error::UnknownFormat { path: path(), content })?;
    if !format.reads(content) {
        return Err(Error::not_readable(shown, format, content));
    }
    let (_, medium) = medium.decompressed(shown, compression, true)?;
    #[cfg(feature = "arrow")]
    if format == Format::Parquet {
        let mut mesh = MeshBuilder::new(shown, format, content, None);
        super::parquet::read(&mut mesh, medium)?;
        return mesh.finish();
    }
    read_stream(medium.stream(), format, content, name, shown, None)
}

/// Reads a mesh from bytes that are not compressed; `name` tells the columns of a file without a header as a path would, and
/// `memory` how many bytes may be held.
pub(crate) fn read_stream(
    stream: Box<dyn BufRead>,
    format: Format,
    content: Content,
    name: &Path,
    shown: &str,
    memory: Option<u64>,
) -> Result<Mesh, Error> {
    let mut mesh = MeshBuilder::new(shown, format, content, memory);
    match format {
        Format::Ply => ply::read(&mut mesh, Cursor::new(stream, shown))?,
        Format::Obj => obj::read(&mut mesh, stream)?,
        Format::Off => off::read(&mut mesh, stream)?,
        Format::Stl => stl::read(&mut mesh, stream, shown)?,
        Format::Xyz => xyz::read(&mut mesh, stream, name)?,
        Format::Vtu => vtu::read(&mut mesh, &mut Cursor::new(stream, shown))?,
        _ => return Err(Error::not_readable(shown, format, content)),
    }
    mesh.finish()
}
