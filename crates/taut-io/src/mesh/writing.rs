//! A mesh to a file, whatever its format.

use std::path::Path;

use taut_points::{Monitor, ReadError, Rows};

use super::{MeshView, Simplices, Vertices, dxf, gltf, obj, off, ply, pov, stl, vrml, vtu};
use crate::create::AtomicFile;
use crate::error::shown_path;
use crate::format::format_to_write;
use crate::write::{OutputFile, Points};
use crate::{Compression, Content, Error, Format};

/// Simplices in one piece of output.
const PIECE_SIMPLICES: usize = 1 << 14;

/// How far single precision may move a coordinate, as a share of the longest side of the mesh: less than a picture shows.
const MOVED_MAX: f64 = 1.0 / 8192.0;

/// Options to write a mesh. Write `MeshOptions { encoding: Encoding::Text, ..Default::default() }`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshOptions {
    /// The format; by default that of the extension.
    pub format: Option<Format>,
    /// The way in which ply and stl are written, which know both ways. Default [`Encoding::Binary`].
    pub encoding: Encoding,
}

/// Numbers as bytes or as decimals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// As bytes: shorter and faster.
    #[default]
    Binary,
    /// As decimals that read back to the same bits.
    Text,
}

/// The data that every writer gets.
pub(super) struct Job<'a> {
    pub(super) mesh: &'a MeshView<'a>,
    pub(super) encoding: Encoding,
    monitor: &'a Monitor<'a>,
}

/// Writes a mesh to `path`, as [`mesh_file`] and [`AtomicFile::commit`].
///
/// ```
/// use taut_io::{Content, MeshOptions, open_mesh, write_mesh};
/// use taut_mesh::TriangleMesh;
/// use taut_points::Monitor;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.1, 0.0]];
/// let mesh = TriangleMesh::new(&vertices, &[[0, 1, 2]])?;
/// let path = std::env::temp_dir().join(format!("taut-{}.ply", std::process::id()));
/// write_mesh(&mesh.into(), &path, &MeshOptions::default(), &Monitor::silent())?;
/// assert_eq!(open_mesh(&path, Content::Surface, None)?.vertices, vertices);
/// # std::fs::remove_file(path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`mesh_file`], and those of the commit; an earlier file of that name is then as it was.
///
/// # Panics
/// As [`mesh_file`].
pub fn write_mesh(
    mesh: &MeshView<'_>,
    path: &Path,
    options: &MeshOptions,
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    mesh_file(mesh, path, options, monitor)?.commit()
}

/// The file that [`write_mesh`] writes, complete, but not yet in its place; `-` is standard output. The extensions `.gz`,
/// `.xz` and `.zst` compress. Points of the plane get the height 0 where a format wants three coordinates.
///
/// # Errors
/// Before anything is written: [`Error::UnknownFormat`], [`Error::NotBuilt`] and [`Error::NotWritable`] of the format,
/// [`Error::MeshWidth`] and [`Error::Dimension`] of a triangulation, [`Error::MeshAttributes`], [`Error::MeshNormal`],
/// [`Error::NoTriangles`], [`Error::MeshRange`] and [`Error::MeshPrecision`] of a surface. Then [`Error::MeshTooLarge`],
/// [`Error::Points`] and those of [`create`](crate::create) and of writing.
///
/// # Panics
/// If an id of a triangulation is no row of its points, or its ids make no whole number of simplices.
pub fn mesh_file(
    mesh: &MeshView<'_>,
    path: &Path,
    options: &MeshOptions,
    monitor: &Monitor<'_>,
) -> Result<AtomicFile, Error> {
    write_to(mesh, path, options, monitor, |shown, compression| {
        OutputFile::create(path, shown, compression)
    })
}

