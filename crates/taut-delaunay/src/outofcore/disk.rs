//! Triangulates points from a source to a folder of tiles, within a limit on memory.
//!
//! *Steps.* (1) A sample is cut by a kd-tree. (2) One pass distributes the points to buckets, hashes and checks them. (3)
//! Buckets that are too large are cut again. (4) Nodes are triangulated from the leaves to the root; each is one file. (5) The
//! manifest says that all is there, and the working files go.
//! *Guarantee.* Tiles and manifest are the same, byte by byte, for any number of threads and after any number of crashes.
//! *Trap.* Memory that a process gave back may stay with its allocator; an eighth of the limit is set aside for that.

mod buckets;
mod commit;
mod distribute;
mod folder;
mod manifest;
mod nodes;
mod plan;
mod sample;
mod split;
mod stamps;
#[cfg(test)]
mod tests;
mod tree_file;

use std::fs::{self, File};
use std::path::Path;

use taut_points::{
    Blocks, InputError, Monitor, OrderBy, PointSource, PointsHash, Scratch, hash_block,
};

pub use plan::DiskPlan;

use super::bytes::WordSum;
use super::driver::{Course, Totals, Walk, run};
use super::node::{Dim, Dimension};
use super::solve::Whole;
use super::tree::{Router, Tree};
use crate::Error;
use commit::Commit;
use folder::{Folder, failed, free_bytes, remove};
use manifest::{Begun, Complete, Manifest};
use nodes::NodeFiles;
use stamps::Stamps;
use tree_file::CutPoints;

/// Options to triangulate to a folder; [`Default`] is what most people want.
#[derive(Clone, Debug, PartialEq)]
pub struct FolderOptions<'a> {
    /// Bytes of memory that the work may take, at least 64 MiB. Default 512 MiB. The tiles depend on it, the simplices do
    /// not.
    pub memory: u64,
    /// Threads to use, 1 to 1024; `None` takes as many as the current rayon pool has. No byte depends on it.
    pub threads: Option<usize>,
    /// Go on with what an earlier run left in the folder. Default false: then the folder must be new or empty.
    pub resume: bool,
    /// True if vector instructions are used where the machine has them. No byte depends on it.
    pub vectors: bool,
    /// Watches the work and can stop it. Pass 1 reads the points, pass 2 triangulates them. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for FolderOptions<'_> {
    fn default() -> Self {
        Self {
            memory: 512 << 20,
            threads: None,
            resume: false,
            vectors: true,
            monitor: Monitor::silent(),
        }
    }
}

/// A triangulation in a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TiledTriangulation {
    /// Coordinates of a point.
    pub dimension: usize,
    /// Points of the input.
    pub points: u64,
    /// The hash of the points.
    pub points_hash: PointsHash,
    /// Counts over all tiles.
    pub totals: Totals,
    /// The tiles, each with the bytes of its file.
    pub tiles: Vec<(u32, u64)>,
}

/// The name of the file of a tile in the folder.
pub fn tile_name(tile: u32) -> String {
    format!("tile-{tile:08}.ttd")
}

/// The Delaunay triangulation of the points of a source, as tiles in a folder.
///
/// Files: `manifest.txt` (lines of text: counts, hash of the points, fingerprint of the simplices, tiles) and a file for each
/// tile, as [`Tile`](super::Tile) says. Until the manifest says `state complete`, the folder `work` has what a run needs that
/// goes on with `resume`. One pass over the points, and a sample; about the time of [`delaunay()`](crate::delaunay) and half as
/// much again.
///
/// # Errors
/// [`Error::Input`] for other dimensions than 2 and 3, for points that are not finite or cannot be read, and when the monitor
/// stops the work; [`Error::FolderTaken`], [`Error::FolderLocked`], [`Error::Space`] before anything is written;
/// [`Error::Memory`] when the unfinished sites of a node do not fit, which a resumed run with more memory overcomes;
/// [`Error::OtherInput`], [`Error::DamagedFolder`] and [`Error::DamagedFront`] of a folder to resume; [`Error::File`].
pub fn delaunay_to_folder(
    source: &dyn PointSource,
    folder: &Path,
    options: &FolderOptions<'_>,
) -> Result<TiledTriangulation, Error> {
    match source.dim() {
        2 => solve::<2>(source, folder, options),
        3 => solve::<3>(source, folder, options),
        dim => {
            Err(Error::Input(InputError::Dimension { dim, expected: "2, the plane, or 3, space" }))
        }
    }
}

/// The memory and disk that [`delaunay_to_folder`] plans with.
///
/// # Errors
/// [`Error::Input`] for less than 64 MiB of memory, and for so many points that this memory cannot be enough.
pub fn plan_folder(
    source: &dyn PointSource,
    memory: u64,
    threads: usize,
) -> Result<DiskPlan, Error> {
    DiskPlan::new(source.len(), source.dim(), memory, threads)
}

