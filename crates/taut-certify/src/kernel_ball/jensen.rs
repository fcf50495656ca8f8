//! One distance that proves most points to be inside a ball of a Gaussian kernel.
//!
//! *Idea.* 1 − e^{−γs} is concave in s, so Σ λᵢ·2(1 − exp(−γ|x − xᵢ|²)) ≤ 2(1 − exp(−γS)) with S = Σ λᵢ|x − xᵢ|², for λ of sum 1. And for
//! any vector m, S = |x − m|² − 2(x − m)·r + v with r = Σ λᵢ(xᵢ − m) and v = Σ λᵢ|xᵢ − m|²: with m near the mean, r is nearly 0.
//! *Rounding.* S is at most |x − m|² + 2|x − m||r| + v. Sums of d squares are off by (d + 6)u, those over k multipliers, which sum to 1
//! but for 2(k + 2)u, by (4k + 12)u more; the factor 1 + (2d + 8k + 100)u on S, and on the result, covers both and the steps between.

use super::distance::{feature_distance, squared_difference};
use crate::arithmetic::U;

pub(super) struct Jensen {
    gamma: f64,
    /// m.
    mean: Vec<f64>,
    /// At least |r|.
    offset: f64,
    /// At least v.
    spread: f64,
    /// The factor that covers all roundings.
    slack: f64,
}

impl Jensen {
    pub(super) fn of(gamma: f64, rows: &[&[f64]], multipliers: &[f64]) -> Self {
        let dim = rows[0].len();
        let slack = 1.0 + (2 * dim + 8 * rows.len() + 100) as f64 * U;
        let pairs = || multipliers.iter().zip(rows);
        let mean: Vec<f64> = (0..dim).map(|j| pairs().map(|(l, row)| l * row[j]).sum()).collect();
        let mut offset = 0.0;
        for (j, m) in mean.iter().enumerate() {
            let terms = || pairs().map(|(l, row)| l * (row[j] - m));
            let size: f64 = terms().map(f64::abs).sum();
            let rest = terms().sum::<f64>().abs() + (slack - 1.0) * size;
            offset += rest * rest;
        }
        let spread = pairs().map(|(l, row)| l * squared_difference(row, &mean)).sum::<f64>();
        // The least normal number makes up for squares that vanish.
        let offset = offset.sqrt() * slack * slack + f64::MIN_POSITIVE.sqrt() * dim as f64;
        Jensen { gamma, mean, offset, spread: spread * slack + f64::MIN_POSITIVE, slack }
    }

    /// No less than Σ λᵢ·2(1 − exp(−γ|x − xᵢ|²)); NaN where a sum overflows.
    pub(super) fn upper_bound(&self, x: &[f64]) -> f64 {
        let square = squared_difference(x, &self.mean) * self.slack + f64::MIN_POSITIVE;
        let sum = (square + 2.0 * square.sqrt() * self.offset + self.spread) * self.slack;
        let bound = feature_distance(self.gamma, sum, self.mean.len());
        (bound.value + bound.error) * self.slack
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bound_is_above_the_sum_and_near_it() {
        let rows: [&[f64]; 3] = [&[0.0, 1.0], &[2.0, -1.0], &[1e3, 1e3 + 0.1]];
        for gamma in [1e-9, 1e-3] {
            let weights = [0.5, 0.3, 0.2];
            let jensen = Jensen::of(gamma, &rows, &weights);
            for x in [[0.0, 0.0], [5.0, 5.0], [-300.0, 800.0], [1e3, 1e3]] {
                let term = |row: &&[f64]| 2.0 * -(-gamma * squared_difference(&x, row)).exp_m1();
                let sum: f64 = rows.iter().zip(weights).map(|(row, l)| l * term(row)).sum();
                let bound = jensen.upper_bound(&x);
                assert!(bound >= sum, "{bound} {sum}");
                assert!(gamma > 1e-4 || bound <= sum * 1.01, "{bound} {sum}");
            }
        }
    }
}
