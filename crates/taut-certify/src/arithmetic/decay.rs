//! 1 − e^{−z} for z ≥ 0, with a proved bound on the error.
//!
//! *Idea.* With n = −round(z/ln 2) and t = −z − n·ln 2, |t| ≤ 0.36, it is (1 − 2ⁿ) − 2ⁿ(eᵗ − 1). The first difference is exact but
//! for one rounding; eᵗ − 1 is a polynomial. For n = 0 the first part is 0 and t = −z, so that small z lose no digit.
//! *Guarantee.* The relative error is at most [`DECAY_ERROR`]. Write u for 2⁻⁵³. For n = 0 the series to t¹⁵/15! is cut off by
//! t¹⁶/16! ≤ 4e-21·|t|, and each of its 15 steps by Horner's rule adds at most 2u times a factor of |t|/k beside 1: less than 6u in all
//! relative to eᵗ − 1 ≥ 0.84|t|. For n < 0 the result is at least 0.29; n·ln 2 in two parts is off by at most |n|·2⁻⁸⁷, the subtractions
//! by 2u of |t| ≤ 0.36, and 2ⁿ ≤ ½ takes the 6u of the polynomial, whose value is at most 0.44, below 2u: in all below 8u/0.29 < 28u.
//! Beyond z = 745 the result is 1 and the truth within 5e-324 of it.

use super::double_double::U;

/// Bound on the relative error of [`decay`].
pub(crate) const DECAY_ERROR: f64 = 32.0 * U;

/// Adding it to a number rounds that to a whole one.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// ln 2 in two parts; the first has 21 zero bits at its end, so that its products with |n| < 2¹¹ are exact.
const LN_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];

/// 1 − e^{−z} for z ≥ 0, infinite z included; NaN for NaN.
pub(crate) fn decay(z: f64) -> f64 {
    if z > 745.0 {
        return 1.0;
    }
    let shifted = ROUNDER - z * std::f64::consts::LOG2_E;
    let n = shifted - ROUNDER;
    let t = (-z - n * LN_2[0]) - n * LN_2[1];
    let mut sum = 0.0;
    for k in (2..=15).rev() {
        sum = (sum + 1.0) * (t / f64::from(k));
    }
    let less_one = t + t * sum;
    // 2ⁿ is at least 2⁻¹⁰⁷⁵ here, and 0 in place of what is below 2⁻¹⁰²² changes nothing.
    let power = f64::from_bits(((n.max(-1023.0) as i64 + 1023) << 52) as u64);
    (1.0 - power) - power * less_one
}

#[cfg(test)]
mod tests {
    use num_rational::BigRational;
    use num_traits::{One, Signed, ToPrimitive, Zero};

    use super::*;

    /// 1 − e^{−z} as a fraction, to within 2⁻²⁰⁰ of its size: (e^{−z/2ᵐ})^{2ᵐ} by the series, in numbers of 400 bits.
    fn truth(z: f64) -> BigRational {
        let scale = num_traits::pow(BigRational::from_integer(2.into()), 500);
        let cut = |x: BigRational| (x * &scale).round() / &scale;
        let x =
            BigRational::from_float(z).unwrap() / BigRational::from_integer((1u64 << 12).into());
        let (mut term, mut sum) = (BigRational::one(), BigRational::zero());
        for k in 1..80u32 {
            term = cut(-term * &x / BigRational::from_integer(k.into()));
            sum += &term;
        }
        // less = e^{−y} − 1 is doubled by less·(less + 2), which keeps its digits.
        let two = BigRational::from_integer(2.into());
        for _ in 0..12 {
            sum = cut(&sum * (&sum + &two));
        }
        -sum
    }

    #[test]
    fn the_error_is_below_its_bound() {
        let mut state = 1u64;
        let mut worst = 0.0f64;
        for k in 0..crate::test_length::long_or(400, 120) {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let unit = (state >> 11) as f64 / (1u64 << 53) as f64;
            let z = if k % 2 == 0 { unit * 60.0 } else { 2f64.powf(-90.0 * unit) };
            let truth = truth(z);
            let off = (BigRational::from_float(decay(z)).unwrap() - &truth).abs() / truth;
            worst = worst.max(off.to_f64().unwrap());
        }
        assert!(worst < DECAY_ERROR / 4.0, "{worst:e}");
        assert!(worst > 0.0);
    }

    #[test]
    fn ends_and_multiples_of_ln_2() {
        assert_eq!(decay(0.0), 0.0);
        assert_eq!(decay(f64::INFINITY), 1.0);
        assert_eq!(decay(5e-324), 5e-324);
        assert!(decay(f64::NAN).is_nan());
        for k in 1..50 {
            let z = std::f64::consts::LN_2 * f64::from(k) / 2.0;
            assert!((decay(z) + (-z).exp_m1()).abs() <= 4e-16, "{z}");
            assert!(decay(z) <= decay(z + 1e-12), "{z}");
        }
    }
}
