//! Exact sums of products of two `f64`, for the sign that no rounded sum can tell.
//!
//! *Idea.* Every finite `f64` is an integer of at most 53 bits times 2ᵉ with −1074 ≤ e ≤ 971, so a product of two is an
//! integer times 2⁻²¹⁴⁸. Two fixed-point numbers hold the positive and the negative products; as both only grow,
//! carries run upwards and short, and the sign of the sum is the order of the two.
//! *Guarantee.* Exact for up to 2⁶⁴ products of any finite numbers, subnormal ones included.
//! *Reference.* The long accumulator of Kulisch, Computer Arithmetic and Validity, 2008.

use std::cmp::Ordering;

/// The highest bit of one product lies below 2·971 + 2·53 + 2148 + 1 = 4197; 64 bits for carries, rounded up.
const LIMBS: usize = 68;

pub(crate) struct ExactSum {
    positive: [u64; LIMBS],
    negative: [u64; LIMBS],
}

/// |value| = mantissa·2^(place − 1074).
fn parts(value: f64) -> (u64, usize) {
    let bits = value.to_bits();
    let (field, fraction) = ((bits >> 52 & 0x7ff) as usize, bits & ((1 << 52) - 1));
    match field {
        0 => (fraction, 0),
        _ => (fraction | 1 << 52, field - 1),
    }
}

impl ExactSum {
    pub(crate) fn zero() -> Self {
        ExactSum { positive: [0; LIMBS], negative: [0; LIMBS] }
    }

    /// Adds 2ᵏ·a·b for finite a, b and k = `doublings` of 0 or 1.
    fn add_product(&mut self, a: f64, b: f64, doublings: usize) {
        let ((ma, pa), (mb, pb)) = (parts(a), parts(b));
        let product = u128::from(ma) * u128::from(mb);
        if product == 0 {
            return;
        }
        let place = pa + pb + doublings;
        let (limb, shift) = (place / 64, place % 64);
        let (low, high) = (product as u64, (product >> 64) as u64);
        let words = if shift == 0 {
            [low, high, 0]
        } else {
            [low << shift, high << shift | low >> (64 - shift), high >> (64 - shift)]
        };
        let negative = a.is_sign_negative() != b.is_sign_negative();
        let limbs = if negative { &mut self.negative } else { &mut self.positive };
        let mut carry = false;
        for (at, word) in limbs[limb..].iter_mut().zip(words) {
            let (sum, over) = at.overflowing_add(word);
            let (sum, over_again) = sum.overflowing_add(u64::from(carry));
            (*at, carry) = (sum, over | over_again);
        }
        let mut above = limbs[limb + words.len()..].iter_mut();
        while carry && let Some(at) = above.next() {
            (*at, carry) = at.overflowing_add(1);
        }
    }

    /// Adds (Σ terms)² for finite terms.
    pub(crate) fn add_square(&mut self, terms: &[f64]) {
        for (i, &a) in terms.iter().enumerate() {
            self.add_product(a, a, 0);
            for &b in &terms[i + 1..] {
                self.add_product(a, b, 1);
            }
        }
    }

    /// Subtracts (Σ terms)² for finite terms.
    pub(crate) fn subtract_square(&mut self, terms: &[f64]) {
        std::mem::swap(&mut self.positive, &mut self.negative);
        self.add_square(terms);
        std::mem::swap(&mut self.positive, &mut self.negative);
    }

    /// The sum compared with 0.
    pub(crate) fn sign(&self) -> Ordering {
        self.positive.iter().rev().cmp(self.negative.iter().rev())
    }
}

#[cfg(test)]
mod tests {
    use num_rational::BigRational;
    use num_traits::{Signed, Zero};
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    /// Numbers that cancel each other now and then, of any exponent.
    fn number() -> impl Strategy<Value = f64> {
        prop_oneof![
            any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |v| v.is_finite()),
            (-3i32..4).prop_map(f64::from),
            Just(f64::MAX),
            Just(-f64::from_bits(1)),
        ]
    }

    fn square(terms: &[f64]) -> BigRational {
        let sum: BigRational = terms.iter().map(|&t| BigRational::from_float(t).unwrap()).sum();
        &sum * &sum
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn signs_are_those_of_fractions(plus in vec(vec(number(), 1..4), 0..4), minus in vec(vec(number(), 1..4), 0..4),
                                        same in any::<bool>()) {
            let minus = if same { plus.iter().rev().cloned().collect() } else { minus };
            let mut sum = ExactSum::zero();
            let mut truth = BigRational::zero();
            for terms in &plus {
                sum.add_square(terms);
                truth += square(terms);
            }
            for terms in &minus {
                sum.subtract_square(terms);
                truth -= square(terms);
            }
            let expected = if truth.is_zero() { Ordering::Equal }
                else if truth.is_positive() { Ordering::Greater } else { Ordering::Less };
            prop_assert_eq!(sum.sign(), expected);
        }
    }

    #[test]
    fn carries_run_as_far_as_they_must() {
        // The square of 2⁵³ − 1 is all ones at both ends; 2²⁰ copies of it carry across limbs.
        let ones = (2f64.powi(53) - 1.0) * 2f64.powi(-1074);
        let mut sum = ExactSum::zero();
        for _ in 0..1 << 20 {
            sum.add_square(&[ones]);
        }
        sum.subtract_square(&[ones * 1024.0]);
        assert_eq!(sum.sign(), Ordering::Equal);
        sum.add_square(&[f64::from_bits(1)]);
        assert_eq!(sum.sign(), Ordering::Greater);
    }
}
