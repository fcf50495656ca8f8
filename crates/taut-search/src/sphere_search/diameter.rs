//! The two rows that are farthest apart, or nearly.
//!
//! *Idea.* Going from a row to the farthest one and on, until that gets no farther, finds a far pair. Then the tree against itself:
//! pairs of nodes whose boxes and balls allow a farther pair are opened, the widest first. The ball of a node bounds distances far
//! better than its box where rows lie on a sphere, or where there are many dimensions.
//! *Guarantee.* With ε = 0 no pair is farther apart, as calculated, and of several it is the one of the lowest rows; else no pair is
//! farther apart than 1 + ε times, and the bound that was reached is told. The same for any number of threads: it runs on one.
//! *Trap.* On a sphere nearly every row has a row nearly as far as the diameter: exact answers may take n² distances there, while
//! a small ε is cheap.
//! *Reference.* O. Egecioglu, B. Kalantari: Approximating the diameter of a set of points in the Euclidean space, Information
//! Processing Letters 32, 1989, for the far pair; S. Har-Peled: A practical approach for computing the diameter of a point set,
//! SoCG 2001, for the pairs of nodes.

use pulp::{Simd, WithSimd};
use taut_certify::Items;
use taut_points::{Monitor, ReadError, with_narrow_vectors};

use super::batch::run_one;
use super::dim::{AnyDim, Dim, Fixed, unrolled};
use super::measure::{Measure, Squares, Surfaces, WideSquares};
use super::nodes::{BLOCK_SIZE, FANOUT, NO_ROW};
use super::places::FindFarthest;
use super::{Diameter, SphereSearch};
use crate::Error;

/// Steps from a row to the farthest one; few sets take more than four.
const STEPS_MAX: usize = 16;
/// Pairs of nodes between two looks at the monitor.
const PAIRS_BETWEEN_CHECKS: u64 = 1 << 12;

/// A pair of nodes that may hold a farther pair of rows.
#[derive(Clone, Copy)]
struct NodePair<K> {
    bound: K,
    /// Levels and numbers.
    nodes: [(u32, u32); 2],
    /// The lowest rows, the lower one first.
    lowest_rows: [u32; 2],
}

/// The diameter to the factor 1 + ε.
pub(super) fn diameter(
    tree: &SphereSearch,
    epsilon: f64,
    monitor: &Monitor<'_>,
) -> Result<Diameter, Error> {
    let task = Task { tree, factor: 1.0 + epsilon, monitor };
    let dim = AnyDim(tree.dim());
    match (tree.is_plain, tree.items) {
        (true, _) => with_narrow_vectors(task),
        (false, Items::Points) => task.diameter::<_, WideSquares>(dim),
        (false, _) => task.diameter::<_, Surfaces<WideSquares>>(dim),
    }
}

#[derive(Clone, Copy)]
struct Task<'a> {
    tree: &'a SphereSearch,
    factor: f64,
    monitor: &'a Monitor<'a>,
}

/// The farthest pair so far.
struct Best<K> {
    key: K,
    /// The lower one first.
    rows: [u32; 2],
    /// Above the keys of all pairs that were left out for the factor.
    bound: K,
}

impl<'a> Task<'a> {
    #[inline(always)]
    fn diameter<D: Dim, M: Measure>(self, dim: D) -> Result<Diameter, Error> {
        let nodes = &self.tree.nodes;
        let mut best = Best { key: M::BELOW_ALL, rows: [NO_ROW; 2], bound: M::BELOW_ALL };
        self.start::<D, M>(dim, &mut best);
        let root = (nodes.root_level(), 0);
        let mut stack =
            vec![NodePair { bound: M::ABOVE_ALL, nodes: [root; 2], lowest_rows: [0; 2] }];
        let mut visited = 0u64;
        while let Some(pair) = stack.pop() {
            if !self.admits::<M>(&pair, &mut best) {
                continue;
            }
            visited += 1;
            if visited.is_multiple_of(PAIRS_BETWEEN_CHECKS) {
                self.monitor.check().map_err(ReadError::from)?;
            }
            match pair.nodes {
                [(0, a), (0, b)] => self.blocks::<D, M>(dim, a as usize, b as usize, &mut best),
                _ => self.open::<D, M>(dim, &pair, &mut stack, &mut best),
            }
        }
        let distance = M::distance(best.key);
        let bound = M::distance(if best.bound > best.key { best.bound } else { best.key });
        Ok(Diameter { rows: best.rows.map(u64::from), distance, upper_bound: bound })
    }

    /// A far pair, by going to the farthest row again and again.
    #[inline(always)]
    fn start<D: Dim, M: Measure>(self, dim: D, best: &mut Best<M::Key>) {
        let mut lane = 0;
        for _ in 0..STEPS_MAX {
            let place = self.tree.row(lane);
            let far = run_one(self.tree, &place, &FindFarthest(self.factor));
            let is_far = |&row: &u32| far.is_some_and(|far| far.row == u64::from(row));
            let Some(other) = self.tree.nodes.rows.iter().position(is_far) else {
                return;
            };
            let before = best.key;
            self.rows::<D, M>(dim, lane, other, best);
            if best.key <= before {
                return;
            }
            lane = other;
        }
    }

