//! Mean and covariance of the rows kept, as a center and a whitener, and the passes that find them.
//!
//! *Idea.* S is never formed: M, lower triangular, stands for M′M = S⁻¹. A pass takes moments of y = M(x − c) for the
//! rows kept; their covariance C = LL′ replaces M by L⁻¹M. Near the end C is nearly the identity, so neither units,
//! offset nor the ratio of the axes costs digits.
//! *Flat.* Rounding of the coordinates moves row a of y by about Σ |M_ab|·ulp(x_b). When that is no small part of 1,
//! which is the deviation of y, the rows lie in a hyperplane as far as their digits tell. The x_b are those of the rows:
//! where many are copies, neither c nor S tells their size. A coordinate that never changes is found by comparison, as
//! rounding of moments would give it a deviation.
//! *Trap.* A covariance may be indefinite after a far outlier was dropped and yet not be flat: it is shifted, and the
//! moments taken again in the better metric.

use taut_kernels::triangle::{POINTS, Triangle, images, leverages, moments};
use taut_kernels::vector::dot;
use taut_kernels::{Center, DoubleDouble};
use taut_points::{ByteReader, ByteWriter, PartsError};

use crate::Error;
use crate::ellipsoid::dense::{cholesky, divide_rows, forward};
use crate::ellipsoid::point_reader::PointReader;

/// Rows count as flat after this many turns of shifting: each takes off some ten digits of a condition number.
const TURNS_MAX: usize = 40;

/// Rounding of coordinates may make up this part of a deviation before the direction counts as flat.
const ROUNDING_RATIO_MAX: f64 = 1.0 / 16.0;

/// Largest part of a deviation by which rounding the center to `f64` may move points; the center has a tail where it is more.
///
/// The checker grants 8 roundings of the center, and at most a tenth of the distance to the border. This is less than a
/// tenth of what it grants at most.
const CENTER_ROUNDING_MAX: f64 = 1.0 / 128.0;

/// c and M.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Estimate {
    pub(crate) center: Vec<f64>,
    /// The vector to add to `center` for c; empty stands for zeros.
    pub(crate) tail: Vec<f64>,
    /// Lower triangular by rows, zeros above: M′M = S⁻¹.
    pub(crate) matrix: Vec<f64>,
}

/// The estimate from the rows kept.
pub(super) enum RankedEstimate {
    /// Mean and covariance.
    Full(Estimate),
    /// The same, but some direction is as thin as rounding of the coordinates.
    Noise(Estimate),
    /// Some direction has no thickness at all.
    Singular,
}

/// The estimate from moments.
pub(super) enum Turned {
    /// In a metric so near to it that it has all its digits.
    Near(Estimate),
    /// In another: it is the metric in which to take the moments again.
    Rough(Estimate),
    Singular,
}

/// The moments of the rows kept, from one pass.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Moments {
    /// Σ yy′, Σ y and Σ 1 for y = M(x − c): (d + 1) × (d + 1), lower triangle.
    sums: Vec<f64>,
    /// The least and the largest of each coordinate.
    lows: Vec<f64>,
    highs: Vec<f64>,
}

impl Moments {
    pub(crate) fn nothing(dim: usize) -> Self {
        let sums = vec![0.0; (dim + 1) * (dim + 1)];
        Moments { sums, lows: vec![f64::INFINITY; dim], highs: vec![f64::NEG_INFINITY; dim] }
    }

    pub(crate) fn merge(&mut self, other: &Moments) {
        self.sums.iter_mut().zip(&other.sums).for_each(|(sum, term)| *sum += term);
        self.lows.iter_mut().zip(&other.lows).for_each(|(low, x)| *low = low.min(*x));
        self.highs.iter_mut().zip(&other.highs).for_each(|(high, x)| *high = high.max(*x));
    }

