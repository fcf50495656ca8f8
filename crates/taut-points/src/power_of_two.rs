//! Powers of two, by which coordinates are scaled without losing a digit, and the exponents of numbers.
//!
//! *Guarantee.* All is taken from bits: on no machine does it depend on how a logarithm is rounded next to a power of two.

/// Bits of the fraction.
const FRACTION_BITS: u32 = f64::MANTISSA_DIGITS - 1;
/// The exponent of 1 as it is stored.
const BIAS: i32 = f64::MAX_EXP - 1;
/// The exponent of the least normal number.
const NORMAL_MIN: i32 = f64::MIN_EXP - 1;
/// The exponent of the least number above 0.
const SUBNORMAL_MIN: i32 = NORMAL_MIN - FRACTION_BITS as i32;

/// Returns 2ᵉ: subnormal below 2⁻¹⁰²², 0 below 2⁻¹⁰⁷⁴ and ∞ from 2¹⁰²⁴ on.
///
/// ```
/// use taut_points::two_to;
/// assert_eq!([-1, 0, 10, 1024].map(two_to), [0.5, 1.0, 1024.0, f64::INFINITY]);
/// assert_eq!([-1074, -1075].map(two_to), [5e-324, 0.0]);
/// ```
pub const fn two_to(exponent: i32) -> f64 {
    if exponent > BIAS {
        f64::INFINITY
    } else if exponent >= NORMAL_MIN {
        f64::from_bits(((exponent + BIAS) as u64) << FRACTION_BITS)
    } else if exponent >= SUBNORMAL_MIN {
        f64::from_bits(1 << (exponent - SUBNORMAL_MIN))
    } else {
        0.0
    }
}

/// Returns the e with 2ᵉ ≤ |x| < 2ᵉ⁺¹: −1075 for 0, and 1024 for what is not finite.
///
/// ```
/// use taut_points::exponent_of;
/// assert_eq!([1.0, -7.9, 0.1, f64::MAX].map(exponent_of), [0, 2, -4, 1023]);
/// assert_eq!([5e-324, 0.0, f64::INFINITY, f64::NAN].map(exponent_of), [-1074, -1075, 1024, 1024]);
/// ```
pub const fn exponent_of(x: f64) -> i32 {
    let magnitude = x.abs().to_bits();
    match magnitude >> FRACTION_BITS {
        0 => SUBNORMAL_MIN - 1 + (u64::BITS - magnitude.leading_zeros()) as i32,
        stored => stored as i32 - BIAS,
    }
}

/// Returns two numbers whose product is 2ᵉ, for |e| up to 2046: the power itself may be out of range. The second is 1 where it is not.
pub const fn two_to_in_steps(exponent: i32) -> [f64; 2] {
    let first = if exponent > BIAS {
        BIAS
    } else if exponent < SUBNORMAL_MIN {
        SUBNORMAL_MIN
    } else {
        exponent
    };
    [two_to(first), two_to(exponent - first)]
}

/// Returns x·2ᵉ, for |e| up to 2046.
pub const fn times_two_to(x: f64, exponent: i32) -> f64 {
    let [first, second] = two_to_in_steps(exponent);
    x * first * second
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_products_of_twos() {
        let (mut up, mut down) = (1.0, 1.0);
        for e in 0..1100 {
            assert_eq!((two_to(e), two_to(-e)), (up, down), "{e}");
            (up, down) = (up * 2.0, down / 2.0);
        }
        assert_eq!([i32::MIN, i32::MAX].map(two_to), [0.0, f64::INFINITY]);
    }

    #[test]
    fn exponents_are_those_of_the_power_below() {
        for e in -1074..1024 {
            let power = two_to(e);
            assert_eq!([exponent_of(power), exponent_of(-power)], [e, e]);
            // The logarithm of such a number is rounded up to e.
            assert_eq!(exponent_of(power.next_down()), e - 1);
            assert_eq!(exponent_of(power.next_up()), e + i32::from(power == 5e-324));
        }
    }

    #[test]
    fn steps_lead_from_one_end_to_the_other_and_back() {
        for e in -2046..=2046 {
            let [first, second] = two_to_in_steps(e);
            assert!(first > 0.0 && first.is_finite() && second > 0.0 && second.is_finite(), "{e}");
            assert_eq!(exponent_of(first) + exponent_of(second), e);
            assert!(second == 1.0 || !(-1074..1024).contains(&e));
        }
        assert_eq!(times_two_to(5e-324, 2046), two_to(972));
        assert_eq!(times_two_to(two_to(972), -2046), 5e-324);
        assert_eq!(times_two_to(3.0 * two_to(-1074), 1074), 3.0);
    }
}
