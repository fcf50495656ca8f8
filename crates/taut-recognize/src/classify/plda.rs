//! Two-covariance probabilistic linear discriminant analysis.
//!
//! *Model.* Points of a class are normal around its mean with the covariance W, and means of classes are normal around one center with
//! the covariance B. A score is the logarithm of the likelihood of a point under the class, given its k training points, over that under
//! a class not known.
//! *Idea.* A linear map makes W the identity and B diagonal. With b on its diagonal, the mean of a class given its k points is
//! m = k·b/(k·b + 1) times their mean, and a new point of it has the variance v = 1 + b/(k·b + 1); of an unknown class, 0 and 1 + b.
//! *Trap.* B is the covariance of the means less W/k, which may have negative eigenvalues: these are taken as 0, and say nothing then.
//! *Reference.* Brümmer and de Villiers, The speaker partitioning problem, Odyssey 2010.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::covariance::{Residuals, lower};
use super::data::Rows;
use super::dense::{eigen, solve_lower};
use super::{Classifier, Score};
use crate::Error;

/// The model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Plda {
    /// The center of all points.
    center: Vec<f64>,
    /// The map, row after row.
    map: Vec<f64>,
    /// b.
    between: Vec<f64>,
    /// m, class after class.
    means: Vec<f64>,
    /// Training points of each class.
    counts: Vec<f64>,
}

impl Plda {
    /// Learns both covariances from `background`, and the means from `rows`.
    pub(super) fn learn(background: &Rows, rows: &Rows) -> Result<Self, Error> {
        let (dim, classes) = (background.dim, background.classes);
        if classes < 2 {
            return Err(Error::ClassCount {
                classes,
                needs: "a covariance between classes needs two",
            });
        }
        let residuals = Residuals::of(background);
        residuals.check(background, "a covariance needs a class of two points or more")?;
        let within = residuals.shrunk();
        let factor = lower(&within, dim)?;
        let counts = |rows: &Rows| -> Vec<f64> {
            rows.counts().into_iter().map(|count| count as f64).collect()
        };
        let means = background.means();
        let center = mean_of_means(&means, dim);
        let between = between(&means, &center, &within, &counts(background), dim);
        let (values, vectors) = eigen(&whitened(&between, &factor, dim), dim);
        let between: Vec<f64> = values.iter().map(|&b| b.max(0.0)).collect();
        // Rows of VᵀL⁻¹ are the solutions of Lᵀx = v: columns of L⁻¹ by solving for each unit vector.
        let mut inverse = vec![0.0; dim * dim];
        for j in 0..dim {
            let mut unit = vec![0.0; dim];
            unit[j] = 1.0;
            solve_lower(&factor, dim, &mut unit);
            (0..dim).for_each(|i| inverse[i * dim + j] = unit[i]);
        }
        let entry = |i: usize, j: usize| -> f64 {
            (0..dim).map(|k| vectors[i * dim + k] * inverse[k * dim + j]).sum()
        };
        let map: Vec<f64> = (0..dim * dim).map(|at| entry(at / dim, at % dim)).collect();
        let mut model = Plda { center, map, between, means: vec![], counts: counts(rows) };
        for (mean, &k) in rows.means().chunks_exact(dim).zip(&model.counts.clone()) {
            let mapped = model.mapped(mean);
            let shrunk = mapped.iter().zip(&model.between).map(|(z, b)| z * k * b / (k * b + 1.0));
            let shrunk: Vec<f64> = shrunk.collect();
            model.means.extend(shrunk);
        }
        let parts = [&model.map, &model.between, &model.means];
        match parts.iter().all(|part| part.iter().all(|value| value.is_finite())) {
            true => Ok(model),
            false => Err(Error::Overflow),
        }
    }

    fn mapped(&self, x: &[f64]) -> Vec<f64> {
        let centered: Vec<f64> = x.iter().zip(&self.center).map(|(x, center)| x - center).collect();
        let rows = self.map.chunks_exact(self.center.len());
        rows.map(|row| row.iter().zip(&centered).map(|(a, b)| a * b).sum()).collect()
    }

    /// The posterior probabilities of the classes, which are taken to be equally frequent and the only ones.
    pub(super) fn probabilities(scores: &[f64]) -> Vec<f64> {
        let largest = scores.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let parts: Vec<f64> = scores.iter().map(|score| (score - largest).exp()).collect();
        let sum: f64 = parts.iter().sum();
        parts.into_iter().map(|part| part / sum).collect()
    }

    pub(super) fn is_sound(&self, dim: usize, classes: usize) -> bool {
        self.center.len() == dim
            && self.map.len() == dim * dim
            && self.between.len() == dim
            && self.between.iter().all(|&b| b >= 0.0)
            && self.means.len() == classes * dim
            && self.counts.len() == classes
            && self.counts.iter().all(|&count| count >= 1.0)
    }
}

/// The mean of the means: a class counts as one, however many points it has.
fn mean_of_means(means: &[f64], dim: usize) -> Vec<f64> {
    let classes = (means.len() / dim) as f64;
    (0..dim).map(|j| means.iter().skip(j).step_by(dim).map(|x| x / classes).sum()).collect()
}

