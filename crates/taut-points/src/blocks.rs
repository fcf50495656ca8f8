//! Fixed blocks of rows, worked on by all threads and put together in block order.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::helpers::share;
use crate::{Monitor, PointSource, ReadError, Rows, Scratch};

/// The partition of n rows of dimension d into blocks; it depends on n and d alone.
///
/// A block holds about [`Blocks::VALUES`] coordinates, so that one block of each thread stays in its second-level
/// cache between the uses a pass makes of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blocks {
    n: u64,
    rows: u64,
}

impl Blocks {
    /// Coordinates in a full block: 256 KiB as `f32`, 512 KiB as `f64`.
    // Part of the format of certificates: changing it changes every hash.
    pub const VALUES: usize = 1 << 16;

    /// The blocks of n rows of dimension d.
    pub fn new(n: u64, dim: usize) -> Self {
        Blocks { n, rows: (Self::VALUES / dim.max(1)).max(1) as u64 }
    }

    /// The blocks of a source.
    pub fn of(source: &dyn PointSource) -> Self {
        Self::new(source.len(), source.dim())
    }

    /// Number of blocks.
    pub fn count(&self) -> u64 {
        self.n.div_ceil(self.rows)
    }

    /// The rows of block `block`.
    pub fn range(&self, block: u64) -> Range<u64> {
        let first = block * self.rows;
        first..first.saturating_add(self.rows).min(self.n)
    }
}

/// Calls `work(first_row, rows)` for each block of `source` on all threads of the current pool and returns the
/// results in block order: one pass.
///
/// # Errors
/// The first error in block order, of reading or of `work`; [`Cancelled`](crate::Cancelled) when `monitor` asks.
pub fn map_blocks<R, E>(
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
    work: impl Fn(u64, Rows<'_>) -> Result<R, E> + Sync,
) -> Result<Vec<R>, E>
where
    R: Send,
    E: From<ReadError> + Send,
{
    let results = Mutex::new(Vec::new());
    for_each_block(source, monitor, &|block, first, rows| {
        let result = rows.map_err(E::from).and_then(|rows| work(first, rows));
        let is_done = result.is_ok();
        let mut results = results.lock().unwrap_or_else(PoisonError::into_inner);
        if results.len() <= block {
            results.resize_with(block + 1, || None);
        }
        results[block] = Some(result);
        is_done
    });
    // All blocks before a failure were handed out, so the first failure in block order is known.
    let results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.into_iter().map_while(|result| result).collect()
}

/// Works on a block, given its first row and its rows or why there are none; returns false to end the pass.
type Work<'a> = dyn Fn(usize, u64, Result<Rows<'_>, ReadError>) -> bool + Sync + 'a;

/// The pass of [`map_blocks`], compiled once for all kinds of work.
fn for_each_block(source: &dyn PointSource, monitor: &Monitor<'_>, work: &Work<'_>) {
    let blocks = Blocks::of(source);
    let one = |scratch: &mut Scratch, block: u64| -> bool {
        let range = blocks.range(block);
        let (first, points) = (range.start, range.end - range.start);
        let rows = match monitor.check() {
            Ok(()) => source.read(range, scratch),
            Err(cancelled) => Err(cancelled.into()),
        };
        let was_read = rows.is_ok();
        let is_done = work(block as usize, first, rows);
        if was_read {
            monitor.points(points);
        }
        is_done
    };
    let workers = (rayon::current_num_threads() as u64).min(blocks.count());
    if workers <= 1 {
        let mut scratch = Scratch::new();
        (0..blocks.count()).all(|block| one(&mut scratch, block));
        return;
    }
    // Blocks are handed out in order, so that a file is read nearly in order too, which is what read-ahead expects.
    // After a failure no more are handed out.
    let next = AtomicU64::new(0);
    let failed = AtomicBool::new(false);
    let worker = || {
        let mut scratch = Scratch::new();
        while !failed.load(Ordering::Relaxed) {
            let block = next.fetch_add(1, Ordering::Relaxed);
            if block >= blocks.count() {
                break;
            }
            failed.fetch_or(!one(&mut scratch, block), Ordering::Relaxed);
        }
    };
    share(workers as usize, &worker);
}

#[cfg(test)]
mod tests {
    use crate::{Monitor, Points, hash_points};

    /// Certificates written by earlier versions hold hashes over these very blocks.
    #[test]
    fn the_hash_over_several_blocks_stays_what_it_is() {
        let values: Vec<f64> = (0..200_000).map(f64::from).collect();
        for (dim, wanted) in
            [(1, "670a33c8a06098f6"), (2, "9497b0a9d120ee1a"), (100_000, "1b5f8fd08edc719f")]
        {
            let points = Points::new(&values, dim).unwrap();
            let hash = hash_points(&points, &Monitor::silent()).unwrap();
            assert_eq!(hash.to_string(), wanted, "dimension {dim}");
        }
    }

    #[test]
    fn the_last_block_ends_with_the_last_row() {
        let blocks = super::Blocks::new(u64::MAX, 1);
        assert_eq!(blocks.range(blocks.count() - 1).end, u64::MAX);
    }
}
