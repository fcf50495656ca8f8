//! By how much the log-volume can be larger than necessary, from the multipliers and the rows they stand on.
//!
//! *Formula.* With yᵢ = F(pᵢ − c), weights uᵢ/Σu, their mean ȳ and W = r·Σuᵢ(yᵢ − ȳ)(yᵢ − ȳ)ᵀ/Σu, no ellipsoid of ℝʳ that
//! encloses the yᵢ has less than √det W times the volume of the unit ball. As y ↦ x multiplies all volumes by the same
//! number, and the answer is what it makes of the unit ball,
//!
//! > log-volume of the answer − log-volume of any enclosing ellipsoid ≤ −½ log det W.
//!
//! Proof: let {y : |G(y − b)| ≤ 1} enclose the yᵢ. Averaging |G(yᵢ − b)|² ≤ 1 gives tr(GWGᵀ)/r + |G(ȳ − b)|² ≤ 1, and the
//! mean of the eigenvalues of GWGᵀ is at least its determinant to the power 1/r, so det G²·det W ≤ 1.
//! *Why in this form.* For a good answer W is nearly I, whatever the scale, the offset and the axes of the points are:
//! no cancellation is left but that in F(pᵢ − c), which is done in doubled precision. That c is the mean of the pᵢ need not
//! be asked: |ȳ| > 0 makes W smaller, as tr W ≤ r(1 − |ȳ|²) when all |yᵢ| ≤ 1.
//! *Rounding.* What W is off by, and what its factorization W = L·D·Lᵀ is, is less than s in norm. So W − sI is
//! factorized in place of W, which makes the determinant smaller. Then −½ log det W ≤ −½ Σ log Dᵢ.
//! *Reference.* Todd, Minimum-Volume Ellipsoids, SIAM 2016, chapter 2.

use taut_points::{Monitor, ReadError};

use super::super::EllipsoidCertificate;
use super::frame::{Frame, power_of_two_below};
use super::item::Item;
use crate::CheckError;
use crate::arithmetic::{DoubleDouble, Field, Ring, U, factorize};
use crate::hashed_pass::KeptRows;

/// −½ log det W, rounded up; infinite where W is singular. Every row is already known to be valid and inside, so that it
/// is not negative but for the excess.
pub(super) fn gap(
    frame: &Frame<'_>,
    certificate: &EllipsoidCertificate,
    support: &KeptRows,
    monitor: &Monitor<'_>,
) -> Result<f64, CheckError> {
    let mut sums = Sums::new(frame.rank);
    for (position, (&id, &u)) in
        certificate.support.iter().zip(&certificate.multipliers).enumerate()
    {
        monitor.check().map_err(ReadError::from)?;
        let item = Item::of(certificate.items, frame.dim, support.row(id));
        let direction = certificate.directions.get(position).map_or(&[][..], Vec::as_slice);
        let touching = Touching::of(frame, &item, direction);
        let sizes = sizes(&touching.offset);
        let widths: f64 = (0..frame.dim).map(|j| item.width(j, frame.scale)).sum();
        let error = frame.image_error::<DoubleDouble>(&sizes, touching.errors.as_deref())
            + touching.image_error_along(frame)
            + frame.width_error(widths);
        sums.add(u, &frame.image(&touching.offset), error);
    }
    Ok(sums.gap())
}

fn sizes(offset: &[DoubleDouble]) -> Vec<f64> {
    offset.iter().map(|x| x.rounded().abs()).collect()
}

/// A point of an item.
///
/// With v = Na and q = aᵀv, for the N = S + 2τD that the row stands for, it is the point m + v/√q that lies farthest in the
/// direction a; or m where q is not known to be positive. As N is positive semidefinite, vvᵀ/q ⪯ N whatever a is.
///
/// The error of q makes v/√q longer or shorter as a whole. It is kept apart from those of the coordinates, as F may make the
/// coordinates of a thin item much larger than their sum: its part of the image is found from the image of v/√q.
pub(crate) struct Touching {
    /// The point, less the center, times s.
    pub(crate) offset: Vec<DoubleDouble>,
    /// v/√q times s; empty where the point is m.
    step: Vec<DoubleDouble>,
    /// What the coordinates may be off by beside what the step is; none where the point is m.
    errors: Option<Vec<f64>>,
    /// The part of the step that it may be longer or shorter by.
    relative: f64,
}