/// What the manifest of a complete folder says of its tiles.
pub(super) struct CompleteManifest {
    /// Coordinates of a point.
    pub(super) dimension: u64,
    /// The numbers of the tiles, ascending.
    pub(super) tiles: Vec<u32>,
}

/// Reads the manifest of a folder that must be complete.
pub(super) fn complete_manifest(path: &Path) -> Result<CompleteManifest, Error> {
    let unfinished = || Error::UnfinishedFolder { folder: path.display().to_string() };
    let manifest = Manifest::read(&Folder::new(path).manifest())?.ok_or_else(unfinished)?;
    let complete = manifest.complete.ok_or_else(unfinished)?;
    let tiles = complete.tiles.iter().map(|tile| tile.0).collect();
    Ok(CompleteManifest { dimension: manifest.begun.dimension, tiles })
}

/// The node of the first bucket: nodes are numbered level by level.
fn first_bucket(plan: &DiskPlan) -> u32 {
    (1 << plan.levels) - 1
}

fn solve<const D: usize>(
    source: &dyn PointSource,
    path: &Path,
    options: &FolderOptions<'_>,
) -> Result<TiledTriangulation, Error>
where
    Dim<D>: Dimension<D>,
{
    let threads = options.threads.unwrap_or_else(rayon::current_num_threads);
    let refused = |refused: taut_points::ThreadsError| InputError::Option {
        name: "threads",
        value: threads.to_string(),
        expected: refused.expected,
    };
    taut_points::check_threads(threads).map_err(refused)?;
    let mut plan = DiskPlan::new(source.len(), D, options.memory, threads)?;
    let folder = Folder::new(path);
    let is_made_here = !path.exists();
    let earlier = open_folder(&folder, options.resume, &plan)?;
    let begun = match &earlier {
        Some(manifest) => manifest.begun,
        None => Begun::new(D, source.len(), &plan),
    };
    let other_input = || Error::OtherInput { folder: path.display().to_string() };
    if begun.points != source.len() || begun.dimension != D as u64 {
        return Err(other_input());
    }
    if plan.row_bytes != begun.row_bytes || begun.levels >= 31 {
        return Err(Error::DamagedFolder { path: folder.manifest().display().to_string() });
    }
    // A tree that was begun is finished, whatever the memory is now.
    plan.levels = begun.levels;
    plan.leaf_points = begun.leaf_points;
    plan.merge_above = begun.merge_above;
    fs::create_dir_all(folder.work()).map_err(failed(&folder.work()))?;
    let lock_path = folder.work().join("lock");
    let lock = File::create(&lock_path).map_err(failed(&lock_path))?;
    if lock.try_lock().is_err() {
        return Err(Error::FolderLocked { folder: path.display().to_string() });
    }
    // Read with the lock: another process may have come to the end in the meantime.
    let complete = match Manifest::read(&folder.manifest())?.and_then(|found| found.complete) {
        Some(complete) if is_of(source, complete.points_hash, options)? => complete,
        Some(_) => return Err(other_input()),
        None => {
            let solved = solve_begun::<D>(source, begun, &plan, &folder, threads, options);
            let is_fault = |error: &Error| match error {
                Error::Input(error) => error.is_fault_of_caller(),
                _ => false,
            };
            // Other points could not go on from here, and these never will.
            if earlier.is_none() && solved.as_ref().is_err_and(is_fault) {
                drop(lock);
                folder.discard(is_made_here)?;
                return solved.map(|complete| finished(source, complete));
            }
            solved?
        }
    };
    complete.tiles.iter().try_for_each(|&(tile, _)| nodes::strip(&folder, tile))?;
    folder.clear_work()?;
    drop(lock);
    folder.remove_work()?;
    Ok(finished(source, complete))
}

/// Tests whether the points of a source have this hash.
fn is_of(
    source: &dyn PointSource,
    hash: PointsHash,
    options: &FolderOptions<'_>,
) -> Result<bool, Error> {
    Ok(taut_points::hash_points(source, &options.monitor)? == hash)
}

/// Begins, or goes on, up to the complete manifest.
fn solve_begun<const D: usize>(
    source: &dyn PointSource,
    begun: Begun,
    plan: &DiskPlan,
    folder: &Folder,
    threads: usize,
    options: &FolderOptions<'_>,
) -> Result<Complete, Error>
where
    Dim<D>: Dimension<D>,
{
    Manifest { begun, complete: None }.write(&folder.manifest())?;
    let cut = match CutPoints::<D>::read(&folder.tree())? {
        Some(cut) => {
            if !is_of(source, cut.points_hash, options)? {
                return Err(Error::OtherInput { folder: folder.root().display().to_string() });
            }
            cut
        }
        None => cut_points(source, plan, folder, threads, &options.monitor)?,
    };
    remove(&folder.commit())?;
    let complete = triangulate(&cut, plan, folder, threads, options)?;
    Manifest { begun, complete: Some(complete.clone()) }.write(&folder.manifest())?;
    Ok(complete)
}

