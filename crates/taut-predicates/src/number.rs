//! The polynomials of this crate are written once, over whatever can be added and multiplied.

use std::ops::{Add, Mul, Sub};

/// A kind of number that a polynomial can be evaluated in: `f64`, double-double, integers of any length.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
}

impl<T> Number for T where T: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}

/// A difference that a polynomial is evaluated at: the first number less the second.
pub(crate) type Difference = [f64; 2];

/// A homogeneous polynomial in `K` differences of coordinates, whose sign is a predicate.
pub(crate) trait Polynomial<const K: usize> {
    /// The number of differences each of its monomials multiplies.
    const DEGREE: u32;
    /// The largest number of roundings that a monomial passes through: 1 for a difference, the sum of both sides and 1 for a
    /// product, the larger side and 1 for a sum. The unit of all error bounds; a test counts again.
    const ROUNDINGS: u32;

    /// Its value; the order of operations is part of the error analysis.
    fn evaluate<N: Number>(differences: &[N; K]) -> N;
}

/// A number together with the permanent: what the same polynomial makes of the absolute values, with plus for minus.
#[derive(Clone, Copy)]
pub(crate) struct Measured<N> {
    pub(crate) value: N,
    pub(crate) permanent: f64,
}

impl<N: Number> Add for Measured<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Measured { value: self.value + other.value, permanent: self.permanent + other.permanent }
    }
}

impl<N: Number> Sub for Measured<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Measured { value: self.value - other.value, permanent: self.permanent + other.permanent }
    }
}

impl<N: Number> Mul for Measured<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Measured { value: self.value * other.value, permanent: self.permanent * other.permanent }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Counts what [`Polynomial::ROUNDINGS`] promises, and the degree.
    #[derive(Clone, Copy)]
    struct Count {
        roundings: u32,
        degree: u32,
    }

    impl Add for Count {
        type Output = Self;

        fn add(self, other: Self) -> Self {
            assert_eq!(self.degree, other.degree, "the polynomial is homogeneous");
            Count { roundings: self.roundings.max(other.roundings) + 1, ..self }
        }
    }

    impl Sub for Count {
        type Output = Self;

        fn sub(self, other: Self) -> Self {
            self.add(other)
        }
    }

    impl Mul for Count {
        type Output = Self;

        fn mul(self, other: Self) -> Self {
            Count {
                roundings: self.roundings + other.roundings + 1,
                degree: self.degree + other.degree,
            }
        }
    }

    /// For each polynomial: the constants of the error analysis are those of its formula, and the coefficients are
    /// small enough for the long integers.
    pub(crate) fn constants_are_those_of<P: Polynomial<K>, const K: usize>() {
        let count = P::evaluate(&[Count { roundings: 1, degree: 1 }; K]);
        assert_eq!((count.roundings, count.degree), (P::ROUNDINGS, P::DEGREE));
        assert!(P::ROUNDINGS < 64 && P::DEGREE <= 8, "as the proofs assume");
        let ones = P::evaluate(&[Measured { value: 0.0, permanent: 1.0 }; K]);
        assert!(ones.permanent < (1u32 << 29) as f64, "as the long integers assume");
    }
}
