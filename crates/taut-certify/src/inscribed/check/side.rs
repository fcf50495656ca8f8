//! One half-space in the frame of the answer, with bounds on what rounding does to it.
//!
//! *Trap.* A half-space is the same whatever its row is multiplied by, and rows of any length occur: squares of the numbers
//! of a row may leave the range of `f64`. So each row is divided by a power of two first, which costs nothing but what
//! underflows beside its largest entry, and ã by another before it is squared.

use super::super::InscribedEllipsoid;
use crate::arithmetic::{DoubleDouble, Field, Ring};

/// ã = Gᵀa and s = b − aᵀc for the row (a, b) over 2ᵏ, where the largest entry of a is in [2ᵏ, 2ᵏ⁺¹), or smaller where b would
/// overflow.
pub(super) struct Side {
    /// ã.
    pub(super) normal: Vec<DoubleDouble>,
    /// |ã|.
    pub(super) length: DoubleDouble,
    /// s.
    pub(super) slack: DoubleDouble,
    /// The errors of ã in length and of s.
    pub(super) normal_error: f64,
    pub(super) slack_error: f64,
}

/// The k of a number in [2ᵏ, 2ᵏ⁺¹), or a little less for subnormal ones; 0 for 0.
pub(super) fn exponent(value: f64) -> i32 {
    if value == 0.0 { 0 } else { ((value.to_bits() >> 52) & 0x7ff) as i32 - 1023 }
}

/// The number over 2ᵏ, and what underflow takes of it at most.
fn divided(value: f64, k: i32) -> (f64, f64) {
    let half = k / 2;
    let power = |k: i32| f64::from_bits(((1023 + k) as u64) << 52);
    let less = value * power(-half) * power(-(k - half));
    let is_exact = less * power(half) * power(k - half) == value;
    (less, if is_exact { 0.0 } else { f64::from_bits(2) })
}

impl Side {
    pub(super) fn of(answer: &InscribedEllipsoid, row: &[f64]) -> Self {
        let dim = answer.center.len();
        let zero = DoubleDouble::of(0.0);
        let rounding = 4.0 * (dim + 8) as f64 * DoubleDouble::ROUNDOFF;
        let largest = row[..dim].iter().fold(0.0f64, |m, a| m.max(a.abs()));
        // An offset far beyond the largest entry must stay in range, whatever entries lose.
        let k = exponent(largest).max(exponent(row[dim]) - OFFSET_EXPONENT_MAX);
        let mut normal = vec![zero; dim];
        let (mut sizes, mut lost) = (0.0, 0.0);
        let (offset, mut slack_lost) = divided(row[dim], k);
        let mut slack = DoubleDouble::of(offset);
        let mut size = offset.abs();
        for (j, axes) in answer.axes.iter().enumerate() {
            let (entry, entry_lost) = divided(row[j], k);
            let a = DoubleDouble::of(entry);
            for (sum, &g) in normal.iter_mut().zip(axes) {
                *sum = sum.plus(&a.times(&DoubleDouble::of(g)));
                sizes += (entry * g).abs();
                lost += entry_lost * g.abs();
            }
            let c = answer.center[j];
            slack = slack.minus(&a.times(&DoubleDouble::of(c)));
            size += (entry * c).abs();
            slack_lost += entry_lost * c.abs();
        }
        let length = length(&normal);
        // Products underflow as well, 2⁻¹⁰⁷⁰ at most for each.
        let normal_error = rounding * (sizes + length.rounded()) + 2.0 * lost + f64::MIN_POSITIVE;
        let slack_error = rounding * size + 2.0 * slack_lost + f64::MIN_POSITIVE;
        Side { normal, length, slack, normal_error, slack_error }
    }

    /// The same half-space divided by the power 2ᵏ that brings |ã| to [1, 2), and k; `None` where |ã| is not known.
    ///
    /// Errors are at least the least normal number, so a length that is known is far above what underflows.
    pub(super) fn normalized(&self) -> Option<(i32, Side)> {
        let length = self.length.rounded();
        let is_known = length > LEAST_KNOWN * self.normal_error && length.is_finite();
        if !is_known {
            return None;
        }
        let k = exponent(length);
        let (half, rest) = (2f64.powi(-(k / 2)), 2f64.powi(-(k - k / 2)));
        let scaled = |v: &DoubleDouble| v.scaled(half).scaled(rest);
        let up = |error: f64| error * half * rest + f64::MIN_POSITIVE;
        let side = Side {
            normal: self.normal.iter().map(scaled).collect(),
            length: scaled(&self.length),
            slack: scaled(&self.slack),
            normal_error: up(self.normal_error),
            slack_error: up(self.slack_error),
        };
        Some((k, side))
    }
}

/// Offsets of half-spaces are brought below 2 to this.
const OFFSET_EXPONENT_MAX: i32 = 1000;

/// The ratio of a length to its error above which the length counts as known.
const LEAST_KNOWN: f64 = 1e6;

/// |ã|, whatever its size.
fn length(normal: &[DoubleDouble]) -> DoubleDouble {
    let largest = normal.iter().fold(0.0f64, |m, v| m.max(v.rounded().abs()));
    let k = exponent(largest).clamp(-1000, 1000);
    let power = f64::from_bits(((1023 + k) as u64) << 52);
    let square = normal.iter().fold(DoubleDouble::of(0.0), |sum, v| {
        let less = v.scaled(1.0 / power);
        sum.plus(&less.times(&less))
    });
    square.root().scaled(power)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A row times any power of two is the same side, to the bit.
    #[test]
    fn sides_do_not_depend_on_the_length_of_a_row() {
        let answer = InscribedEllipsoid {
            center: vec![0.25, -3.0],
            axes: vec![vec![0.5, 0.1], vec![-0.2, 0.75]],
            log_volume: 0.0,
        };
        let plain = Side::of(&answer, &[1.25, 0.7, 4.0]);
        for k in [-1000, -600, -1, 1, 512, 1020] {
            let row = [1.25, 0.7, 4.0].map(|v: f64| v * 2f64.powi(k));
            let side = Side::of(&answer, &row);
            assert_eq!(side.length.rounded(), plain.length.rounded(), "{k}");
            assert_eq!(side.slack.rounded(), plain.slack.rounded(), "{k}");
            assert!(side.normal_error <= 2.0 * plain.normal_error, "{k}");
        }
        assert!(plain.length.rounded() > 0.5 && plain.normal_error < 1e-26);
        // A tiny ellipsoid has a length as well.
        let tiny =
            InscribedEllipsoid { axes: vec![vec![1e-200, 0.0], vec![0.0, 1e-200]], ..answer };
        let length = Side::of(&tiny, &[1.0, 0.0, 1.0]).length.rounded();
        assert!((length - 1e-200).abs() < 1e-214, "{length:e}");
    }
}
