//! One row minus the center, scaled, to twice the precision of `f64`, and the square of its length.

use taut_points::Scalar;

use super::super::Ball;
use super::scale::Scale;
use crate::arithmetic::{Compensated, square, two_sum};

const LANES: usize = 4;

/// Numbers of this size and above have squares and products with exact errors; see the head of the arithmetic.
const EXACT_SIZE_MIN: f64 = f64::from_bits((1023 - 480) << 52);

/// Returns true if products with this number have exact errors.
pub(super) fn is_tame_number(value: f64) -> bool {
    value == 0.0 || value.abs() >= EXACT_SIZE_MIN
}

/// More than what underflow can add to a sum of `count` squares or products of scaled numbers.
pub(super) fn underflow(count: usize) -> f64 {
    (count + 8) as f64 * f64::from_bits((1023 - 900) << 52)
}

/// (p − c)·2ᵏ = high + low, coordinate by coordinate; kept and filled again for one row after the other.
pub(super) struct Difference {
    pub(super) high: Vec<f64>,
    /// Off by at most U times its own size: with a tail of the center it is the rounded sum of two errors.
    pub(super) low: Vec<f64>,
}

impl Difference {
    pub(super) fn new(dim: usize) -> Self {
        Difference { high: vec![0.0; dim], low: vec![0.0; dim] }
    }

    /// Takes the difference of `row` and the center of `ball`.
    pub(super) fn fill<T: Scalar>(&mut self, row: &[T], ball: &Ball, scale: Scale) {
        let parts = self.high.iter_mut().zip(&mut self.low);
        let coordinates = parts.zip(row.iter().zip(&ball.center));
        if ball.center_tail.is_empty() {
            for ((high, low), (&x, &c)) in coordinates {
                let (sum, error) = two_sum(x.into(), -c);
                (*high, *low) = (sum * scale.up, error * scale.up);
            }
        } else {
            for (((high, low), (&x, &c)), &t) in coordinates.zip(&ball.center_tail) {
                let (sum, error) = two_sum(x.into(), -c);
                let (sum, error_of_tail) = two_sum(sum, -t);
                (*high, *low) = (sum * scale.up, (error + error_of_tail) * scale.up);
            }
        }
    }

    /// Returns true if nothing can have underflowed: nothing was scaled, and no number is below [`EXACT_SIZE_MIN`] but 0.
    pub(super) fn is_tame(&self, scale: Scale) -> bool {
        let all_tame = |values: &[f64]| values.iter().all(|&v| is_tame_number(v));
        !scale.is_needed() && all_tame(&self.high) && all_tame(&self.low)
    }

    /// |p − c|²·4ᵏ, up to [`underflow`].
    pub(super) fn square(&self) -> Compensated {
        let mut lanes = Lanes::default();
        let (high, high_rest) = self.high.as_chunks::<LANES>();
        let (low, low_rest) = self.low.as_chunks::<LANES>();
        for (high, low) in high.iter().zip(low) {
            lanes.add(high, low);
        }
        let (mut high, mut low) = ([0.0; LANES], [0.0; LANES]);
        high[..high_rest.len()].copy_from_slice(high_rest);
        low[..low_rest.len()].copy_from_slice(low_rest);
        lanes.add(&high, &low);
        lanes.sum(self.high.len() / LANES + 1)
    }
}

/// [`Compensated::add_square`] for several sums at once, in a form that compilers turn into vector instructions.
#[derive(Default)]
struct Lanes {
    sum: [f64; LANES],
    low: [f64; LANES],
    size: [f64; LANES],
}

impl Lanes {
    #[inline(always)]
    fn add(&mut self, high: &[f64; LANES], low: &[f64; LANES]) {
        for k in 0..LANES {
            let (product, error) = square(high[k]);
            let (sum, error_of_sum) = two_sum(self.sum[k], product);
            let cross = low[k] * (2.0 * high[k] + low[k]);
            self.sum[k] = sum;
            self.low[k] += (error + error_of_sum) + cross;
            self.size[k] += (error.abs() + error_of_sum.abs())
                + low[k].abs() * (2.0 * high[k].abs() + low[k].abs());
        }
    }

    fn sum(&self, steps: usize) -> Compensated {
        let mut all = Compensated::default();
        for k in 0..LANES {
            all.merge(Compensated {
                sum: self.sum[k],
                low: self.low[k],
                size: self.size[k],
                steps,
            });
        }
        all
    }
}
