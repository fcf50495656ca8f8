//! Whole numbers of any size, for signs that no bounded number of bits can tell.
//!
//! *Idea.* Every finite `f64` is a whole number of at most 53 bits times a power of two. Numbers brought to the least of
//! their powers are whole numbers, of at most 2099 bits for the extremes of the range, and a determinant of them is a
//! whole number too. Schoolbook arithmetic: this stage is reached by one sign in millions.

use std::cmp::Ordering;

use super::ring::Ring;

/// ± Σ limbsᵢ·2⁶⁴ⁱ, without leading zeros; zero has no limbs and is not negative.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Integer {
    negative: bool,
    limbs: Vec<u64>,
}

/// |value| = mantissa·2^exponent, with an odd mantissa; zero is 0·2⁰.
pub(crate) fn parts(value: f64) -> (u64, i32) {
    let bits = value.to_bits();
    let (field, fraction) = ((bits >> 52 & 0x7ff) as i32, bits & ((1 << 52) - 1));
    let (mantissa, exponent) = match field {
        0 => (fraction, -1074),
        _ => (fraction | 1 << 52, field - 1075),
    };
    match mantissa {
        0 => (0, 0),
        _ => (mantissa >> mantissa.trailing_zeros(), exponent + mantissa.trailing_zeros() as i32),
    }
}

impl Integer {
    /// value·2^−exponent, for a finite value of which no bit lies below 2^exponent.
    pub(crate) fn scaled(value: f64, exponent: i32) -> Self {
        let (mantissa, own) = parts(value);
        if mantissa == 0 {
            return Integer { negative: false, limbs: vec![] };
        }
        let places = (own - exponent) as usize;
        let mut limbs = vec![0; places / 64];
        let wide = u128::from(mantissa) << (places % 64);
        limbs.extend([wide as u64, (wide >> 64) as u64]);
        Integer { negative: value < 0.0, limbs }.trimmed()
    }

    /// Compared with 0.
    pub(crate) fn sign(&self) -> Ordering {
        match (self.limbs.is_empty(), self.negative) {
            (true, _) => Ordering::Equal,
            (false, true) => Ordering::Less,
            (false, false) => Ordering::Greater,
        }
    }

    /// (m, e) with |value − m·2ᵉ| ≤ 2u·|value| and m an `f64` below 2¹²⁸; m = 0 for 0 alone.
    pub(crate) fn approximately(&self) -> (f64, i64) {
        let limb = |back: usize| self.limbs.len().checked_sub(back).map_or(0, |at| self.limbs[at]);
        let size = (u128::from(limb(1)) << 64 | u128::from(limb(2))) as f64;
        let exponent = 64 * (self.limbs.len() as i64 - 2);
        (if self.negative { -size } else { size }, exponent)
    }

    fn trimmed(mut self) -> Self {
        while self.limbs.last() == Some(&0) {
            self.limbs.pop();
        }
        self.negative &= !self.limbs.is_empty();
        self
    }

    /// self ± other.
    fn combined(&self, other: &Self, negate: bool) -> Self {
        let negative = other.negative != negate;
        if self.negative == negative {
            return Integer { negative, limbs: sum(&self.limbs, &other.limbs) }.trimmed();
        }
        match compare(&self.limbs, &other.limbs) {
            Ordering::Less => Integer { negative, limbs: difference(&other.limbs, &self.limbs) },
            _ => Integer { negative: self.negative, limbs: difference(&self.limbs, &other.limbs) },
        }
        .trimmed()
    }
}

fn compare(a: &[u64], b: &[u64]) -> Ordering {
    a.len().cmp(&b.len()).then_with(|| a.iter().rev().cmp(b.iter().rev()))
}

fn sum(a: &[u64], b: &[u64]) -> Vec<u64> {
    let mut carry = 0;
    let mut limbs: Vec<u64> = (0..a.len().max(b.len()))
        .map(|i| {
            let limb = |limbs: &[u64]| u128::from(limbs.get(i).copied().unwrap_or(0));
            let total = limb(a) + limb(b) + carry;
            carry = total >> 64;
            total as u64
        })
        .collect();
    limbs.push(carry as u64);
    limbs
}

/// a − b for a ≥ b.
fn difference(a: &[u64], b: &[u64]) -> Vec<u64> {
    let mut borrow = false;
    let limb = |(i, &limb): (usize, &u64)| {
        let (rest, under) = limb.overflowing_sub(b.get(i).copied().unwrap_or(0));
        let (rest, under_again) = rest.overflowing_sub(u64::from(borrow));
        borrow = under | under_again;
        rest
    };
    a.iter().enumerate().map(limb).collect()
}

impl Ring for Integer {
    fn plus(&self, other: &Self) -> Self {
        self.combined(other, false)
    }

    fn minus(&self, other: &Self) -> Self {
        self.combined(other, true)
    }

    fn times(&self, other: &Self) -> Self {
        let mut limbs = vec![0u64; self.limbs.len() + other.limbs.len()];
        for (i, &a) in self.limbs.iter().enumerate() {
            let mut carry = 0u128;
            for (j, &b) in other.limbs.iter().enumerate() {
                let total = u128::from(a) * u128::from(b) + u128::from(limbs[i + j]) + carry;
                limbs[i + j] = total as u64;
                carry = total >> 64;
            }
            limbs[i + other.limbs.len()] = carry as u64;
        }
        Integer { negative: self.negative != other.negative, limbs }.trimmed()
    }
}

#[cfg(test)]
mod tests {
    use num_rational::BigRational;
    use num_traits::{Signed, Zero};
    use proptest::prelude::*;

    use super::*;

    fn any_finite() -> impl Strategy<Value = f64> {
        any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |v| v.is_finite())
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        /// a·b − c·d + e·a for any finite numbers has the sign that fractions give.
        #[test]
        fn signs_are_those_of_fractions(values in [any_finite(), any_finite(), any_finite(), any_finite(), any_finite()]) {
            let exact = |v: f64| BigRational::from_float(v).expect("finite");
            let [a, b, c, d, e] = values;
            let wanted = exact(a) * exact(b) - exact(c) * exact(d) + exact(e) * exact(a);
            let least = values.iter().filter(|v| **v != 0.0).map(|v| parts(*v).1).min().unwrap_or(0);
            let [a, b, c, d, e] = values.map(|v| Integer::scaled(v, least));
            let found = a.times(&b).minus(&c.times(&d)).plus(&e.times(&a));
            let wanted = match () {
                () if wanted.is_zero() => Ordering::Equal,
                () if wanted.is_negative() => Ordering::Less,
                () => Ordering::Greater,
            };
            prop_assert_eq!(found.sign(), wanted);
            prop_assert_eq!(found.minus(&found).sign(), Ordering::Equal);
        }
    }

    #[test]
    fn carries_and_borrows_run_across_limbs() {
        let ones = Integer { negative: false, limbs: vec![u64::MAX; 3] };
        let one = Integer::scaled(1.0, 0);
        let power = ones.plus(&one);
        assert_eq!(power.limbs, [0, 0, 0, 1]);
        assert_eq!(power.minus(&one), ones);
        assert_eq!(one.minus(&power).sign(), Ordering::Less);
        assert_eq!(ones.times(&ones), power.times(&power).minus(&power).minus(&power).plus(&one));
    }
}
