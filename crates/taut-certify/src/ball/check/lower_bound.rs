//! Measures how much larger than necessary the radius can be, from the multipliers and the rows they stand on.
//!
//! *Formulas.* Those of the head of the checker: W, T = Σλᵢtᵢ with tᵢ = |pᵢ − c|² − (R − rᵢ)², M = Σλᵢ(pᵢ − c), so that
//! p̄ − c = M/W, and g = Σλᵢ(R − rᵢ)/W. Then σ = |M/W|² − T/W, and x = σ/(g + √(g² − σ)) is at least R − L.
//! Where the bound is weak, the root is nearly 0 or x nearly g, and g² − σ would lose digits; there x is found as
//! g − √V with W²V = (Σλᵢ(R − rᵢ))² + WT − |M|² in compensated arithmetic. The smaller of the two is the answer.
//! *Bounds.* tᵢ and the sums T and M are compensated, with running bounds. What follows is a handful of operations on
//! numbers that are not negative, in plain `f64`: each costs a relative u, and each is rounded the safe way by a factor
//! 1 ± 8u or more. x grows with σ and falls with g, so σ is taken from above and g from below. When nothing is
//! rounded and the answer is optimal, all of this is exactly 0.
//! *Trap.* Any multipliers prove a lower bound, so those below 2⁻²⁰⁰, whose products could underflow, count as 0.
//!
//! *The center.* That c is the combination p̄ is no part of the proof, but part of what the certificate states; without
//! this, damage to a coordinate of the center could hide, as moving it raises R to second order only. |M/W|, with its
//! bound, must not exceed what writing c down costs, coordinate by coordinate:
//! - without a tail, 4u(|cⱼ| + R): half an ulp of cⱼ is at most u|cⱼ|, the rest is for the sum Σλᵢpᵢ;
//! - with a tail, 4uR + 8u²|cⱼ|: half an ulp of the tail is at most u²|cⱼ|, the rest is for the sum Σλᵢ(pᵢ − c₀) about
//!   some origin c₀ within the points;
//! - in both cases 2⁻¹⁰⁷⁴, the distance of subnormal numbers.

use taut_points::{Monitor, ReadError};

use super::super::{Ball, BallCertificate};
use super::difference::{Difference, is_tame_number, underflow};
use super::enclosure::{excess_square, item};
use super::scale::Scale;
use crate::arithmetic::{Compensated, Known, U, two_product, two_sum};
use crate::hashed_pass::KeptRows;
use crate::{CheckError, Items, Violation};

/// Multipliers below this count as 0.
const LEAST_MULTIPLIER: f64 = f64::from_bits((1023 - 200) << 52);

/// The bound that the multipliers prove.
pub(super) struct Bound {
    /// L, rounded down.
    pub(super) lower: f64,
    /// R/L − 1, rounded up.
    pub(super) gap: f64,
}

/// Proves the bound; every row is already known to be valid and inside the ball.
pub(super) fn prove(
    ball: &Ball,
    certificate: &BallCertificate,
    support: &KeptRows,
    monitor: &Monitor<'_>,
) -> Result<Bound, CheckError> {
    let mut sums = Sums::new(ball, certificate);
    for (&id, &lambda) in certificate.support.iter().zip(&certificate.multipliers) {
        monitor.check().map_err(ReadError::from)?;
        if lambda < LEAST_MULTIPLIER {
            continue;
        }
        sums.add(lambda, support.row(id));
    }
    let moment = sums.moment_square()?;
    Ok(sums.bound(&moment))
}

/// The sums over the support, all of them scaled.
struct Sums<'a> {
    ball: &'a Ball,
    items: Items,
    scale: Scale,
    difference: Difference,
    /// W.
    weight: Compensated,
    /// T, and what the bounds of the tᵢ and underflow may add to it.
    excess: Compensated,
    excess_error: f64,
    /// M: sums, their low parts and the sizes of these, by coordinate.
    moment: [Vec<f64>; 3],
    /// True if anything may have underflowed.
    underflows: bool,
    /// Σλᵢ(R − rᵢ).
    slack: Compensated,
    /// The least R − rᵢ.
    slack_min: f64,
    /// Rows on which all this stands.
    count: usize,
}

