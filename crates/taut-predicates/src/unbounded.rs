//! Integers of any length, on the stack: the last stage.
//!
//! *Idea.* Finite `f64` are whole multiples of a power of two, so that the differences of one call are integers
//! in units of the smallest one, and the sign of a homogeneous polynomial does not depend on the unit.
//! *Guarantee.* Never fails, overflows or allocates: a difference has at most 2101 bits (from 2⁻¹⁰⁷⁴ to 2¹⁰²⁵), so
//! degree 8 with coefficients below 2³⁰ fits the long form. Lengths are tracked: the cost is that of the bits
//! that are there, and calls of fewer bits work in shorter forms that are cheap to copy. The longest take some 130 KB
//! of stack.
//! *Reference.* Schoolbook arithmetic; expansions (Shewchuk, Discrete & Computational Geometry 18, 1997) would
//! fail at the ends of the exponent range and be longer for mixed magnitudes.

use std::ops::{Add, Mul, Sub};

use crate::number::{Difference, Polynomial};
use crate::sign::Sign;

/// The short form has this many limbs.
const SHORT_LIMBS: usize = 16;
/// The middle form has this many limbs.
const MIDDLE_LIMBS: usize = 64;
/// The long form has this many limbs.
const LONG_LIMBS: usize = 268;
/// This many bits are needed beside the differences: 30 for the coefficients of the polynomial, and a limb, as the
/// product of two numbers is first given as many limbs as both have together.
const SPARE_BITS: usize = 30 + 64;
const _: () = assert!(LONG_LIMBS * 64 >= 8 * 2101 + SPARE_BITS);

/// The sign of the polynomial at these differences.
#[cold]
#[inline(never)]
pub(crate) fn sign<P: Polynomial<K>, const K: usize>(differences: &[Difference; K]) -> Sign {
    let (mut unit, mut top) = (i32::MAX, i32::MIN);
    for &number in differences.as_flattened() {
        let (mantissa, exponent) = decode(number);
        if mantissa != 0 {
            unit = unit.min(exponent);
            top = top.max(exponent + 64 - mantissa.leading_zeros() as i32);
        }
    }
    if top == i32::MIN {
        return Sign::Zero; // all differences are of zeros
    }
    // One bit more for the difference itself.
    let bits = P::DEGREE as usize * (top - unit + 1) as usize + SPARE_BITS;
    if bits <= 64 * SHORT_LIMBS {
        P::evaluate(&differences.map(|d| Integer::<SHORT_LIMBS>::difference(d, unit))).sign()
    } else if bits <= 64 * MIDDLE_LIMBS {
        P::evaluate(&differences.map(|d| Integer::<MIDDLE_LIMBS>::difference(d, unit))).sign()
    } else {
        P::evaluate(&differences.map(|d| Integer::<LONG_LIMBS>::difference(d, unit))).sign()
    }
}

/// The number without its sign as m·2ᵉ, m odd or zero.
fn decode(number: f64) -> (u64, i32) {
    let bits = number.to_bits();
    let biased = ((bits >> 52) & 0x7ff) as i32;
    let fraction = bits & ((1 << 52) - 1);
    let (mantissa, exponent) =
        if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    let zeros = if mantissa == 0 { 0 } else { mantissa.trailing_zeros() };
    (mantissa >> zeros, exponent + zeros as i32)
}

/// A whole number of up to N limbs: a sign, and the limbs below `len`, the last of them not zero.
#[derive(Clone, Copy)]
struct Integer<const N: usize> {
    negative: bool,
    len: usize,
    limbs: [u64; N],
}

impl<const N: usize> Integer<N> {
    const ZERO: Self = Integer { negative: false, len: 0, limbs: [0; N] };

    fn new(number: f64, unit: i32) -> Self {
        let (mantissa, exponent) = decode(number);
        let mut integer = Self::ZERO;
        if mantissa == 0 {
            return integer;
        }
        let shift = (exponent - unit) as usize;
        let (limb, wide) = (shift / 64, u128::from(mantissa) << (shift % 64));
        integer.negative = number < 0.0;
        integer.limbs[limb] = wide as u64;
        integer.len = limb + 1;
        if wide >> 64 != 0 {
            integer.limbs[limb + 1] = (wide >> 64) as u64;
            integer.len = limb + 2;
        }
        integer
    }

