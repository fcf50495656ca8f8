//! The polynomials of this crate are written once, over whatever can be added and multiplied.

use std::ops::{Add, Mul, Sub};

/// A kind of number that a polynomial can be evaluated in: `f64`, double-double, integers of any length.
pub(crate) trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
}

impl<T> Number for T where T: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}

/// A homogeneous polynomial in `K` differences of coordinates, whose sign is a predicate.
pub(crate) trait Polynomial<const K: usize> {
    /// How many differences each of its monomials multiplies.
    const DEGREE: u32;

    /// Its value; the order of operations is part of the error analysis.
    fn evaluate<N: Number>(differences: &[N; K]) -> N;
}

/// A difference that a polynomial is evaluated at: the first number less the second.
pub(crate) type Difference = [f64; 2];
