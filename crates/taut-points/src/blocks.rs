//! Fixed blocks of rows, worked on by all threads and put together in block order.

use std::ops::Range;

use rayon::prelude::*;

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
        first..(first + self.rows).min(self.n)
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
    let blocks = Blocks::of(source);
    let one = |scratch: &mut Scratch, block: u64| -> Result<R, E> {
        monitor.check().map_err(ReadError::from)?;
        let range = blocks.range(block);
        let (first, points) = (range.start, range.end - range.start);
        let result = work(first, source.read(range, scratch)?);
        monitor.points(points);
        result
    };
    if blocks.count() <= 1 {
        return (0..blocks.count()).map(|block| one(&mut Scratch::new(), block)).collect();
    }
    let results: Vec<Result<R, E>> = (0..blocks.count())
        .into_par_iter()
        .map_init(Scratch::new, |scratch, block| one(scratch, block))
        .collect();
    results.into_iter().collect()
}
