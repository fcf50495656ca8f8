//! Mahalanobis distances from the means of classes (thesis, 7.6).
//!
//! *Idea.* A point is an outlier of a class where (x − μ)ᵀΣ⁻¹(x − μ) is at least γ². Σ is the covariance within classes, pooled over all
//! and shrunk; or, as in the thesis, ½(Σ of the class + Σ pooled), which follows classes of different shape.
//! *Trap.* A class of fewer points than dimensions has a singular covariance, and so may the pooled one: the matrix of the thesis gets
//! 1e-6 of its mean diagonal added.

use serde::{Deserialize, Serialize};

use super::covariance::{Residuals, lower, of_class};
use super::data::Rows;
use super::dense::solve_lower;
use super::method::Covariance;
use super::{Classifier, Score};
use crate::Error;

/// The part of the mean diagonal that is added to the covariance of the thesis.
const THESIS_RIDGE: f64 = 1e-6;

/// Means and covariances.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Mahalanobis {
    dim: usize,
    /// Class after class.
    means: Vec<f64>,
    /// The lower factor of one covariance for all classes, or of one for each.
    lower: Vec<Vec<f64>>,
}

impl Mahalanobis {
    /// Learns the means from `rows`, and the covariance that is pooled from `background`.
    pub(super) fn learn(
        background: &Rows,
        rows: &Rows,
        covariance: Covariance,
    ) -> Result<Self, Error> {
        let dim = rows.dim;
        let residuals = Residuals::of(background);
        residuals.check(background, "a covariance needs a class of two points or more")?;
        let lower = match covariance {
            Covariance::Pooled => vec![lower(&residuals.shrunk(), dim)?],
            Covariance::Thesis => {
                let pooled = residuals.pooled();
                let of_class = |class| {
                    let own = of_class(rows, class);
                    let mut both: Vec<f64> =
                        own.iter().zip(&pooled).map(|(own, pooled)| (own + pooled) / 2.0).collect();
                    let trace: f64 = (0..dim).map(|i| both[i * dim + i]).sum();
                    (0..dim).for_each(|i| both[i * dim + i] += THESIS_RIDGE * trace / dim as f64);
                    lower(&both, dim)
                };
                (0..rows.classes).map(of_class).collect::<Result<_, _>>()?
            }
        };
        Ok(Mahalanobis { dim, means: rows.means(), lower })
    }

    pub(super) fn is_sound(&self, dim: usize, classes: usize) -> bool {
        let is_factor = |lower: &Vec<f64>| {
            lower.len() == dim * dim && (0..dim).all(|i| lower[i * dim + i] > 0.0)
        };
        self.dim == dim
            && self.means.len() == classes * dim
            && (self.lower.len() == 1 || self.lower.len() == classes)
            && self.lower.iter().all(is_factor)
    }
}

impl Classifier for Mahalanobis {
    fn dim(&self) -> usize {
        self.dim
    }

    fn classes(&self) -> usize {
        self.means.len() / self.dim
    }

    /// The value is less the squared distance.
    fn scores(&self, x: &[f64], out: &mut [Score]) {
        let mut z = vec![0.0; self.dim];
        for (class, (mean, out)) in self.means.chunks_exact(self.dim).zip(out).enumerate() {
            z.iter_mut().zip(x).zip(mean).for_each(|((z, x), mean)| *z = x - mean);
            let lower = self.lower.get(class).unwrap_or(&self.lower[0]);
            solve_lower(lower, self.dim, &mut z);
            *out = Score { value: -z.iter().map(|z| z * z).sum::<f64>(), tie: 0.0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Rows {
        let values = vec![0.0, 0.0, 4.0, 1.0, 2.0, 5.0, 10.0, 10.0, 11.0, 12.0, 14.0, 11.0];
        Rows { values, dim: 2, labels: vec![0, 0, 0, 1, 1, 1], classes: 2 }
    }

    #[test]
    fn the_verifier_of_the_thesis_has_its_covariance() {
        let rows = rows();
        let found = Mahalanobis::learn(&rows, &rows, Covariance::Thesis).unwrap();
        // Class 0: mean (2, 2), Σ = ((8, 2), (2, 14))/2; class 1: mean (35/3, 11), Σ = ((26/3, 1), (1, 2))/2.
        let pooled = [(4.0 + 13.0 / 3.0) / 2.0, (1.0 + 0.5) / 2.0, (7.0 + 1.0) / 2.0];
        let [a, b, c] = [(4.0 + pooled[0]) / 2.0, (1.0 + pooled[1]) / 2.0, (7.0 + pooled[2]) / 2.0];
        let ridge = THESIS_RIDGE * (a + c) / 2.0;
        let (a, c) = (a + ridge, c + ridge);
        let mut out = [Score::default(); 2];
        found.scores(&[3.0, 1.0], &mut out);
        let expected = (c + a + 2.0 * b) / (a * c - b * b);
        assert!((out[0].value + expected).abs() < 1e-13, "{} {expected}", out[0].value);
    }

    #[test]
    fn one_covariance_serves_all_classes() {
        let found = Mahalanobis::learn(&rows(), &rows(), Covariance::Pooled).unwrap();
        assert!(found.lower.len() == 1 && found.is_sound(2, 2) && !found.is_sound(2, 3));
        assert_eq!(found.best(&[2.0, 2.0]), (0, Score { value: 0.0, tie: 0.0 }));
        assert_eq!(found.best(&[9.0, 9.0]).0, 1);
        let single = Rows { values: vec![0.0, 1.0], dim: 1, labels: vec![0, 1], classes: 2 };
        assert!(Mahalanobis::learn(&single, &single, Covariance::Pooled).is_err());
    }
}
