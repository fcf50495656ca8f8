//! Double-double: pairs of `f64`, some 106 bits, from exact differences, with a bound like that of the filter.
//!
//! *Idea.* A difference of two coordinates is exactly a pair (hi, lo). Pairs are added and multiplied with a relative
//! error of a few u², u = 2⁻⁵³, and the polynomial of absolute values rides along in plain `f64`. Points of a sphere or
//! a surface, rounded to `f64`, have determinants of about 2⁻⁵³ of the permanent: hopeless for the filter, easy here. It is
//! asked where the magnitudes are too mixed for integers of fixed width.
//!
//! *Guarantee.* Call a pair normal if |lo| ≤ u·|hi|. Results are normal, as they end in an exact sum of two `f64`. Let
//! x, y be normal and p(x) ≥ |x| the permanent. First-order errors, in units of u²:
//! - x ± y: lo + lo rounds by 1·(|x| + |y|); adding the error of hi + hi, of size u·|x + y|, rounds by 2·(|x| + |y|);
//!   the rest is exact. Together 3·(p(x) + p(y)).
//! - x·y: lo·lo is left out, 1; hi·lo and lo·hi round by 1 each, their sum by 2, and 3 where it meets the error of
//!   hi·hi. Together 8·p(x)p(y).
//!
//! A leaf has none. So by induction |computed − exact| ≤ 8·k·u²·permanent, where k counts 1 for a leaf, the sum of both
//! sides and 1 for a product, the larger side and 1 for a sum: [`Polynomial::ROUNDINGS`], the same count as for the
//! filter. What a leaf counts but does not cost, and the 5 saved in each sum, exceed all terms of higher order and the
//! relative error k·u of the computed permanent, as k < 2⁶.
//!
//! *Exponents.* With differences up to 2⁶⁰ and degree 8 at most nothing overflows, not even where a factor is split. An
//! underflow costs less than 2⁻¹⁰⁷⁰ in a product of two factors or more, and is enlarged to 2⁻¹⁰⁷⁰·2^(6·61 + 10) <
//! 2⁻⁶⁹⁰ by the others; fewer than 2¹⁰ such errors stay below [`UNDERFLOW_ERROR`], which is added to the bound.
//! *Reference.* Dekker, Numerische Mathematik 18, 1971; Joldes, Muller & Popescu, Tight and rigorous error bounds for
//! basic building blocks of double-word arithmetic, ACM Transactions on Mathematical Software 44(2), 2017, whose
//! algorithms have bounds 3 (of the larger sum) and 5 where we count 3 and 8.

use std::ops::{Add, Mul, Sub};

use crate::number::{Difference, Measured, Polynomial};
use crate::sign::Sign;

/// Greatest magnitude of a difference.
pub(crate) const DIFFERENCE_MAX: f64 = (1u64 << 60) as f64;
/// 2⁻⁶⁵⁰.
pub(crate) const UNDERFLOW_ERROR: f64 = f64::from_bits((1023 - 650) << 52);
/// u².
const U2: f64 = f64::EPSILON * f64::EPSILON / 4.0;

/// The unevaluated sum of two `f64`, of which the second is at most half a unit in the last place of the first.
#[derive(Clone, Copy)]
pub(crate) struct DoubleDouble {
    pub(crate) hi: f64,
    pub(crate) lo: f64,
}

/// The sign of the polynomial at these differences, or none if even 106 bits may hide it.
#[inline(always)]
pub(crate) fn sign<P: Polynomial<K>, const K: usize>(
    differences: &[Difference; K],
) -> Option<Sign> {
    let Measured { value, permanent } = evaluate::<P, K>(differences)?;
    let bound = f64::from(8 * P::ROUNDINGS) * U2 * permanent + UNDERFLOW_ERROR;
    (value.hi.abs() > bound).then(|| Sign::from(value.hi))
}

/// Value and permanent, if the differences are of moderate magnitude.
#[inline(always)]
pub(crate) fn evaluate<P: Polynomial<K>, const K: usize>(
    differences: &[Difference; K],
) -> Option<Measured<DoubleDouble>> {
    let leaves = differences.map(DoubleDouble::difference);
    // Comparisons with NaN are false.
    if !leaves.iter().fold(true, |within, leaf| within & (leaf.hi.abs() <= DIFFERENCE_MAX)) {
        return None;
    }
    Some(P::evaluate(&leaves.map(|leaf| Measured { value: leaf, permanent: leaf.hi.abs() })))
}

impl DoubleDouble {
    #[inline(always)]
    fn difference([from, less]: Difference) -> Self {
        Self::sum(from, -less)
    }

    /// x + y without error (Knuth).
    #[inline(always)]
    fn sum(x: f64, y: f64) -> Self {
        let hi = x + y;
        let back = hi - x;
        DoubleDouble { hi, lo: (x - (hi - back)) + (y - back) }
    }

    /// x·y without error.
    #[inline(always)]
    fn product(x: f64, y: f64) -> Self {
        let hi = x * y;
        if cfg!(target_feature = "fma") {
            return DoubleDouble { hi, lo: x.mul_add(y, -hi) };
        }
        let ((x1, x2), (y1, y2)) = (split(x), split(y));
        DoubleDouble { hi, lo: ((x1 * y1 - hi) + x1 * y2 + x2 * y1) + x2 * y2 }
    }
}

/// A number as the sum of two with 26 bits each (Dekker).
#[inline(always)]
fn split(x: f64) -> (f64, f64) {
    const FACTOR: f64 = ((1u64 << 27) + 1) as f64;
    let scaled = FACTOR * x;
    let high = scaled - (scaled - x);
    (high, x - high)
}

impl Add for DoubleDouble {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let top = Self::sum(self.hi, other.hi);
        Self::sum(top.hi, top.lo + (self.lo + other.lo))
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + DoubleDouble { hi: -other.hi, lo: -other.lo }
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let top = Self::product(self.hi, other.hi);
        let lo = top.lo + (self.hi * other.lo + self.lo * other.hi);
        // The first is larger, or both are zero: three operations instead of six (Dekker).
        let hi = top.hi + lo;
        DoubleDouble { hi, lo: lo - (hi - top.hi) }
    }
}
