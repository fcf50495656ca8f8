//! Weighted fourth moments Σ rᵢwᵢ⊗wᵢ⊗wᵢ⊗wᵢ of points w = (y, 1): the normal matrix of an interior-point step.
//!
//! *Idea.* Entry (ab, cd) of F′ diag(r) F, F the rows of products w_a·w_b, is the same for all orders of a, b, c, d. Of the m⁴/8 entries of
//! its upper triangle m⁴/24 differ: those with a ≤ b ≤ c ≤ d. They are found by products of matrices, those of a few b at once: pairs (a, b)
//! by pairs (c, d) with c no less than the least of these b. The products w_c·w_d of some points are made once for all b, and stand point by
//! point: of products that stood pair by pair, packing them took two thirds of the time of multiplying them.
//! *Guarantee.* Sums are over points in their order, and products are of fixed shapes: nothing depends on threads.
//! *Evidence.* In thirty dimensions 0.45 of the products that the upper triangle takes, in 150 a third, and nothing of the size of F.

use taut_kernels::matrix::{Matrix, MatrixMut, add_product};
use taut_kernels::triangle::POINTS;
use taut_points::parallel::ParallelSlice;

use super::working_set::copy_row;

/// Products w_c·w_d that are to be in memory at once: two megabytes. Half a megabyte takes as long.
const PRODUCTS_WANTED: usize = 1 << 18;
/// Blocks of points whose products are made at once, at least: more products than that from 63 dimensions on.
const CHUNK_BLOCKS_MIN: usize = 4;
/// A group has at least this many pairs (a, b), if there are so many left: what a register takes of a matrix.
const GROUP_PAIRS_MIN: usize = 32;

/// The moments a ≤ b ≤ c ≤ d with b in a range: (a, b) by rows, (c, d) by columns.
#[derive(Clone, Debug)]
struct Group {
    /// First b, and the one after the last.
    first: usize,
    end: usize,
    /// Pairs (a, b) with a ≤ b < end and b ≥ first, by b.
    rows: usize,
    /// Pairs (c, d) with first ≤ c ≤ d, by c.
    columns: usize,
    moments: Vec<f64>,
}

impl Group {
    fn new(m: usize, first: usize, end: usize) -> Self {
        let rows = triangle(end) - triangle(first);
        let columns = triangle(m - first);
        Group { first, end, rows, columns, moments: vec![0.0; rows * columns] }
    }

    fn row(&self, a: usize, b: usize) -> usize {
        triangle(b) - triangle(self.first) + a
    }
}

/// Where the moments of four coordinates are, and what they are.
#[derive(Clone, Debug)]
pub(super) struct FourthMoments {
    m: usize,
    groups: Vec<Group>,
    /// The group of each b.
    group_of: Vec<usize>,
    /// Of some points, one after the other, the products w_c·w_d of all c ≤ d, by c.
    products: Vec<f64>,
    /// Coordinate by coordinate, those of all these points.
    coordinates: Vec<f64>,
}

/// Pairs a ≤ b below n.
fn triangle(n: usize) -> usize {
    n * (n + 1) / 2
}

impl FourthMoments {
    /// Of points with m coordinates, the last of which is 1.
    pub(super) fn new(m: usize) -> Self {
        let (mut groups, mut group_of, mut first) = (vec![], vec![], 0);
        while first < m {
            let is_enough = |&end: &usize| triangle(end) - triangle(first) >= GROUP_PAIRS_MIN;
            let end = (first + 1..m).find(is_enough).unwrap_or(m);
            group_of.resize(end, groups.len());
            groups.push(Group::new(m, first, end));
            first = end;
        }
        FourthMoments { m, groups, group_of, products: vec![], coordinates: vec![] }
    }

    /// Takes the moments of points in blocks, each with its weight; those that fill the last block have none.
    pub(super) fn fill(&mut self, blocks: &[f64], weights: &[f64]) {
        let m = self.m;
        let p = triangle(m);
        self.groups.iter_mut().for_each(|group| group.moments.fill(0.0));
        let chunk = (PRODUCTS_WANTED / p / POINTS).max(CHUNK_BLOCKS_MIN) * POINTS;
        for (blocks, weights) in blocks.chunks(chunk * (m - 1)).zip(weights.chunks(chunk)) {
            self.products.resize(weights.len() * p, 0.0);
            let by_block = self.products.par_chunks_mut(POINTS * p).enumerate();
            by_block.for_each(|(number, products)| {
                let size = POINTS * (m - 1);
                make_products(&blocks[number * size..][..size], m, products);
            });
            self.put_coordinates(blocks, weights.len());
            let (products, coordinates) = (&self.products, &self.coordinates);
            self.groups.par_chunks_mut(1).for_each(|groups| {
                groups.iter_mut().for_each(|group| add(group, products, coordinates, weights));
            });
        }
    }

