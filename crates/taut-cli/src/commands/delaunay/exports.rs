//! What is written of a triangulation tile by tile: cells, alpha complexes, lines and rasters.

use std::io::{self, Write};
use std::path::Path;

use anyhow::anyhow;
use taut::delaunay::Error;
use taut::delaunay::outofcore::{AlphaPart, Mosaic};
use taut_io::{AtomicFile, MeshOptions, MeshView, SimplexSource, SpooledSimplices, mesh_file};

use super::{Args, voronoi};
use crate::input::reading::Opened;
use crate::output::numbers::count;
use crate::reports::Field;
use crate::watch::Watch;

/// Files that are complete, and what is said of them.
#[derive(Default)]
pub(super) struct Exports {
    pub(super) files: Vec<AtomicFile>,
    pub(super) fields: Vec<Field>,
}

impl Exports {
    pub(super) fn add(&mut self, file: AtomicFile, field: Field) {
        self.files.push(file);
        self.fields.push(field);
    }

    pub(super) fn extend(&mut self, more: Exports) {
        self.files.extend(more.files);
        self.fields.extend(more.fields);
    }
}

/// Errors of writing that pass through a library which knows only its own.
#[derive(Default)]
pub(super) struct Relay(Option<taut_io::Error>);

impl Relay {
    /// Hands on success; keeps what went wrong, and stops the library.
    pub(super) fn pass(&mut self, written: Result<(), taut_io::Error>) -> Result<(), Error> {
        written.map_err(|error| {
            self.0 = Some(error);
            Error::File { path: String::new(), source: io::Error::other("an output failed") }
        })
    }

    /// The result of the library, or what went wrong in writing.
    pub(super) fn explain<R>(
        self,
        result: Result<R, Error>,
        explain: impl FnOnce(Error) -> anyhow::Error,
    ) -> anyhow::Result<R> {
        match (result, self.0) {
            (Err(_), Some(error)) => Err(error.into()),
            (result, _) => result.map_err(explain),
        }
    }
}

/// The simplices of all tiles, as rows of the input.
struct TileSimplices<'a, const D: usize> {
    mosaic: &'a Mosaic<D>,
}

impl<const D: usize> SimplexSource for TileSimplices<'_, D> {
    fn count(&self) -> u64 {
        self.mosaic.simplices()
    }

    fn read(
        &self,
        put: &mut dyn FnMut(&[u32]) -> Result<(), taut_io::Error>,
    ) -> Result<(), taut_io::Error> {
        for &number in self.mosaic.tiles() {
            let tile = self.mosaic.tile(number).map_err(|error| {
                taut_io::Error::reading("the tiles", io::Error::other(error.to_string()))
            })?;
            let mut ids = Vec::new();
            for sites in tile.simplices.chunks(TILE_IDS_AT_ONCE) {
                ids.clear();
                // There are no more points than 32 bits count.
                ids.extend(sites.iter().map(|&v| tile.rows[v as usize] as u32));
                put(&ids)?;
            }
        }
        Ok(())
    }
}

/// Ids of whole simplices that are translated at once: a multiple of all numbers of vertices.
const TILE_IDS_AT_ONCE: usize = 12 << 12;

/// A triangulation in tiles, and where and within what it is written.
pub(super) struct Tiled<'a> {
    pub(super) points: &'a Opened,
    pub(super) memory: u64,
    /// A folder for temporary files.
    pub(super) scratch: &'a Path,
    pub(super) watch: &'a Watch,
}

impl Tiled<'_> {
    /// Refuses points whose rows need more than 32 bits in a mesh.
    pub(super) fn check_rows(&self) -> anyhow::Result<()> {
        match u32::try_from(self.points.source().len()) {
            Ok(_) => Ok(()),
            Err(_) => Err(anyhow!(
                "{}: meshes have ids of 32 bits, which do not count so many points: name a folder for tiles with -o FOLDER/",
                self.points.name()
            )),
        }
    }

    fn mesh(
        &self,
        simplices: &dyn SimplexSource,
        width: usize,
        path: &Path,
    ) -> anyhow::Result<AtomicFile> {
        let mesh = MeshView::streamed(self.points.vertices(), simplices, width.max(1));
        let file = self
            .watch
            .during("writing", |monitor| mesh_file(&mesh, path, &MeshOptions::default(), monitor));
        Ok(file?)
    }

    fn explain(&self, error: Error) -> anyhow::Error {
        anyhow!("{}: {error}", self.points.name())
    }
}

