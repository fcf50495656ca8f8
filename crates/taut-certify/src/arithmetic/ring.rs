//! Numbers that can be added and multiplied: one formula for a determinant serves every precision.

use std::cmp::Ordering;

use super::double_double::{two_product, two_sum};
use super::integer::parts;

/// The operations of a determinant.
pub(crate) trait Ring: Clone {
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
}

impl Ring for f64 {
    #[inline(always)]
    fn plus(&self, other: &f64) -> f64 {
        self + other
    }

    #[inline(always)]
    fn minus(&self, other: &f64) -> f64 {
        self - other
    }

    #[inline(always)]
    fn times(&self, other: &f64) -> f64 {
        self * other
    }
}

/// A whole number modulo 2¹²⁸: the number itself, if it is known to be smaller than 2¹²⁷ in size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Residue(u128);

impl Residue {
    pub(crate) const ZERO: Residue = Residue(0);

    /// The residue of a whole number.
    #[inline(always)]
    pub(crate) fn of(value: i64) -> Self {
        Residue(i128::from(value) as u128)
    }

    /// The residue of value/2^exponent, for a finite value of which no bit lies below 2^exponent.
    pub(crate) fn scaled(value: f64, exponent: i32) -> Self {
        let (mantissa, own) = parts(value);
        let size = u128::from(mantissa).checked_shl((own - exponent) as u32).unwrap_or(0);
        Residue(if value < 0.0 { size.wrapping_neg() } else { size })
    }

    /// The whole number with this residue that is at least −2¹²⁷ and less than 2¹²⁷, compared with 0.
    pub(crate) fn sign(self) -> Ordering {
        (self.0 as i128).cmp(&0)
    }
}

impl Ring for Residue {
    #[inline(always)]
    fn plus(&self, other: &Residue) -> Residue {
        Residue(self.0.wrapping_add(other.0))
    }

    #[inline(always)]
    fn minus(&self, other: &Residue) -> Residue {
        Residue(self.0.wrapping_sub(other.0))
    }

    #[inline(always)]
    fn times(&self, other: &Residue) -> Residue {
        Residue(self.0.wrapping_mul(other.0))
    }
}

/// high + low with |low| ≤ u·|high|: a number of about 106 bits.
///
/// Sums are off by at most 4u² of the result and products by at most 5u², with u = 2⁻⁵³ (Joldes, Muller, Popescu, ACM
/// Trans. Math. Softw. 44(2), 2017: AccurateDWPlusDW and DWTimesDW1), but for what underflows: less than 2⁻¹⁰⁷⁰.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DoubleDouble {
    pub(crate) high: f64,
    pub(crate) low: f64,
}

/// a + b = sum + error exactly, where |a| ≥ |b| or a = 0.
#[inline(always)]
fn fast_two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

impl DoubleDouble {
    /// a − b, exactly.
    #[inline(always)]
    pub(crate) fn difference(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, -b);
        DoubleDouble { high, low }
    }
}

impl Ring for DoubleDouble {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        let (sum, error) = two_sum(self.high, other.high);
        let (low, rest) = two_sum(self.low, other.low);
        let sum = fast_two_sum(sum, error + low);
        fast_two_sum(sum.high, sum.low + rest)
    }

    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        self.plus(&DoubleDouble { high: -other.high, low: -other.low })
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let (product, error) = two_product(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        fast_two_sum(product, error + cross)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::Integer;
    use super::*;

    fn sign_of(x: f64) -> Ordering {
        x.partial_cmp(&0.0).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// (a² − b²) − (a − b)(a + b) + c, where products have far more than 128 bits.
        #[test]
        fn residues_survive_what_cancels(
            a in -1.0f64..1.0, b in -1.0f64..1.0, c in -100i32..100, low in -200i32..-110,
        ) {
            let c = f64::from(c) * 2f64.powi(low);
            fn value<T: Ring>(a: T, b: T, c: T) -> T {
                let squares = a.times(&a).minus(&b.times(&b));
                squares.minus(&a.minus(&b).times(&a.plus(&b))).plus(&c)
            }
            // Random numbers below 1 are multiples of 2⁻¹¹⁰ as well.
            let [a, b] = [a, b].map(|x| (x + 2.0) - 2.0);
            let of = |x| Integer::scaled(x, low);
            prop_assert_eq!(value(of(a), of(b), of(c)).sign(), sign_of(c));
            let of = |x| Residue::scaled(x, low);
            prop_assert_eq!(value(of(a), of(b), of(c)).sign(), sign_of(c));
        }
    }

    #[test]
    fn residues_have_signs() {
        for (value, sign) in
            [(3.0, Ordering::Greater), (-3.0, Ordering::Less), (0.0, Ordering::Equal)]
        {
            assert_eq!(Residue::scaled(value, -60).sign(), sign);
        }
        // 2^200 is 0 modulo 2^128.
        assert_eq!(Residue::scaled(1.0, -200).sign(), Ordering::Equal);
    }
}
