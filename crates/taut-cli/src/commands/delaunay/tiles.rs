//! Triangulations of more points than memory may hold: tiles in a folder, within a limit on memory.

use std::path::Path;

use anyhow::{anyhow, bail};
use serde_json::json;
use taut::certify::TilesVerdict;
use taut::delaunay::Error as DelaunayError;
use taut::delaunay::outofcore::{
    FolderOptions, TiledTriangulation, delaunay_to_folder, plan_folder,
};

use super::Args;
use crate::clock::Clock;
use crate::commands::verify::tiles::{MEMORY_DEFAULT, judge};
use crate::exit::Outcome;
use crate::input::reading::Opened;
use crate::output::numbers::{count, counted};
use crate::output::writing;
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

impl Args {
    /// Returns the folder for tiles where the output is one, or where points take more memory than allowed.
    pub(super) fn tiles_folder(&self, points: &Opened) -> anyhow::Result<Option<&Path>> {
        let out = self.out.as_deref();
        if let Some(folder) = out.filter(|out| is_folder(out)) {
            return Ok(Some(folder));
        }
        let (n, dim) = (points.source().len(), points.source().dim());
        let needed = n.saturating_mul(bytes_in_memory(dim));
        let Some(memory) = self.reading.memory().filter(|&memory| memory < needed) else {
            return match self.resume {
                true => bail!("--resume goes on with a folder of tiles: name it with -o FOLDER"),
                false => Ok(None),
            };
        };
        match out.filter(|out| !writing::is_stream(out) && out.extension().is_none()) {
            Some(folder) => Ok(Some(folder)),
            None => bail!(
                "{}: to triangulate {} in memory takes about {}, more than --memory {}: name a folder for tiles with -o \
                 FOLDER/, or allow more memory",
                points.name(),
                counted(n, "point"),
                bytes(needed),
                bytes(memory)
            ),
        }
    }

    /// Refuses options that a folder of tiles does not have.
    fn refuse_other_outputs(&self) -> anyhow::Result<()> {
        let others = [
            ("--hull", self.hull.is_some()),
            ("--voronoi", self.voronoi.is_some()),
            ("--alpha", self.alpha.is_asked()),
            ("--draw", self.draw.is_some()),
            ("--no-neighbors", self.no_neighbors),
        ];
        match others.into_iter().find(|(_, is_there)| *is_there) {
            Some((name, _)) => {
                bail!(
                    "{name} belongs to triangulations in memory, not to folders of tiles: leave it out"
                )
            }
            None => Ok(()),
        }
    }

    /// Triangulates to a folder, checks and reports.
    pub(super) fn run_tiles(
        &self,
        folder: &Path,
        points: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<Outcome> {
        self.refuse_other_outputs()?;
        let memory = points.memory_left(self.reading.memory().unwrap_or(MEMORY_DEFAULT));
        let mut clock = Clock::start();
        let plan = plan_folder(points.source(), memory, rayon::current_num_threads());
        let plan = plan.map_err(|error| explain(points, error))?;
        let disk = bytes(plan.disk_bytes());
        watch.print(&format!(
            "{}: {} of disk will be taken while {} triangulated within {} of memory",
            folder.display(),
            disk,
            match points.source().len() {
                1 => "1 point is".to_owned(),
                n => format!("{} points are", count(n)),
            },
            bytes(memory)
        ));
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
        if self.json {
            writing::print(format!("{:#}\n", document(folder, &found, verdict)).as_bytes())?;
        } else if !self.effort.quiet {
            let mut fields = fields(folder, &found, verdict);
            fields.push(clock.field());
            let place = if found.dimension == 2 { "the plane" } else { "space" };
            let points = counted(found.points, "point");
            let title = format!("Delaunay triangulation of {points} in {place}, in tiles");
            writing::print(reports::text(&title, &fields).as_bytes())?;
        }
        Ok(Outcome::Done)
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
        DelaunayError::Memory { .. } => {
            anyhow!("{error}: go on with --resume and a larger --memory")
        }
        DelaunayError::File { .. } => anyhow!("{error}; go on with --resume once that is repaired"),
        other => other.into(),
    }
}

/// An amount of memory or disk in words.
fn bytes(amount: u64) -> String {
    let units = [("TiB", 40), ("GiB", 30), ("MiB", 20), ("KiB", 10)];
    match units.into_iter().find(|(_, power)| amount >> power > 0) {
        Some((unit, power)) => format!("{:.1} {unit}", amount as f64 / (1u64 << power) as f64),
        None => format!("{amount} bytes"),
    }
}

fn fields(folder: &Path, found: &TiledTriangulation, verdict: Option<TilesVerdict>) -> Vec<Field> {
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
        Field::new("tiles", counted(found.tiles.len() as u64, "file")).remark(format!(
            "{} in {}",
            bytes(size),
            folder.display()
        )),
        verified,
        Field::new("hash", totals.fingerprint.to_string())
            .remark("of the simplices, whatever their order"),
    ]
}

fn document(
    folder: &Path,
    found: &TiledTriangulation,
    verdict: Option<TilesVerdict>,
) -> serde_json::Value {
    let totals = &found.totals;
    json!({
        "schema": taut::certify::SCHEMA,
        "kind": "delaunay-tiles",
        "answer": {
            "folder": folder.display().to_string(),
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
