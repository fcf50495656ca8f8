//! The first pass: each point goes to the bucket of its cell.
//!
//! *Idea.* Threads share the blocks of the source; each hashes its block, finds the cell of each point and appends it to the
//! cell's bucket, and notes boxes, counts and magnitudes. After every so many bytes all threads stop, the buckets are
//! brought to the disk, and how far this came is written to one small file.
//! *Guarantee.* After a crash the pass goes on behind the last such file: buckets are cut to the lengths in it. What was read
//! before is not read again.
//! *Trap.* Coordinates that are not finite are refused here, before anything is triangulated.

use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use taut_points::{
    BlockHash, Blocks, InputError, Monitor, OrderBy, PointSource, Points, PointsHash, Rows, Scalar,
    Scratch, hash_block,
};

use super::buckets::{Bucket, Buffers};
use super::commit::Commit;
use super::folder::Folder;
use super::plan::DiskPlan;
use crate::Error;
use crate::outofcore::tree::{CellBox, FINE_LEVELS, Router};
use crate::sites::Magnitudes;

/// Points whose cells are looked for together, in a block that stays in the cache of the first level.
const ROUTED_TOGETHER: usize = 256;

/// Bytes of records between two commits, at least and at most: an eighth of all, so that a crash repeats little of the
/// distribution of few points too, while each commit waits for all buckets to be on the disk.
const COMMIT_BYTES: [u64; 2] = [16 << 20, 256 << 20];

/// What one thread keeps from block to block.
struct Worker<const D: usize> {
    buffers: Buffers,
    cells: Vec<CellBox<D>>,
    magnitudes: Magnitudes,
    scratch: Scratch,
    hashes: Vec<(u64, BlockHash)>,
}

/// Distributes the points from where `commit` says on; returns the last commit.
pub(super) fn distribute<const D: usize>(
    source: &dyn PointSource,
    router: &Router<D>,
    plan: &DiskPlan,
    folder: &Folder,
    mut commit: Commit<D>,
    threads: usize,
    monitor: &Monitor<'_>,
) -> Result<Commit<D>, Error> {
    let first_node = super::first_bucket(plan);
    let buckets = (0..1u32 << plan.levels)
        .zip(&commit.lengths)
        .map(|(k, &length)| Bucket::open(&folder.bucket(first_node + k), length))
        .collect::<Result<Vec<Bucket>, Error>>()?;
    let blocks = Blocks::of(source);
    let empty = || Worker {
        buffers: Buffers::new(buckets.len(), plan.buffer_bytes as usize, D, plan.row_bytes),
        cells: vec![CellBox::EMPTY; router.cells()],
        magnitudes: Magnitudes::EMPTY,
        scratch: Scratch::new(),
        hashes: vec![],
    };
    let mut workers: Vec<Worker<D>> = (0..threads).map(|_| empty()).collect();
    let block_bytes = (Blocks::VALUES / D) as u64 * (8 * D as u64 + u64::from(plan.row_bytes));
    let commit_bytes = (plan.bucket_bytes / 8).clamp(COMMIT_BYTES[0], COMMIT_BYTES[1]);
    let blocks_each = commit_bytes / block_bytes;
    monitor.pass(1, source.len());
    let done = (0..commit.blocks()).map(|block| blocks.range(block));
    monitor.points(done.map(|rows| rows.end - rows.start).sum());
    while commit.blocks() < blocks.count() {
        let end = blocks.count().min(commit.blocks() + blocks_each);
        let next = AtomicU64::new(commit.blocks());
        let failed: Mutex<Option<(u64, Error)>> = Mutex::new(None);
        let share = Share { source, router, blocks: &blocks, buckets: &buckets, monitor };
        std::thread::scope(|scope| {
            for worker in &mut workers {
                let (share, next, failed) = (&share, &next, &failed);
                scope.spawn(move || {
                    loop {
                        let block = next.fetch_add(1, Ordering::Relaxed);
                        if block >= end {
                            break;
                        }
                        if let Err(error) = share.block(worker, block) {
                            next.store(end, Ordering::Relaxed);
                            let mut failed =
                                failed.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                            if failed.as_ref().is_none_or(|&(earlier, _)| block < earlier) {
                                *failed = Some((block, error));
                            }
                        }
                    }
                });
            }
        });
        let failed = failed.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some((_, error)) = failed {
            return Err(error);
        }
        for worker in &mut workers {
            worker.buffers.flush(&buckets)?;
            commit.hashes.append(&mut worker.hashes);
            commit.magnitudes.merge(worker.magnitudes);
            for (all, cell) in commit.cells.iter_mut().zip(&mut worker.cells) {
                all.merge(&std::mem::replace(cell, CellBox::EMPTY));
            }
        }
        commit.hashes.order_by_key(|&(block, _)| block);
        for (length, bucket) in commit.lengths.iter_mut().zip(&buckets) {
            *length = bucket.sync()?;
        }
        commit.write(&folder.commit())?;
    }
    Ok(commit)
}

