//! Radii: numbers of at least 0 that are only ever rounded in one direction.

use num_bigint::{BigInt, Sign};

use super::Interval;

/// v·2ᵉ with v = 0 or v in [1, 2), so that nothing over- or underflows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Radius {
    value: f64,
    exponent: i64,
}

/// More than one rounding of an `f64` costs, relatively.
const ROUNDED_UP: f64 = 1.0 + 4.0 * f64::EPSILON;
const ROUNDED_DOWN: f64 = 1.0 - 4.0 * f64::EPSILON;

/// What the exponent of 1 is stored as.
const EXPONENT_BIAS: u64 = 1023;

/// 2⁻ᵏ for k below 1000.
fn inverse_power(k: u64) -> f64 {
    f64::from_bits((EXPONENT_BIAS - k) << 52)
}

impl Radius {
    pub(super) const ZERO: Radius = Radius { value: 0.0, exponent: 0 };

    pub(super) fn power(exponent: i64) -> Self {
        Radius { value: 1.0, exponent }
    }

    pub(super) fn is_zero(self) -> bool {
        self.value == 0.0
    }

    /// Brings a value of at least 0, of moderate size and so not subnormal, to [1, 2).
    fn of(value: f64, exponent: i64) -> Self {
        if value == 0.0 {
            return Radius::ZERO;
        }
        let (field, fraction) = (value.to_bits() >> 52, value.to_bits() & ((1 << 52) - 1));
        let value = f64::from_bits(EXPONENT_BIAS << 52 | fraction);
        Radius { value, exponent: exponent + field as i64 - EXPONENT_BIAS as i64 }
    }

    /// The leading 53 bits of |m| and how many bits follow.
    fn leading(mantissa: &BigInt) -> (f64, i64) {
        let rest = (mantissa.bits() as i64 - 53).max(0);
        let digits = (mantissa.magnitude() >> rest).iter_u64_digits().next().unwrap_or(0);
        (digits as f64, rest)
    }

    /// |m|·2ᵉ, rounded up.
    pub(super) fn at_least(mantissa: &BigInt, exponent: i64) -> Self {
        let (value, rest) = Radius::leading(mantissa);
        let is_cut = rest > 0;
        Radius::of(if is_cut { value * ROUNDED_UP } else { value }, exponent + rest)
    }

    /// |m|·2ᵉ, rounded down.
    pub(super) fn at_most(mantissa: &BigInt, exponent: i64) -> Self {
        let (value, rest) = Radius::leading(mantissa);
        Radius::of(value, exponent + rest)
    }

    pub(super) fn scaled(self, k: i64) -> Self {
        if self.is_zero() { self } else { Radius { exponent: self.exponent + k, ..self } }
    }

    /// Rounded up.
    pub(super) fn plus(self, other: Self) -> Self {
        if self.is_zero() {
            return other;
        }
        if other.is_zero() {
            return self;
        }
        let (large, small) =
            if self.exponent >= other.exponent { (self, other) } else { (other, self) };
        let apart = (large.exponent - small.exponent).min(60) as u64;
        Radius::of((large.value + small.value * inverse_power(apart)) * ROUNDED_UP, large.exponent)
    }

    /// Rounded up.
    pub(super) fn times(self, other: Self) -> Self {
        Radius::of(self.value * other.value * ROUNDED_UP, self.exponent + other.exponent)
    }

    /// The quotient by a number above 0 that was rounded down; rounded up.
    pub(super) fn over_lower(self, other: Self) -> Self {
        Radius::of(self.value / other.value * ROUNDED_UP, self.exponent - other.exponent)
    }

    /// Rounded up.
    pub(super) fn root(self) -> Self {
        let odd = self.exponent & 1;
        let value = if odd == 1 { 2.0 * self.value } else { self.value };
        Radius::of(value.sqrt() * ROUNDED_UP, (self.exponent - odd) / 2)
    }

    /// The difference, rounded down, if it is known to be above 0.
    pub(super) fn minus_lower(self, other: Self) -> Option<Self> {
        if other.is_zero() {
            return if self.is_zero() { None } else { Some(self) };
        }
        if self.is_zero() || self.exponent < other.exponent {
            return None;
        }
        let apart = (self.exponent - other.exponent).min(60) as u64;
        let rest = self.value * ROUNDED_DOWN - other.value * ROUNDED_UP * inverse_power(apart);
        (rest > 0.0).then(|| Radius::of(rest * ROUNDED_DOWN, self.exponent))
    }

    /// The radius as an interval of one number.
    pub(super) fn number(self) -> Interval {
        match Interval::exact(self.value) {
            Some(value) => value.scaled(self.exponent),
            None => Interval::zero(),
        }
    }
}

/// m·2ᵉ in plain `f64`, to 53 bits or so; 0 or infinite out of range.
pub(super) fn to_f64(mantissa: &BigInt, exponent: i64) -> f64 {
    let (value, rest) = Radius::leading(mantissa);
    let value = if mantissa.sign() == Sign::Minus { -value } else { value };
    let exponent = (exponent + rest).clamp(-2400, 2400) as i32;
    // In steps, as powers of two beyond the range of `f64` are wanted where the product is within.
    let (half, rest) = (exponent / 4, exponent - 3 * (exponent / 4));
    let power = 2f64.powi(half);
    if exponent < 0 {
        value * power * 2f64.powi(rest) * power * power
    } else {
        value * power * power * power * 2f64.powi(rest)
    }
}