/// The bytes of the file `name` that [`mesh_file`] would write, where there are no files.
///
/// ```
/// use taut_io::{MeshOptions, mesh_bytes};
/// use taut_mesh::TriangleMesh;
/// use taut_points::Monitor;
///
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 0.5, 0.0]];
/// let mesh = TriangleMesh::new(&vertices, &[[0, 1, 2]])?;
/// let bytes = mesh_bytes(&mesh.into(), "one.obj", &MeshOptions::default(), &Monitor::silent())?;
/// assert!(bytes.ends_with(b"v 0 0 0\nv 1 0 0\nv 0 0.5 0\nf 1 2 3\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`mesh_file`], but for those of files.
///
/// # Panics
/// As [`mesh_file`].
pub fn mesh_bytes(
    mesh: &MeshView<'_>,
    name: &str,
    options: &MeshOptions,
    monitor: &Monitor<'_>,
) -> Result<Vec<u8>, Error> {
    let file = write_to(mesh, Path::new(name), options, monitor, |shown, compression| {
        OutputFile::in_memory(shown, compression)
    })?;
    Ok(file.into_memory())
}

fn write_to(
    mesh: &MeshView<'_>,
    path: &Path,
    options: &MeshOptions,
    monitor: &Monitor<'_>,
    create: impl FnOnce(&str, Option<Compression>) -> Result<OutputFile<'_>, Error>,
) -> Result<AtomicFile, Error> {
    let shown = shown_path(path);
    let content = match mesh.vertices {
        Vertices::Points(_) => Content::Triangulation,
        Vertices::Places(_) => Content::Surface,
    };
    let (format, compression) = format_to_write(path, &shown, options.format, content)?;
    match content {
        Content::Triangulation => check_triangulation(mesh, &shown, format)?,
        _ => check_surface(mesh, &shown, format, options.encoding)?,
    }
    let mut out = create(&shown, compression)?;
    let job = Job { mesh, encoding: options.encoding, monitor };
    match format {
        Format::Ply => ply::write(&job, &mut out)?,
        Format::Obj => obj::write(&job, &mut out)?,
        Format::Off => off::write(&job, &mut out)?,
        Format::Vtu => vtu::write(&job, &mut out)?,
        #[cfg(feature = "arrow")]
        Format::Parquet => super::parquet::write(&job, &mut out)?,
        Format::Stl => stl::write(&job, &mut out)?,
        Format::Glb => gltf::write_binary(mesh, &mut out)?,
        Format::Gltf => gltf::write_json(mesh, &mut out)?,
        Format::Dxf => dxf::write(mesh, &mut out)?,
        Format::Vrml => vrml::write(mesh, &mut out)?,
        Format::Pov => pov::write(mesh, &mut out)?,
        _ => return Err(Error::not_writable(&shown, format, content)),
    }
    out.finish()
}

/// Refuses a triangulation that the format cannot hold.
fn check_triangulation(mesh: &MeshView<'_>, shown: &str, format: Format) -> Result<(), Error> {
    let (path, width) = (shown.to_owned(), mesh.width);
    if !format.holds_simplices(width) {
        return Err(Error::MeshWidth { path, format, width });
    }
    if let Vertices::Points(source) = mesh.vertices
        && !(1..=3).contains(&source.dim())
    {
        return Err(Error::Dimension { path, format, expected: "1, 2 or 3", dim: source.dim() });
    }
    assert!(mesh.ids().len().is_multiple_of(width), "simplices are whole rows");
    assert!(
        mesh.ids().iter().all(|&id| u64::from(id) < mesh.vertex_count()),
        "simplices name rows of the points"
    );
    Ok(())
}

/// Refuses a surface that the format cannot hold.
fn check_surface(
    mesh: &MeshView<'_>,
    shown: &str,
    format: Format,
    encoding: Encoding,
) -> Result<(), Error> {
    let path = || shown.to_owned();
    let vertices = mesh.places();
    let given =
        [("normals", mesh.normals.map(<[_]>::len)), ("colors", mesh.colors.map(<[_]>::len))];
    for (what, found) in given {
        if let Some(found) = found.filter(|&found| found != vertices.len()) {
            let vertices = vertices.len();
            return Err(Error::MeshAttributes { path: path(), what, found, vertices });
        }
    }
    let normals = mesh.normals.unwrap_or_default().as_flattened();
    if let Some(place) = normals.iter().position(|value| !value.is_finite()) {
        let (vertex, column, value) = (place / 3, place % 3, normals[place]);
        return Err(Error::MeshNormal { path: path(), vertex, column, value });
    }
    if mesh.simplex_count() == 0 && (vertices.is_empty() || !format.holds_bare_vertices()) {
        return Err(Error::NoTriangles { path: path() });
    }
    let single = match format {
        Format::Glb | Format::Gltf => true,
        Format::Stl => encoding == Encoding::Binary,
        _ => false,
    };
    if single { check_single(vertices, shown, format) } else { Ok(()) }
}