impl<'a> Sums<'a> {
    fn new(ball: &'a Ball, certificate: &BallCertificate) -> Self {
        let dim = ball.center.len();
        Sums {
            ball,
            items: certificate.items,
            scale: Scale::of(ball.radius),
            difference: Difference::new(dim),
            weight: Compensated::default(),
            excess: Compensated::default(),
            excess_error: 0.0,
            moment: std::array::from_fn(|_| vec![0.0; dim]),
            underflows: false,
            slack: Compensated::default(),
            slack_min: f64::INFINITY,
            count: 0,
        }
    }

    /// Takes in one row of the support.
    fn add(&mut self, lambda: f64, row: &[f64]) {
        let (position, r) = item(self.items, row);
        self.difference.fill(position, self.ball, self.scale);
        let excess = excess_square(&self.difference, self.ball.radius, r, self.scale);
        let (rho, rho_low) = two_sum(self.ball.radius, -r);
        let is_tame = self.difference.is_tame(self.scale)
            && is_tame_number(rho_low)
            && is_tame_number(excess.high);
        self.underflows |= !is_tame;
        self.count += 1;
        self.weight.add(lambda);
        self.excess.add_product(lambda, excess.high);
        self.excess.add_small(lambda * excess.low, (lambda * excess.low).abs());
        self.excess_error += lambda * excess.error;
        let (rho, rho_low) = (rho * self.scale.up, rho_low * self.scale.up);
        self.slack.add_product(lambda, rho);
        self.slack.add_small(lambda * rho_low, (lambda * rho_low).abs());
        self.slack_min = self.slack_min.min(rho);
        self.add_moment(lambda);
    }

    /// M += λ(p − c).
    fn add_moment(&mut self, lambda: f64) {
        let [sums, lows, sizes] = &mut self.moment;
        let parts = self.difference.high.iter().zip(&self.difference.low);
        let sums = sums.iter_mut().zip(lows).zip(sizes);
        for (((sum, low), size), (&high, &rest)) in sums.zip(parts) {
            let (product, error) = two_product(lambda, high);
            let (total, error_of_sum) = two_sum(*sum, product);
            let small = lambda * rest;
            *sum = total;
            *low += (error + error_of_sum) + small;
            *size += (error.abs() + error_of_sum.abs()) + small.abs();
        }
    }

    /// W, rounded down.
    fn weight_min(&self) -> f64 {
        self.weight.known().high * (1.0 - 8.0 * U)
    }

    /// |M|², if no coordinate of M/W is larger than rounding explains.
    fn moment_square(&self) -> Result<MomentSquare, Violation> {
        let Ball { center, center_tail, radius } = self.ball;
        let [sums, lows, sizes] = &self.moment;
        let mut square = MomentSquare::default();
        for (column, &c) in center.iter().enumerate() {
            let sum = Compensated {
                sum: sums[column],
                low: lows[column],
                size: sizes[column],
                steps: self.count,
            };
            let moment = self.widened(sum.known(), 0.0);
            let offset = moment.size() / self.weight_min() * (1.0 + 8.0 * U);
            let tolerance = match center_tail.is_empty() {
                true => 4.0 * U * (c.abs() * self.scale.up + radius * self.scale.up),
                false => {
                    4.0 * U * (radius * self.scale.up) + 8.0 * U * U * (c.abs() * self.scale.up)
                }
            };
            let subnormal = f64::from_bits(1) * self.scale.up;
            let is_rounding = offset <= tolerance + subnormal;
            if !is_rounding {
                let beside = moment.high / self.weight_min() * self.scale.down;
                let tail = center_tail.get(column).copied().unwrap_or(0.0);
                return Err(Violation::Center {
                    column,
                    claimed: c,
                    found: c + (tail + beside),
                    difference: beside,
                });
            }
            square.sum.add_square(1.0, moment.high, moment.low);
            square.error += (2.0 * moment.size() + moment.error) * moment.error;
            square.max += moment.size() * moment.size();
        }
        let rounding = 1.0 + (center.len() + 8) as f64 * U;
        Ok(MomentSquare { error: square.error * rounding, max: square.max * rounding, ..square })
    }

