//! Triangulations of more points than memory may hold: tiles in a folder, within a limit on memory.

use std::path::Path;

use anyhow::{anyhow, bail};
use serde_json::json;
use taut::certify::{TilesVerdict, check_tiles_disk};
use taut::delaunay::Error as DelaunayError;
use taut::delaunay::outofcore::{
    DiskPlan, FolderOptions, Mosaic, TiledTriangulation, delaunay_to_folder, plan_folder,
};
use taut_io::ScratchFolder;

use super::Args;
use super::exports::{self, Exports, Tiled};
use crate::clock::Clock;
use crate::commands::verify::tiles::{MEMORY_DEFAULT, judge};
use crate::exit::Outcome;
use crate::input::reading::Opened;
use crate::output::numbers::{bytes, count, counted};
use crate::output::writing::{self, Outputs};
use crate::pipeline::Find as _;
use crate::reports::{self, Field};
use crate::watch::Watch;

/// Bytes that a triangulation in memory takes for each point, with its check, by the dimension of the points: the peak of the
/// command for 10⁶ uniform points on two threads (docs/delaunay.md), and a tenth more.
fn bytes_in_memory(dimension: usize) -> u64 {
    if dimension == 2 { 256 } else { 800 }
}

/// Tests whether a place for the output is that of a folder: one that is there, or a name with a separator at its end.
pub(super) fn is_folder(out: &Path) -> bool {
    let ends_open = out.to_string_lossy().ends_with(std::path::is_separator);
    !writing::is_stream(out) && (ends_open || out.is_dir())
}

