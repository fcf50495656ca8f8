//! Exact numbers m·2ᵉ with an integer m of any length: sums and products of doubles, without a single rounding.

use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

use num_bigint::{BigInt, Sign};
use num_traits::{One, Signed, Zero};

/// The number m·2ᵉ.
#[derive(Clone, Debug)]
pub struct Dyadic {
    mantissa: BigInt,
    exponent: i64,
}

impl Dyadic {
    /// Returns 0.
    pub fn zero() -> Self {
        Dyadic { mantissa: BigInt::zero(), exponent: 0 }
    }

    /// Returns an integer.
    pub fn integer(value: i64) -> Self {
        Dyadic { mantissa: value.into(), exponent: 0 }
    }

    /// Returns 2ᵏ.
    pub fn power(k: i64) -> Self {
        Dyadic { mantissa: BigInt::one(), exponent: k }
    }

    /// Returns the value of a finite double.
    pub fn of(value: f64) -> Self {
        assert!(value.is_finite(), "an exact number was asked of {value}");
        let bits = value.to_bits();
        let (field, fraction) = ((bits >> 52 & 0x7ff) as i64, (bits & ((1 << 52) - 1)) as i64);
        let (mantissa, exponent) =
            if field == 0 { (fraction, -1074) } else { (fraction | 1 << 52, field - 1075) };
        if mantissa == 0 {
            return Self::zero();
        }
        let zeros = mantissa.trailing_zeros();
        let odd = mantissa >> zeros;
        let odd = if value < 0.0 { -odd } else { odd };
        Dyadic { mantissa: odd.into(), exponent: exponent + i64::from(zeros) }
    }

    /// Returns the sign as an ordering against 0.
    pub fn sign(&self) -> Ordering {
        match self.mantissa.sign() {
            Sign::Minus => Ordering::Less,
            Sign::NoSign => Ordering::Equal,
            Sign::Plus => Ordering::Greater,
        }
    }

    /// Returns true if the number is 0.
    pub fn is_zero(&self) -> bool {
        self.mantissa.is_zero()
    }

    /// Returns |x|.
    pub fn abs(&self) -> Self {
        Dyadic { mantissa: self.mantissa.abs(), exponent: self.exponent }
    }

    /// Returns x².
    pub fn square(&self) -> Self {
        self * self
    }

    /// Returns x·2ᵏ.
    pub fn scaled(&self, k: i64) -> Self {
        Dyadic { mantissa: self.mantissa.clone(), exponent: self.exponent + k }
    }

    /// Returns k with 2ᵏ⁻¹ ≤ |x| < 2ᵏ; the least `i64` for 0.
    pub fn magnitude(&self) -> i64 {
        if self.is_zero() { i64::MIN } else { self.exponent + self.mantissa.bits() as i64 }
    }

    /// Returns the number rounded toward −∞ to `bits` significant bits.
    pub fn floored(&self, bits: u64) -> Self {
        let drop = self.mantissa.bits().saturating_sub(bits);
        Dyadic { mantissa: &self.mantissa >> drop, exponent: self.exponent + drop as i64 }
    }

    /// Returns x/y with a relative error below 2^(1 − bits).
    pub fn quotient(&self, divisor: &Self, bits: u64) -> Self {
        let wanted = bits + divisor.mantissa.bits();
        let shift = wanted.saturating_sub(self.mantissa.bits());
        Dyadic {
            mantissa: (&self.mantissa << shift) / &divisor.mantissa,
            exponent: self.exponent - divisor.exponent - shift as i64,
        }
    }

    /// Returns √x rounded down, with a relative error below 2^(1 − bits); 0 for numbers that are not positive.
    pub fn root(&self, bits: u64) -> Self {
        if self.sign() != Ordering::Greater {
            return Self::zero();
        }
        let mut shift = (2 * bits).saturating_sub(self.mantissa.bits()) as i64;
        if (self.exponent - shift) % 2 != 0 {
            shift += 1;
        }
        let radicand: BigInt = &self.mantissa << shift;
        Dyadic { mantissa: radicand.sqrt(), exponent: (self.exponent - shift) / 2 }
    }