    fn difference([from, less]: Difference, unit: i32) -> Self {
        Self::new(from, unit) - Self::new(less, unit)
    }

    fn sign(&self) -> Sign {
        match (self.len, self.negative) {
            (0, _) => Sign::Zero,
            (_, true) => Sign::Negative,
            (_, false) => Sign::Positive,
        }
    }

    fn trimmed(mut self) -> Self {
        while self.len > 0 && self.limbs[self.len - 1] == 0 {
            self.len -= 1;
        }
        self
    }

    /// |self| + |other| with the sign of self.
    fn magnitudes_added(&self, other: &Self) -> Self {
        let (long, short) = if self.len < other.len { (other, self) } else { (self, other) };
        let mut sum = *long;
        sum.negative = self.negative;
        let mut carry = false;
        for i in 0..long.len {
            if i >= short.len && !carry {
                return sum;
            }
            let addend = if i < short.len { short.limbs[i] } else { 0 };
            let (partial, over) = long.limbs[i].overflowing_add(addend);
            let (limb, again) = partial.overflowing_add(u64::from(carry));
            sum.limbs[i] = limb;
            carry = over | again;
        }
        if carry {
            sum.limbs[sum.len] = 1;
            sum.len += 1;
        }
        sum
    }

    /// |self| − |other| with the sign of self, if |self| is the larger.
    fn magnitudes_subtracted(&self, other: &Self) -> Self {
        let mut rest = *self;
        let mut borrow = false;
        for i in 0..self.len {
            if i >= other.len && !borrow {
                break;
            }
            let less = if i < other.len { other.limbs[i] } else { 0 };
            let (partial, under) = self.limbs[i].overflowing_sub(less);
            let (limb, again) = partial.overflowing_sub(u64::from(borrow));
            rest.limbs[i] = limb;
            borrow = under | again;
        }
        debug_assert!(!borrow, "the larger magnitude comes first");
        rest.trimmed()
    }

    fn is_smaller_than(&self, other: &Self) -> bool {
        if self.len != other.len {
            return self.len < other.len;
        }
        self.limbs[..self.len].iter().rev().lt(other.limbs[..other.len].iter().rev())
    }

    fn plus(&self, other: &Self) -> Self {
        if self.negative == other.negative {
            self.magnitudes_added(other)
        } else if self.is_smaller_than(other) {
            other.magnitudes_subtracted(self)
        } else {
            self.magnitudes_subtracted(other)
        }
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = Self::ZERO;
        if self.len == 0 || other.len == 0 {
            return product;
        }
        product.negative = self.negative != other.negative;
        product.len = self.len + other.len;
        for (i, &a) in self.limbs[..self.len].iter().enumerate() {
            if a == 0 {
                continue; // common: numbers of very different magnitude leave a gap
            }
            let mut carry = 0;
            let (row, rest) = product.limbs[i..].split_at_mut(other.len);
            for (limb, &b) in row.iter_mut().zip(&other.limbs[..other.len]) {
                let wide = u128::from(a) * u128::from(b) + u128::from(*limb) + u128::from(carry);
                *limb = wide as u64;
                carry = (wide >> 64) as u64;
            }
            rest[0] = carry;
        }
        product.trimmed()
    }
}

impl<const N: usize> Add for Integer<N> {
    type Output = Self;

    #[inline(never)]
    fn add(self, other: Self) -> Self {
        self.plus(&other)
    }
}

impl<const N: usize> Sub for Integer<N> {
    type Output = Self;

    #[inline(never)]
    fn sub(self, mut other: Self) -> Self {
        other.negative = !other.negative;
        self.plus(&other)
    }
}

impl<const N: usize> Mul for Integer<N> {
    type Output = Self;

    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        self.times(&other)
    }
}
