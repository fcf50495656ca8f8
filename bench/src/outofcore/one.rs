//! taut as a program of its own: one triangulation in memory, on the disk or by diamonds, or one check, and one line.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use taut_certify::{TilesOptions, check_tiles};
use taut_delaunay::outofcore::{FolderOptions, delaunay_to_folder};
use taut_delaunay::{DelaunayOptions, Plane, Space};
use taut_points::{FileSource, ScalarKind};

use super::*;
use crate::context::pool;

/// What to do with the points of a file.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Task {
    pub(crate) dim: usize,
    pub(crate) points: u64,
    pub(crate) threads: usize,
    /// Little-endian doubles, row by row.
    pub(crate) file: PathBuf,
    pub(crate) way: Way,
}

/// How it is done.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) enum Way {
    /// In memory: the build alone, without an answer.
    Memory,
    /// To a folder, within so many bytes.
    Folder { memory: u64, folder: PathBuf },
    /// Checks such a folder.
    Check { memory: u64, folder: PathBuf },
    /// By the diamonds of the thesis, in memory.
    Diamonds,
}

/// What it cost, and what came of it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Done {
    pub(crate) cpu: f64,
    pub(crate) wall: f64,
    /// Peak memory of the process, points included.
    pub(crate) peak: Option<u64>,
    pub(crate) simplices: u64,
    pub(crate) fingerprint: String,
    /// Tiles, or diamonds.
    pub(crate) parts: u64,
    /// Sites that leaves passed up; of diamonds the longest list.
    pub(crate) front: u64,
    /// Sites that were triangulated again; of diamonds the copies of all points.
    pub(crate) merged: u64,
    /// Bytes of all tiles, and the most that working files took at a time.
    pub(crate) tiles: u64,
    pub(crate) working: u64,
    /// Why the check rejects the folder.
    pub(crate) rejected: Option<String>,
}

impl Task {
    /// Does it, and tells what it cost.
    pub(crate) fn perform(&self) -> Result<Done> {
        pool(self.threads)?.install(|| match &self.way {
            Way::Memory => self.in_memory(),
            Way::Folder { memory, folder } => self.to_folder(*memory, folder),
            Way::Check { memory, folder } => self.check(*memory, folder),
            Way::Diamonds => self.by_diamonds(),
        })
    }

    fn source(&self) -> Result<FileSource> {
        Ok(FileSource::open(&self.file, 0, self.points, self.dim, ScalarKind::F64)?)
    }

    fn in_memory(&self) -> Result<Done> {
        let values = read_raw(&self.file)?;
        let points = Points::new(&values, self.dim)?;
        let options = DelaunayOptions { threads: Some(self.threads), ..Default::default() };
        let meter = Meter::start();
        let simplices = match self.dim {
            2 => Plane::build(&points, &options)?.simplices().count(),
            _ => Space::build(&points, &options)?.simplices().count(),
        };
        Ok(Done { simplices: simplices as u64, ..Done::of(meter) })
    }

    fn to_folder(&self, memory: u64, folder: &Path) -> Result<Done> {
        let source = self.source()?;
        let (most, has_ended) = (AtomicU64::new(0), AtomicBool::new(false));
        let meter = Meter::start();
        let found = std::thread::scope(|scope| {
            scope.spawn(|| {
                while !has_ended.load(Ordering::Relaxed) {
                    most.fetch_max(bytes_in(&folder.join("work")), Ordering::Relaxed);
                    std::thread::sleep(Duration::from_millis(20));
                }
            });
            let threads = Some(self.threads);
            let options = FolderOptions { memory, threads, ..FolderOptions::default() };
            let found = delaunay_to_folder(&source, folder, &options);
            has_ended.store(true, Ordering::Relaxed);
            found
        })?;
        Ok(Done {
            simplices: found.totals.simplices,
            fingerprint: found.totals.fingerprint.to_string(),
            parts: found.totals.tiles,
            front: found.totals.front_sites,
            merged: found.totals.merged_sites,
            tiles: found.tiles.iter().map(|tile| tile.1).sum(),
            working: most.into_inner(),
            ..Done::of(meter)
        })
    }

    fn check(&self, memory: u64, folder: &Path) -> Result<Done> {
        let source = self.source()?;
        let meter = Meter::start();
        let options = TilesOptions { memory, ..TilesOptions::default() };
        let verdict = check_tiles(folder, &source, &options);
        Ok(Done { rejected: verdict.err().map(|why| why.to_string()), ..Done::of(meter) })
    }

    fn by_diamonds(&self) -> Result<Done> {
        ensure!(self.dim == 2, "diamonds are triangulated in the plane");
        let values = read_raw(&self.file)?;
        let meter = Meter::start();
        let found = diamonds::triangulate(values.as_chunks().0)?;
        Ok(Done {
            simplices: found.triangles,
            parts: found.diamonds,
            front: found.longest,
            merged: found.copies,
            ..Done::of(meter)
        })
    }
}

impl Done {
    /// What has been spent; the peak is that of the process.
    fn of(meter: Meter) -> Self {
        let cost = meter.stop();
        Done {
            cpu: cost.cpu,
            wall: cost.wall,
            peak: meter::peak(),
            simplices: 0,
            fingerprint: String::new(),
            parts: 0,
            front: 0,
            merged: 0,
            tiles: 0,
            working: 0,
            rejected: None,
        }
    }
}

/// Bytes of the files of a folder; 0 if there is none.
fn bytes_in(folder: &Path) -> u64 {
    let Ok(entries) = std::fs::read_dir(folder) else { return 0 };
    // A file may go while it is looked at.
    entries.filter_map(|entry| Some(entry.ok()?.metadata().ok()?.len())).sum()
}
