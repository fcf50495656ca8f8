//! A sample of the points: an origin, a first whitener, and the first points of a working set.
//!
//! *Idea.* Rows at equal distances. The mean of some of them is the origin of all calculations; the covariance of all
//! makes leverages comparable before anything is known of the optimum.
//! *Trap.* The points of largest leverage alone may lie in a plane: of data with few different points, or many copies,
//! they may be copies of one. A working set like that has no ellipsoid, and gives leverages of 1e16 outside. So the points
//! farthest from the span of those before them are taken, too, an affine basis, unless the others hold one.

use taut_kernels::extremes::all_finite;
use taut_kernels::substitution::products;
use taut_kernels::triangle::POINTS;
use taut_kernels::vector::dot;

use super::point_reader::PointReader;
use super::whitener::{Rebased, Whitener};
use super::working_set::{WorkingSet, copy_row, rows_of_blocks};
use crate::Error;

/// The sample has this many rows.
const SAMPLE_ROWS: u64 = 4096;
/// The mean of this many rows of it is the origin.
const MEAN_ROWS: usize = 256;
/// The covariance of the sample ends this near the identity.
const REBASE_TOLERANCE: f64 = 1e-3;
/// Points hold an affine basis if the last point of theirs is at least this part as far from the hyperplane through the others as the
/// first two are from each other: then no working set with them is thin.
const HELD_BASIS_RATIO: f64 = 0.05;
/// A basis is sought among so many of the chosen points first.
const BASIS_CHOSEN_MAX: usize = 128;

/// Some of the points.
pub(super) struct Sample {
    /// The vector that is subtracted from all coordinates before anything else.
    pub(super) origin: Vec<f64>,
    /// The rows, relative to that, all with the same weight.
    pub(super) set: WorkingSet,
}

impl Sample {
    pub(super) fn new(reader: &PointReader<'_>) -> Result<Self, Error> {
        let count = SAMPLE_ROWS.min(reader.len());
        let ids: Vec<u64> = (0..count)
            .map(|k| (u128::from(k) * u128::from(reader.len()) / u128::from(count)) as u64)
            .collect();
        let mut rows = reader.rows(&ids)?;
        let dim = reader.dim();
        let origin = mean(&rows, dim);
        for row in rows.chunks_exact_mut(dim) {
            row.iter_mut().zip(&origin).for_each(|(x, o)| *x -= o);
        }
        Ok(Sample { origin, set: WorkingSet::of_rows(dim, ids, &rows) })
    }

    /// Returns true if all rows are finite, relative to the origin.
    pub(super) fn is_finite(&self) -> bool {
        all_finite(self.set.blocks())
    }

    /// The largest absolute value of each coordinate, relative to the origin.
    pub(super) fn extents(&self) -> Vec<f64> {
        let dim = self.set.dim();
        let mut extents = vec![0.0f64; dim];
        // Blocks are filled up with zeros, which are no extremes of these.
        for block in self.set.blocks().chunks_exact(POINTS * dim) {
            for (extent, values) in extents.iter_mut().zip(block.chunks_exact(POINTS)) {
                *extent = values.iter().fold(*extent, |most, v| most.max(v.abs()));
            }
        }
        extents
    }

    /// Takes up more rows, relative to the origin; all have the same weight then.
    pub(super) fn add(&mut self, ids: &[u64], rows: &[f64]) {
        for (&id, row) in ids.iter().zip(rows.chunks_exact(self.set.dim())) {
            self.set.push(id, row, 0.0);
        }
        self.set.weights_mut().fill(1.0);
        self.set.normalize();
    }

    /// A map that makes the covariance of the sample the identity, and what stood in its way.
    pub(super) fn whitener(&self, extents: &[f64]) -> (Whitener, Rebased) {
        let mut whitener = Whitener::of_scales(extents);
        let how = whitener.rebase(&self.set, REBASE_TOLERANCE);
        (whitener, how)
    }

    /// Positions of what is least and largest in each coordinate of `blocks`, the images of the sample under its whitener; and of an
    /// affine basis, unless those and the positions `chosen` hold one.
    pub(super) fn spread(&self, blocks: &[f64], chosen: &[usize]) -> Vec<usize> {
        let dim = self.set.dim();
        let mut spread = extreme(blocks, dim, self.set.len());
        let holds = |chosen: &[usize]| {
            let held: Vec<usize> = chosen.iter().chain(&spread).copied().collect();
            holds_basis(blocks, dim, &held)
        };
        // The first of many chosen points nearly always hold one, and to test them takes less time.
        let some = chosen.get(..BASIS_CHOSEN_MAX).is_some_and(holds);
        if !some && !holds(chosen) {
            spread.extend(affine_basis(rows_of_blocks(blocks, dim, self.set.len()), dim).0);
        }
        spread
    }
}

