//! Rigorous interval arithmetic with 256 bits.
//!
//! *Form.* An [`Interval`] is the set {x : |x − m·2ᵉ| ≤ r} with an integer m of any sign, an exponent e without limits, and
//! a radius r. Each operation returns an interval that contains every result for every choice of operands: the integer is
//! cut to [`PRECISION_BITS`] bits and what was cut off is added to the radius, and all radii are rounded up. An interval of
//! radius 0 is one number, so sums and products of few `f64` are exact.
//! *Limits.* Nothing over- or underflows. A quotient by an interval that contains 0, the root of one that contains negative
//! numbers only, and the logarithm of one that contains 0 are `None`.
//! *Reference.* Johansson, Arb: efficient arbitrary-precision midpoint-radius interval arithmetic, IEEE Transactions on
//! Computers 66(8), 2017.

mod functions;
mod radius;
#[cfg(test)]
mod tests;

use std::cmp::Ordering;

use num_bigint::{BigInt, Sign};

pub(crate) use self::functions::log_unit_ball;
use self::radius::Radius;

/// This many bits of the integer m are kept.
const PRECISION_BITS: u64 = 256;
/// A summand whose leading bit lies this many bits below that of the other is counted in the radius alone.
const FAR_APART: i64 = 4096;

/// All numbers within a radius of m·2ᵉ.
#[derive(Clone, Debug)]
pub(crate) struct Interval {
    mantissa: BigInt,
    exponent: i64,
    radius: Radius,
}

impl Interval {
    pub(crate) fn zero() -> Self {
        Interval { mantissa: BigInt::ZERO, exponent: 0, radius: Radius::ZERO }
    }

    pub(crate) fn integer(value: i64) -> Self {
        Interval { mantissa: BigInt::from(value), exponent: 0, radius: Radius::ZERO }
    }