    /// Σ 1.
    pub(crate) fn count(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    pub(crate) fn write(&self, bytes: &mut ByteWriter) {
        [&self.sums, &self.lows, &self.highs].into_iter().for_each(|list| bytes.floats(list));
    }

    pub(crate) fn read(bytes: &mut ByteReader<'_>, dim: usize) -> Result<Self, PartsError> {
        let (sums, lows, highs) = (bytes.floats()?, bytes.floats()?, bytes.floats()?);
        let width = dim.saturating_add(1);
        let fits = sums.len() == width.saturating_mul(width)
            && [&lows, &highs].iter().all(|list| list.len() == dim);
        if fits { Ok(Moments { sums, lows, highs }) } else { Err(bytes.wrong()) }
    }

    /// Returns true if some coordinate is the same in all rows.
    fn is_constant(&self) -> bool {
        self.lows.iter().zip(&self.highs).any(|(low, high)| low == high)
    }

    /// The largest |x| of each coordinate.
    pub(super) fn sizes(&self) -> Vec<f64> {
        self.lows.iter().zip(&self.highs).map(|(low, high)| low.abs().max(high.abs())).collect()
    }
}

impl Estimate {
    /// A first metric: the largest distance of a coordinate from that of the first row kept is 1.
    pub(super) fn rough(data: &mut PointReader<'_>, kept: &[bool]) -> Result<Self, Error> {
        let dim = data.dim();
        let first = kept.iter().position(|&kept| kept).unwrap_or(0) as u64;
        let center = data.rows(&[first])?;
        let extents = data.visit(|first, rows| {
            let mut extents = vec![0.0f64; dim];
            for (row, _) in rows.chunks_exact(dim).zip(&kept[first as usize..]).filter(|(_, k)| **k)
            {
                for ((e, x), c) in extents.iter_mut().zip(row).zip(&center) {
                    *e = e.max((x - c).abs());
                }
            }
            extents
        })?;
        let mut matrix = vec![0.0; dim * dim];
        for j in 0..dim {
            let extent = extents.iter().fold(0.0f64, |m, block| m.max(block[j]));
            let scale = if extent > 0.0 { 1.0 / extent } else { 1.0 };
            if !scale.is_normal() {
                return Err(Error::Overflow);
            }
            matrix[j * dim + j] = scale;
        }
        Ok(Estimate { center, tail: vec![], matrix })
    }

    /// Drops the tail of the center where rounding it away moves no point by a large part of a deviation.
    pub(super) fn with_needed_tail(mut self) -> Self {
        let is_fine = |row: &[f64]| {
            let moved: f64 = row.iter().zip(&self.center).map(|(m, c)| (m * c).abs()).sum();
            0.5 * f64::EPSILON * moved <= CENTER_ROUNDING_MAX
        };
        if self.matrix.chunks_exact(self.dim()).all(is_fine) {
            self.tail.clear();
        }
        self
    }

    /// x − c for coordinate j.
    fn offset(&self, j: usize, x: f64) -> f64 {
        let offset = x - self.center[j];
        self.tail.get(j).map_or(offset, |tail| offset - tail)
    }

    pub(crate) fn dim(&self) -> usize {
        self.center.len()
    }

    /// ln det S.
    pub(super) fn log_det(&self) -> f64 {
        let dim = self.dim();
        -2.0 * (0..dim).map(|a| self.matrix[a * dim + a].ln()).sum::<f64>()
    }

    /// M(x − c).
    pub(super) fn image(&self, row: &[f64]) -> Vec<f64> {
        let offset: Vec<f64> = row.iter().enumerate().map(|(j, x)| self.offset(j, *x)).collect();
        self.matrix.chunks_exact(self.dim()).map(|m| dot(m, &offset)).collect()
    }

    /// |M(x − c)|² of all rows.
    pub(super) fn distances(&self, data: &mut PointReader<'_>) -> Result<Vec<f64>, Error> {
        let blocks = data.visit(|_, rows| self.distances_of(rows))?;
        Ok(blocks.concat())
    }

    /// |M(x − c)|² of some rows.
    pub(crate) fn distances_of(&self, rows: &[f64]) -> Vec<f64> {
        let center = Center { high: self.center.clone(), low: self.tail.clone() };
        let mut squares = vec![0.0; rows.len() / self.dim()];
        leverages(rows, &self.matrix, &center, &mut vec![], &mut squares);
        // Not a number but a square too large for one.
        squares.iter_mut().filter(|d| d.is_nan()).for_each(|d| *d = f64::INFINITY);
        squares
    }

    fn moments(&self, data: &mut PointReader<'_>, kept: &[bool]) -> Result<Moments, Error> {
        let blocks =
            data.visit(|first, rows| self.moments_of(rows, |row| kept[first as usize + row]))?;
        let mut all = Moments::nothing(self.dim());
        blocks.iter().for_each(|block| all.merge(block));
        Ok(all)
    }

    /// The moments of some rows, of those that are kept.
    pub(crate) fn moments_of(&self, rows: &[f64], is_kept: impl Fn(usize) -> bool) -> Moments {
        let dim = self.dim();
        let shift = vec![0.0; dim];
        let rows = rows.chunks_exact(dim).enumerate();
        let chosen: Vec<&[f64]> =
            rows.filter(|(row, _)| is_kept(*row)).map(|(_, row)| row).collect();
        let mut found = Moments::nothing(dim);
        let blocks = chosen.len().div_ceil(POINTS);
        let mut y = vec![0.0; blocks * dim * POINTS];
        let mut weights = vec![0.0; blocks * POINTS];
        weights[..chosen.len()].fill(1.0);
        let mut x = vec![0.0; dim * POINTS];
        let mut squares = [0.0; POINTS];
        for (chosen, y) in chosen.chunks(POINTS).zip(y.chunks_exact_mut(dim * POINTS)) {
            for (i, row) in chosen.iter().enumerate() {
                for (j, &value) in row.iter().enumerate() {
                    x[j * POINTS + i] = self.offset(j, value);
                    found.lows[j] = found.lows[j].min(value);
                    found.highs[j] = found.highs[j].max(value);
                }
            }
            let triangle = Triangle { matrix: &self.matrix, shift: &shift };
            images(triangle, &x, y, &mut squares);
        }
        found.sums = moments(dim, &y, &weights);
        found
    }

