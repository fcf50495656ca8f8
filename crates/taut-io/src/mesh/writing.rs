//! A mesh to a file, block by block.

use std::path::Path;

use taut_points::{Monitor, PointSource, ReadError, Rows};

use super::{MeshFormat, obj, off, ply, vtu};
use crate::Error;
use crate::create::AtomicFile;
use crate::error::shown_path;
use crate::write::{Out, Points};

/// Simplices in one piece of output.
const PIECE: usize = 1 << 14;

/// What is to be written.
pub(super) struct Job<'a> {
    points: Points<'a>,
    pub(super) width: usize,
    simplices: &'a [u32],
}

/// Writes simplices on points to `path` in the given format, or in that of the extension, as [`mesh_file`] and
/// [`AtomicFile::commit`].
///
/// # Errors
/// [`Error`]; an earlier file of that name is then as it was.
pub fn write_mesh(
    points: &dyn PointSource,
    simplices: &[u32],
    width: usize,
    path: &Path,
    format: Option<MeshFormat>,
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    mesh_file(points, simplices, width, path, format, monitor)?.commit()
}

/// The file that [`write_mesh`] writes, complete, but not yet in its place.
///
/// `simplices` are rows of `width` ids, 1 to 4, of rows of `points`. All points are written as vertices, in order. The
/// extensions `.gz`, `.xz` and `.zst` compress.
///
/// # Errors
/// [`Error::UnknownMesh`], [`Error::MeshWidth`], [`Error::MeshDimension`], [`Error::MeshNotBuilt`], those of
/// [`create`](crate::create), and [`Error::Points`].
///
/// # Panics
/// If an id is no row of `points`, or `simplices` has no whole number of rows.
pub fn mesh_file(
    points: &dyn PointSource,
    simplices: &[u32],
    width: usize,
    path: &Path,
    format: Option<MeshFormat>,
    monitor: &Monitor<'_>,
) -> Result<AtomicFile, Error> {
    let shown = shown_path(path);
    let (named, compression) = MeshFormat::of_path(path);
    let format = format.or(named).ok_or_else(|| Error::UnknownMesh { path: shown.clone() })?;
    if !format.is_built() {
        return Err(Error::MeshNotBuilt { path: shown, format });
    }
    if !format.holds(width) {
        return Err(Error::MeshWidth { path: shown, format, width });
    }
    if !(1..=3).contains(&points.dim()) {
        return Err(Error::MeshDimension { path: shown, format, dim: points.dim() });
    }
    assert!(simplices.len().is_multiple_of(width), "simplices are whole rows");
    assert!(
        simplices.iter().all(|&id| u64::from(id) < points.len()),
        "simplices name rows of the points"
    );
    let mut out = Out::create(path, &shown, compression)?;
    let job = Job { points: Points { source: points, columns: &[], monitor }, width, simplices };
    match format {
        MeshFormat::Ply => ply::write(&job, &mut out)?,
        MeshFormat::Obj => obj::write(&job, &mut out)?,
        MeshFormat::Off => off::write(&job, &mut out)?,
        MeshFormat::Vtu => vtu::write(&job, &mut out)?,
        #[cfg(feature = "arrow")]
        MeshFormat::Parquet => super::parquet::write(&job, &mut out)?,
        #[cfg(not(feature = "arrow"))]
        MeshFormat::Parquet => return Err(Error::MeshNotBuilt { path: shown, format }),
    }
    out.finish()
}

impl Job<'_> {
    /// Number of vertices.
    pub(super) fn vertices(&self) -> u64 {
        self.points.source.len()
    }

    /// Number of simplices.
    pub(super) fn len(&self) -> usize {
        self.simplices.len() / self.width
    }

    /// Writes what `write` makes of each vertex.
    pub(super) fn each_vertex(
        &self,
        out: &mut Out<'_>,
        mut write: impl FnMut([f64; 3], &mut Vec<u8>),
    ) -> Result<(), Error> {
        let mut bytes = Vec::new();
        self.points.blocks(|rows: Rows<'_>| {
            bytes.clear();
            for i in 0..rows.len() {
                let mut at = [0.0; 3];
                rows.copy_row(i, &mut at[..self.points.source.dim()]);
                write(at, &mut bytes);
            }
            out.put(&bytes)
        })
    }

    /// Writes what `write` makes of each simplex.
    pub(super) fn each_simplex(
        &self,
        out: &mut Out<'_>,
        mut write: impl FnMut(&[u32], &mut Vec<u8>),
    ) -> Result<(), Error> {
        let mut bytes = Vec::new();
        for piece in self.pieces() {
            bytes.clear();
            piece?.chunks_exact(self.width).for_each(|ids| write(ids, &mut bytes));
            out.put(&bytes)?;
        }
        Ok(())
    }

    /// The ids of many simplices at a time; an error when the monitor says so.
    pub(super) fn pieces(&self) -> impl Iterator<Item = Result<&[u32], Error>> {
        self.simplices.chunks(PIECE * self.width).map(|piece| {
            self.points.monitor.check().map_err(ReadError::from)?;
            Ok(piece)
        })
    }
}
