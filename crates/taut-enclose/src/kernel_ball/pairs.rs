//! The optimal multipliers of a working set, by steps of pairs.
//!
//! *Problem.* Maximize D(λ) = ½ Σ λᵢλⱼρᵢⱼ over Σλ = 1 and 0 ≤ λᵢ ≤ C.
//! *Idea.* With aᵢ = Σ λⱼρᵢⱼ, moving t from λⱼ to λᵢ adds t(aᵢ − aⱼ) − t²ρᵢⱼ to D, which is most for t = (aᵢ − aⱼ)/(2ρᵢⱼ). The pair is the
//! i of the largest aᵢ that can grow, and the j that then gains most.
//! *Guarantee.* D never falls; the steps end when no aᵢ that can grow exceeds one that can shrink by more than the tolerance. On the last
//! working set those of a hard ball end as well when its squared radius, max aᵢ − D, exceeds D by no more than that: of points near a sphere,
//! pairs with small multipliers are off for much longer. Earlier, what is exact in these multipliers spares passes.
//! *Cost.* O(|W|) for each step, and the columns of ρ that it has not seen, O(|W|d).
//! *Trap.* a and Σλ are brought up to date with each step, and their errors grow with them: they are corrected from time to time.
//! *Reference.* Fan, Chen and Lin, Working set selection using second order information, JMLR 6, 2005.

use std::collections::VecDeque;

use taut_certify::Kernel;
use taut_points::{Cancelled, Monitor, OrderBy};

use super::features::Features;

/// Numbers that the columns kept may hold: 256 MiB.
const COLUMN_VALUES_MAX: usize = 1 << 25;
/// Steps between two looks at the monitor.
const STEPS_BETWEEN_LOOKS: u64 = 256;
/// What rounding may make of a sum of 1, and far more. Larger differences are those of multipliers that are not free to change.
const DRIFT_MAX: f64 = 1e-6;
/// Steps after which a is summed up again.
const STEPS_BETWEEN_SUMS: u64 = 20_000;

/// A working set with multipliers.
pub(super) struct Pairs {
    pub(super) kernel: Kernel,
    pub(super) dim: usize,
    pub(super) features: Features,
    pub(super) lambda: Vec<f64>,
    /// aᵢ.
    pub(super) mean: Vec<f64>,
    /// C.
    pub(super) most: f64,
    pub(super) steps: u64,
    columns: Vec<Option<Box<[f64]>>>,
    /// The columns kept, oldest first.
    kept: VecDeque<usize>,
}

impl Pairs {
    pub(super) fn new(
        kernel: Kernel,
        dim: usize,
        features: Features,
        lambda: Vec<f64>,
        most: f64,
    ) -> Self {
        let columns = vec![None; features.len()];
        let mut pairs = Pairs {
            kernel,
            dim,
            features,
            lambda,
            mean: vec![],
            most,
            steps: 0,
            columns,
            kept: VecDeque::new(),
        };
        pairs.sum_up();
        pairs
    }

    /// Scales the multipliers below C so that the sum of all is 1 again: after many steps rounding is in its last digits.
    fn normalize(&mut self) {
        let is_free = |lambda: f64| lambda > 0.0 && lambda < self.most;
        let at_most: f64 = self.lambda.iter().filter(|&&lambda| !is_free(lambda)).sum();
        let free: f64 = self.lambda.iter().filter(|&&lambda| is_free(lambda)).sum();
        let factor = (1.0 - at_most) / free;
        if (factor - 1.0).abs() < DRIFT_MAX {
            let most = self.most;
            for lambda in self.lambda.iter_mut().filter(|lambda| **lambda > 0.0 && **lambda < most)
            {
                *lambda = (*lambda * factor).min(most);
            }
        }
    }

    /// Finds a from λ.
    fn sum_up(&mut self) {
        self.normalize();
        let mut mean = vec![0.0; self.features.len()];
        for j in 0..self.features.len() {
            let lambda = self.lambda[j];
            if lambda > 0.0 {
                self.load(j, None);
                let column = self.column(j);
                mean.iter_mut().zip(column).for_each(|(a, rho)| *a += lambda * rho);
            }
        }
        self.mean = mean;
    }

    /// Makes sure that column `j` is there; column `other` stays.
    fn load(&mut self, j: usize, other: Option<usize>) {
        if self.columns[j].is_some() {
            return;
        }
        let size = self.features.len();
        if (self.kept.len() + 1) * size > COLUMN_VALUES_MAX.max(3 * size)
            && let Some(at) = self.kept.iter().position(|&k| Some(k) != other)
            && let Some(oldest) = self.kept.remove(at)
        {
            self.columns[oldest] = None;
        }
        let mut column = vec![0.0; size];
        self.features.distances_from(self.kernel, &self.features, j, self.dim, &mut column);
        self.columns[j] = Some(column.into());
        self.kept.push_back(j);
    }

    fn column(&self, j: usize) -> &[f64] {
        self.columns[j].as_deref().unwrap_or_default()
    }

    /// D.
    pub(super) fn spread(&self) -> f64 {
        self.lambda.iter().zip(&self.mean).map(|(l, a)| l * a).sum::<f64>() / 2.0
    }