/// Tests whether points of blocks hold an affine basis that is not thin.
fn holds_basis(blocks: &[f64], dim: usize, held: &[usize]) -> bool {
    let mut rows = vec![0.0; held.len() * dim];
    for (&i, row) in held.iter().zip(rows.chunks_exact_mut(dim)) {
        copy_row(blocks, dim, i, row);
    }
    affine_basis(rows, dim).1 >= HELD_BASIS_RATIO
}

/// Positions of an affine basis of some rows, each next the farthest from the span of those before it, and how far the last is as a part
/// of how far the second is; 0 if the rows do not span the space.
fn affine_basis(mut rows: Vec<f64>, dim: usize) -> (Vec<usize>, f64) {
    let count = rows.len() / dim;
    let mut left: Vec<f64> = rows.chunks_exact(dim).map(|row| dot(row, row)).collect();
    let farthest = |left: &[f64]| (0..count).max_by(|&a, &b| left[a].total_cmp(&left[b]));
    let Some(first) = farthest(&left) else { return (vec![], 0.0) };
    let mut chosen = vec![first];
    let start = rows[first * dim..(first + 1) * dim].to_vec();
    for row in rows.chunks_exact_mut(dim) {
        row.iter_mut().zip(&start).for_each(|(v, s)| *v -= s);
    }
    left.iter_mut().zip(rows.chunks_exact(dim)).for_each(|(l, row)| *l = dot(row, row));
    let mut basis: Vec<Vec<f64>> = vec![];
    let mut along = vec![0.0; count];
    let (mut second, mut last) = (0.0, 0.0);
    for number in 0..dim {
        let Some(next) = farthest(&left) else { break };
        let mut direction = rows[next * dim..(next + 1) * dim].to_vec();
        for other in basis.iter().chain(&basis) {
            let product = dot(&direction, other);
            direction.iter_mut().zip(other).for_each(|(v, o)| *v -= product * o);
        }
        last = dot(&direction, &direction).sqrt();
        if number == 0 {
            second = last;
        }
        if last == 0.0 {
            break;
        }
        direction.iter_mut().for_each(|v| *v /= last);
        products(&rows, dim, &direction, &mut along);
        left.iter_mut().zip(&along).for_each(|(left, product)| *left -= product * product);
        left[next] = 0.0;
        chosen.push(next);
        basis.push(direction);
    }
    (chosen, last / second)
}

/// Positions of the least and the largest of each coordinate in turn, of the first `count` points of blocks.
fn extreme(blocks: &[f64], dim: usize, count: usize) -> Vec<usize> {
    if count == 0 {
        return vec![];
    }
    let (mut least, mut largest) = (vec![f64::INFINITY; dim], vec![f64::NEG_INFINITY; dim]);
    let mut at = vec![[0, 0]; dim];
    for (block, first) in blocks.chunks_exact(POINTS * dim).zip((0..count).step_by(POINTS)) {
        let bounds = least.iter_mut().zip(&mut largest).zip(&mut at);
        for (values, ((least, largest), at)) in block.chunks_exact(POINTS).zip(bounds) {
            let values = &values[..POINTS.min(count - first)];
            // Few blocks hold an extreme.
            if values.iter().any(|v| v < least || v >= largest) {
                for (i, &value) in (first..).zip(values) {
                    if value < *least {
                        (*least, at[0]) = (value, i);
                    }
                    if value >= *largest {
                        (*largest, at[1]) = (value, i);
                    }
                }
            }
        }
    }
    at.concat()
}

/// The mean of some rows at equal distances, taken from the first on, so that equal coordinates give just that.
fn mean(rows: &[f64], dim: usize) -> Vec<f64> {
    let count = rows.len() / dim;
    let step = count.div_ceil(MEAN_ROWS);
    let used = count.div_ceil(step) as f64;
    let mut mean = rows[..dim].to_vec();
    for row in rows.chunks_exact(dim).step_by(step) {
        for ((mean, x), first) in mean.iter_mut().zip(row).zip(&rows[..dim]) {
            // Divided first, so that the sum cannot overflow.
            *mean += x / used - first / used;
        }
    }
    mean
}