    /// Tests whether a pair of nodes may hold a farther pair of rows, and notes the bound of one that is left out for the factor.
    #[inline(always)]
    fn admits<M: Measure>(self, pair: &NodePair<M::Key>, best: &mut Best<M::Key>) -> bool {
        let is_farther =
            pair.bound > best.key || pair.bound == best.key && pair.lowest_rows < best.rows;
        if !is_farther || self.factor == 1.0 || best.rows[0] == NO_ROW {
            return is_farther;
        }
        let is_far = M::distance(pair.bound) > self.factor * M::distance(best.key);
        if !is_far && pair.bound > best.bound {
            best.bound = pair.bound;
        }
        is_far
    }

    /// Pushes the pairs of the children of the higher node with the other one, the widest last.
    #[inline(always)]
    fn open<D: Dim, M: Measure>(
        self,
        dim: D,
        pair: &NodePair<M::Key>,
        stack: &mut Vec<NodePair<M::Key>>,
        best: &mut Best<M::Key>,
    ) {
        let nodes = &self.tree.nodes;
        let [a, b] = pair.nodes;
        let (split, kept) = if a.0 >= b.0 { (a, b) } else { (b, a) };
        let (below, group) = (&nodes.levels[split.0 as usize - 1], split.1 as usize);
        let lowest_rows = below.lowest_rows_of(group);
        let first = stack.len();
        let is_parent = split.0 == kept.0 + 1 && kept.1 as usize / FANOUT == split.1 as usize;
        let is_root = kept.0 == nodes.root_level();
        let (keys, kept_row) = if is_root {
            ([M::ABOVE_ALL; FANOUT], 0)
        } else {
            let level = &nodes.levels[kept.0 as usize];
            let node = kept.1 as usize;
            let (low, high): (Vec<f64>, Vec<f64>) = level.ends_of(dim.get(), node).unzip();
            let center = level.center_of(dim.get(), node);
            let ball = (&center[..], level.radii[node]);
            let row_radius = level.row_radius(node);
            let keys = below.upper::<D, M>(dim, group, (&low, &high), ball, row_radius);
            (keys, level.lowest_rows[node])
        };
        for lane in 0..below.width(group) {
            let child = (split.0 - 1, (group * FANOUT + lane) as u32);
            // Of the children of one node each pair is met in one order.
            if is_parent && child.1 < kept.1 {
                continue;
            }
            let mut rows = [lowest_rows[lane], kept_row];
            rows.sort_unstable();
            let new = NodePair { bound: keys[lane], nodes: [child, kept], lowest_rows: rows };
            if self.admits::<M>(&new, best) {
                stack.push(new);
            }
        }
        stack[first..]
            .sort_by(|a, b| a.bound.partial_cmp(&b.bound).unwrap_or(std::cmp::Ordering::Equal));
    }

    /// All pairs of rows of two blocks.
    #[inline(always)]
    fn blocks<D: Dim, M: Measure>(self, dim: D, a: usize, b: usize, best: &mut Best<M::Key>) {
        for lane in 0..BLOCK_SIZE.min(self.tree.len as usize - a * BLOCK_SIZE) {
            let keys = self.keys_from::<D, M>(dim, a * BLOCK_SIZE + lane, b);
            let mut most = M::BELOW_ALL;
            for key in keys {
                most = if key > most { key } else { most };
            }
            if most >= best.key {
                for (i, key) in keys.into_iter().enumerate() {
                    self.offer(key, [a * BLOCK_SIZE + lane, b * BLOCK_SIZE + i], best);
                }
            }
        }
    }

    /// One pair of rows, by their lanes.
    #[inline(always)]
    fn rows<D: Dim, M: Measure>(self, dim: D, a: usize, b: usize, best: &mut Best<M::Key>) {
        let keys = self.keys_from::<D, M>(dim, a, b / BLOCK_SIZE);
        self.offer(keys[b % BLOCK_SIZE], [a, b], best);
    }

    #[inline(always)]
    fn offer<K: PartialOrd>(self, key: K, lanes: [usize; 2], best: &mut Best<K>) {
        let mut rows = lanes.map(|lane| self.tree.nodes.rows[lane]);
        rows.sort_unstable();
        if (key > best.key || key == best.key && rows < best.rows) && rows[1] != NO_ROW {
            (best.key, best.rows) = (key, rows);
        }
    }

    /// The keys of the rows of a block from a row.
    #[inline(always)]
    fn keys_from<D: Dim, M: Measure>(
        self,
        dim: D,
        lane: usize,
        block: usize,
    ) -> [M::Key; BLOCK_SIZE] {
        let nodes = &self.tree.nodes;
        let own = nodes.block(dim, lane / BLOCK_SIZE);
        let columns = nodes.block(dim, block);
        let keys = M::keys(dim.get(), |axis, scale| {
            let (column, x) = (&columns[axis], own[axis][lane % BLOCK_SIZE] * scale);
            let mut differences = [0.0; BLOCK_SIZE];
            for i in 0..BLOCK_SIZE {
                differences[i] = x - column[i] * scale;
            }
            differences
        });
        let radius = self.tree.row_radius(lane / BLOCK_SIZE, lane % BLOCK_SIZE);
        M::lengthen(keys, |i| radius + self.tree.row_radius(block, i))
    }
}

impl WithSimd for Task<'_> {
    type Output = Result<Diameter, Error>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let dim = AnyDim(self.tree.dim());
        match (unrolled::<S>(self.tree.dim()), self.tree.items) {
            (Some(2), Items::Points) => self.diameter::<_, Squares>(Fixed::<2>),
            (Some(3), Items::Points) => self.diameter::<_, Squares>(Fixed::<3>),
            (_, Items::Points) => self.diameter::<_, Squares>(dim),
            _ => self.diameter::<_, Surfaces<Squares>>(dim),
        }
    }
}
