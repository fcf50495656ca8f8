//! The affine map that makes the weighted covariance of a point set the identity.
//!
//! *Idea.* With y = Mx − t for a lower triangular M, take mean ȳ and covariance Σ = LL′ of the images and replace M by
//! L⁻¹M, t by L⁻¹(t + ȳ). Then the leverage κ − 1 of a point is |y|².
//! *Guarantee.* Repeated, this *is* a Cholesky factorization of the inverse covariance, but in steps each of which is
//! well conditioned: the last Σ is the identity up to rounding, so leverages are right to about 1e-15 wherever the
//! points themselves say that much. On sets with axes in a ratio of 1e12 one factorization has no digit right.
//! *Trap.* A covariance that rounding has made indefinite is shifted by a multiple of the identity, which costs one
//! more turn and no accuracy (shifted CholeskyQR; Fukaya, Kannan, Nakatsukasa, Yamamoto, Yanagisawa, SIAM J. Sci.
//! Comput. 42(1), 2020).

use taut_kernels::triangle::{POINTS, Triangle, forms, images, moments};
use taut_kernels::vector::dot;

use super::dense::{cholesky, divide_rows, forward};
use super::working_set::WorkingSet;

/// It is left at that after this many turns: each takes off at least some ten digits of a condition number.
const TURNS_MAX: usize = 40;
/// A pivot below this part of its diagonal entry, for each dimension, may be what the sums over the points have rounded: then
/// chance decides whether points in a hyperplane seem to span the space.
const SIGNIFICANT_PIVOT: f64 = 16.0 * f64::EPSILON;

/// The way in which a covariance became the identity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rebased {
    /// By plain factors.
    Plainly,
    /// By shifted factors: rounding could not tell the points from points in a hyperplane at first.
    Shifted,
    /// Not at all: the points do lie in a hyperplane, or far beyond the range of `f64`.
    Never,
}

/// y = Mx − t.
#[derive(Clone, Debug)]
pub(super) struct Whitener {
    dim: usize,
    /// M, lower triangular by rows, zeros above.
    matrix: Vec<f64>,
    shift: Vec<f64>,
}

/// The images of a working set.
#[derive(Default)]
pub(super) struct Whitened {
    /// y, in blocks as the working set.
    pub(super) blocks: Vec<f64>,
    /// |y|² of each point.
    pub(super) leverages: Vec<f64>,
}

impl Whitened {
    /// The largest |y|², 0 for no points.
    pub(super) fn largest(&self) -> f64 {
        self.leverages.iter().fold(0.0, |m, &v| if v > m { v } else { m })
    }

    /// w′Nw of each point, w = (y, 1), for a symmetric matrix N of which the lower triangle is read.
    pub(super) fn forms(&self, matrix: &[f64]) -> Vec<f64> {
        let m = matrix.len().isqrt();
        let dim = m - 1;
        // With N = [[A, n], [n′, ν]]: w′Nw = y′(Ty + 2n) + ν, T the lower triangle of A, doubled beside the diagonal.
        let mut triangle = vec![0.0; dim * dim];
        for a in 0..dim {
            for b in 0..=a {
                triangle[a * dim + b] = if a == b { 1.0 } else { 2.0 } * matrix[a * m + b];
            }
        }
        let shift: Vec<f64> = matrix[dim * m..][..dim].iter().map(|n| -2.0 * n).collect();
        let triangle = Triangle { matrix: &triangle, shift: &shift };
        let corner = matrix[m * m - 1];
        let mut out = [0.0; POINTS];
        let mut all = Vec::with_capacity(self.leverages.len() + POINTS);
        for block in self.blocks.chunks_exact(POINTS * dim) {
            forms(triangle, block, &mut out);
            all.extend(out.iter().map(|form| form + corner));
        }
        all.truncate(self.leverages.len());
        all
    }
}

impl Whitener {
    /// Divides each coordinate by its scale.
    pub(super) fn of_scales(scales: &[f64]) -> Self {
        let dim = scales.len();
        let mut matrix = vec![0.0; dim * dim];
        for (j, scale) in scales.iter().enumerate() {
            matrix[j * dim + j] = 1.0 / scale;
        }
        Whitener { dim, matrix, shift: vec![0.0; dim] }
    }

    pub(super) fn matrix(&self) -> &[f64] {
        &self.matrix
    }

    /// The point that goes to 0: M⁻¹t.
    pub(super) fn center(&self) -> Vec<f64> {
        let mut center = self.shift.clone();
        forward(&self.matrix, self.dim, &mut center);
        center
    }

    /// The images of all points of a working set.
    pub(super) fn apply(&self, set: &WorkingSet) -> Whitened {
        let mut whitened = Whitened::default();
        self.apply_in_place(set, &mut whitened);
        whitened
    }

