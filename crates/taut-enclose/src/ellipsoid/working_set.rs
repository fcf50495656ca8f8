//! The points a solver works on, coordinate by coordinate in blocks, each with its multiplier.

use std::borrow::Cow;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};
use std::sync::OnceLock;

use taut_kernels::triangle::POINTS;

/// The largest number of points whose wᵢwᵢ′, wᵢ = (yᵢ, 1), can be independent: multipliers on more can be moved to fewer.
pub(super) const fn basis_max(dim: usize) -> usize {
    (dim + 1) * (dim + 2) / 2
}

/// Where points stand, by row number.
type Positions = HashMap<u64, usize, BuildHasherDefault<IdHasher>>;

/// Points relative to an origin, in the order the kernels want, and their multipliers u.
#[derive(Clone, Debug)]
pub(super) struct WorkingSet {
    dim: usize,
    ids: Vec<u64>,
    /// Where each point stands; made when it is first asked for.
    positions: OnceLock<Positions>,
    /// Coordinate j of point i stands at (i / 32)·32d + 32j + i % 32; the last block is filled with zeros.
    blocks: Vec<f64>,
    /// u, and zeros up to the end of the last block.
    weights: Vec<f64>,
}

impl WorkingSet {
    pub(super) fn new(dim: usize) -> Self {
        WorkingSet { dim, ids: vec![], positions: OnceLock::new(), blocks: vec![], weights: vec![] }
    }

    /// Points of equal multipliers, whose numbers differ.
    pub(super) fn of_rows(dim: usize, ids: Vec<u64>, rows: &[f64]) -> Self {
        let count = ids.len();
        let size = count.next_multiple_of(POINTS);
        let (mut blocks, mut weights) = (vec![0.0; size * dim], vec![0.0; size]);
        for (block, rows) in blocks.chunks_exact_mut(POINTS * dim).zip(rows.chunks(POINTS * dim)) {
            for (j, column) in block.chunks_exact_mut(POINTS).enumerate() {
                for (row, value) in rows.chunks_exact(dim).zip(column) {
                    *value = row[j];
                }
            }
        }
        weights[..count].fill(1.0 / count as f64);
        WorkingSet { dim, ids, positions: OnceLock::new(), blocks, weights }
    }

    pub(super) fn dim(&self) -> usize {
        self.dim
    }

    pub(super) fn len(&self) -> usize {
        self.ids.len()
    }

    pub(super) fn ids(&self) -> &[u64] {
        &self.ids
    }

    pub(super) fn contains(&self, id: u64) -> bool {
        self.positions().contains_key(&id)
    }

    fn positions(&self) -> &Positions {
        self.positions.get_or_init(|| self.ids.iter().copied().zip(0..).collect())
    }

    /// Where a point stands.
    pub(super) fn position(&self, id: u64) -> Option<usize> {
        self.positions().get(&id).copied()
    }

    pub(super) fn blocks(&self) -> &[f64] {
        &self.blocks
    }

    /// u of the points, without what fills the last block.
    pub(super) fn weights(&self) -> &[f64] {
        &self.weights[..self.len()]
    }

    pub(super) fn weights_mut(&mut self) -> &mut [f64] {
        let k = self.len();
        &mut self.weights[..k]
    }

    /// Makes the multipliers sum to 1; those that rounding has made of nothing become 0.
    pub(super) fn normalize(&mut self) {
        /// Weights below this are 0: far below what moves a log-volume of 1e-14, far above the rounding of a sum.
        const WEIGHT_MIN: f64 = 1e-15;
        self.weights.iter_mut().filter(|u| **u < WEIGHT_MIN).for_each(|u| *u = 0.0);
        let total: f64 = self.weights.iter().sum();
        self.weights.iter_mut().for_each(|u| *u /= total);
    }

