//! The answer of every predicate.

use std::ops::{Mul, Neg};

/// The sign of a real number that was found without error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Sign {
    /// Less than nothing.
    Negative,
    /// Nothing at all: a tie of the input, not of its rounding.
    Zero,
    /// More than nothing.
    Positive,
}

impl Sign {
    /// Returns true if the number is greater than zero.
    #[inline]
    #[must_use]
    pub fn is_positive(self) -> bool {
        self == Sign::Positive
    }

    /// Returns true if the number is less than zero.
    #[inline]
    #[must_use]
    pub fn is_negative(self) -> bool {
        self == Sign::Negative
    }

    /// Returns true if the number is zero.
    #[inline]
    #[must_use]
    pub fn is_zero(self) -> bool {
        self == Sign::Zero
    }
}

impl Neg for Sign {
    type Output = Sign;

    #[inline]
    fn neg(self) -> Sign {
        match self {
            Sign::Negative => Sign::Positive,
            Sign::Zero => Sign::Zero,
            Sign::Positive => Sign::Negative,
        }
    }
}

/// The sign of the product.
impl Mul for Sign {
    type Output = Sign;

    #[inline]
    fn mul(self, other: Sign) -> Sign {
        match self {
            Sign::Negative => -other,
            Sign::Zero => Sign::Zero,
            Sign::Positive => other,
        }
    }
}

/// The sign of the number; that of a NaN is [`Sign::Zero`].
impl From<f64> for Sign {
    #[inline]
    fn from(value: f64) -> Sign {
        if value > 0.0 {
            Sign::Positive
        } else if value < 0.0 {
            Sign::Negative
        } else {
            Sign::Zero
        }
    }
}

impl From<i64> for Sign {
    #[inline]
    fn from(value: i64) -> Sign {
        Sign::from(i128::from(value))
    }
}

impl From<i128> for Sign {
    #[inline]
    fn from(value: i128) -> Sign {
        match value {
            0 => Sign::Zero,
            1.. => Sign::Positive,
            _ => Sign::Negative,
        }
    }
}