impl Touching {
    pub(crate) fn of(frame: &Frame<'_>, item: &Item<'_>, direction: &[f64]) -> Self {
        let offset: Vec<DoubleDouble> = frame.offset(item.center());
        let center = |offset| Touching { offset, step: vec![], errors: None, relative: 0.0 };
        let Some(scaled) = Scaled::of(item, frame.dim) else { return center(offset) };
        let a = scaled.direction(direction);
        if a.iter().all(|&a| a == 0.0) {
            return center(offset);
        }
        let zero = DoubleDouble::of(0.0);
        let n = a.len();
        let rounding = (n + 8) as f64 * DoubleDouble::ROUNDOFF;
        let mut errors = Vec::with_capacity(n);
        let (mut v, mut q, mut q_error) = (Vec::with_capacity(n), zero, 0.0);
        for (j, &aj) in a.iter().enumerate() {
            let (mut sum, mut size) = (zero, 0.0);
            for (k, &ak) in a.iter().enumerate() {
                let term = scaled.entry(j, k).times(&DoubleDouble::of(ak));
                sum = sum.plus(&term);
                size += term.rounded().abs();
            }
            let error = rounding * size + f64::MIN_POSITIVE;
            q = q.plus(&sum.times(&DoubleDouble::of(aj)));
            q_error += (2.0 * error + rounding * size) * aj.abs();
            errors.push(error);
            v.push(sum);
        }
        let is_known = q.rounded() > 1e6 * q_error && q.rounded().is_finite();
        if !is_known {
            return center(offset);
        }
        let root = q.root();
        let mut found = Touching {
            offset,
            step: vec![zero; frame.dim],
            errors: None,
            relative: q_error / q.rounded() * (1.0 + 16.0 * U),
        };
        let mut all = vec![0.0; frame.dim];
        for ((&j, &power), (v, error)) in
            scaled.columns.iter().zip(&scaled.powers).zip(v.iter().zip(&errors))
        {
            let step = v.over(&root).scaled(power).scaled(frame.scale);
            // The true v is divided by the true √q, which is larger or smaller by less than a millionth.
            let error = error / root.rounded() * power * frame.scale * (1.0 + 1e-6);
            let x = &mut found.offset[j];
            *x = x.plus(&step);
            let size = step.rounded().abs() + x.rounded().abs();
            all[j] = (error + 8.0 * DoubleDouble::ROUNDOFF * size) * (1.0 + 16.0 * U);
            found.step[j] = step;
        }
        found.errors = Some(all);
        found
    }

    /// What each coordinate of the offset may be off by, beside a few roundings; none where the point is the center.
    pub(crate) fn coordinate_errors(&self) -> Option<Vec<f64>> {
        let along = |(error, step): (&f64, &DoubleDouble)| {
            (error + self.relative * step.rounded().abs()) * (1.0 + 4.0 * U)
        };
        self.errors.as_ref().map(|errors| errors.iter().zip(&self.step).map(along).collect())
    }

    /// What the image of the point may be off by, in length, because the step is longer or shorter.
    fn image_error_along(&self, frame: &Frame<'_>) -> f64 {
        if self.step.is_empty() {
            return 0.0;
        }
        let image: Vec<DoubleDouble> = frame.image(&self.step);
        let length = image.iter().map(|y| y.rounded() * y.rounded()).sum::<f64>().sqrt();
        let beside = frame.image_error::<DoubleDouble>(&sizes(&self.step), None);
        self.relative * (length + beside) * (1.0 + (frame.rank + 16) as f64 * U)
    }
}

/// P⁻¹NP⁻¹ for powers of two P that bring the diagonal to [1, 4], without the rows and columns of zeros.
struct Scaled {
    columns: Vec<usize>,
    powers: Vec<f64>,
    /// The lower triangle, row by row.
    lower: Vec<DoubleDouble>,
}

impl Scaled {
    /// `None` for a point.
    fn of(item: &Item<'_>, dim: usize) -> Option<Self> {
        if item.is_point() {
            return None;
        }
        let columns: Vec<usize> = (0..dim).filter(|&j| item.width(j, 1.0) > 0.0).collect();
        let powers: Vec<f64> =
            columns.iter().map(|&j| power_of_two_below(item.width(j, 1.0))).collect();
        let mut lower = Vec::with_capacity(columns.len() * (columns.len() + 1) / 2);
        for (a, &j) in columns.iter().enumerate() {
            for (b, &k) in columns[..=a].iter().enumerate() {
                lower.push(item.shape(j, k, [1.0 / powers[a], 1.0 / powers[b]]));
            }
        }
        Some(Scaled { columns, powers, lower })
    }

    fn entry(&self, j: usize, k: usize) -> DoubleDouble {
        let (j, k) = (j.max(k), j.min(k));
        self.lower[j * (j + 1) / 2 + k]
    }