    /// A sum with what its terms are off by, and with what may have underflowed.
    fn widened(&self, sum: Known, error: f64) -> Known {
        let lost = if self.underflows { underflow(self.count) } else { 0.0 };
        Known { error: (sum.error + error) * (1.0 + (self.count + 8) as f64 * U) + lost, ..sum }
    }

    /// From the sums to x, and from x to the bounds.
    fn bound(&self, moment: &MomentSquare) -> Bound {
        let radius = self.ball.radius * self.scale.up;
        let x = self.surplus(moment);
        if x == 0.0 {
            return Bound { lower: self.ball.radius, gap: 0.0 };
        }
        let least = (radius - x).next_down();
        let scaled = least * self.scale.down;
        // Scaling back into the subnormal numbers may round up.
        let is_exact = scaled * self.scale.up == least;
        let lower = if is_exact { scaled } else { scaled.next_down() }.max(0.0);
        let gap = if least > 0.0 { x / least * (1.0 + 8.0 * U) } else { f64::INFINITY };
        Bound { lower, gap }
    }

    /// x, rounded up.
    fn surplus(&self, moment: &MomentSquare) -> f64 {
        let (weight, excess) =
            (self.weight_min(), self.widened(self.excess.known(), self.excess_error));
        let slack = self.widened(self.slack.known(), 0.0);
        let known =
            [weight, excess.high, excess.error, moment.max, moment.error, slack.high, slack.error];
        if known.iter().any(|v| !v.is_finite()) {
            // Sums beyond the largest number prove no more than that a radius is not negative.
            return self.ball.radius * self.scale.up;
        }
        // −T, rounded up; where it is not positive, rounding is all there is.
        let shortfall = excess.error - excess.high * (1.0 - 4.0 * U * excess.high.signum());
        let shortfall = if shortfall <= 0.0 { 0.0 } else { shortfall };
        let sigma = (shortfall / weight + moment.max / (weight * weight)) * (1.0 + 16.0 * U);
        if sigma == 0.0 {
            return 0.0;
        }
        let slack_min = (slack.high - slack.error) / self.weight.known().high * (1.0 - 16.0 * U);
        let slack_max = slack.size() / weight * (1.0 + 8.0 * U);
        let radicand = slack_min * slack_min * (1.0 - 8.0 * U) - sigma;
        let directly = match radicand > 0.0 && slack_min > 0.0 {
            true => sigma / (slack_min + radicand.sqrt()) * (1.0 + 16.0 * U),
            false => slack_max,
        };
        let by_root = match self.root(moment, excess, slack) {
            root if root.is_finite() => (slack_max - root).max(0.0) * (1.0 + 8.0 * U),
            _ => slack_max,
        };
        directly.min(by_root).min(self.slack_min * (1.0 + 8.0 * U))
    }

    /// √V, rounded down; 0 where V is not known to be positive.
    fn root(&self, moment: &MomentSquare, excess: Known, slack: Known) -> f64 {
        let weight = self.weight.known();
        let mut sum = moment.sum.negated();
        sum.add_square(1.0, slack.high, slack.low);
        sum.add_product(excess.high, weight.high);
        for (a, b) in
            [(excess.high, weight.low), (excess.low, weight.high), (excess.low, weight.low)]
        {
            sum.add_small(a * b, (a * b).abs());
        }
        let errors = moment.error
            + (2.0 * slack.size() + slack.error) * slack.error
            + excess.size() * weight.error
            + weight.size() * excess.error
            + underflow(self.count);
        let square = sum.known();
        let least = square.high * (1.0 - 4.0 * U) - (square.error + errors) * (1.0 + 32.0 * U);
        if least > 0.0 { least.sqrt() / weight.size() * (1.0 - 8.0 * U) } else { 0.0 }
    }
}

/// |M|² in three forms.
#[derive(Default)]
struct MomentSquare {
    sum: Compensated,
    /// The error of `sum`, beside its own bound.
    error: f64,
    /// |M|², rounded up.
    max: f64,
}
