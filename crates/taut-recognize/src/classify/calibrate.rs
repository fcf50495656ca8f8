//! Probabilities from scores, and thresholds for rejection, both learned on points not trained on.
//!
//! *Idea.* For each class the margin of a point is its score less the best score of another class. A sigmoid of the margin,
//! 1/(1 + exp(−(a·m + b))), is fitted to whether the class is right, by the likelihood of targets that are drawn in from 0 and 1. The
//! values of all classes are divided by their sum.
//! *Reference.* Platt, Probabilistic outputs for support vector machines, 1999; Newton's steps: Lin, Lin and Weng, Mach. Learn. 68, 2007.

use serde::{Deserialize, Serialize};

/// Steps of Newton's method, which ends after some ten.
const NEWTON_STEPS_MAX: usize = 100;
/// Halvings of a step that does not lower the loss.
const HALVINGS_MAX: usize = 60;
/// Added to the diagonal of the Hessian matrix, as in the reference.
const RIDGE: f64 = 1e-12;
/// A gradient below this, per point, ends the steps.
const GRADIENT_MAX: f64 = 1e-12;

/// A sigmoid for each class.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Calibration {
    sigmoids: Vec<Sigmoid>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Sigmoid {
    slope: f64,
    offset: f64,
}

impl Calibration {
    /// Fits to scores of all classes, point after point, and the right classes.
    pub(super) fn learn(scores: &[f64], labels: &[usize], classes: usize) -> Self {
        let margins: Vec<f64> = scores.chunks_exact(classes).flat_map(margins).collect();
        let of_class = |class: usize| {
            let pairs: Vec<(f64, bool)> = margins
                .chunks_exact(classes)
                .zip(labels)
                .map(|(margins, &label)| (margins[class], label == class))
                .collect();
            Sigmoid::fit(&pairs)
        };
        Calibration { sigmoids: (0..classes).map(of_class).collect() }
    }

    /// The probabilities of the classes for one point.
    pub(super) fn probabilities(&self, scores: &[f64]) -> Vec<f64> {
        let parts: Vec<f64> =
            margins(scores).iter().zip(&self.sigmoids).map(|(&m, sigmoid)| sigmoid.at(m)).collect();
        let sum: f64 = parts.iter().sum();
        let equal = 1.0 / parts.len() as f64;
        // All vanish only where no class fits at all.
        parts.iter().map(|part| if sum > 0.0 { part / sum } else { equal }).collect()
    }

    pub(super) fn is_sound(&self, classes: usize) -> bool {
        self.sigmoids.len() == classes
    }
}

/// Each score less the best other one.
fn margins(scores: &[f64]) -> Vec<f64> {
    let other = |class: usize| {
        let others = scores.iter().enumerate().filter(move |other| other.0 != class);
        others.map(|other| *other.1).fold(f64::NEG_INFINITY, f64::max)
    };
    (0..scores.len()).map(|class| scores[class] - other(class)).collect()
}

impl Sigmoid {
    fn at(self, margin: f64) -> f64 {
        1.0 / (1.0 + (-(self.slope * margin + self.offset)).exp())
    }