    /// Takes steps until no pair is off by more than `tolerance` times D or, where `ends_by_gap`, a hard ball is within it. Returns the a at
    /// which points change from inside to outside.
    pub(super) fn maximize(
        &mut self,
        tolerance: f64,
        ends_by_gap: bool,
        monitor: &Monitor<'_>,
    ) -> Result<f64, Cancelled> {
        let mut since_sum = 0;
        let mut spread = self.spread();
        loop {
            if self.steps.is_multiple_of(STEPS_BETWEEN_LOOKS) {
                monitor.check()?;
            }
            let (mut grows, mut highest, mut lowest) = (0, f64::NEG_INFINITY, f64::INFINITY);
            for (k, (&a, &lambda)) in self.mean.iter().zip(&self.lambda).enumerate() {
                if lambda < self.most && a > highest {
                    (grows, highest) = (k, a);
                }
                if lambda > 0.0 && a < lowest {
                    lowest = a;
                }
            }
            let is_off = highest - lowest > tolerance * self.spread_from(highest, lowest);
            let is_near =
                ends_by_gap && self.most >= 1.0 && highest - 2.0 * spread <= tolerance * spread;
            let is_settled = !is_off || is_near;
            if (is_settled && since_sum > 0) || since_sum >= STEPS_BETWEEN_SUMS {
                self.sum_up();
                (since_sum, spread) = (0, self.spread());
                continue;
            }
            if is_settled {
                // Where all multipliers are at C, nothing can grow: the border is the innermost point.
                return Ok(if highest.is_finite() { (highest + lowest) / 2.0 } else { lowest });
            }
            self.load(grows, None);
            let Some(shrinks) = self.best_partner(grows, highest) else {
                return Ok((highest + lowest) / 2.0);
            };
            self.load(shrinks, Some(grows));
            spread += self.step(grows, shrinks);
            since_sum += 1;
        }
    }

    /// About D: at the optimum all a of the border are D + R².
    fn spread_from(&self, highest: f64, lowest: f64) -> f64 {
        if highest.is_finite() { (highest + lowest) / 4.0 } else { lowest / 2.0 }
    }

    /// The j of the largest gain of D, the first of equal ones.
    fn best_partner(&self, grows: usize, highest: f64) -> Option<usize> {
        let mut best = (0.0, None);
        let column = self.column(grows);
        for (k, ((&a, &lambda), &rho)) in self.mean.iter().zip(&self.lambda).zip(column).enumerate()
        {
            let excess = highest - a;
            // Tested first: with a division for every point a step took half as long again.
            if lambda > 0.0 && excess > 0.0 {
                // In this order, so that the square of a small excess does not vanish.
                let gain = excess * (excess / rho);
                if gain > best.0 {
                    best = (gain, Some(k));
                }
            }
        }
        best.1
    }

    /// Moves from one multiplier to the other; returns by how much D grows.
    fn step(&mut self, grows: usize, shrinks: usize) -> f64 {
        let rho = self.column(grows)[shrinks];
        let excess = self.mean[grows] - self.mean[shrinks];
        let wanted = excess / (2.0 * rho);
        let room = self.most - self.lambda[grows];
        let step = wanted.min(room).min(self.lambda[shrinks]);
        // The bounds are reached exactly, so that points at them are known to be there.
        let leave = self.lambda[shrinks] - step;
        self.lambda[grows] = if step == room { self.most } else { self.lambda[grows] + step };
        self.lambda[shrinks] = leave;
        let (columns, mean) = (&self.columns, &mut self.mean);
        let (from, to) = (columns[shrinks].as_deref(), columns[grows].as_deref());
        if let (Some(from), Some(to)) = (from, to) {
            for ((a, to), from) in mean.iter_mut().zip(to).zip(from) {
                *a += step * (to - from);
            }
        }
        self.steps += 1;
        step * (excess - step * rho)
    }

    /// Replaces the working set by the rows with λ > 0, or all where `keeps_all`, and new ones with λ = 0.
    pub(super) fn replace(self, new: Features, keeps_all: bool) -> Self {
        let places: Vec<usize> =
            (0..self.features.len()).filter(|&i| keeps_all || self.lambda[i] > 0.0).collect();
        let mut features = self.features.subset(&places, self.dim);
        let mut lambda: Vec<f64> = places.iter().map(|&i| self.lambda[i]).collect();
        lambda.resize(places.len() + new.len(), 0.0);
        features.append(new);
        let mut next = Pairs::new(self.kernel, self.dim, features, lambda, self.most);
        next.steps = self.steps;
        next
    }

    /// The number of λ > 0.
    pub(super) fn support_len(&self) -> usize {
        self.lambda.iter().filter(|&&lambda| lambda > 0.0).count()
    }

    /// Places with λ > 0, by row number.
    pub(super) fn support(&self) -> Vec<usize> {
        let mut places: Vec<usize> =
            (0..self.lambda.len()).filter(|&i| self.lambda[i] > 0.0).collect();
        places.order_by_key(|&i| self.features.ids[i]);
        places
    }
}