/// The covariance of the means, less what they owe to the points within classes.
fn between(means: &[f64], center: &[f64], within: &[f64], counts: &[f64], dim: usize) -> Vec<f64> {
    let classes = counts.len();
    let share = counts.iter().map(|count| 1.0 / count).sum::<f64>() / classes as f64;
    let mut between: Vec<f64> = within.iter().map(|w| -w * share).collect();
    for mean in means.chunks_exact(dim) {
        for i in 0..dim {
            for j in 0..dim {
                let product = (mean[i] - center[i]) * (mean[j] - center[j]);
                between[i * dim + j] += product / (classes - 1) as f64;
            }
        }
    }
    between
}

/// L⁻¹BL⁻ᵀ.
fn whitened(between: &[f64], factor: &[f64], dim: usize) -> Vec<f64> {
    let solve_columns = |a: &[f64]| {
        let mut out = vec![0.0; dim * dim];
        for j in 0..dim {
            let mut column: Vec<f64> = (0..dim).map(|i| a[i * dim + j]).collect();
            solve_lower(factor, dim, &mut column);
            // Transposed, so that doing it twice treats both sides.
            out[j * dim..(j + 1) * dim].copy_from_slice(&column);
        }
        out
    };
    let both = solve_columns(&solve_columns(between));
    let mean = |at: usize| (both[at] + both[at % dim * dim + at / dim]) / 2.0;
    (0..dim * dim).map(mean).collect()
}

/// The logarithm of the normal density with mean 0.
fn log_density(square: f64, variance: f64) -> f64 {
    -0.5 * (square / variance + (TAU * variance).ln())
}

/// The variances v of a new point of a class that has `count` points.
struct Variances {
    count: f64,
    /// 1/v.
    inverse: Vec<f64>,
    /// Σ log 2πv.
    logarithms: f64,
}

impl Variances {
    fn of(between: &[f64], count: f64) -> Self {
        let variance = |b: &f64| 1.0 + b / (count * b + 1.0);
        let inverse = between.iter().map(|b| 1.0 / variance(b)).collect();
        let logarithms = between.iter().map(|b| (TAU * variance(b)).ln()).sum();
        Variances { count, inverse, logarithms }
    }
}

impl Classifier for Plda {
    fn dim(&self) -> usize {
        self.center.len()
    }

    fn classes(&self) -> usize {
        self.counts.len()
    }

    /// The value is the log-likelihood ratio.
    fn scores(&self, x: &[f64], out: &mut [Score]) {
        let z = self.mapped(x);
        let unknown: f64 =
            z.iter().zip(&self.between).map(|(z, b)| log_density(z * z, 1.0 + b)).sum();
        let classes = self.means.chunks_exact(z.len()).zip(&self.counts);
        // Classes of equally many points share their variances, and the logarithms of these.
        let mut shared = Variances::of(&self.between, self.counts.first().copied().unwrap_or(1.0));
        for ((mean, &k), out) in classes.zip(out) {
            if k != shared.count {
                shared = Variances::of(&self.between, k);
            }
            let squares = z.iter().zip(mean).map(|(z, m)| (z - m) * (z - m));
            let known: f64 = squares.zip(&shared.inverse).map(|(square, w)| square * w).sum();
            *out = Score { value: -0.5 * (known + shared.logarithms) - unknown, tie: 0.0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn in_one_dimension_the_ratio_is_that_of_the_formula() {
        let values = vec![-1.0, 1.0, 9.0, 11.0, -9.0, -13.0];
        let rows = Rows { values, dim: 1, labels: vec![0, 0, 1, 1, 2, 2], classes: 3 };
        let model = Plda::learn(&rows, &rows).unwrap();
        // Means 0, 10, −11; W = (2 + 2 + 8)/3 = 4; B = var(0, 10, −11) − W/2.
        let mean: f64 = -1.0 / 3.0;
        let variance = (mean * mean + (10.0 - mean).powi(2) + (-11.0 - mean).powi(2)) / 2.0;
        let b = (variance - 2.0) / 4.0;
        let (z, m) = ((8.0 - mean) / 2.0, (10.0 - mean) / 2.0 * 2.0 * b / (2.0 * b + 1.0));
        let v = 1.0 + b / (2.0 * b + 1.0);
        let expected = log_density((z - m) * (z - m), v) - log_density(z * z, 1.0 + b);
        let mut out = [Score::default(); 3];
        model.scores(&[8.0], &mut out);
        assert!((out[1].value - expected).abs() < 1e-12, "{} {expected}", out[1].value);
        assert_eq!(model.best(&[8.0]).0, 1);
    }

    #[test]
    fn the_map_makes_both_covariances_diagonal() {
        let values: Vec<f64> =
            (0..36).map(|i| f64::from(i * i % 17) + f64::from(i / 9) * f64::from(i % 3)).collect();
        let rows = Rows { values, dim: 3, labels: (0..12).map(|i| i / 3).collect(), classes: 4 };
        let model = Plda::learn(&rows, &rows).unwrap();
        let within = Residuals::of(&rows).shrunk();
        for i in 0..3 {
            for j in 0..3 {
                let product: f64 = (0..9)
                    .map(|at| model.map[i * 3 + at / 3] * within[at] * model.map[j * 3 + at % 3])
                    .sum();
                assert!((product - if i == j { 1.0 } else { 0.0 }).abs() < 1e-11, "{product}");
            }
        }
        assert!(model.is_sound(3, 4) && !model.is_sound(3, 5));
        let probabilities = Plda::probabilities(&[-1e5, 3.0, 3.0]);
        assert_eq!(probabilities, [0.0, 0.5, 0.5]);
    }
}
