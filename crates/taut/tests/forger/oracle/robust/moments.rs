//! Mean and covariance of points in the frame of an answer.

use super::super::claims::Claims;
use super::super::interval::Interval;
use super::super::linear::{Factor, Matrix, Vector, Way, difference};

/// The mean, and the covariance with divisor k − 1 for k points.
pub(super) struct Moments {
    mean: Vector,
    covariance: Matrix,
    /// `None` for a singular covariance.
    factor: Option<Factor>,
}

impl Moments {
    /// `None` for no points.
    pub(super) fn of(points: &[Vector], rank: usize) -> Option<Self> {
        let count = Interval::integer(points.len() as i64);
        let less = Interval::integer((points.len() as i64 - 1).max(1));
        let zeros = vec![Interval::zero(); rank];
        let sum = points
            .iter()
            .fold(zeros.clone(), |sum, y| sum.iter().zip(y).map(|(s, y)| s.plus(y)).collect());
        let mean: Vector = sum.iter().map(|s| s.over(&count)).collect::<Option<_>>()?;
        let mut covariance = vec![zeros; rank];
        for y in points {
            let offset = difference(y, &mean);
            for (a, row) in covariance.iter_mut().enumerate() {
                for (entry, x) in row.iter_mut().zip(&offset) {
                    *entry = entry.plus(&offset[a].times(x));
                }
            }
        }
        for entry in covariance.iter_mut().flatten() {
            *entry = entry.over(&less)?;
        }
        let factor = Factor::of(&covariance, Way::Proved);
        Some(Moments { mean, covariance, factor })
    }

    /// Claims that the mean is 0 and the covariance I over `border`.
    pub(super) fn is_standard(
        &self,
        claims: &mut Claims,
        border: &Interval,
        slack: f64,
    ) -> Option<()> {
        for (a, value) in self.mean.iter().enumerate() {
            let what = format!("coordinate {a} of the center in its frame");
            claims.near(&what, value, &Interval::zero(), 1.01 * slack);
        }
        for (a, row) in self.covariance.iter().enumerate() {
            for (b, entry) in row.iter().enumerate() {
                let wanted = Interval::integer(i64::from(a == b));
                let what = format!("entry ({a}, {b}) of the scatter in its frame");
                claims.near(&what, &entry.times(border), &wanted, 1.01 * slack);
            }
        }
        Some(())
    }

    pub(super) fn log_determinant(&self) -> Option<Interval> {
        self.factor.as_ref()?.determinant().ln()
    }

    /// (y − ȳ)ᵀC⁻¹(y − ȳ).
    pub(super) fn square(&self, y: &[Interval]) -> Option<Interval> {
        self.factor.as_ref()?.quadratic(&difference(y, &self.mean))
    }
}