    /// Mean and covariance (divisor k − 1) of the k rows kept.
    pub(super) fn of_rows(
        &self,
        data: &mut PointReader<'_>,
        kept: &[bool],
    ) -> Result<RankedEstimate, Error> {
        let mut next = self.clone();
        for _ in 0..TURNS_MAX {
            let found = next.moments(data, kept)?;
            match next.turned(&found)? {
                Turned::Singular => return Ok(RankedEstimate::Singular),
                Turned::Near(estimate) if estimate.is_noise(&found.sizes()) => {
                    return Ok(RankedEstimate::Noise(estimate));
                }
                Turned::Near(estimate) => return Ok(RankedEstimate::Full(estimate)),
                Turned::Rough(estimate) => next = estimate,
            }
        }
        Ok(RankedEstimate::Singular)
    }

    /// Mean and covariance (divisor k − 1) of k rows, from their moments in this metric.
    pub(super) fn turned(&self, found: &Moments) -> Result<Turned, Error> {
        let dim = self.dim();
        let moments = &found.sums;
        if moments.iter().any(|v| !v.is_finite()) {
            return Err(Error::Overflow);
        }
        let last = &moments[dim * (dim + 1)..];
        let count = last[dim];
        if count < dim as f64 + 1.0 || found.is_constant() {
            return Ok(Turned::Singular);
        }
        let mut mean: Vec<f64> = last[..dim].iter().map(|s| s / count).collect();
        let mut covariance = vec![0.0; dim * dim];
        for a in 0..dim {
            for b in 0..=a {
                let product = moments[a * (dim + 1) + b] - mean[a] * mean[b] * count;
                covariance[a * dim + b] = product / (count - 1.0);
            }
        }
        // No deviation at all, exactly.
        let deviates = |a: usize| covariance[a * dim + a] > 0.0;
        if !(0..dim).all(deviates) {
            return Ok(Turned::Singular);
        }
        let Some((lower, is_near)) = factor(covariance, dim) else {
            return Err(Error::Overflow);
        };
        let mut next = self.clone();
        forward(&next.matrix, dim, &mut mean);
        next.tail.resize(dim, 0.0);
        for ((c, tail), m) in next.center.iter_mut().zip(&mut next.tail).zip(&mean) {
            let sum = DoubleDouble::sum(*c, *tail + m);
            (*c, *tail) = (sum.high, sum.low);
        }
        divide_rows(&lower, dim, &mut next.matrix);
        if next.matrix.iter().any(|m| !m.is_finite()) {
            return Ok(Turned::Singular);
        }
        let next = next.with_needed_tail();
        Ok(if is_near { Turned::Near(next) } else { Turned::Rough(next) })
    }

    /// Returns true if rounding of coordinates of these sizes could make up what is left of some direction.
    pub(super) fn is_noise(&self, sizes: &[f64]) -> bool {
        let dim = self.dim();
        let is_clear = |row: &[f64]| {
            let noise: f64 = row.iter().zip(sizes).map(|(m, s)| (m * s).powi(2)).sum();
            noise.sqrt() * f64::EPSILON < ROUNDING_RATIO_MAX
        };
        !self.matrix.chunks_exact(dim).all(is_clear)
    }
}

/// L with C = LL′, and whether C was so near the identity that L has all its digits. Shifted where C is indefinite.
fn factor(covariance: Vec<f64>, dim: usize) -> Option<(Vec<f64>, bool)> {
    let mut lower = covariance.clone();
    if cholesky(&mut lower, dim) {
        let is_near = (0..dim).all(|a| (1e-3..1e3).contains(&lower[a * dim + a]));
        return Some((lower, is_near));
    }
    let largest = (0..dim).map(|a| covariance[a * dim + a]).fold(f64::MIN_POSITIVE, f64::max);
    let mut shift = 1e-15 * dim as f64 * largest;
    while shift.is_finite() {
        lower.copy_from_slice(&covariance);
        (0..dim).for_each(|a| lower[a * dim + a] += shift);
        if cholesky(&mut lower, dim) {
            return Some((lower, false));
        }
        shift *= 30.0;
    }
    None
}