    /// Copies blocks of so many points to `coordinates`.
    fn put_coordinates(&mut self, blocks: &[f64], count: usize) {
        let dim = self.m - 1;
        // The last one is 1.
        self.coordinates.clear();
        self.coordinates.resize(self.m * count, 1.0);
        for (number, block) in blocks.chunks_exact(POINTS * dim).enumerate() {
            for (j, values) in block.chunks_exact(POINTS).enumerate() {
                self.coordinates[j * count + number * POINTS..][..POINTS].copy_from_slice(values);
            }
        }
    }

    /// The moments of coordinates a ≤ b ≤ c ≤ d, of d = c first and up to d = m − 1.
    pub(super) fn of(&self, [a, b, c]: [usize; 3]) -> &[f64] {
        let group = &self.groups[self.group_of[b]];
        let column = group.columns - triangle(self.m - c);
        &group.moments[group.row(a, b) * group.columns + column..][..self.m - c]
    }
}

/// The products of coordinates of a block of points.
fn make_products(block: &[f64], m: usize, products: &mut [f64]) {
    let mut point = vec![1.0; m];
    for (i, mut products) in products.chunks_exact_mut(triangle(m)).enumerate() {
        // The last coordinate is 1.
        copy_row(block, m - 1, i, &mut point[..m - 1]);
        for c in 0..m {
            let (row, rest) = products.split_at_mut(m - c);
            row.iter_mut().zip(&point[c..]).for_each(|(product, w)| *product = point[c] * w);
            products = rest;
        }
    }
}

/// Adds the products of some points to the moments of a group.
fn add(group: &mut Group, products: &[f64], coordinates: &[f64], weights: &[f64]) {
    let count = weights.len();
    let coordinate = |j: usize| &coordinates[j * count..(j + 1) * count];
    let mut left = Vec::with_capacity(group.rows * count);
    for b in group.first..group.end {
        let weighted: Vec<f64> = coordinate(b).iter().zip(weights).map(|(w, r)| w * r).collect();
        for a in 0..=b {
            left.extend(coordinate(a).iter().zip(&weighted).map(|(x, y)| x * y));
        }
    }
    let p = products.len() / count;
    let left = Matrix::from_rows(&left, group.rows, count);
    let right = Matrix::from_rows(products, count, p).column_range(p - group.columns..p);
    let target = MatrixMut::from_rows(&mut group.moments, group.rows, group.columns);
    add_product(target, 1.0, left, right);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ellipsoid::working_set::WorkingSet;
    use taut_points::{Distribution, generate};

    #[test]
    fn moments_are_those_of_the_definition() {
        // The last ones take two chunks.
        for (n, dim) in [(5, 1), (40, 2), (150, 9), (70, 13), (600, 32)] {
            let values: Vec<f64> = generate(Distribution::Normal, n, dim, 7).unwrap();
            let mut set = WorkingSet::new(dim);
            let rows = (0..).zip(values.chunks_exact(dim));
            rows.for_each(|(id, row)| set.push(id, row, 1.0));
            let (m, blocks) = (dim + 1, set.blocks());
            let mut weights: Vec<f64> = (0..n).map(|i| 0.5 + (i % 7) as f64).collect();
            weights.resize(blocks.len() / dim, 0.0);
            let mut moments = FourthMoments::new(m);
            // What was there before does not count.
            moments.fill(blocks, &vec![1.0; weights.len()]);
            moments.fill(blocks, &weights);
            let mut rows = vec![vec![1.0; m]; n];
            rows.iter_mut().enumerate().for_each(|(i, w)| copy_row(blocks, dim, i, &mut w[..dim]));
            for c in 0..m {
                for (a, b) in (0..=c).flat_map(|b| (0..=b).map(move |a| (a, b))) {
                    for d in c..m {
                        let term = |(w, r): (&Vec<f64>, &f64)| r * w[a] * w[b] * w[c] * w[d];
                        let expected: f64 = rows.iter().zip(&weights).map(term).sum();
                        let size: f64 = rows.iter().zip(&weights).map(|t| term(t).abs()).sum();
                        let found = moments.of([a, b, c])[d - c];
                        assert!((found - expected).abs() <= 1e-13 * size, "{a} {b} {c} {d}");
                    }
                }
            }
        }
    }
}