impl<const D: usize> Commit<D> {
    /// The hash of the points, once all are distributed.
    pub(super) fn points_hash(&self, source: &dyn PointSource) -> PointsHash {
        let hashes = self.hashes.iter().map(|&(_, hash)| hash);
        PointsHash::of_blocks(source.len(), D, hashes)
    }
}

/// What all threads have in common.
struct Share<'a, const D: usize> {
    source: &'a dyn PointSource,
    router: &'a Router<D>,
    blocks: &'a Blocks,
    buckets: &'a [Bucket],
    monitor: &'a Monitor<'a>,
}

impl<const D: usize> Share<'_, D> {
    fn block(&self, worker: &mut Worker<D>, block: u64) -> Result<(), Error> {
        self.monitor.check()?;
        let range = self.blocks.range(block);
        let first = range.start;
        let mut scratch = std::mem::take(&mut worker.scratch);
        let rows = self.source.read(range, &mut scratch)?;
        worker.hashes.push((block, hash_block(&rows)));
        let count = rows.len();
        match rows {
            Rows::F32(points) => self.route(worker, &points, first)?,
            Rows::F64(points) => self.route(worker, &points, first)?,
        }
        worker.scratch = scratch;
        self.monitor.points(count as u64);
        Ok(())
    }

    fn route<T: Scalar>(
        &self,
        worker: &mut Worker<D>,
        points: &Points<'_, T>,
        first: u64,
    ) -> Result<(), Error> {
        let (mut block, mut cells) = ([[0.0; D]; ROUTED_TOGETHER], [0u32; ROUTED_TOGETHER]);
        let begins = (first..).step_by(ROUTED_TOGETHER);
        for (begin, values) in begins.zip(points.values().chunks(ROUTED_TOGETHER * D)) {
            let count = values.len() / D;
            for (p, values) in block.iter_mut().zip(values.chunks_exact(D)) {
                *p = std::array::from_fn(|i| values[i].into() + 0.0);
            }
            let (block, cells) = (&block[..count], &mut cells[..count]);
            // Without an exit, so that it compiles to vectors.
            let is_finite = |all: bool, x: &f64| all & (x.abs() <= f64::MAX);
            if !block.as_flattened().iter().fold(true, is_finite) {
                return Err(non_finite(block, begin));
            }
            worker.magnitudes.add_all(block.as_flattened());
            self.router.find_cells(block, cells);
            for ((row, &p), &cell) in (begin..).zip(block).zip(&*cells) {
                worker.cells[cell as usize].add(p);
                worker.buffers.push(self.buckets, (cell >> FINE_LEVELS) as usize, p, row)?;
            }
        }
        Ok(())
    }
}

/// The error for the first coordinate that is not finite; `begin` is the row of the first point.
#[cold]
fn non_finite<const D: usize>(points: &[[f64; D]], begin: u64) -> Error {
    let wrong = |p: &[f64; D]| p.iter().position(|x| !x.is_finite());
    let found = (begin..).zip(points).find_map(|(row, p)| Some((row, wrong(p)?, p)));
    let (row, column, value) = found.map_or((begin, 0, f64::NAN), |(row, i, p)| (row, i, p[i]));
    Error::Input(InputError::NonFinite { row, column, value })
}