    /// The number itself; `None` for NaN and infinities.
    pub(crate) fn exact(value: f64) -> Option<Self> {
        if !value.is_finite() {
            return None;
        }
        let bits = value.to_bits();
        let (field, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
        let (mantissa, exponent) = match field {
            0 => (fraction, -1074),
            _ => (fraction | 1 << 52, field as i64 - 1075),
        };
        let zeros = if mantissa == 0 { 0 } else { mantissa.trailing_zeros() };
        let mantissa = BigInt::from(mantissa >> zeros);
        let mantissa = if value < 0.0 { -mantissa } else { mantissa };
        Some(Interval { mantissa, exponent: exponent + i64::from(zeros), radius: Radius::ZERO })
    }

    /// The quotient of two integers.
    pub(crate) fn fraction(numerator: i64, denominator: i64) -> Option<Self> {
        Interval::integer(numerator).over(&Interval::integer(denominator))
    }

    /// Cuts the integer to [`PRECISION_BITS`] bits.
    fn of(mantissa: BigInt, exponent: i64, radius: Radius) -> Self {
        let bits = mantissa.bits();
        if bits <= PRECISION_BITS {
            return Interval { mantissa, exponent, radius };
        }
        let cut = (bits - PRECISION_BITS) as i64;
        // The shift rounds down, which is less than one unit.
        Interval {
            mantissa: mantissa >> cut,
            exponent: exponent + cut,
            radius: radius.plus(Radius::power(exponent + cut)),
        }
    }

    fn is_zero(&self) -> bool {
        self.mantissa.sign() == Sign::NoSign && self.radius.is_zero()
    }

    /// |m·2ᵉ|, rounded up.
    fn size(&self) -> Radius {
        Radius::at_least(&self.mantissa, self.exponent)
    }

    /// The exponent of the leading bit of m·2ᵉ.
    fn magnitude(&self) -> i64 {
        self.exponent + self.mantissa.bits() as i64
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        if self.is_zero() {
            return other.clone();
        }
        if other.is_zero() {
            return self.clone();
        }
        let radius = self.radius.plus(other.radius);
        let (large, small) =
            if self.magnitude() >= other.magnitude() { (self, other) } else { (other, self) };
        let is_far = large.mantissa.sign() != Sign::NoSign
            && large.magnitude() - small.magnitude() > FAR_APART;
        if is_far {
            let radius = radius.plus(small.size());
            return Interval { radius, ..large.clone() };
        }
        let exponent = self.exponent.min(other.exponent);
        let aligned = |x: &Interval| &x.mantissa << (x.exponent - exponent);
        Interval::of(aligned(self) + aligned(other), exponent, radius)
    }

    pub(crate) fn minus(&self, other: &Self) -> Self {
        self.plus(&other.negative())
    }

    pub(crate) fn negative(&self) -> Self {
        Interval { mantissa: -&self.mantissa, ..self.clone() }
    }

    pub(crate) fn times(&self, other: &Self) -> Self {
        let radius = if self.radius.is_zero() && other.radius.is_zero() {
            Radius::ZERO
        } else {
            let whole = self.size().plus(self.radius);
            whole.times(other.radius).plus(self.radius.times(other.size()))
        };
        Interval::of(&self.mantissa * &other.mantissa, self.exponent + other.exponent, radius)
    }

    pub(crate) fn square(&self) -> Self {
        self.times(self)
    }

    /// The product with 2ᵏ.
    pub(crate) fn scaled(&self, k: i64) -> Self {
        Interval {
            mantissa: self.mantissa.clone(),
            exponent: self.exponent + k,
            radius: self.radius.scaled(k),
        }
    }

    /// The quotient; `None` where the divisor may be 0.
    pub(crate) fn over(&self, other: &Self) -> Option<Self> {
        let least = other.least_size()?;
        if self.is_zero() {
            return Some(Interval::zero());
        }
        // So many bits more that the quotient has at least PRECISION_BITS of them.
        let shift =
            (PRECISION_BITS + other.mantissa.bits()) as i64 + 2 - self.mantissa.bits() as i64;
        let shift = shift.max(0);
        let mantissa = (&self.mantissa << shift) / &other.mantissa;
        let exponent = self.exponent - other.exponent - shift;
        let mut radius = Radius::power(exponent);
        if !self.radius.is_zero() || !other.radius.is_zero() {
            // |(m + s)/(n + t) − m/n| = |sn − mt| / |n(n + t)|.
            let change =
                self.radius.plus(self.size().times(other.radius).over_lower(other.size_below()));
            radius = radius.plus(change.over_lower(least));
        }
        Some(Interval::of(mantissa, exponent, radius))
    }

    /// |m·2ᵉ|, rounded down.
    fn size_below(&self) -> Radius {
        Radius::at_most(&self.mantissa, self.exponent)
    }

    /// A lower bound above 0 on the size of every number of the interval, if there is one.
    fn least_size(&self) -> Option<Radius> {
        self.size_below().minus_lower(self.radius)
    }

    /// The root of what is not negative in the interval; `None` where all of it is negative.
    pub(crate) fn root(&self) -> Option<Self> {
        if self.is_zero() {
            return Some(Interval::zero());
        }
        let is_negative = self.mantissa.sign() == Sign::Minus;
        if is_negative && self.least_size().is_some() {
            return None;
        }
        if is_negative || self.least_size().is_none() {
            // Somewhere from 0 to the root of the largest number.
            let most = self.size().plus(self.radius).root();
            return Some(Interval { mantissa: BigInt::ZERO, exponent: 0, radius: most });
        }
        let shift = (2 * PRECISION_BITS + 4).saturating_sub(self.mantissa.bits()) as i64;
        let shift = shift + ((self.exponent - shift) & 1);
        let mantissa = (&self.mantissa << shift).sqrt();
        let exponent = (self.exponent - shift) / 2;
        let mut radius = Radius::power(exponent);
        if !self.radius.is_zero() {
            // |√(x + t) − √x| ≤ |t|/√x.
            radius = radius.plus(self.radius.over_lower(Radius::at_most(&mantissa, exponent)));
        }
        Some(Interval::of(mantissa, exponent, radius))
    }

    pub(crate) fn absolute(&self) -> Self {
        match self.mantissa.sign() {
            Sign::Minus => self.negative(),
            _ => self.clone(),
        }
    }

    /// The sign that all numbers of the interval have; `None` where they differ.
    pub(crate) fn sign(&self) -> Option<Ordering> {
        if self.is_zero() {
            return Some(Ordering::Equal);
        }
        self.least_size()?;
        Some(self.mantissa.sign().cmp(&Sign::NoSign))
    }

    pub(crate) fn is_nonzero(&self) -> bool {
        self.sign().is_some_and(Ordering::is_ne)
    }

    pub(crate) fn is_positive(&self) -> bool {
        self.sign() == Some(Ordering::Greater)
    }

    /// Tests whether x ≤ y; `None` where that depends on the choice of x and y.
    pub(crate) fn at_most(&self, other: &Self) -> Option<bool> {
        Some(other.minus(self).sign()? != Ordering::Less)
    }

    /// The number in the middle.
    pub(crate) fn middle(&self) -> Self {
        Interval { radius: Radius::ZERO, ..self.clone() }
    }

    /// As [`Interval::middle`], without a copy.
    pub(crate) fn into_middle(self) -> Self {
        Interval { radius: Radius::ZERO, ..self }
    }

    /// The largest number of the interval, or a little more.
    pub(crate) fn upper(&self) -> Self {
        self.middle().plus(&self.radius.number())
    }

    /// The least number of the interval, or a little less.
    pub(crate) fn lower(&self) -> Self {
        self.middle().minus(&self.radius.number())
    }

    /// The radius as a number.
    pub(crate) fn spread(&self) -> Self {
        self.radius.number()
    }

    /// The number in the middle in plain `f64`: 0 or infinite out of its range.
    pub(crate) fn rounded(&self) -> f64 {
        radius::to_f64(&self.mantissa, self.exponent)
    }

    /// ⌊log₂⌋ of the number in the middle, or one less; 0 for 0.
    pub(crate) fn binary_order(&self) -> i64 {
        if self.mantissa.sign() == Sign::NoSign { 0 } else { self.magnitude() - 1 }
    }
}
