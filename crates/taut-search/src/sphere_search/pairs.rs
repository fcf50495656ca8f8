//! Pairs of rows of two trees, or of one, within a distance.
//!
//! *Idea.* For each block of one tree a walk down the other, with the box of the block in place of a point: what it costs is shared
//! by sixteen rows. Then the rows of the block against the box of each block that is left, and those near it against its rows. All of
//! this compares squares with the square of a reach; roots are taken of what is found.
//! *Guarantee.* All pairs whose distance as calculated, less the radii of balls, is at most the one asked for; sorted by both rows;
//! the same for any number of threads. Of one tree each pair comes once, the lower row first.
//! *Trap.* Of one tree no subtree can be left out by its rows, as tree order is not that of rows; by its place in the tree it can.

use pulp::{Simd, WithSimd};
use taut_certify::Items;
use taut_points::parallel::{IntoParallel, ParallelSlice};
use taut_points::{ReadError, with_narrow_vectors};

use super::dim::{AnyDim, Dim, Fixed, unrolled};
use super::measure::{Measure, Squares, Surfaces, WideSquares};
use super::nodes::{BLOCK_SIZE, FANOUT, NO_ROW};
use super::{QueryOptions, RowPair, SphereSearch};
use crate::Error;

/// Blocks of one task.
const TASK_SIZE: usize = 1 << 6;
/// Buckets that pairs are put into, as a power of two.
const BUCKET_BITS: u32 = 10;

/// Pairs of one row that one thread sorts alone.
const LONG_RUN: usize = 1 << 16;

/// All pairs of a row of `first` and one of `second`, or of two rows where there is no second tree.
pub(super) fn within(
    first: &SphereSearch,
    second: Option<&SphereSearch>,
    distance: f64,
    options: &QueryOptions<'_>,
) -> Result<Vec<RowPair>, Error> {
    let blocks: Vec<usize> = (0..first.nodes.blocks()).collect();
    let tasks: Vec<Vec<Found>> = blocks
        .par_chunks(TASK_SIZE)
        .map(|blocks| {
            options.monitor.check().map_err(ReadError::from)?;
            let other = second.unwrap_or(first);
            let task = Task { first, other, is_one: second.is_none(), blocks, distance };
            Ok(task.run())
        })
        .collect::<Result<_, Error>>()?;
    Ok(sorted(tasks, first.len as usize))
}

/// A pair as it is found: 16 bytes, where a [`RowPair`] takes 24.
#[derive(Clone, Copy)]
struct Found {
    rows: [u32; 2],
    distance: f64,
}

/// All pairs in the order of their rows: first into buckets of a range of first rows, then each bucket in the
/// caches.
fn sorted(tasks: Vec<Vec<Found>>, rows: usize) -> Vec<RowPair> {
    let shift = (rows.ilog2() + 1).saturating_sub(BUCKET_BITS);
    let bucket = |found: &Found| (found.rows[0] >> shift) as usize;
    let mut ends = vec![0usize; (1 << BUCKET_BITS) + 1];
    for found in tasks.iter().flatten() {
        ends[bucket(found) + 1] += 1;
    }
    for bucket in 1..ends.len() {
        ends[bucket] += ends[bucket - 1];
    }
    let sizes: Vec<usize> = ends.windows(2).map(|ends| ends[1] - ends[0]).collect();
    let mut pairs = vec![RowPair { rows: [0; 2], distance: 0.0 }; ends[1 << BUCKET_BITS]];
    for found in tasks.into_iter().flatten() {
        let end = &mut ends[bucket(&found)];
        pairs[*end] = RowPair { rows: found.rows.map(u64::from), distance: found.distance };
        *end += 1;
    }
    let mut buckets = vec![];
    let mut rest = &mut pairs[..];
    for size in sizes {
        let (bucket, others) = rest.split_at_mut(size);
        buckets.push(bucket);
        rest = others;
    }
    buckets.into_par_iter().with_min_len(8).for_each_init(Default::default, |memory, bucket| {
        sort_bucket(bucket, (1 << shift) - 1, memory);
    });
    pairs
}

