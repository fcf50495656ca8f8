//! A mesh of a file, whatever its format.

use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;

use super::{MeshFormat, obj, off, ply, vtu};
use crate::cursor::Cursor;
use crate::device::refuse_device;
use crate::error::{Refuse, shown_path};
use crate::input::Medium;
use crate::{Compression, Error, MeshPlace, compress};

/// Simplices of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Vertices of a simplex, 1 to 4.
    pub width: usize,
    /// The simplices: rows of `width` ids, each the number of a vertex, from 0.
    pub simplices: Vec<u32>,
    /// The vertices, in order; `None` where the format has none.
    pub vertices: Option<Vec<[f64; 3]>>,
    /// The format that was read.
    pub format: MeshFormat,
    /// The file as shown to people.
    pub path: String,
}

/// Reads the mesh of `path`, as [`write_mesh`](crate::write_mesh) writes it: of ply what is binary and little-endian,
/// of vtu what is appended raw. What is compressed is told by the extension or by the first bytes.
///
/// # Errors
/// [`Error::UnknownMesh`], [`Error::Mesh`] and [`Error::MeshKind`] with line or element, [`Error::NoSimplices`], and those of
/// opening a file.
pub fn open_mesh(path: &Path) -> Result<Mesh, Error> {
    let shown = shown_path(path);
    let failed = |source| Error::reading(&shown, source);
    let kind = fs::metadata(path).map_err(failed)?;
    if kind.is_dir() {
        return Err(Error::Directory { path: shown });
    }
    let file = File::open(path).map_err(failed)?;
    refuse_device(&file, &shown)?;
    let medium = match kind.is_file() {
        true => Medium::File(file, path.to_owned()),
        false => Medium::Stream(Box::new(BufReader::with_capacity(1 << 18, file))),
    };
    read(medium, path, &shown)
}

/// Reads the mesh of a file whose bytes are in memory; `name` tells the format as a path would.
///
/// # Errors
/// As [`open_mesh`].
pub fn open_mesh_bytes(bytes: Vec<u8>, name: &str) -> Result<Mesh, Error> {
    read(Medium::Bytes(bytes.into()), Path::new(name), &shown_path(name.as_ref()))
}

fn read(medium: Medium, name: &Path, shown: &str) -> Result<Mesh, Error> {
    let (format, compression) = MeshFormat::of_path(name);
    let format = format.ok_or_else(|| Error::UnknownMesh { path: shown.to_owned() })?;
    let (head, mut medium) = medium.peek(shown)?;
    if head.is_empty() {
        return Err(Error::Empty { path: shown.to_owned() });
    }
    if let Some(compression) = compression.or(Compression::of_magic(&head)) {
        medium = Medium::Stream(compress::decoder(compression, medium.stream(), shown)?);
    }
    let mut mesh = Building {
        path: shown,
        format,
        first: 0,
        vertices: Vec::new(),
        has_vertices: format != MeshFormat::Parquet,
        width: 0,
        simplices: Vec::new(),
    };
    match format {
        MeshFormat::Ply => ply::read(&mut mesh, &mut Cursor::new(medium.stream(), shown))?,
        MeshFormat::Obj => obj::read(&mut mesh, medium.stream())?,
        MeshFormat::Off => off::read(&mut mesh, medium.stream())?,
        MeshFormat::Vtu => vtu::read(&mut mesh, &mut Cursor::new(medium.stream(), shown))?,
        #[cfg(feature = "arrow")]
        MeshFormat::Parquet => super::parquet::read(&mut mesh, medium)?,
        #[cfg(not(feature = "arrow"))]
        MeshFormat::Parquet => {
            return Err(Error::MeshNotBuilt { path: shown.to_owned(), format });
        }
    }
    mesh.finish()
}

/// A mesh as far as it was read, and what is wrong with the rest.
pub(super) struct Building<'a> {
    pub(super) path: &'a str,
    pub(super) format: MeshFormat,
    /// The id of the first vertex in this format.
    pub(super) first: i64,
    pub(super) vertices: Vec<[f64; 3]>,
    has_vertices: bool,
    width: usize,
    simplices: Vec<u32>,
}

impl Refuse for Building<'_> {
    fn path(&self) -> &str {
        self.path
    }

    fn damaged(&self, place: MeshPlace, problem: impl Into<String>) -> Error {
        let (path, format) = (self.path.to_owned(), self.format);
        Error::Mesh { path, format, place, problem: problem.into() }
    }
}

impl Building<'_> {
    /// Number of simplices so far.
    pub(super) fn len(&self) -> u64 {
        (self.simplices.len() / self.width.max(1)) as u64
    }

    pub(super) fn vertex(&mut self, place: MeshPlace, at: [f64; 3]) -> Result<(), Error> {
        if at.iter().any(|x| !x.is_finite()) {
            return Err(self.damaged(place, "a coordinate is not finite"));
        }
        if self.vertices.len() >= u32::MAX as usize {
            return Err(self.damaged(place, "there are more vertices than ids of 32 bits"));
        }
        self.vertices.push(at);
        Ok(())
    }

    /// Adds a simplex whose vertices, numbered from 0, have been read before.
    pub(super) fn simplex(&mut self, place: MeshPlace, ids: &[i64]) -> Result<(), Error> {
        if self.width == 0 {
            self.width = ids.len();
        }
        if ids.len() != self.width {
            let problem =
                format!("{} vertices, where the first simplex has {}", ids.len(), self.width);
            return Err(self.kind(place, problem));
        }
        let known = if self.has_vertices { self.vertices.len() } else { u32::MAX as usize };
        for &id in ids {
            match u32::try_from(id).ok().filter(|&id| (id as usize) < known) {
                Some(id) => self.simplices.push(id),
                None => {
                    let id = id.saturating_add(self.first);
                    let problem = match self.has_vertices {
                        true => format!("it names vertex {id}, and {known} were read before it"),
                        false => format!("it names vertex {id}, which is no id of 32 bits"),
                    };
                    return Err(self.damaged(place, problem));
                }
            }
        }
        Ok(())
    }

    /// Refuses a count that does not hold.
    pub(super) fn expect(&self, what: &str, promised: u64, found: u64) -> Result<(), Error> {
        match promised == found {
            true => Ok(()),
            false => {
                let problem = format!("it promises {promised} {what}, but has {found}");
                Err(self.damaged(MeshPlace::File, problem))
            }
        }
    }

    /// What is no damage, but not read either.
    pub(super) fn kind(&self, place: MeshPlace, problem: impl Into<String>) -> Error {
        let remedy = match self.format {
            MeshFormat::Ply => "as binary little-endian ply, of simplices of one dimension",
            MeshFormat::Vtu => "as vtu with uncompressed raw appended data",
            _ => "with simplices of one dimension",
        };
        Error::MeshKind { path: self.path.to_owned(), place, problem: problem.into(), remedy }
    }

    fn finish(self) -> Result<Mesh, Error> {
        if self.simplices.is_empty() {
            return Err(Error::NoSimplices { path: self.path.to_owned() });
        }
        Ok(Mesh {
            width: self.width,
            simplices: self.simplices,
            vertices: self.has_vertices.then_some(self.vertices),
            format: self.format,
            path: self.path.to_owned(),
        })
    }
}