/// Opens a new folder, or one with a triangulation to resume, and looks for room.
fn open_folder(folder: &Folder, resume: bool, plan: &DiskPlan) -> Result<Option<Manifest>, Error> {
    let root = folder.root();
    let shown = || root.display().to_string();
    let earlier = Manifest::read(&folder.manifest())?;
    if earlier.is_some() && resume {
        return Ok(earlier);
    }
    if !folder.is_new(resume)? {
        return Err(Error::FolderTaken { folder: shown() });
    }
    let needed = plan.disk_bytes();
    let above = root.ancestors().find(|folder| folder.is_dir()).unwrap_or(Path::new("."));
    if let Some(free) = free_bytes(above).filter(|&free| free < needed) {
        return Err(Error::Space { folder: shown(), needed, free });
    }
    fs::create_dir_all(root).map_err(failed(root))?;
    Ok(None)
}

/// Distributes the points to leaves.
fn cut_points<const D: usize>(
    source: &dyn PointSource,
    plan: &DiskPlan,
    folder: &Folder,
    threads: usize,
    monitor: &Monitor<'_>,
) -> Result<CutPoints<D>, Error> {
    let sample = sample::sample(source)?;
    let mut sum = WordSum::default();
    sample.as_flattened().iter().for_each(|x: &f64| sum.add(&x.to_bits().to_le_bytes()));
    let sample_hash = sum.finish();
    let router = Router::<D>::new(sample, plan.router_levels());
    let buckets = 1usize << plan.levels;
    let commit = match Commit::read(&folder.commit(), buckets, router.cells())? {
        Some(commit) if commit.sample != sample_hash => {
            return Err(Error::OtherInput { folder: folder.root().display().to_string() });
        }
        Some(commit) => {
            check_blocks(source, &commit, folder, monitor)?;
            commit
        }
        None => Commit::new(sample_hash, buckets, router.cells()),
    };
    let commit = distribute::distribute(source, &router, plan, folder, commit, threads, monitor)?;
    let mut tree = Tree::new(&commit.cells);
    let first = first_bucket(plan);
    let nodes: Vec<u32> = (0..buckets as u32).map(|k| first + k).collect();
    let split::Leaves { leaves, replaced } =
        split::split(&mut tree, &router, &nodes, plan, folder)?;
    let points_hash = commit.points_hash(source);
    let cut = CutPoints { tree, leaves, magnitudes: commit.magnitudes, points_hash };
    cut.write(&folder.tree())?;
    replaced.iter().try_for_each(|&node| remove(&folder.bucket(node)))?;
    Ok(cut)
}

/// Refuses a source whose first blocks are not those that were distributed.
fn check_blocks<const D: usize>(
    source: &dyn PointSource,
    commit: &Commit<D>,
    folder: &Folder,
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    let blocks = Blocks::of(source);
    let mut scratch = Scratch::new();
    for &(block, hash) in &commit.hashes {
        monitor.check()?;
        let is_there = block < blocks.count();
        if !is_there || hash_block(&source.read(blocks.range(block), &mut scratch)?) != hash {
            return Err(Error::OtherInput { folder: folder.root().display().to_string() });
        }
    }
    Ok(())
}

/// Goes through all nodes.
fn triangulate<const D: usize>(
    cut: &CutPoints<D>,
    plan: &DiskPlan,
    folder: &Folder,
    threads: usize,
    options: &FolderOptions<'_>,
) -> Result<Complete, Error>
where
    Dim<D>: Dimension<D>,
{
    let mut is_leaf = vec![false; cut.tree.len()];
    cut.leaves.iter().for_each(|&leaf| is_leaf[leaf as usize] = true);
    let walk = Walk::new(|node| cut.tree.children(node), |node| is_leaf[node as usize]);
    let whole = Whole::new(&cut.tree, cut.magnitudes, options.vectors);
    let course = Course {
        merge_above: plan.merge_above,
        row_bytes: plan.row_bytes,
        threads,
        budget: plan.node_budget,
        site_bytes: plan::site_bytes(D),
    };
    let stamps = Stamps::open(&folder.stamps());
    let files = NodeFiles { folder, tree: &cut.tree, row_bytes: plan.row_bytes, stamps };
    let sites = |leaf: u32| cut.tree.cell(leaf).count;
    options.monitor.pass(2, cut.tree.cell(0).count);
    taut_points::keep_freed_memory(options.memory, threads);
    let totals = run(&whole, &walk, &course, &sites, &files, &options.monitor)?;
    let all = walk.nodes().iter().filter_map(|&node| Some((node, files.tile_bytes(node)?)));
    let mut tiles: Vec<(u32, u64)> = all.collect();
    tiles.order();
    Ok(Complete { points_hash: cut.points_hash, totals, tiles })
}

fn finished(source: &dyn PointSource, complete: Complete) -> TiledTriangulation {
    let Complete { points_hash, totals, tiles } = complete;
    TiledTriangulation { dimension: source.dim(), points: source.len(), points_hash, totals, tiles }
}