/// Sorts the pairs of a range of first rows, which the bits of `mask` tell apart: by counting, then the few of each row.
fn sort_bucket(bucket: &mut [RowPair], mask: u64, memory: &mut (Vec<RowPair>, Vec<usize>)) {
    let (unsorted, ends) = memory;
    unsorted.clear();
    unsorted.extend_from_slice(bucket);
    ends.clear();
    ends.resize(mask as usize + 2, 0);
    let row = |pair: &RowPair| (pair.rows[0] & mask) as usize;
    for pair in &*unsorted {
        ends[row(pair) + 1] += 1;
    }
    for row in 1..ends.len() {
        ends[row] += ends[row - 1];
    }
    for pair in unsorted {
        let end = &mut ends[row(pair)];
        bucket[*end] = *pair;
        *end += 1;
    }
    for run in bucket.chunk_by_mut(|a, b| a.rows[0] == b.rows[0]) {
        match run.len() {
            0 | 1 => {}
            2..=LONG_RUN => run.sort_unstable_by_key(|pair| pair.rows[1]),
            _ => run.par_sort_unstable_by_key(|pair| pair.rows[1]),
        }
    }
}

#[derive(Clone, Copy)]
struct Task<'a> {
    first: &'a SphereSearch,
    other: &'a SphereSearch,
    /// Both are one tree.
    is_one: bool,
    blocks: &'a [usize],
    distance: f64,
}

/// The bounds of a block, and what is near them in the other tree.
#[derive(Default)]
struct Block {
    low: Vec<f64>,
    high: Vec<f64>,
    /// Nodes to visit, by level.
    stack: Vec<(u32, u32)>,
    /// Blocks of the other tree whose boxes are near.
    near: Vec<u32>,
}

