//! The result that a method hands to the proof.

use std::collections::BTreeMap;

use taut_certify::{PassBounds, Stop};
use taut_kernels::Center;

use super::counters::Counters;
use super::newton::gap;
use super::point_reader::PassResult;
use super::whitener::Whitener;

/// Multipliers, the ellipsoid they mean, and the pass that shows how far points lie outside.
pub(super) struct Candidate {
    /// Row numbers of the points with a multiplier.
    pub(super) support: Vec<u64>,
    /// u, in that order.
    pub(super) multipliers: Vec<f64>,
    /// M, lower triangular by rows: |M(x − c)|² ≤ d is the trial ellipsoid.
    pub(super) matrix: Vec<f64>,
    /// c.
    pub(super) center: Center,
    /// The pass with M and c.
    pub(super) found: PassResult,
}

/// The way in which a method ended.
pub(super) struct Outcome {
    pub(super) best: Candidate,
    pub(super) stop: Stop,
    pub(super) iterations: u64,
    /// Points the method worked on.
    pub(super) core_set: u64,
    pub(super) history: Vec<PassBounds>,
    pub(super) counters: BTreeMap<String, u64>,
}

/// Collects the candidates of a method and keeps the best.
pub(super) struct Progress {
    dim: usize,
    best: Option<Candidate>,
    history: Vec<PassBounds>,
}

impl Progress {
    pub(super) fn new(dim: usize) -> Self {
        Progress { dim, best: None, history: vec![] }
    }

    /// Takes note of a pass with this whitener, in which |y|² was at most `largest`, and of the points worked on then. Of candidates
    /// within the `wanted` gap the one with fewer points is the better.
    pub(super) fn note(
        &mut self,
        whitener: &Whitener,
        working_set: usize,
        largest: f64,
        wanted: f64,
        candidate: impl FnOnce() -> Candidate,
    ) {
        let lower = trial_log_volume(self.dim, whitener.matrix());
        let upper = (lower + gap(self.dim, largest)).min(f64::MAX);
        self.history.push(PassBounds { lower, upper, working_set: working_set as u64 });
        let both_suffice = gap(self.dim, largest) <= wanted && self.best_gap() <= wanted;
        if both_suffice {
            let candidate = candidate();
            if candidate.support.len() < self.support() {
                self.best = Some(candidate);
            }
        } else if self.best.as_ref().is_none_or(|best| largest < best.found.largest) {
            self.best = Some(candidate());
        }
    }

    /// The number of points with a multiplier in the best candidate; 0 if there is none.
    pub(super) fn support(&self) -> usize {
        self.best.as_ref().map_or(0, |best| best.support.len())
    }

    pub(super) fn best_gap(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |best| gap(self.dim, best.found.largest))
    }

    pub(super) fn into_outcome(self, stop: Stop, counters: Counters, core_set: usize) -> Outcome {
        Outcome {
            best: self.best.expect("a method makes a pass before it stops"),
            stop,
            iterations: counters.steps,
            core_set: core_set as u64,
            history: self.history,
            counters: counters.into_named(),
        }
    }
}

/// The log-volume of |M(x − c)|² ≤ d.
pub(super) fn trial_log_volume(dim: usize, matrix: &[f64]) -> f64 {
    let logs: f64 = (0..dim).map(|a| matrix[a * dim + a].ln()).sum();
    log_unit_ball(dim) + 0.5 * dim as f64 * (dim as f64).ln() - logs
}

/// The natural logarithm of the volume of the unit ball in ℝᵈ: κ₀ = 1, κ₁ = 2, κ_d = κ_{d−2}·2π/d.
pub(crate) fn log_unit_ball(dim: usize) -> f64 {
    let start = if dim.is_multiple_of(2) { 0.0 } else { 2f64.ln() };
    let first = if dim.is_multiple_of(2) { 2 } else { 3 };
    (first..=dim).step_by(2).map(|d| (2.0 * std::f64::consts::PI / d as f64).ln()).sum::<f64>()
        + start
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_unit_ball_has_the_volume_of_the_books() {
        let pi = std::f64::consts::PI;
        let known = [1.0, 2.0, pi, 4.0 / 3.0 * pi, pi * pi / 2.0, 8.0 / 15.0 * pi * pi];
        for (dim, volume) in known.into_iter().enumerate() {
            assert!((super::log_unit_ball(dim) - f64::ln(volume)).abs() < 1e-15 * 4.0, "{dim}");
        }
    }
}