    /// Adds a point unless it is there already; the row is relative to the origin.
    pub(super) fn push(&mut self, id: u64, row: &[f64], weight: f64) {
        let i = self.len();
        if self.contains(id) {
            return;
        }
        self.positions.get_mut().expect("`contains` has made them").insert(id, i);
        if i.is_multiple_of(POINTS) {
            self.blocks.resize(self.blocks.len() + POINTS * self.dim, 0.0);
            self.weights.resize(self.weights.len() + POINTS, 0.0);
        }
        self.ids.push(id);
        self.weights[i] = weight;
        for (j, &value) in row.iter().enumerate() {
            let at = self.place(i, j);
            self.blocks[at] = value;
        }
    }

    fn place(&self, i: usize, j: usize) -> usize {
        place(self.dim, i, j)
    }

    /// The coordinates of point i.
    pub(super) fn copy_row(&self, i: usize, row: &mut [f64]) {
        copy_row(&self.blocks, self.dim, i, row);
    }

    /// The points at these positions, none of which comes twice, and their multipliers.
    pub(super) fn select(&self, positions: &[usize]) -> WorkingSet {
        let (blocks, weights) = self.select_blocks(positions);
        let ids = positions.iter().map(|&i| self.ids[i]).collect();
        WorkingSet { dim: self.dim, ids, positions: OnceLock::new(), blocks, weights }
    }

    fn select_blocks(&self, positions: &[usize]) -> (Vec<f64>, Vec<f64>) {
        let size = positions.len().next_multiple_of(POINTS);
        let (mut blocks, mut weights) = (vec![0.0; size * self.dim], vec![0.0; size]);
        for (k, &i) in positions.iter().enumerate() {
            weights[k] = self.weights[i];
            for j in 0..self.dim {
                blocks[place(self.dim, k, j)] = self.blocks[place(self.dim, i, j)];
            }
        }
        (blocks, weights)
    }

    /// The same points but for those that `keep` says no to.
    pub(super) fn retain(&mut self, keep: impl Fn(usize) -> bool) {
        let kept: Vec<usize> = (0..self.len()).filter(|&i| keep(i)).collect();
        *self = self.select(&kept);
    }

    /// The blocks and padded weights of the points with a multiplier alone.
    pub(super) fn support(&self) -> (Cow<'_, [f64]>, Cow<'_, [f64]>) {
        if self.weights[..self.len()].iter().all(|u| *u > 0.0) {
            return (Cow::Borrowed(&self.blocks), Cow::Borrowed(&self.weights));
        }
        let used: Vec<usize> = (0..self.len()).filter(|&i| self.weights[i] > 0.0).collect();
        let (blocks, weights) = self.select_blocks(&used);
        (Cow::Owned(blocks), Cow::Owned(weights))
    }
}

/// A hash of row numbers: one multiplication, as they are no secret and come from no enemy.
#[derive(Clone, Copy, Debug, Default)]
struct IdHasher(u64);

impl Hasher for IdHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.write_u64(byte.into()));
    }

    fn write_u64(&mut self, id: u64) {
        // 2⁶⁴ over the golden ratio, and the upper half down, which tables look at first.
        let product = (self.0 ^ id).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = product ^ (product >> 32);
    }
}

fn place(dim: usize, i: usize, j: usize) -> usize {
    i / POINTS * POINTS * dim + j * POINTS + i % POINTS
}

/// Point i of blocks of points of dimension d.
pub(super) fn copy_row(blocks: &[f64], dim: usize, i: usize, row: &mut [f64]) {
    for (j, value) in row.iter_mut().enumerate() {
        *value = blocks[place(dim, i, j)];
    }
}

/// All of `count` points of blocks of points of dimension d, row by row.
pub(super) fn rows_of_blocks(blocks: &[f64], dim: usize, count: usize) -> Vec<f64> {
    let mut rows = vec![0.0; count * dim];
    for (block, rows) in blocks.chunks_exact(POINTS * dim).zip(rows.chunks_mut(POINTS * dim)) {
        for (j, column) in block.chunks_exact(POINTS).enumerate() {
            for (row, value) in rows.chunks_exact_mut(dim).zip(column) {
                row[j] = *value;
            }
        }
    }
    rows
}
