//! A sample of the points: an origin, a first whitener, and the first points of a working set.
//!
//! *Idea.* Rows at equal distances. The mean of some of them is the origin of all calculations; the covariance of all
//! makes leverages comparable before anything is known of the optimum.
//! *Trap.* The points of largest leverage alone may lie in a plane: of data with few different points, or many copies,
//! they may be copies of one. A working set like that has no ellipsoid, and gives leverages of 1e16 outside. So the points
//! farthest from the span of those before them are taken, too: an affine basis.

use taut_kernels::vector::dot;

use super::point_reader::PointReader;
use super::whitener::{Rebased, Whitener};
use super::working_set::{WorkingSet, copy_row};
use crate::Error;

/// The sample has this many rows.
const SAMPLE_ROWS: u64 = 4096;
/// The mean of this many rows of it is the origin.
const MEAN_ROWS: usize = 256;
/// The covariance of the sample ends this near the identity.
const REBASE_TOLERANCE: f64 = 1e-3;

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
        let rows = reader.rows(&ids)?;
        let dim = reader.dim();
        let origin = mean(&rows, dim);
        let mut set = WorkingSet::with_room(dim, ids.len());
        let mut row = vec![0.0; dim];
        for (&id, values) in ids.iter().zip(rows.chunks_exact(dim)) {
            for ((row, x), o) in row.iter_mut().zip(values).zip(&origin) {
                *row = x - o;
            }
            set.push(id, &row, 1.0 / count as f64);
        }
        Ok(Sample { origin, set })
    }

    /// Returns true if all rows are finite, relative to the origin.
    pub(super) fn is_finite(&self) -> bool {
        self.set.blocks().iter().all(|v| v.is_finite())
    }

    /// The largest absolute value of each coordinate, relative to the origin.
    pub(super) fn extents(&self) -> Vec<f64> {
        let dim = self.set.dim();
        let mut extents = vec![0.0f64; dim];
        let mut row = vec![0.0; dim];
        for i in 0..self.set.len() {
            self.set.copy_row(i, &mut row);
            extents.iter_mut().zip(&row).for_each(|(e, v)| *e = e.max(v.abs()));
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

    /// Positions of an affine basis, and of what is least and largest in each coordinate of `blocks`, the images of the
    /// sample under its whitener.
    pub(super) fn spread(&self, blocks: &[f64]) -> Vec<usize> {
        let dim = self.set.dim();
        let k = self.set.len();
        let mut rows = vec![0.0; k * dim];
        for (i, row) in rows.chunks_exact_mut(dim).enumerate() {
            copy_row(blocks, dim, i, row);
        }
        let mut chosen = extreme(&rows, dim);
        let mut left: Vec<f64> = rows.chunks_exact(dim).map(|row| dot(row, row)).collect();
        let farthest = |left: &[f64]| (0..k).max_by(|&a, &b| left[a].total_cmp(&left[b]));
        let Some(first) = farthest(&left) else { return chosen };
        chosen.push(first);
        let start = rows[first * dim..(first + 1) * dim].to_vec();
        for row in rows.chunks_exact_mut(dim) {
            row.iter_mut().zip(&start).for_each(|(v, s)| *v -= s);
        }
        left.iter_mut().zip(rows.chunks_exact(dim)).for_each(|(l, row)| *l = dot(row, row));
        let mut basis: Vec<Vec<f64>> = vec![];
        for _ in 0..dim {
            let Some(next) = farthest(&left) else { break };
            let mut direction = rows[next * dim..(next + 1) * dim].to_vec();
            for other in basis.iter().chain(&basis) {
                let product = dot(&direction, other);
                direction.iter_mut().zip(other).for_each(|(v, o)| *v -= product * o);
            }
            let norm = dot(&direction, &direction).sqrt();
            if norm == 0.0 {
                break;
            }
            direction.iter_mut().for_each(|v| *v /= norm);
            for (left, row) in left.iter_mut().zip(rows.chunks_exact(dim)) {
                let product = dot(row, &direction);
                *left -= product * product;
            }
            left[next] = 0.0;
            chosen.push(next);
            basis.push(direction);
        }
        chosen
    }
}

/// Positions of the rows, the least and the largest of each coordinate in turn.
fn extreme(rows: &[f64], dim: usize) -> Vec<usize> {
    let Some(first) = rows.get(..dim) else { return vec![] };
    let (mut least, mut largest) = (first.to_vec(), first.to_vec());
    let mut at = vec![[0, 0]; dim];
    for (i, row) in rows.chunks_exact(dim).enumerate() {
        let bounds = least.iter_mut().zip(&mut largest).zip(&mut at);
        for (&value, ((least, largest), at)) in row.iter().zip(bounds) {
            if value < *least {
                (*least, at[0]) = (value, i);
            }
            if value >= *largest {
                (*largest, at[1]) = (value, i);
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
