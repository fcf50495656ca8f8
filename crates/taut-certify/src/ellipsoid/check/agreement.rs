//! Decides whether the numbers of an answer that say the same thing agree: matrix and factor, factor and log-volume.
//!
//! *Matrix.* Each entry of Q must be that of FᵀF up to 4(r + 4)u times the root of the product of the two diagonal
//! entries, which is more than multiplying out in `f64` costs; and Q must be symmetric to the bit. What the
//! difference adds to (x − c)ᵀQ(x − c) is bounded from how far the items reach along each axis. Columns of F are brought
//! to about 1 first: squares of entries 1e154 apart have no place in one matrix.
//! *Log-volume.* log κᵣ − log|det F|, for flat sets log κᵣ − log|det FBᵀ|. A triangular F has the product of its
//! diagonal as determinant. For any other, with PF = LU in `f64` and X, Y the inverses of L, U as found in `f64`, the
//! matrix T = XPFY is nearly I, and det F = ± det T/(det X·det Y): T is formed and factorized in doubled precision.
//! The log-volume must be that up to 32u times the sum of the sizes of all logarithms it is made of, plus r.
//! *Trap.* Rows and columns of F may differ by a hundred orders of magnitude: pivots are compared with their rows.

use super::super::{Ellipsoid, Hull};
use super::frame::{Frame, power_of_two_below};
use crate::Violation;
use crate::arithmetic::{DoubleDouble, Field, Ring, U};

/// The difference of Q and FᵀF, over s², when column j of F is multiplied by `powers[j]`.
pub(crate) struct Difference {
    entries: Vec<f64>,
    powers: Vec<f64>,
}

impl Difference {
    /// A bound on (x − c)ᵀ(Q − FᵀF)(x − c) for items of these extents.
    pub(super) fn bound(&self, extents: &[f64]) -> f64 {
        let extents: Vec<f64> = extents.iter().zip(&self.powers).map(|(x, p)| x / p).collect();
        let rows = self.entries.chunks_exact(extents.len());
        rows.zip(&extents)
            .map(|(row, x)| x * row.iter().zip(&extents).map(|(e, y)| e * y).sum::<f64>())
            .sum()
    }
}

/// Compares the matrix with the factor.
pub(crate) fn matrix(ellipsoid: &Ellipsoid, frame: &Frame<'_>) -> Result<Difference, Violation> {
    let dim = frame.dim;
    let powers = column_powers(frame);
    let mut product = vec![DoubleDouble::of(0.0); dim * (dim + 1) / 2];
    for a in 0..frame.rank {
        let (row, span) = frame.row(a);
        let row: Vec<f64> = row.iter().zip(&powers[span.clone()]).map(|(f, p)| f * p).collect();
        for (&f, j) in row.iter().zip(span.clone()) {
            let entries = &mut product[j * (j + 1) / 2..][span.start..=j];
            for (entry, &g) in entries.iter_mut().zip(&row) {
                *entry = entry.plus(&DoubleDouble::of(f).times(&DoubleDouble::of(g)));
            }
        }
    }
    let root = |j: usize| product[j * (j + 3) / 2].rounded().sqrt();
    let rounding = 4.0 * (frame.rank + 4) as f64 * U;
    let mut entries = vec![0.0; dim * dim];
    for j in 0..dim {
        for k in 0..=j {
            let (claimed, mirrored) = (ellipsoid.matrix[j][k], ellipsoid.matrix[k][j]);
            let found = product[j * (j + 1) / 2 + k];
            // Where one product of powers would leave the range of `f64`, each of them with the entry does not.
            let scaled = |v: f64| v * (powers[j] / frame.scale) * (powers[k] / frame.scale);
            let off = DoubleDouble::of(scaled(claimed)).minus(&found).rounded().abs();
            // Where an entry of FᵀF is so small that it has lost digits, only those digits are granted.
            let subnormal = (scaled(f64::from_bits(1)) * (frame.rank + 1) as f64).min(rounding);
            let agrees = off <= rounding * (root(j) * root(k)) + subnormal;
            if !agrees || claimed != mirrored {
                let found = found.rounded() * (frame.scale / powers[j]) * (frame.scale / powers[k]);
                let claimed = if agrees { mirrored } else { claimed };
                return Err(Violation::Matrix { row: j, column: k, claimed, found });
            }
            let bound = off * (1.0 + 8.0 * U) + U * U * (root(j) * root(k)) + f64::MIN_POSITIVE;
            entries[j * dim + k] = bound;
            entries[k * dim + j] = bound;
        }
    }
    Ok(Difference { entries, powers })
}