/// The same in the plane and in space.
macro_rules! exports {
    ($name:ident, $d:literal, $cell:path, $head:path, $names:literal) => {
        pub(super) fn $name(
            args: &Args,
            mosaic: &Mosaic<$d>,
            mesh: Option<&Path>,
            tiled: &Tiled<'_>,
        ) -> anyhow::Result<Exports> {
            let mut exports = Exports::default();
            if let Some(path) = mesh {
                tiled.check_rows()?;
                let width = mosaic.vertices_per_simplex();
                exports.files.push(tiled.mesh(&TileSimplices { mosaic }, width, path)?);
            }
            if let Some(alpha) = args.alpha.radius() {
                tiled.check_rows()?;
                let mut spools = [
                    SpooledSimplices::new($d + 1, Some(tiled.scratch))?,
                    SpooledSimplices::new($d, Some(tiled.scratch))?,
                ];
                let mut singular = 0u64;
                let mut relay = Relay::default();
                let put = &mut |part: AlphaPart<'_>| {
                    let (spool, rows) = match part {
                        AlphaPart::Simplex(rows) => (0, rows),
                        AlphaPart::Boundary(rows) => (1, rows),
                        AlphaPart::Singular(_) => {
                            singular += 1;
                            return Ok(());
                        }
                    };
                    let ids: Vec<u32> = rows.iter().map(|&row| row as u32).collect();
                    relay.pass(spools[spool].push(&ids))
                };
                let done = tiled
                    .watch
                    .during("alpha", |monitor| mosaic.alpha_complex(alpha, monitor, put));
                relay.explain(done, |error| tiled.explain(error))?;
                let [simplices, boundary] = &spools;
                exports.fields.push(super::alpha::field(
                    alpha,
                    $names,
                    [simplices.count(), boundary.count(), singular],
                ));
                for (path, spool, width) in [
                    (args.alpha.simplices_file(), simplices, $d + 1),
                    (args.alpha.boundary_file(), boundary, $d),
                ] {
                    if let Some(path) = path {
                        exports.files.push(tiled.mesh(spool, width, path)?);
                    }
                }
            }
            if let Some(path) = &args.voronoi {
                let (low, high) = voronoi::frame(tiled.points.source())?;
                let corner = |p: [f64; 3]| std::array::from_fn(|k| p[k]);
                let mut file = taut_io::create(path)?;
                let mut text = $head(low, high);
                let mut cells = 0u64;
                let mut relay = Relay::default();
                let put = &mut |row: u64, cell: &_| {
                    text.push_str(if cells == 0 { "\n" } else { ",\n" });
                    cells += 1;
                    $cell(&mut text, row, cell);
                    if text.len() < TEXT_BYTES {
                        return Ok(());
                    }
                    let written = file.write_all(text.as_bytes());
                    text.clear();
                    relay.pass(written.map_err(|source| failed(path, source)))
                };
                let done = tiled.watch.during("cells", |monitor| {
                    mosaic.voronoi_cells([corner(low), corner(high)], monitor, put)
                });
                relay.explain(done, |error| tiled.explain(error))?;
                text.push_str("\n]}\n");
                file.write_all(text.as_bytes())
                    .and_then(|()| file.flush())
                    .map_err(|source| failed(path, source))?;
                exports.add(file, Field::new("cells", count(cells)));
            }
            Ok(exports)
        }
    };
}
exports!(of_plane, 2, voronoi::put_feature, voronoi::head_in_plane, "triangles");
exports!(of_space, 3, voronoi::put_polyhedron, voronoi::head_in_space, "tetrahedra");

/// Bytes of text that are written at once.
const TEXT_BYTES: usize = 1 << 18;

fn failed(path: &Path, source: io::Error) -> taut_io::Error {
    taut_io::Error::writing(&path.display().to_string(), source)
}
