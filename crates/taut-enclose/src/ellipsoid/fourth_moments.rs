//! Weighted fourth moments Σ rᵢwᵢ⊗wᵢ⊗wᵢ⊗wᵢ of points w = (y, 1): the normal matrix of an interior-point step.
//!
//! *Idea.* Entry (ab, cd) of F′ diag(r) F, F the rows of products w_a·w_b, is the same for all orders of a, b, c, d. Of the m⁴/8 entries of
//! its upper triangle m⁴/24 differ: those with a ≤ b ≤ c ≤ d. They are found by products of matrices, those of a few b at once: pairs (a, b)
//! by pairs (c, d) with c no less than the least of these b.
//! *Guarantee.* Sums are over points in their order, and products are of fixed shapes: nothing depends on threads.
//! *Evidence.* 2000 points in thirty dimensions: a third of the products that the upper triangle takes, and nothing of the size of F.

use taut_kernels::matrix::{Matrix, MatrixMut, add_product};
use taut_kernels::triangle::POINTS;
use taut_points::parallel::ParallelSlice;

/// Points whose products are made at once: those of a group are to stay in the cache.
const CHUNK_BLOCKS: usize = 4;
const CHUNK: usize = CHUNK_BLOCKS * POINTS;
/// A group has at least this many pairs (a, b), if there are so many left: what a register takes of a matrix.
const GROUP_PAIRS_MIN: usize = 32;

/// The moments a ≤ b ≤ c ≤ d with b in a range: (a, b) by rows, (c, d) by columns.
#[derive(Clone, Debug)]
struct Group {
    /// First b, and the one after the last.
    first: usize,
    end: usize,
    /// Columns: pairs (c, d) with first ≤ c ≤ d.
    columns: usize,
    moments: Vec<f64>,
}

impl Group {
    fn rows(&self) -> usize {
        triangle(self.end) - triangle(self.first)
    }
}

/// Where the moments of four coordinates are, and what they are.
#[derive(Clone, Debug)]
pub(super) struct FourthMoments {
    m: usize,
    groups: Vec<Group>,
    /// The group of each b.
    group_of: Vec<usize>,
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
            let columns = triangle(m - first);
            let rows = triangle(end) - triangle(first);
            group_of.resize(end, groups.len());
            groups.push(Group { first, end, columns, moments: vec![0.0; rows * columns] });
            first = end;
        }
        FourthMoments { m, groups, group_of }
    }

    /// Takes the moments of points in blocks, each with its weight; those that fill the last block have none.
    pub(super) fn fill(&mut self, blocks: &[f64], weights: &[f64]) {
        let m = self.m;
        self.groups.par_chunks_mut(1).for_each(|groups| {
            for group in groups {
                group.moments.fill(0.0);
                let size = CHUNK * (m - 1);
                for (blocks, weights) in blocks.chunks(size).zip(weights.chunks(CHUNK)) {
                    add(group, m, blocks, weights);
                }
            }
        });
    }

    /// The moment of coordinates a ≤ b ≤ c ≤ d.
    fn sorted(&self, [a, b, c, d]: [usize; 4]) -> f64 {
        let group = &self.groups[self.group_of[b]];
        let row = triangle(b) - triangle(group.first) + a;
        let column = triangle(self.m - group.first) - triangle(self.m - c) + d - c;
        group.moments[row * group.columns + column]
    }

    /// The moment of coordinates a ≤ b and c ≤ d.
    pub(super) fn of(&self, [a, b]: [usize; 2], [c, d]: [usize; 2]) -> f64 {
        let (low, middle) = if a < c { (a, c) } else { (c, a) };
        let (other, high) = if b < d { (b, d) } else { (d, b) };
        let (second, third) = if middle < other { (middle, other) } else { (other, middle) };
        self.sorted([low, second, third, high])
    }
}

/// Adds the products of some points to the moments of a group.
fn add(group: &mut Group, m: usize, blocks: &[f64], weights: &[f64]) {
    let (count, dim) = (weights.len(), m - 1);
    // Coordinate by coordinate, those of all points one after the other; the last one is 1.
    let mut coordinates = vec![1.0; m * count];
    for (number, block) in blocks.chunks_exact(POINTS * dim).enumerate() {
        for (j, values) in block.chunks_exact(POINTS).enumerate() {
            coordinates[j * count + number * POINTS..][..POINTS].copy_from_slice(values);
        }
    }
    let coordinate = |j: usize| &coordinates[j * count..(j + 1) * count];
    let mut left = Vec::with_capacity(group.rows() * count);
    for b in group.first..group.end {
        let weighted: Vec<f64> = coordinate(b).iter().zip(weights).map(|(w, r)| w * r).collect();
        for a in 0..=b {
            left.extend(coordinate(a).iter().zip(&weighted).map(|(x, y)| x * y));
        }
    }
    // By pairs, though a product copies it before it reads it: point by point it took longer to make.
    let mut right = Vec::with_capacity(group.columns * count);
    for c in group.first..m {
        for d in c..m {
            right.extend(coordinate(c).iter().zip(coordinate(d)).map(|(x, y)| x * y));
        }
    }
    let (rows, columns) = (group.rows(), group.columns);
    let left = Matrix::from_rows(&left, rows, count);
    let right = Matrix::from_rows(&right, columns, count);
    let target = MatrixMut::from_rows(&mut group.moments, rows, columns);
    add_product(target, 1.0, left, right.transpose());
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ellipsoid::working_set::{WorkingSet, copy_row};
    use taut_points::{Distribution, generate};

    #[test]
    fn moments_are_those_of_the_definition() {
        for (n, dim) in [(5, 1), (40, 2), (150, 9), (70, 13)] {
            let values: Vec<f64> = generate(Distribution::Normal, n, dim, 7).unwrap();
            let mut set = WorkingSet::new(dim);
            let rows = (0..).zip(values.chunks_exact(dim));
            rows.for_each(|(id, row)| set.push(id, row, 1.0));
            let (m, blocks) = (dim + 1, set.blocks());
            let mut weights: Vec<f64> = (0..n).map(|i| 0.5 + (i % 7) as f64).collect();
            weights.resize(blocks.len() / dim, 0.0);
            let mut moments = FourthMoments::new(m);
            // What was there before does not count.
            moments.fill(blocks, &weights);
            moments.fill(blocks, &weights);
            let mut rows = vec![vec![1.0; m]; n];
            rows.iter_mut().enumerate().for_each(|(i, w)| copy_row(blocks, dim, i, &mut w[..dim]));
            for b in 0..m {
                for (a, d) in (0..=b).flat_map(|a| (0..m).map(move |d| (a, d))) {
                    for c in 0..=d {
                        let term = |(w, r): (&Vec<f64>, &f64)| r * w[a] * w[b] * w[c] * w[d];
                        let expected: f64 = rows.iter().zip(&weights).map(term).sum();
                        let size: f64 = rows.iter().zip(&weights).map(|t| term(t).abs()).sum();
                        let found = moments.of([a, b], [c, d]);
                        assert!((found - expected).abs() <= 1e-13 * size, "{a} {b} {c} {d}");
                    }
                }
            }
        }
    }
}