/// The powers of two that bring the largest entry of each column of F/s to [1, 2); 1 for a column of zeros.
fn column_powers(frame: &Frame<'_>) -> Vec<f64> {
    let mut largest = vec![0.0f64; frame.dim];
    for a in 0..frame.rank {
        largest.iter_mut().zip(frame.full_row(a)).for_each(|(m, f)| *m = m.max(f.abs()));
    }
    // Beyond 2^±1000 a power has no inverse; F/s has entries of 2 at most.
    let power =
        |m: f64| if m > 0.0 { 1.0 / power_of_two_below(m.max(2f64.powi(-1000))) } else { 1.0 };
    largest.into_iter().map(power).collect()
}

/// A number, and what it is off by at most.
pub(crate) struct LogVolume {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

/// Compares the log-volume with the factor; returns it as found here.
///
/// Each logarithm is off by 2u of itself at most, and that of a rounded number by u more; the sum by u of the sizes for each
/// of them.
pub(crate) fn log_volume(ellipsoid: &Ellipsoid, frame: &Frame<'_>) -> Result<LogVolume, Violation> {
    let claimed = ellipsoid.log_volume;
    let singular = Violation::LogVolume { claimed, found: f64::INFINITY };
    let mut logs = log_unit_ball(frame.rank);
    logs.extend(
        log_determinant(ellipsoid.hull.as_ref(), frame).ok_or(singular)?.iter().map(|l| -l),
    );
    logs.push(-(frame.rank as f64) * frame.scale.ln());
    // The basis is orthonormal to 16(d + 4)u in each product.
    let of_basis = match ellipsoid.hull {
        Some(_) => 16.0 * (frame.rank * (frame.dim + 4)) as f64 * U,
        None => 0.0,
    };
    claimed_log_volume(claimed, &logs, frame.rank, of_basis)
}

/// Compares a log-volume with the sum of the logarithms it is made of, which is off by `other` beside its rounding.
pub(crate) fn claimed_log_volume(
    claimed: f64,
    logs: &[f64],
    rank: usize,
    other: f64,
) -> Result<LogVolume, Violation> {
    let size: f64 = logs.iter().map(|l| l.abs()).sum();
    let found: f64 = logs.iter().sum();
    let tolerance = 32.0 * U * (size + rank as f64) + other;
    let error = (logs.len() + 4) as f64 * U * (size + rank as f64) + other;
    let agrees = (found - claimed).abs() <= tolerance && tolerance.is_finite();
    match agrees {
        true => Ok(LogVolume { value: found, error }),
        false => Err(Violation::LogVolume { claimed, found }),
    }
}

/// log κᵣ as a sum of logarithms: κ₀ = 1, κ₁ = 2, κᵣ = κᵣ₋₂·2π/r.
pub(crate) fn log_unit_ball(rank: usize) -> Vec<f64> {
    let first = if rank % 2 == 1 { vec![std::f64::consts::LN_2] } else { vec![] };
    let steps = (2..=rank).filter(|k| k % 2 == rank % 2);
    first.into_iter().chain(steps.map(|k| (std::f64::consts::TAU / k as f64).ln())).collect()
}

/// log|det F/s| or log|det (F/s)Bᵀ| as a sum of logarithms; `None` for a matrix that is singular but for rounding.
pub(crate) fn log_determinant(hull: Option<&Hull>, frame: &Frame<'_>) -> Option<Vec<f64>> {
    let n = frame.rank;
    let square: Vec<DoubleDouble> = match hull {
        None => (0..n).flat_map(|a| frame.full_row(a)).map(|&v| DoubleDouble::of(v)).collect(),
        Some(hull) => {
            let dot = |f: &[f64], b: &[f64]| {
                let terms = f.iter().zip(b);
                terms.fold(DoubleDouble::of(0.0), |sum, (&f, &b)| {
                    sum.plus(&DoubleDouble::of(f).times(&DoubleDouble::of(b)))
                })
            };
            (0..n).flat_map(|a| hull.basis.iter().map(move |b| dot(frame.full_row(a), b))).collect()
        }
    };
    let is_zero = |i: usize, j: usize| square[i * n + j].rounded() == 0.0;
    let lower = (0..n).all(|i| (i + 1..n).all(|j| is_zero(i, j)));
    let upper = (0..n).all(|i| (0..i).all(|j| is_zero(i, j)));
    if lower || upper {
        return (0..n).map(|i| log(square[i * n + i].rounded())).collect();
    }
    let factors = Inverses::of(&square, n)?;
    let product = factors.product(&square);
    let mut logs = log_determinant_near_one(product, n)?;
    for i in 0..n {
        logs.push(-log(factors.upper[i * n + i])?);
    }
    Some(logs)
}

fn log(value: f64) -> Option<f64> {
    let log = value.abs().ln();
    log.is_finite().then_some(log)
}

/// The inverses X of L and Y of U for PF = LU, in plain `f64`, and the order of the rows.
struct Inverses {
    n: usize,
    order: Vec<usize>,
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl Inverses {
    /// By elimination with pivots chosen by their size beside the largest entry of their row.
    fn of(square: &[DoubleDouble], n: usize) -> Option<Self> {
        let mut rows: Vec<(usize, Vec<f64>)> = square
            .chunks_exact(n)
            .map(|row| row.iter().map(Field::rounded).collect())
            .enumerate()
            .collect();
        let sizes: Vec<f64> =
            rows.iter().map(|(_, row)| row.iter().fold(0.0, |m: f64, v| m.max(v.abs()))).collect();
        for k in 0..n {
            let size = |row: &(usize, Vec<f64>)| row.1[k].abs() / sizes[row.0];
            let best = (k..n).max_by(|&i, &j| size(&rows[i]).total_cmp(&size(&rows[j])))?;
            rows.swap(k, best);
            let (done, rest) = rows.split_at_mut(k + 1);
            let pivot = &done[k].1;
            for (_, row) in rest {
                let factor = row[k] / pivot[k];
                row[k] = factor;
                row[k + 1..].iter_mut().zip(&pivot[k + 1..]).for_each(|(v, p)| *v -= factor * p);
            }
        }
        let (order, rows): (Vec<usize>, Vec<Vec<f64>>) = rows.into_iter().unzip();
        let (mut lower, mut upper) = (vec![0.0; n * n], vec![0.0; n * n]);
        for k in 0..n {
            lower[k * n + k] = 1.0;
            for i in k + 1..n {
                let sum: f64 = (k..i).map(|j| rows[i][j] * lower[j * n + k]).sum();
                lower[i * n + k] = -sum;
            }
            upper[k * n + k] = 1.0 / rows[k][k];
            for i in (0..k).rev() {
                let sum: f64 = (i + 1..=k).map(|j| rows[i][j] * upper[j * n + k]).sum();
                upper[i * n + k] = -sum / rows[i][i];
            }
        }
        Some(Inverses { n, order, lower, upper })
    }

    /// X·P·F·Y.
    fn product(&self, square: &[DoubleDouble]) -> Vec<DoubleDouble> {
        let n = self.n;
        let zero = DoubleDouble::of(0.0);
        let add = |sums: &mut [DoubleDouble], factor: DoubleDouble, row: &[DoubleDouble]| {
            for (sum, value) in sums.iter_mut().zip(row) {
                *sum = sum.plus(&factor.times(value));
            }
        };
        let upper: Vec<DoubleDouble> = self.upper.iter().map(|&v| DoubleDouble::of(v)).collect();
        let mut right = vec![zero; n * n];
        for (row, &from) in right.chunks_exact_mut(n).zip(&self.order) {
            for j in 0..n {
                add(&mut row[j..], square[from * n + j], &upper[j * n + j..(j + 1) * n]);
            }
        }
        let mut product = vec![zero; n * n];
        for (i, row) in product.chunks_exact_mut(n).enumerate() {
            for j in 0..=i {
                add(row, DoubleDouble::of(self.lower[i * n + j]), &right[j * n..(j + 1) * n]);
            }
        }
        product
    }
}

/// The logarithms of the pivots of a matrix near I; `None` for one that is not.
fn log_determinant_near_one(mut matrix: Vec<DoubleDouble>, n: usize) -> Option<Vec<f64>> {
    let square = |at: usize| {
        let beside = DoubleDouble::of(if at.is_multiple_of(n + 1) { 1.0 } else { 0.0 });
        matrix[at].minus(&beside).rounded().powi(2)
    };
    let off: f64 = (0..n * n).map(square).sum();
    let is_near = off <= 0.25;
    if !is_near {
        return None;
    }
    for k in 0..n {
        let (done, rest) = matrix.split_at_mut((k + 1) * n);
        let pivot = &done[k * n..];
        for row in rest.chunks_exact_mut(n) {
            let factor = row[k].over(&pivot[k]);
            for (value, p) in row[k + 1..].iter_mut().zip(&pivot[k + 1..]) {
                *value = value.minus(&factor.times(p));
            }
        }
    }
    (0..n).map(|k| log(matrix[k * (n + 1)].rounded())).collect()
}