/// Where tiles go.
pub(super) enum TilesPlace<'a> {
    /// To a folder that is the output.
    Folder(&'a Path),
    /// To a folder beside this output, until all outputs are written from them.
    Temporary(&'a Path),
}

impl Args {
    /// Returns where tiles go: to a folder that is the output, or beside the outputs where points take more memory than allowed.
    pub(super) fn tiles_place(&self, points: &Opened) -> anyhow::Result<Option<TilesPlace<'_>>> {
        let out = self.out.as_deref();
        if let Some(folder) = out.filter(|out| is_folder(out)) {
            return Ok(Some(TilesPlace::Folder(folder)));
        }
        let (n, dim) = (points.source().len(), points.source().dim());
        let needed = n.saturating_mul(bytes_in_memory(dim));
        let Some(memory) = self.reading.memory().filter(|&memory| memory < needed) else {
            return match self.resume {
                true => bail!("--resume goes on with a folder of tiles: name it with -o FOLDER"),
                false => Ok(None),
            };
        };
        if self.resume {
            bail!("--resume goes on with a folder of tiles: name it with -o FOLDER");
        }
        let refused = |remedy: &str| {
            anyhow!(
                "{}: to triangulate {} in memory takes about {}, more than --memory {}: {remedy}, or allow more memory",
                points.name(),
                counted(n, "point"),
                bytes(needed),
                bytes(memory)
            )
        };
        match out {
            Some(out) if !writing::is_stream(out) && out.extension().is_none() => {
                return Ok(Some(TilesPlace::Folder(out)));
            }
            Some(_) if self.mesh_format()?.is_none() => {
                return Err(refused(
                    "name a folder for tiles with -o FOLDER/, or a mesh such as .ply or .parquet",
                ));
            }
            _ => {}
        }
        match self.side_files().into_iter().chain(out).find(|path| !writing::is_stream(path)) {
            Some(output) => Ok(Some(TilesPlace::Temporary(output))),
            None => Err(refused("name a folder for tiles with -o FOLDER/")),
        }
    }

    /// Refuses an output folder within the folder of the points: the next command that reads the points would take the tiles
    /// for some of them.
    pub(super) fn refuse_within_input(&self) -> anyhow::Result<()> {
        let input = &self.points.path;
        let Some(out) = self.out.as_deref().filter(|out| input.is_dir() && is_folder(out)) else {
            return Ok(());
        };
        // The folder may not be there yet, but where it will be is.
        let there = out.ancestors().find_map(|folder| match folder.as_os_str().is_empty() {
            true => Path::new(".").canonicalize().ok(),
            false => folder.canonicalize().ok(),
        });
        match there.zip(input.canonicalize().ok()).filter(|(there, input)| there.starts_with(input))
        {
            Some(_) => bail!(
                "-o {}: the tiles would lie among the points in {}: name a folder outside of it",
                out.display(),
                input.display()
            ),
            None => Ok(()),
        }
    }

    /// Refuses options that tiles do not have.
    fn refuse_other_outputs(&self) -> anyhow::Result<()> {
        let others = [
            ("--hull", self.hull.is_some()),
            ("--draw", self.draw.is_some()),
            ("--no-neighbors", self.no_neighbors),
        ];
        match others.into_iter().find(|(_, is_there)| *is_there) {
            Some((name, _)) => {
                bail!("{name} belongs to triangulations in memory, not to tiles: leave it out")
            }
            None => Ok(()),
        }
    }

    /// Bytes of a mesh of all simplices, and of files that wait for it.
    fn export_bytes(&self, points: &Opened) -> u64 {
        let dim = points.source().dim() as u64;
        let n = points.source().len();
        // In PLY: three coordinates, and a list of ids for each of the simplices of uniform points.
        let simplices = n.saturating_mul(if dim == 2 { 2 } else { 7 });
        let mesh = n.saturating_mul(24).saturating_add(simplices.saturating_mul(1 + 4 * (dim + 1)));
        let is_mesh =
            self.out.as_deref().is_some_and(|out| !is_folder(out) && out.extension().is_some());
        // Both parts of an alpha complex wait in a file, and are then written.
        let alpha = if self.alpha.radius().is_some() { mesh.saturating_mul(2) } else { 0 };
        alpha.saturating_add(if is_mesh { mesh } else { 0 })
    }

    /// Triangulates to tiles, checks, writes what is computed from them, and reports.
    pub(super) fn run_tiles(
        &self,
        place: &TilesPlace<'_>,
        points: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<Outcome> {
        self.refuse_other_outputs()?;
        let memory = points.memory_left(self.reading.memory().unwrap_or(MEMORY_DEFAULT));
        let mut clock = Clock::start();
        let plan = plan_folder(points.source(), memory, rayon::current_num_threads());
        let plan = plan.map_err(|error| explain(points, error))?;
        let scratch;
        let (folder, output) = match *place {
            TilesPlace::Folder(folder) => (folder, folder),
            TilesPlace::Temporary(output) => {
                scratch = ScratchFolder::beside(output)?;
                (scratch.path(), output)
            }
        };
        self.tell_disk(&plan, points, output, memory, watch)?;
        let found = watch.during("triangulating", |monitor| {
            let options = FolderOptions {
                memory,
                threads: None,
                resume: self.resume,
                monitor: *monitor,
                ..FolderOptions::default()
            };
            delaunay_to_folder(points.source(), folder, &options)
        });
        let found = found.map_err(|error| explain(points, error))?;
        clock.lap("triangulating");
        let mut verdict = None;
        if !self.no_verify {
            match judge(folder, points, memory, Some(folder), watch)? {
                Ok(proved) => verdict = Some(proved),
                Err(why) => {
                    writing::print_error(&format!("the check failed: {why}"));
                    return Ok(Outcome::CheckFailed);
                }
            }
            clock.lap("checking");
        }
        let mesh = match place {
            TilesPlace::Folder(_) => None,
            TilesPlace::Temporary(_) => self.out.as_deref(),
        };
        let exports = self.exports(folder, mesh, points, memory, watch)?;
        if !exports.files.is_empty() {
            clock.lap("writing");
        }
        let mut outputs = Outputs::default();
        exports.files.into_iter().for_each(|file| outputs.hold(file));
        let is_kept = matches!(place, TilesPlace::Folder(_));
        if self.json {
            outputs.print(&format!("{:#}\n", document(is_kept.then_some(folder), &found, verdict)));
        } else if !self.effort.quiet && !self.side_files().into_iter().any(writing::is_stream) {
            let mut fields = fields(is_kept.then_some(folder), &found, verdict);
            fields.extend(exports.fields);
            fields.push(clock.field());
            let place = if found.dimension == 2 { "the plane" } else { "space" };
            let points = counted(found.points, "point");
            let title = format!("Delaunay triangulation of {points} in {place}, in tiles");
            outputs.print(&reports::text(&title, &fields));
        }
        outputs.finish()?;
        Ok(Outcome::Done)
    }

    /// Says about how much disk will be taken, and refuses what does not fit. Nobody knows how large fronts will be before the
    /// work is done: on circles, lines and surfaces all sites may go up, and the check sorts more facets between tiles.
    fn tell_disk(
        &self,
        plan: &DiskPlan,
        points: &Opened,
        output: &Path,
        memory: u64,
        watch: &Watch,
    ) -> anyhow::Result<()> {
        let source = points.source();
        let check = match self.no_verify {
            true => 0,
            false => check_tiles_disk(source.len(), source.dim(), 1 << plan.levels, memory),
        };
        // The files of the check are gone when the first output is written; tiles are there for both.
        let beside = check.max(self.export_bytes(points));
        let needed = plan.disk_bytes().saturating_add(beside);
        watch.print(&format!(
            "{}: {} of disk will be taken while {} triangulated within {} of memory{}, if they lie as evenly as uniform ones; more by points on lines, curves or surfaces",
            output.display(),
            bytes(needed),
            match points.source().len() {
                1 => "1 point is".to_owned(),
                n => format!("{} points are", count(n)),
            },
            bytes(memory),
            match check {
                0 => String::new(),
                check => format!(" and checked, {} by the check", bytes(check)),
            }
        ));
        match taut_io::free_bytes(output).filter(|&free| free < needed && !self.resume) {
            Some(free) => bail!(
                "{}: {} of disk are needed, but {} are free: make room or choose another folder",
                output.display(),
                bytes(needed),
                bytes(free)
            ),
            None => Ok(()),
        }
    }

    /// Prepares all files that are computed from the tiles of a folder.
    fn exports(
        &self,
        folder: &Path,
        mesh: Option<&Path>,
        points: &Opened,
        memory: u64,
        watch: &Watch,
    ) -> anyhow::Result<Exports> {
        if mesh.is_none() && self.side_files().is_empty() && self.alpha.radius().is_none() {
            return Ok(Exports::default());
        }
        // A tile takes at most half, as its bytes and as its lists; the links and the cells of a grid an eighth each.
        let part = memory / 8;
        let tiled = Tiled { points, memory: part, scratch: folder, watch };
        let opened = |error| explain(points, error);
        if points.source().dim() == 2 {
            let mosaic = Mosaic::<2>::open(folder, part).map_err(opened)?;
            let mut exports = exports::of_plane(self, &mosaic, mesh, &tiled)?;
            let terrain =
                self.terrain.export(&mosaic, points, Some(tiled.memory), Some(folder), watch)?;
            exports.extend(terrain);
            Ok(exports)
        } else {
            let mosaic = Mosaic::<3>::open(folder, part).map_err(opened)?;
            exports::of_space(self, &mosaic, mesh, &tiled)
        }
    }
}

/// What went wrong, with the place in the file of points where that is meant.
fn explain(points: &Opened, error: DelaunayError) -> anyhow::Error {
    match error {
        DelaunayError::Input(_) => points.explain(error),
        // These name the folder or a file of it.
        DelaunayError::FolderTaken { folder } => {
            anyhow!(
                "{folder} is not empty: go on with what was begun there with --resume, or name a new folder"
            )
        }
        DelaunayError::Memory { sites, needed, .. } => anyhow!(
            "{} must be triangulated at once, which takes {}: go on with --resume and a larger --memory",
            counted(sites, "point"),
            bytes(needed)
        ),
        DelaunayError::File { .. } => anyhow!("{error}; go on with --resume once that is repaired"),
        other => other.into(),
    }
}

fn fields(
    folder: Option<&Path>,
    found: &TiledTriangulation,
    verdict: Option<TilesVerdict>,
) -> Vec<Field> {
    let totals = &found.totals;
    let size: u64 = found.tiles.iter().map(|tile| tile.1).sum();
    let equal = match totals.duplicates {
        0 => "no two points are equal".to_owned(),
        1 => "1 point equals an earlier one".to_owned(),
        more => format!("{} points equal an earlier one", count(more)),
    };
    let verified = match &verdict {
        Some(proved) => Field::new("verified", "yes").remark(format!(
            "the only one, with {} decided by the perturbation",
            counted(proved.ties, "tie")
        )),
        None => Field::new("verified", "not checked"),
    };
    vec![
        Field::new("sites", count(totals.sites)).remark(equal),
        Field::new("simplices", count(totals.simplices)),
        Field::new("hull", counted(totals.hull, "facet")),
        Field::new("tiles", counted(found.tiles.len() as u64, "file")).remark(match folder {
            Some(folder) => format!("{} in {}", bytes(size), folder.display()),
            None => format!("{} for a while, on the disk", bytes(size)),
        }),
        verified,
        Field::new("fingerprint", totals.fingerprint.to_string())
            .remark("of the simplices, whatever their order"),
    ]
}

fn document(
    folder: Option<&Path>,
    found: &TiledTriangulation,
    verdict: Option<TilesVerdict>,
) -> serde_json::Value {
    let totals = &found.totals;
    json!({
        "schema": taut::certify::SCHEMA,
        "kind": "delaunay-tiles",
        "answer": {
            "folder": folder.map(|folder| folder.display().to_string()),
            "dimension": found.dimension,
            "points": found.points,
            "points_hash": found.points_hash.to_string(),
            "sites": totals.sites,
            "duplicates": totals.duplicates,
            "simplices": totals.simplices,
            "hull": totals.hull,
            "fingerprint": totals.fingerprint.to_string(),
            "tiles": found.tiles.len(),
        },
        "verdict": verdict,
    })
}
