//! Sums over points: their mean and covariance in the frame of the answer, and the metric these make.

use super::slack::Slack;
use crate::Violation;
use crate::arithmetic::{DoubleDouble, Field, Ring, factorize};

/// A variance below this part of the mean square is none: the square of what a solver in `f64` tells from rounding. Of
/// copies of one point all variances are rounding, so that they are not compared with each other.
const VARIANCE_RATIO_MIN: f64 = 1e-16;

/// Σ 1, Σ y and Σ yy′.
#[derive(Clone)]
pub(super) struct Sums {
    pub(super) count: u64,
    first: Vec<DoubleDouble>,
    /// The lower triangle by rows.
    second: Vec<DoubleDouble>,
}

/// Mean and factorized covariance of y over the rows kept.
pub(super) struct Metric {
    mean: Vec<f64>,
    /// C = LDL′: L below the diagonal, D on it.
    lower: Vec<f64>,
}

impl Sums {
    pub(super) fn new(rank: usize) -> Self {
        let zero = DoubleDouble::of(0.0);
        Sums { count: 0, first: vec![zero; rank], second: vec![zero; rank * (rank + 1) / 2] }
    }

    pub(super) fn add(&mut self, y: &[DoubleDouble]) {
        self.count += 1;
        let mut entries = self.second.iter_mut();
        for (a, (sum, value)) in self.first.iter_mut().zip(y).enumerate() {
            *sum = sum.plus(value);
            for (entry, other) in entries.by_ref().take(a + 1).zip(y) {
                *entry = entry.plus(&value.times(other));
            }
        }
    }

    pub(super) fn merge(&mut self, other: &Sums) {
        self.count += other.count;
        let pairs = self.first.iter_mut().chain(&mut self.second);
        for (sum, term) in pairs.zip(other.first.iter().chain(&other.second)) {
            *sum = sum.plus(term);
        }
    }

    /// Mean and covariance, divisor k − 1, the lower triangle by rows.
    fn estimate(&self) -> (Vec<DoubleDouble>, Vec<DoubleDouble>) {
        let count = DoubleDouble::of(self.count as f64);
        let less = DoubleDouble::of(self.count.saturating_sub(1).max(1) as f64);
        let mean: Vec<DoubleDouble> = self.first.iter().map(|s| s.over(&count)).collect();
        let mut covariance = self.second.clone();
        let mut entries = covariance.iter_mut();
        for (a, value) in mean.iter().enumerate() {
            for (entry, other) in entries.by_ref().take(a + 1).zip(&mean) {
                *entry = entry.minus(&value.times(other).times(&count)).over(&less);
            }
        }
        (mean, covariance)
    }

    /// Tests whether the mean is 0 and the covariance I/border.
    pub(super) fn is_standard(
        &self,
        border: f64,
        rank: usize,
        slack: &Slack,
    ) -> Result<(), Violation> {
        let (mean, covariance) = self.estimate();
        let wrong =
            |what: String, claimed, found| Err(Violation::Estimate { what, claimed, found });
        for (a, value) in mean.iter().enumerate() {
            let is_zero = value.rounded().abs() <= slack.of_places;
            if !is_zero {
                let what = format!("coordinate {a} of the center, in the frame of the ellipsoid,");
                return wrong(what, 0.0, value.rounded());
            }
        }
        for a in 0..rank {
            for b in 0..=a {
                let wanted = f64::from(u8::from(a == b));
                let found = covariance[a * (a + 1) / 2 + b].rounded() * border;
                let agrees = (found - wanted).abs() <= slack.of_shapes;
                if !agrees {
                    let what =
                        format!("entry ({a}, {b}) of the scatter, in the frame of the ellipsoid,");
                    return wrong(what, wanted, found);
                }
            }
        }
        Ok(())
    }
}

impl Sums {
    /// Returns true if there is no scatter: points are too few, or span less than they should but for rounding.
    pub(super) fn is_flat(&self, rank: usize) -> bool {
        if self.count <= rank as u64 {
            return true;
        }
        let (_, mut covariance) = self.estimate();
        let diagonal = |a: usize| a * (a + 3) / 2;
        let squares: f64 = (0..rank).map(|a| self.second[diagonal(a)].rounded()).sum();
        let shift = DoubleDouble::of(VARIANCE_RATIO_MIN * squares / self.count as f64);
        for a in 0..rank {
            covariance[diagonal(a)] = covariance[diagonal(a)].minus(&shift);
        }
        !factorize(&mut covariance, rank)
    }
}

impl Metric {
    /// None where the covariance is singular.
    pub(super) fn of(sums: &Sums, rank: usize) -> Option<Self> {
        let (mean, mut covariance) = sums.estimate();
        factorize(&mut covariance, rank).then(|| Metric {
            mean: mean.iter().map(Field::rounded).collect(),
            lower: covariance.iter().map(Field::rounded).collect(),
        })
    }

    /// ln det C.
    pub(super) fn log_det(&self) -> f64 {
        (0..self.mean.len()).map(|a| self.lower[a * (a + 3) / 2].ln()).sum()
    }

    /// (y − ȳ)′C⁻¹(y − ȳ).
    pub(super) fn square(&self, y: &[DoubleDouble]) -> f64 {
        let mut z: Vec<f64> = vec![];
        let mut square = 0.0;
        for (a, (y, mean)) in y.iter().zip(&self.mean).enumerate() {
            let row = &self.lower[a * (a + 1) / 2..];
            let along: f64 = row.iter().zip(&z).map(|(l, z)| l * z).sum();
            let value = y.minus(&DoubleDouble::of(*mean)).rounded() - along;
            square += value * value / row[a];
            z.push(value);
        }
        square
    }
}
