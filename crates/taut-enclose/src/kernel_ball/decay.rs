//! 2(1 − e^{−γs}) for many squared distances s: the squared distance in the feature space of a Gaussian kernel.
//!
//! *Idea.* With n = round(−z·log₂e) and t = −z − n·ln 2 it is (1 − 2ⁿ) − 2ⁿ(eᵗ − 1), the last by a polynomial. No branch and no call
//! is in the loop, so that the compiler takes several numbers at a time; small z keep all digits, as n = 0 there.
//! *Error.* A few units of the last place; the checker has its own arithmetic.

use pulp::{Simd, WithSimd};
use taut_points::vectors;

/// e^{−708} is the last power that is a normal number.
const EXPONENT_MAX: f64 = 708.0;
/// Adding it rounds to a whole number, which then stands in the low bits.
const ROUNDER: f64 = 6_755_399_441_055_744.0;
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
/// 1/k! for k = 2 to 13.
const COEFFICIENTS: [f64; 12] = [
    0.5,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

/// Puts 2(1 − e^{−γs}) in the place of each s ≥ 0. The widest vectors of the processor give the same bits as any others.
pub(super) fn decay_all(gamma: f64, squares: &mut [f64]) {
    vectors().dispatch(All { gamma, squares });
}

struct All<'a> {
    gamma: f64,
    squares: &'a mut [f64],
}

impl WithSimd for All<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.squares.iter_mut().for_each(|s| *s = 2.0 * decay(self.gamma * *s));
    }
}

/// 1 − e^{−z} for z ≥ 0.
#[inline(always)]
pub(super) fn decay(z: f64) -> f64 {
    let z = if z < EXPONENT_MAX { z } else { EXPONENT_MAX };
    let shifted = -z * std::f64::consts::LOG2_E + ROUNDER;
    let n = shifted - ROUNDER;
    let t = (-z - n * LN_2[0]) - n * LN_2[1];
    // In pairs and pairs of pairs (Estrin 1960): Horner's form would wait for twelve products, one after the other.
    let c = &COEFFICIENTS;
    let (t2, t4) = (t * t, (t * t) * (t * t));
    let four = |k: usize| (c[k] + c[k + 1] * t) + (c[k + 2] + c[k + 3] * t) * t2;
    let sum = (four(0) + four(4) * t4) + four(8) * (t4 * t4);
    let less_one = t + t2 * sum;
    let power = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    (1.0 - power) - power * less_one
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_digits_at_every_size() {
        for k in -1000..700 {
            let z = 1.5f64.powi(k) * 1.25;
            let expected = -(-z).exp_m1();
            assert!((decay(z) - expected).abs() <= 1e-15 * expected, "{z:e}");
        }
        assert_eq!(decay(0.0), 0.0);
        assert_eq!(decay(f64::INFINITY), 1.0);
    }
}