    /// Returns √x rounded up, with a relative error below 2^(2 − bits).
    pub fn root_up(&self, bits: u64) -> Self {
        let root = self.root(bits);
        if root.square() == *self { root } else { &root + &root.scaled(1 - bits as i64) }
    }

    /// Returns the number to about 17 digits, for people to read.
    pub fn text(&self) -> String {
        let magnitude = self.magnitude();
        if self.is_zero() {
            return "0".into();
        }
        let short = self.scaled(-magnitude).floored(60);
        let value = short.mantissa.to_string().parse::<f64>().unwrap_or(f64::NAN);
        let value = value * 2f64.powi(short.exponent as i32);
        match i32::try_from(magnitude) {
            Ok(k) if k.abs() < 1000 => format!("{:e}", value * 2f64.powi(k)),
            _ => format!("{value}·2^{magnitude}"),
        }
    }
}

impl Add for &Dyadic {
    type Output = Dyadic;
    fn add(self, other: &Dyadic) -> Dyadic {
        if self.is_zero() {
            return other.clone();
        }
        if other.is_zero() {
            return self.clone();
        }
        let (high, low) =
            if self.exponent >= other.exponent { (self, other) } else { (other, self) };
        let shift = (high.exponent - low.exponent) as u64;
        Dyadic { mantissa: (&high.mantissa << shift) + &low.mantissa, exponent: low.exponent }
    }
}

impl Neg for &Dyadic {
    type Output = Dyadic;
    fn neg(self) -> Dyadic {
        Dyadic { mantissa: -&self.mantissa, exponent: self.exponent }
    }
}

impl Sub for &Dyadic {
    type Output = Dyadic;
    fn sub(self, other: &Dyadic) -> Dyadic {
        self + &-other
    }
}

impl Mul for &Dyadic {
    type Output = Dyadic;
    fn mul(self, other: &Dyadic) -> Dyadic {
        if self.is_zero() || other.is_zero() {
            return Dyadic::zero();
        }
        Dyadic {
            mantissa: &self.mantissa * &other.mantissa,
            exponent: self.exponent + other.exponent,
        }
    }
}

impl PartialEq for Dyadic {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Dyadic {}

impl PartialOrd for Dyadic {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Dyadic {
    fn cmp(&self, other: &Self) -> Ordering {
        (self - other).sign()
    }
}

/// Returns Σ aᵢ.
pub fn sum(parts: impl IntoIterator<Item = Dyadic>) -> Dyadic {
    parts.into_iter().fold(Dyadic::zero(), |sum, part| &sum + &part)
}

/// Returns |a − b|².
pub fn distance_square(a: &[Dyadic], b: &[Dyadic]) -> Dyadic {
    sum(a.iter().zip(b).map(|(a, b)| (a - b).square()))
}

/// Returns the coordinates as exact numbers.
pub fn exact(values: &[f64]) -> Vec<Dyadic> {
    values.iter().map(|&value| Dyadic::of(value)).collect()
}

#[test]
fn exact_numbers_compute() {
    let third = Dyadic::integer(1).quotient(&Dyadic::integer(3), 100);
    let off = (&(&third * &Dyadic::integer(3)) - &Dyadic::integer(1)).abs();
    assert!(!off.is_zero() && off < Dyadic::power(-98));
    for value in [5e-324, -1.5, f64::MAX, 0.1, 3.0] {
        let square = Dyadic::of(value).square();
        assert_eq!(square.root(64), Dyadic::of(value.abs()));
        assert_eq!(square.root_up(64), Dyadic::of(value.abs()));
    }
    let two = Dyadic::integer(2);
    let (low, high) = (two.root(200), two.root_up(200));
    assert!(low.square() < two && two < high.square());
    assert!(&high - &low < Dyadic::power(-196));
    assert_eq!(Dyadic::of(-0.75).floored(1), Dyadic::integer(-1));
    assert_eq!(Dyadic::of(0.3).text(), "3e-1");
}