    fn fit(pairs: &[(f64, bool)]) -> Self {
        let right = pairs.iter().filter(|pair| pair.1).count() as f64;
        let wrong = pairs.len() as f64 - right;
        let target = |is_right: bool| match is_right {
            true => (right + 1.0) / (right + 2.0),
            false => 1.0 / (wrong + 2.0),
        };
        let loss = |sigmoid: Sigmoid| -> f64 {
            pairs
                .iter()
                .map(|&(m, is_right)| {
                    let z = sigmoid.slope * m + sigmoid.offset;
                    // log(1 + e^{−z}) without overflow.
                    (1.0 - target(is_right)) * z + (-z).max(0.0) + (-z.abs()).exp().ln_1p()
                })
                .sum()
        };
        let mut best = Sigmoid { slope: 0.0, offset: ((right + 1.0) / (wrong + 1.0)).ln() };
        let mut least = loss(best);
        for _ in 0..NEWTON_STEPS_MAX {
            let (mut g, mut h) = ([0.0; 2], [RIDGE, 0.0, RIDGE]);
            for &(m, is_right) in pairs {
                let p = best.at(m);
                let (difference, weight) = (p - target(is_right), p * (1.0 - p));
                g = [g[0] + difference * m, g[1] + difference];
                h = [h[0] + weight * m * m, h[1] + weight * m, h[2] + weight];
            }
            let determinant = h[0] * h[2] - h[1] * h[1];
            let size = g[0].abs().max(g[1].abs());
            if !(size > GRADIENT_MAX * pairs.len() as f64 && determinant > 0.0) {
                break;
            }
            let direction = [
                -(h[2] * g[0] - h[1] * g[1]) / determinant,
                -(h[0] * g[1] - h[1] * g[0]) / determinant,
            ];
            let mut step = 1.0;
            let mut is_lower = false;
            for _ in 0..HALVINGS_MAX {
                let next = Sigmoid {
                    slope: best.slope + step * direction[0],
                    offset: best.offset + step * direction[1],
                };
                let value = loss(next);
                if value < least {
                    (best, least, is_lower) = (next, value, true);
                    break;
                }
                step /= 2.0;
            }
            if !is_lower {
                break;
            }
        }
        best
    }
}

/// The score below which a point is rejected, so that at most the share `reject` of the scores of right classes is below.
pub(super) fn threshold(scores: &[f64], reject: f64) -> Option<f64> {
    let mut sorted = scores.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get((reject * sorted.len() as f64) as usize).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fit_has_no_gradient_and_binary_probabilities_agree() {
        let scores: Vec<f64> =
            (0..40).flat_map(|i| [0.0, f64::from((i * 7) % 40) / 10.0 - 2.0]).collect();
        let labels: Vec<usize> =
            (0..40).map(|i| usize::from((i * 7) % 40 + (i * 11) % 13 > 24)).collect();
        let found = Calibration::learn(&scores, &labels, 2);
        let [one, other] = found.sigmoids[..] else { panic!("two sigmoids") };
        assert!(other.slope > 0.0);
        // Of two classes each sigmoid is one less the other.
        assert!((one.slope - other.slope).abs() < 1e-6 && (one.offset + other.offset).abs() < 1e-6);
        let right = labels.iter().sum::<usize>() as f64;
        let gradient: f64 = scores
            .chunks_exact(2)
            .zip(&labels)
            .map(|(s, &label)| {
                let high = (right + 1.0) / (right + 2.0);
                let target = if label == 1 { high } else { 1.0 / (42.0 - right) };
                other.at(s[1] - s[0]) - target
            })
            .sum();
        assert!(gradient.abs() < 1e-8, "{gradient}");
        let probabilities = found.probabilities(&[0.0, 1.0]);
        assert!((probabilities.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        assert!(probabilities[1] > 0.5);
    }

    #[test]
    fn separated_scores_give_finite_sigmoids() {
        let scores = [1.0, -1.0, 1.0, -1.0, -1.0, 1.0, -1.0, 1.0];
        let found = Calibration::learn(&scores, &[0, 0, 1, 1], 2);
        assert!(found.sigmoids.iter().all(|s| s.slope.is_finite() && s.offset.is_finite()));
        let p = found.probabilities(&[1.0, -1.0])[0];
        assert!((p - 0.75).abs() < 1e-6, "{p}");
    }

    #[test]
    fn a_threshold_rejects_at_most_the_share() {
        let scores = [5.0, 1.0, 4.0, 2.0, 3.0];
        assert_eq!(threshold(&scores, 0.2), Some(2.0));
        assert_eq!(threshold(&scores, 0.39), Some(2.0));
        assert_eq!(threshold(&scores, 0.0), Some(1.0));
        assert_eq!(threshold(&[], 0.5), None);
    }
}