    /// Pa, up to its length; nothing but another direction where a part of it underflows.
    ///
    /// Powers of two bring it to size 1: of a thin item, rounding the direction turns the point farthest in it by much more.
    fn direction(&self, direction: &[f64]) -> Vec<f64> {
        let longest = |v: &[f64]| v.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let length = longest(direction);
        if length == 0.0 {
            return vec![0.0; self.columns.len()];
        }
        let size = power_of_two_below(length);
        let widest = longest(&self.powers);
        let each = self.columns.iter().zip(&self.powers);
        let a: Vec<f64> = each.map(|(&j, p)| direction[j] / size * (p / widest)).collect();
        let length = longest(&a);
        if length == 0.0 {
            return a;
        }
        let size = power_of_two_below(length);
        a.iter().map(|v| v / size).collect()
    }
}

/// Sums over the support.
struct Sums {
    rank: usize,
    /// Σu.
    weight: DoubleDouble,
    /// Σuᵢyᵢ.
    mean: Vec<DoubleDouble>,
    /// The lower triangle of Σuᵢyᵢyᵢᵀ, row by row.
    squares: Vec<DoubleDouble>,
    /// Σuᵢ|yᵢ|², and what rounding of the yᵢ adds to it in norm.
    size: f64,
    error: f64,
    count: usize,
}

impl Sums {
    fn new(rank: usize) -> Self {
        let zero = DoubleDouble::of(0.0);
        Sums {
            rank,
            weight: zero,
            mean: vec![zero; rank],
            squares: vec![zero; rank * (rank + 1) / 2],
            size: 0.0,
            error: 0.0,
            count: 0,
        }
    }

    /// Takes in one point, off by `error` in length.
    fn add(&mut self, u: f64, y: &[DoubleDouble], error: f64) {
        let weight = DoubleDouble::of(u);
        self.weight = self.weight.plus(&weight);
        let mut squares = self.squares.iter_mut();
        for (a, ya) in y.iter().enumerate() {
            let term = weight.times(ya);
            self.mean[a] = self.mean[a].plus(&term);
            for (yb, square) in y[..=a].iter().zip(&mut squares) {
                *square = square.plus(&term.times(yb));
            }
        }
        let length2: f64 = y.iter().map(|y| y.rounded() * y.rounded()).sum();
        self.size += u * length2;
        self.error += u * error * (2.0 * length2.sqrt() + error);
        self.count += 1;
    }

    /// −½ Σ log Dᵢ.
    fn gap(&self) -> f64 {
        let rank = DoubleDouble::of(self.rank as f64);
        let mut matrix = Vec::with_capacity(self.squares.len());
        for a in 0..self.rank {
            let ma = self.mean[a].over(&self.weight);
            for b in 0..=a {
                let mb = self.mean[b].over(&self.weight);
                let square = self.squares[a * (a + 1) / 2 + b].over(&self.weight);
                matrix.push(rank.times(&square.minus(&ma.times(&mb))));
            }
        }
        let shift = DoubleDouble::of(self.shift());
        for a in 0..self.rank {
            let at = a * (a + 3) / 2;
            matrix[at] = matrix[at].minus(&shift);
        }
        if !factorize(&mut matrix, self.rank) {
            return f64::INFINITY;
        }
        let (mut sum, mut size) = (0.0, 0.0);
        for a in 0..self.rank {
            let term = logarithm(&matrix[a * (a + 3) / 2]);
            sum -= 0.5 * term;
            size += term.abs();
        }
        // Logarithms are good to a few units in the last place on every platform; so are the numbers given to them.
        sum + (self.rank + 16) as f64 * U * size
    }

    /// s: what W and its factorization are off by, in norm.
    ///
    /// Each entry of the two sums passes at most k + 8 roundings, and the norm of the matrix of the sums of sizes is at
    /// most Σuᵢ|yᵢ|²; the mean weighs no more than the squares do. tr W ≤ r·Σuᵢ|yᵢ|²/Σu.
    fn shift(&self) -> f64 {
        let rank = self.rank as f64;
        let of_sums = (2 * self.count + 32) as f64 * DoubleDouble::ROUNDOFF * self.size;
        let of_factors = (4 * self.rank + 16) as f64 * DoubleDouble::ROUNDOFF * self.size;
        // The loss of products of numbers far below 1, in each of the entries.
        let underflow = (self.count + 4) as f64 * (rank + 4.0) * f64::MIN_POSITIVE;
        let weight = self.weight.rounded();
        rank * (of_sums + of_factors + 2.0 * self.error + underflow) / weight
            * (1.0 + (self.count + 16) as f64 * U)
    }
}

/// log x, relatively to a few units in the last place: near 1 from x − 1, which doubled precision knows as well.
pub(crate) fn logarithm(x: &DoubleDouble) -> f64 {
    let beside_one = x.minus(&DoubleDouble::of(1.0)).rounded();
    if beside_one.abs() < 0.5 { beside_one.ln_1p() } else { x.rounded().ln() }
}
