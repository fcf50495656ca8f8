//! Numbers of twice the precision of `f64`, for cells that are flat but for the last bits of their corners.
//!
//! *Idea.* A number is the sum of two, the second less than half a unit in the last place of the first; the errors of sums and products are
//! numbers themselves, and kept.
//! *Reference.* Dekker, Numer. Math. 18, 1971; Knuth, *The Art of Computer Programming* 2, 4.2.2.

use std::ops::{Add, Mul, Sub};

/// The sum of two numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TwoSum {
    pub(super) high: f64,
    low: f64,
}

impl TwoSum {
    /// The difference of two numbers, exactly.
    pub(super) fn difference(a: f64, b: f64) -> Self {
        Self::sum(a, -b)
    }

    fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let b_in = high - a;
        Self { high, low: (a - (high - b_in)) + (b - b_in) }
    }
}

impl Add for TwoSum {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let sum = Self::sum(self.high, other.high);
        Self::sum(sum.high, sum.low + (self.low + other.low))
    }
}

impl Sub for TwoSum {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self { high: -other.high, low: -other.low }
    }
}

impl Mul for TwoSum {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        let error = self.high.mul_add(other.high, -high);
        Self::sum(high, error + (self.high * other.low + self.low * other.high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_one_number_loses_is_kept() {
        let tiny = 2f64.powi(-70);
        let one = TwoSum::difference(1.0, -tiny);
        assert_eq!((one.high, one.low), (1.0, tiny));
        let square = one * one - TwoSum::difference(1.0, 0.0);
        assert_eq!(square.high, 2.0 * tiny);
        let third = TwoSum::difference(0.1, 0.3);
        assert_eq!((third + TwoSum::difference(0.3, 0.1)).high, 0.0);
    }
}
