//! Integers of fixed width, for differences that are 62-bit multiples of one power of two.
//!
//! *Idea.* The largest difference of the call is brought below 2⁶¹ by a power of two; if then all are whole numbers,
//! the polynomial is evaluated in 128 bits and a few limbs, branch-free. So ties of data such as a grid with step 0.1,
//! whose coordinates are not on a grid at all once they are rounded, still cost no more than a few filters.
//! *Guarantee.* Exact. With |difference| ≤ 2⁶¹ + 2⁸ =: m, minors and planar lifts are below 2m² < 2¹²⁴ and spatial lifts
//! below 3m² < 2¹²⁵, in `i128`; orientation in space is below 6m³ < 2¹⁸⁷, in three limbs; in-circle below 12m⁴ < 2²⁴⁹, in
//! four; in-sphere below 72m⁵ < 2³¹³, in five.
//! *Reference.* Two's complement, schoolbook.

use crate::number::Difference;
use crate::sign::Sign;

/// The differences as integers with a common unit, if 62 bits are enough.
#[inline(always)]
pub(crate) fn integers<const K: usize>(differences: &[Difference; K]) -> Option<[i64; K]> {
    let rounded = differences.map(|[from, less]| from - less);
    let max = rounded.iter().fold(0.0, |max: f64, x| max.max(x.abs()));
    let exponent = (max.to_bits() >> 52) as i64 - 1023;
    // Beyond these the scales below, or the roundings, would leave the range of normal numbers.
    if !(-900..=900).contains(&exponent) {
        return None;
    }
    let scale = f64::from_bits(((1023 + 60 - exponent) as u64) << 52);
    let unit = f64::from_bits(((1023 - 60 + exponent) as u64) << 52);
    let mut whole = true;
    let integers = std::array::from_fn(|i| {
        let ([from, less], hi) = (differences[i], rounded[i]);
        let back = hi - from;
        let lo = (from - (hi - back)) - (less + back);
        // Truncation is undone only if nothing was cut off.
        let (hi_whole, lo_whole) = ((hi * scale) as i64, (lo * scale) as i64);
        whole &= (hi_whole as f64 * unit == hi) & (lo_whole as f64 * unit == lo);
        hi_whole + lo_whole
    });
    whole.then_some(integers)
}

/// A whole number of 64·L bits in two's complement, the least significant limb first.
#[derive(Clone, Copy)]
pub(crate) struct Wide<const L: usize>([u64; L]);

impl From<i64> for Wide<1> {
    #[inline(always)]
    fn from(value: i64) -> Self {
        Wide([value as u64])
    }
}

impl From<i128> for Wide<2> {
    #[inline(always)]
    fn from(value: i128) -> Self {
        Wide([value as u64, (value >> 64) as u64])
    }
}

impl<const L: usize> Wide<L> {
    /// The product, which has room for all bits: C = A + L.
    #[inline(always)]
    pub(crate) fn times<const A: usize, const C: usize>(self, other: Wide<A>) -> Wide<C> {
        const { assert!(C == A + L) }
        let mut product = [0; C];
        for i in 0..L {
            let mut carry = 0;
            for j in 0..A {
                let wide = u128::from(self.0[i]) * u128::from(other.0[j])
                    + u128::from(product[i + j])
                    + u128::from(carry);
                product[i + j] = wide as u64;
                carry = (wide >> 64) as u64;
            }
            product[i + A] = carry;
        }
        // The limbs stand for x + 2^(64·L) where x < 0: take the other factor off the upper half.
        subtract_at(&mut product, L, &other.0, self.is_negative());
        subtract_at(&mut product, A, &self.0, other.is_negative());
        Wide(product)
    }

    #[inline(always)]
    pub(crate) fn plus(self, other: Self) -> Self {
        let (mut sum, mut carry) = ([0; L], false);
        for i in 0..L {
            let (partial, over) = self.0[i].overflowing_add(other.0[i]);
            let (limb, again) = partial.overflowing_add(u64::from(carry));
            sum[i] = limb;
            carry = over | again;
        }
        Wide(sum)
    }

    #[inline(always)]
    fn is_negative(self) -> bool {
        (self.0[L - 1] as i64) < 0
    }

    #[inline(always)]
    pub(crate) fn sign(self) -> Sign {
        if self.is_negative() {
            Sign::Negative
        } else if self.0.iter().fold(0, |all, limb| all | limb) == 0 {
            Sign::Zero
        } else {
            Sign::Positive
        }
    }
}

/// Takes `less` off the limbs from `at` on, if wanted; the borrow of the last limb is dropped.
#[inline(always)]
fn subtract_at<const C: usize, const A: usize>(
    limbs: &mut [u64; C],
    at: usize,
    less: &[u64; A],
    wanted: bool,
) {
    let mask = u64::from(wanted).wrapping_neg();
    let mut borrow = false;
    for i in 0..A {
        let (partial, under) = limbs[at + i].overflowing_sub(less[i] & mask);
        let (limb, again) = partial.overflowing_sub(u64::from(borrow));
        limbs[at + i] = limb;
        borrow = under | again;
    }
}
