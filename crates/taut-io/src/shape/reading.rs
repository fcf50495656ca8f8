//! A shape of a file, whatever its format.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use super::building::Building;
use super::{Shape, ShapeFormat, obj, off, ply, stl, xyz};
use crate::cursor::Cursor;
use crate::device::refuse_device;
use crate::error::shown_path;
use crate::input::{Medium, refuse_device_at_stdin};
use crate::{Compression, Error, compress};

/// Reads the shape of `path` in the given format, or in that of the extension; `-` is standard input. What is compressed is
/// told by the extension or by the first bytes.
///
/// Vertices keep their order, used or not; of stl, corners with equal coordinates are one vertex. A polygon of more than three
/// corners becomes the fan of triangles around its first corner, which is right where the polygon is convex. Normals and
/// colours are kept where each vertex has one, and only one; all else that files hold of edges, faces, textures, materials
/// and opacity is passed over. Colours that are full at 1 are brought to 255.
///
/// # Errors
/// [`Error::UnknownShape`] and [`Error::ShapeNotReadable`] of the format; [`Error::Shape`] and [`Error::ShapeKind`], with
/// line or element, of what the file holds; [`Error::NoVertices`]; and those of opening a file.
pub fn open_shape(path: &Path, format: Option<ShapeFormat>) -> Result<Shape, Error> {
    if path.as_os_str() == "-" {
        refuse_device_at_stdin()?;
        let stream = Box::new(BufReader::with_capacity(1 << 18, io::stdin()));
        return read(Medium::Stream(stream), Path::new(""), format, "standard input");
    }
    let shown = shown_path(path);
    let failed = |source| Error::reading(&shown, source);
    let kind = fs::metadata(path).map_err(failed)?;
    if kind.is_dir() {
        return Err(Error::Directory { path: shown });
    }
    let file = File::open(path).map_err(failed)?;
    refuse_device(&file, &shown)?;
    let stream = Box::new(BufReader::with_capacity(1 << 18, file));
    read(Medium::Stream(stream), path, format, &shown)
}

/// Reads the shape of a file whose bytes are in memory; `name` tells the format as a path would.
///
/// ```
/// let text = b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n".to_vec();
/// let shape = taut_io::open_shape_bytes(text, "triangle.off", None)?;
/// assert_eq!((shape.vertices[1], shape.triangles[0]), ([1.0, 0.0, 0.0], [0, 1, 2]));
/// # Ok::<(), taut_io::Error>(())
/// ```
///
/// # Errors
/// As [`open_shape`].
pub fn open_shape_bytes(
    bytes: Vec<u8>,
    name: &str,
    format: Option<ShapeFormat>,
) -> Result<Shape, Error> {
    read(Medium::Bytes(bytes.into()), Path::new(name), format, &shown_path(name.as_ref()))
}

fn read(
    medium: Medium,
    name: &Path,
    format: Option<ShapeFormat>,
    shown: &str,
) -> Result<Shape, Error> {
    let path = || shown.to_owned();
    let (named, compression) = ShapeFormat::of_path(name);
    let format = format.or(named).ok_or_else(|| Error::UnknownShape { path: path() })?;
    if !format.can_read() {
        return Err(Error::ShapeNotReadable { path: path(), format });
    }
    let (mut head, mut medium) = medium.peek(shown)?;
    if let Some(compression) = compression.or(Compression::of_magic(&head)) {
        let stream = compress::decoder(compression, medium.stream(), shown)?;
        (head, medium) = Medium::Stream(stream).peek(shown)?;
    }
    if head.is_empty() {
        return Err(Error::Empty { path: path() });
    }
    read_stream(medium.stream(), format, name, shown, None)
}

/// Reads a shape from bytes that are not compressed; `name` tells the columns of a file without a header as a path would, and
/// `memory` how many bytes may be held.
pub(crate) fn read_stream(
    stream: Box<dyn BufRead>,
    format: ShapeFormat,
    name: &Path,
    shown: &str,
    memory: Option<u64>,
) -> Result<Shape, Error> {
    let mut shape = Building::new(shown, format, memory);
    match format {
        ShapeFormat::Ply => ply::read(&mut shape, Cursor::new(stream, shown))?,
        ShapeFormat::Obj => obj::read(&mut shape, stream)?,
        ShapeFormat::Off => off::read(&mut shape, stream)?,
        ShapeFormat::Stl => stl::read(&mut shape, stream, shown)?,
        ShapeFormat::Xyz => xyz::read(&mut shape, stream, name)?,
        _ => return Err(Error::ShapeNotReadable { path: shown.to_owned(), format }),
    }
    shape.finish()
}
