//! Pairs of rows of two trees, or of one, within a distance.
//!
//! *Idea.* For each block of one tree a walk down the other, with the box of the block in place of a point: what it costs is shared
//! by sixteen rows. Then each row of the block against the rows of the blocks that are left.
//! *Guarantee.* All pairs whose distance as calculated, less the radii of balls, is at most the one asked for; sorted by both rows;
//! the same for any number of threads. Of one tree each pair comes once, the lower row first.
//! *Trap.* Of one tree no subtree can be left out by its rows, as tree order is not that of rows; by its place in the tree it can.

use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use taut_certify::Items;
use taut_points::ReadError;

use super::dim::{AnyDim, Dim, Fixed};
use super::measure::{Measure, Squares, Surfaces, WideSquares};
use super::nodes::{BLOCK_SIZE, FANOUT, Level, NO_ROW};
use super::{QueryOptions, RowPair, SphereSearch};
use crate::Error;

/// Blocks of one task.
const TASK_SIZE: usize = 1 << 6;

/// All pairs of a row of `first` and one of `second`, or of two rows where there is no second tree.
pub(super) fn within(
    first: &SphereSearch,
    second: Option<&SphereSearch>,
    distance: f64,
    options: &QueryOptions<'_>,
) -> Result<Vec<RowPair>, Error> {
    let blocks: Vec<usize> = (0..first.nodes.blocks()).collect();
    let tasks: Vec<Vec<RowPair>> = blocks
        .par_chunks(TASK_SIZE)
        .map(|blocks| {
            options.monitor.check().map_err(ReadError::from)?;
            let other = second.unwrap_or(first);
            let task = Task { first, other, is_one: second.is_none(), blocks, distance };
            Ok(task.run())
        })
        .collect::<Result<_, Error>>()?;
    let mut pairs: Vec<RowPair> = tasks.into_iter().flatten().collect();
    pairs.par_sort_unstable_by_key(|pair| pair.rows);
    Ok(pairs)
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

impl Task<'_> {
    fn run(self) -> Vec<RowPair> {
        let are_points = [self.first, self.other].iter().all(|tree| tree.items == Items::Points);
        let is_plain = self.first.is_plain && self.other.is_plain;
        let dim = AnyDim(self.first.dim());
        match (are_points, is_plain) {
            (_, true) => Arch::new().dispatch(self),
            (true, false) => self.pairs::<_, WideSquares>(dim),
            (false, false) => self.pairs::<_, Surfaces<WideSquares>>(dim),
        }
    }

    #[inline(always)]
    fn in_dim<D: Dim>(self, dim: D) -> Vec<RowPair> {
        match [self.first, self.other].iter().all(|tree| tree.items == Items::Points) {
            true => self.pairs::<D, Squares>(dim),
            false => self.pairs::<D, Surfaces<Squares>>(dim),
        }
    }

    #[inline(always)]
    fn pairs<D: Dim, M: Measure>(self, dim: D) -> Vec<RowPair> {
        let limit = M::limit(self.distance);
        let (mut stack, mut near, mut pairs) = (vec![], vec![], vec![]);
        for &block in self.blocks {
            let bounds = BlockBounds::of(self.first, block);
            self.near_blocks::<D, M>(dim, &bounds, limit, &mut stack, &mut near);
            for lane in 0..bounds.width {
                self.pairs_of_row::<D, M>(dim, (block, lane), limit, &near, &mut pairs);
            }
        }
        pairs
    }

    /// The blocks of the other tree whose boxes are near that of a block.
    #[inline(always)]
    fn near_blocks<D: Dim, M: Measure>(
        self,
        dim: D,
        bounds: &BlockBounds,
        limit: f64,
        stack: &mut Vec<(u32, u32)>,
        near: &mut Vec<u32>,
    ) {
        let nodes = &self.other.nodes;
        near.clear();
        stack.clear();
        stack.push((nodes.root_level(), 0));
        while let Some((level, node)) = stack.pop() {
            if level == 0 {
                near.push(node);
                continue;
            }
            let (below, group) = (&nodes.levels[level as usize - 1], node as usize);
            let box_of_block = (&bounds.low[..], &bounds.high[..]);
            let keys = below.lower::<D, M>(dim, group, box_of_block, bounds.row_radius);
            // Of one tree no block before this one: it has seen this one.
            let first = if self.is_one { bounds.block >> (3 * (level - 1)) } else { 0 };
            for lane in 0..below.width(group) {
                let node = group * FANOUT + lane;
                if M::is_within(keys[lane], limit) && node >= first {
                    stack.push((level - 1, node as u32));
                }
            }
        }
    }

    /// The pairs of one row.
    #[inline(always)]
    fn pairs_of_row<D: Dim, M: Measure>(
        self,
        dim: D,
        (block, lane): (usize, usize),
        limit: f64,
        near: &[u32],
        pairs: &mut Vec<RowPair>,
    ) {
        let own = self.first.nodes.block(dim, block).as_chunks::<BLOCK_SIZE>().0;
        let row = self.first.nodes.rows_of(block)[lane];
        let row_radius = self.first.row_radius(block, lane);
        let nodes = &self.other.nodes;
        for &other in near {
            let columns = nodes.block(dim, other as usize).as_chunks::<BLOCK_SIZE>().0;
            let keys: [M::Key; BLOCK_SIZE] = M::keys(dim.get(), |axis, scale| {
                let (column, x) = (&columns[axis], own[axis][lane] * scale);
                let mut differences = [0.0; BLOCK_SIZE];
                for i in 0..BLOCK_SIZE {
                    differences[i] = x - column[i] * scale;
                }
                differences
            });
            // The sum of the radii first: it is that of the pair, whichever comes first.
            let keys =
                M::lengthen(keys, |i| -(row_radius + self.other.row_radius(other as usize, i)));
            let mut mask = 0u32;
            for i in 0..BLOCK_SIZE {
                mask |= u32::from(M::is_within(keys[i], limit)) << i;
            }
            if self.is_one && other as usize == block {
                mask &= u32::MAX << lane << 1;
            }
            let rows = nodes.rows_of(other as usize);
            while mask != 0 {
                let i = mask.trailing_zeros() as usize;
                mask &= mask - 1;
                if rows[i] != NO_ROW {
                    let mut rows = [u64::from(row), u64::from(rows[i])];
                    if self.is_one {
                        rows.sort_unstable();
                    }
                    pairs.push(RowPair { rows, distance: M::distance(keys[i]) });
                }
            }
        }
    }
}

impl WithSimd for Task<'_> {
    type Output = Vec<RowPair>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Vec<RowPair> {
        match self.first.dim() {
            2 => self.in_dim(Fixed::<2>),
            3 => self.in_dim(Fixed::<3>),
            dim => self.in_dim(AnyDim(dim)),
        }
    }
}

/// The bounds of a block.
struct BlockBounds {
    block: usize,
    low: Vec<f64>,
    high: Vec<f64>,
    row_radius: f64,
    /// Its rows.
    width: usize,
}

impl BlockBounds {
    fn of(tree: &SphereSearch, block: usize) -> Self {
        let level: &Level = &tree.nodes.levels[0];
        let (low, high) = level.box_of(tree.dim(), block);
        let row_radius = level.row_radius(block);
        let width = (tree.len as usize - block * BLOCK_SIZE).min(BLOCK_SIZE);
        BlockBounds { block, low, high, row_radius, width }
    }
}