impl Task<'_> {
    fn run(self) -> Vec<Found> {
        let are_points = [self.first, self.other].iter().all(|tree| tree.items == Items::Points);
        let is_plain = self.first.is_plain && self.other.is_plain;
        let dim = AnyDim(self.first.dim());
        match (are_points, is_plain) {
            (_, true) => with_narrow_vectors(self),
            (true, false) => self.pairs::<_, WideSquares>(dim),
            (false, false) => self.pairs::<_, Surfaces<WideSquares>>(dim),
        }
    }

    #[inline(always)]
    fn in_dim<D: Dim>(self, dim: D) -> Vec<Found> {
        match [self.first, self.other].iter().all(|tree| tree.items == Items::Points) {
            true => self.pairs::<D, Squares>(dim),
            false => self.pairs::<D, Surfaces<Squares>>(dim),
        }
    }

    #[inline(always)]
    fn pairs<D: Dim, M: Measure>(self, dim: D) -> Vec<Found> {
        let limit = M::limit(self.distance);
        let mut block = Block::default();
        let mut pairs = vec![];
        for &number in self.blocks {
            self.near_blocks::<D, M>(dim, number, limit, &mut block);
            for &other in &block.near {
                let other = other as usize;
                let mut rows = self.rows_near::<D, M>(dim, (number, other), limit);
                while rows != 0 {
                    let lane = rows.trailing_zeros() as usize % BLOCK_SIZE;
                    rows &= rows - 1;
                    self.pairs_of_row::<D, M>(dim, (number, lane), other, limit, &mut pairs);
                }
            }
        }
        pairs
    }

    /// Finds the blocks of the other tree whose boxes are near that of a block.
    #[inline(always)]
    fn near_blocks<D: Dim, M: Measure>(self, dim: D, number: usize, limit: f64, block: &mut Block) {
        let Block { low, high, stack, near, .. } = block;
        let bounds = &self.first.nodes.levels[0];
        low.clear();
        high.clear();
        for (l, h) in bounds.ends_of(dim.get(), number) {
            low.push(l);
            high.push(h);
        }
        let row_radius = bounds.row_radius(number);
        let nodes = &self.other.nodes;
        near.clear();
        stack.push((nodes.root_level(), 0));
        while let Some((level, group)) = stack.pop() {
            let (level, group) = (level - 1, group as usize);
            let below = &nodes.levels[level as usize];
            let box_of_block = (&low[..], &high[..]);
            let mut lanes = below.lanes_near::<D, M>(dim, group, box_of_block, row_radius, limit);
            // Of one tree no block before this one: it has seen this one.
            let first = if self.is_one { number >> (FANOUT.ilog2() * level) } else { 0 };
            while lanes != 0 {
                let node = group * FANOUT + lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                if node < first {
                    continue;
                }
                match level {
                    0 => near.push(node as u32),
                    _ => stack.push((level, node as u32)),
                }
            }
        }
    }

    /// The lanes of the rows of a block that are near the box of another one.
    #[inline(always)]
    fn rows_near<D: Dim, M: Measure>(
        self,
        dim: D,
        (block, other): (usize, usize),
        limit: f64,
    ) -> u32 {
        let own = self.first.nodes.block(dim, block);
        let level = &self.other.nodes.levels[0];
        let (boxes, lane) = (level.boxes_of(dim, other / FANOUT), other % FANOUT);
        let differences = |axis: usize, scale: f64| {
            let ends = &boxes[axis];
            let (low, high) = (ends[lane] * scale, ends[FANOUT + lane] * scale);
            let mut differences = [0.0; BLOCK_SIZE];
            for i in 0..BLOCK_SIZE {
                let x = own[axis][i] * scale;
                let (above, below) = (low - x, x - high);
                let outside = if above > below { above } else { below };
                differences[i] = if outside > 0.0 { outside } else { 0.0 };
            }
            differences
        };
        let radius = level.row_radius(other);
        let lengths = |i: usize| self.first.row_radius(block, i) + radius;
        let near = M::lanes_near::<BLOCK_SIZE>(dim.get(), differences, lengths, limit);
        let width = (self.first.len as usize - block * BLOCK_SIZE).min(BLOCK_SIZE);
        near & ((1 << width) - 1)
    }

    /// The pairs of one row with those of another block.
    #[inline(always)]
    fn pairs_of_row<D: Dim, M: Measure>(
        self,
        dim: D,
        (block, lane): (usize, usize),
        other: usize,
        limit: f64,
        pairs: &mut Vec<Found>,
    ) {
        let own = self.first.nodes.block(dim, block);
        let row_radius = self.first.row_radius(block, lane);
        let columns = self.other.nodes.block(dim, other);
        let differences = |axis: usize, scale: f64| {
            let (column, x) = (&columns[axis], own[axis][lane] * scale);
            let mut differences = [0.0; BLOCK_SIZE];
            for i in 0..BLOCK_SIZE {
                differences[i] = x - column[i] * scale;
            }
            differences
        };
        // The sum of the radii first: it is that of the pair, whichever comes first.
        let length = |i: usize| row_radius + self.other.row_radius(other, i);
        let mut near = M::lanes_near::<BLOCK_SIZE>(dim.get(), differences, length, limit);
        if self.is_one && other == block {
            near &= u32::MAX << lane << 1;
        }
        let row = self.first.nodes.rows_of(block)[lane];
        let rows = self.other.nodes.rows_of(other);
        while near != 0 {
            let i = near.trailing_zeros() as usize % BLOCK_SIZE;
            near &= near - 1;
            let key = M::keys(dim.get(), |axis, scale| {
                [own[axis][lane] * scale - columns[axis][i] * scale]
            });
            let [key] = M::lengthen(key, |_| -length(i));
            if M::is_within(key, limit) && rows[i] != NO_ROW {
                let (a, b) = (row, rows[i]);
                let rows = if self.is_one && b < a { [b, a] } else { [a, b] };
                pairs.push(Found { rows, distance: M::distance(key) });
            }
        }
    }
}

impl WithSimd for Task<'_> {
    type Output = Vec<Found>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Vec<Found> {
        match unrolled::<S>(self.first.dim()) {
            Some(2) => self.in_dim(Fixed::<2>),
            Some(3) => self.in_dim(Fixed::<3>),
            _ => self.in_dim(AnyDim(self.first.dim())),
        }
    }
}