    /// Writes the images of all points of a working set into the memory of earlier ones.
    pub(super) fn apply_in_place(&self, set: &WorkingSet, whitened: &mut Whitened) {
        self.apply_to(set.blocks(), whitened);
        whitened.leverages.truncate(set.len());
    }

    fn apply_to(&self, points: &[f64], whitened: &mut Whitened) {
        let size = POINTS * self.dim;
        let Whitened { blocks, leverages } = whitened;
        blocks.resize(points.len(), 0.0);
        leverages.clear();
        leverages.reserve(points.len() / self.dim);
        let mut out = [0.0; POINTS];
        for (x, y) in points.chunks_exact(size).zip(blocks.chunks_exact_mut(size)) {
            images(Triangle { matrix: &self.matrix, shift: &self.shift }, x, y, &mut out);
            leverages.extend(out);
        }
    }

    /// Follows a step of weight β to the point x, in coordinates in which the covariance is the identity.
    pub(super) fn step(&mut self, x: &[f64], beta: f64) {
        let dim = self.dim;
        let y: Vec<f64> = (0..dim)
            .map(|a| dot(&self.matrix[a * dim..a * dim + a + 1], &x[..=a]) - self.shift[a])
            .collect();
        let mut covariance = vec![0.0; dim * dim];
        for a in 0..dim {
            for b in 0..=a {
                let identity = if a == b { 1.0 } else { 0.0 };
                covariance[a * dim + b] = (1.0 - beta) * (identity + beta * y[a] * y[b]);
            }
        }
        // A step away goes at most to where a weight is 0, but rounding may call that singular.
        let (lower, _) = shifted_cholesky(covariance, dim, 1.0);
        self.move_to(&lower, &y.iter().map(|y| beta * y).collect::<Vec<_>>());
    }

    /// M ← L⁻¹M, t ← L⁻¹(t + ȳ).
    fn move_to(&mut self, lower: &[f64], mean: &[f64]) {
        self.shift.iter_mut().zip(mean).for_each(|(t, y)| *t += y);
        forward(lower, self.dim, &mut self.shift);
        divide_rows(lower, self.dim, &mut self.matrix);
    }

    /// Makes the covariance of the weighted points the identity; the last turn starts from one within `near` of it.
    ///
    /// The returned value tells the cost in rounding.
    pub(super) fn rebase(&mut self, set: &WorkingSet, near: f64) -> Rebased {
        let (dim, m) = (self.dim, self.dim + 1);
        let mut how = Rebased::Plainly;
        let (points, weights) = set.support();
        let mut images = Whitened::default();
        for _ in 0..TURNS_MAX {
            self.apply_to(&points, &mut images);
            let moments = moments(dim, &images.blocks, &weights);
            let total = moments[m * m - 1];
            let mean: Vec<f64> = moments[dim * m..][..dim].iter().map(|s| s / total).collect();
            let mut covariance = vec![0.0; dim * dim];
            let (mut far, mut largest) = (0.0f64, 0.0f64);
            for a in 0..dim {
                for b in 0..=a {
                    let value = moments[a * m + b] / total - mean[a] * mean[b];
                    covariance[a * dim + b] = value;
                    far = far.max((value - if a == b { 1.0 } else { 0.0 }).abs());
                }
                largest = largest.max(covariance[a * dim + a]);
            }
            if !(largest > 0.0 && covariance.iter().all(|v| v.is_finite())) {
                return Rebased::Never;
            }
            let (lower, shifted) = shifted_cholesky(covariance, dim, largest);
            if shifted {
                how = Rebased::Shifted;
            }
            self.move_to(&lower, &mean);
            if far < near {
                return how;
            }
        }
        Rebased::Never
    }
}

/// The factor of A + σ1 for the least σ tried that has one: 0, or 1e-15 times d and the largest entry, and upwards; and
/// whether σ is not 0. A itself has one only if its pivots are above [`SIGNIFICANT_PIVOT`].
fn shifted_cholesky(matrix: Vec<f64>, dim: usize, largest: f64) -> (Vec<f64>, bool) {
    let mut shift = 0.0;
    loop {
        let mut lower = matrix.clone();
        (0..dim).for_each(|a| lower[a * dim + a] += shift);
        let found = cholesky(&mut lower, dim);
        let shifted = shift > 0.0;
        let is_significant = |a: usize| {
            let pivot = lower[a * dim + a].powi(2);
            pivot > SIGNIFICANT_PIVOT * dim as f64 * matrix[a * dim + a]
        };
        if found && (shifted || (0..dim).all(is_significant)) {
            return (lower, shifted);
        }
        shift = if shifted { shift * 30.0 } else { 1e-15 * dim as f64 * largest };
    }
}