/// Checks that single precision holds the coordinates, and moves none by a visible part of the mesh.
fn check_single(vertices: &[[f64; 3]], shown: &str, format: Format) -> Result<(), Error> {
    let flat = vertices.as_flattened();
    let named = |place: usize| (shown.to_owned(), place / 3, place % 3, flat[place]);
    if let Some(place) = flat.iter().position(|&value| !(value as f32).is_finite()) {
        let (path, vertex, column, value) = named(place);
        return Err(Error::MeshRange { path, format, vertex, column, value });
    }
    let side = |k: usize| {
        let values = || vertices.iter().map(|at| at[k]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    let longest = side(0).max(side(1)).max(side(2));
    let is_moved = |&value: &f64| (f64::from(value as f32) - value).abs() > MOVED_MAX * longest;
    match flat.iter().position(|value| longest > 0.0 && is_moved(value)) {
        None => Ok(()),
        Some(place) => {
            let (path, vertex, column, value) = named(place);
            Err(Error::MeshPrecision { path, format, vertex, column, value })
        }
    }
}

impl Job<'_> {
    /// Writes what `write` makes of each vertex and its number.
    pub(super) fn each_vertex(
        &self,
        out: &mut OutputFile<'_>,
        mut write: impl FnMut(usize, [f64; 3], &mut Vec<u8>),
    ) -> Result<(), Error> {
        let source = match self.mesh.vertices {
            Vertices::Points(source) => source,
            Vertices::Places(places) => {
                return out.each(places.iter().enumerate(), |(i, &at), bytes| write(i, at, bytes));
            }
        };
        let mut bytes = Vec::new();
        let mut number = 0;
        let points = Points { source, columns: &[], monitor: self.monitor };
        points.blocks(|rows: Rows<'_>| {
            bytes.clear();
            for i in 0..rows.len() {
                let mut at = [0.0; 3];
                rows.copy_row(i, &mut at[..source.dim()]);
                write(number, at, &mut bytes);
                number += 1;
            }
            out.put(&bytes)
        })
    }

    /// Writes what `write` makes of each simplex.
    pub(super) fn each_simplex(
        &self,
        out: &mut OutputFile<'_>,
        mut write: impl FnMut(&[u32], &mut Vec<u8>),
    ) -> Result<(), Error> {
        let mut bytes = Vec::new();
        self.each_piece(|piece| {
            bytes.clear();
            piece.chunks_exact(self.mesh.width).for_each(|ids| write(ids, &mut bytes));
            out.put(&bytes)
        })
    }

    /// Hands the ids of many simplices at a time to `work`; an error when the monitor says so, and where a stream has other
    /// simplices than it promised.
    pub(super) fn each_piece(
        &self,
        mut work: impl FnMut(&[u32]) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let width = self.mesh.width;
        let mut count = 0;
        let mut in_pieces = |ids: &[u32], is_checked: bool| {
            for piece in ids.chunks(PIECE_SIMPLICES * width) {
                self.monitor.check().map_err(ReadError::from)?;
                let is_known = |&id: &u32| u64::from(id) < self.mesh.vertex_count();
                let is_whole = || piece.len().is_multiple_of(width) && piece.iter().all(is_known);
                if !is_checked && !is_whole() {
                    return Err(other_simplices());
                }
                count += (piece.len() / width) as u64;
                work(piece)?;
            }
            Ok(())
        };
        match self.mesh.simplices {
            Simplices::Ids(ids) => in_pieces(ids, true)?,
            Simplices::Stream(source) => source.read(&mut |ids| in_pieces(ids, false))?,
        }
        if count == self.mesh.simplex_count() { Ok(()) } else { Err(other_simplices()) }
    }
}

/// A stream of simplices is not what it promised to be.
fn other_simplices() -> Error {
    let problem = "there are other simplices than were promised, or ids of no vertex";
    Error::reading("the stream of simplices", std::io::Error::other(problem))
}
