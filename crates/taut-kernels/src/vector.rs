//! Dot products and sums of vectors, in registers as wide as the processor has.
//!
//! Strict `f64` sums do not vectorize, and the baseline of x86-64 has no fused multiply-add, so the small dense
//! algebra of the solvers goes through here: eight running sums, the same on every run.
#![allow(unsafe_code)]

use crate::lanes::Lanes;
use crate::triangle::{Work, dispatch};

/// Calls the body, which must be `#[inline(always)]` code, compiled for the best instruction set there is.
macro_rules! dispatched {
    ($(#[$doc:meta])* $name:ident($($arg:ident: $type:ty),*) $(-> $result:ty)?, $body:ident) => {
        $(#[$doc])*
        pub fn $name($($arg: $type),*) $(-> $result)? {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx512f,fma")]
                fn with_avx512($($arg: $type),*) $(-> $result)? {
                    $body::<true>($($arg),*)
                }
                #[target_feature(enable = "avx2,fma")]
                fn with_avx2($($arg: $type),*) $(-> $result)? {
                    $body::<true>($($arg),*)
                }
                let set = taut_points::instruction_set();
                if set == taut_points::InstructionSet::Avx512 {
                    // SAFETY: the processor has both features.
                    #[allow(unsafe_code)]
                    return unsafe { with_avx512($($arg),*) };
                }
                if set >= taut_points::InstructionSet::Avx2 {
                    // SAFETY: the processor has both features.
                    #[allow(unsafe_code)]
                    return unsafe { with_avx2($($arg),*) };
                }
            }
            $body::<false>($($arg),*)
        }
    };
}

pub(crate) use dispatched;

#[inline(always)]
fn multiply_add<const FUSED: bool>(a: f64, b: f64, sum: f64) -> f64 {
    if FUSED { a.mul_add(b, sum) } else { sum + a * b }
}

/// Σ aᵢbᵢ.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sum = 0.0;
    dispatch(Dot { a, b, sum: &mut sum });
    sum
}

struct Dot<'a> {
    a: &'a [f64],
    b: &'a [f64],
    sum: &'a mut f64,
}

impl Work for Dot<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(self) {
        let (a, a_rest) = self.a.as_chunks::<8>();
        let (b, b_rest) = self.b.as_chunks::<8>();
        let (mut even, mut odd) = ([0.0; 8], [0.0; 8]);
        // SAFETY: features are the caller's promise; each chunk and each array holds eight values.
        unsafe {
            let (mut evens, mut odds) = (L::zero(), L::zero());
            let ((a, a_last), (b, b_last)) = (a.as_chunks::<2>(), b.as_chunks::<2>());
            for (a, b) in a.iter().zip(b) {
                evens = L::load(a[0].as_ptr()).multiply_add(L::load(b[0].as_ptr()), evens);
                odds = L::load(a[1].as_ptr()).multiply_add(L::load(b[1].as_ptr()), odds);
            }
            if let ([a], [b]) = (a_last, b_last) {
                evens = L::load(a.as_ptr()).multiply_add(L::load(b.as_ptr()), evens);
            }
            evens.store(even.as_mut_ptr());
            odds.store(odd.as_mut_ptr());
        }
        let mut sum = 0.0;
        for i in 0..8 {
            sum += even[i] + odd[i];
        }
        for (&a, &b) in a_rest.iter().zip(b_rest) {
            // SAFETY: features are the caller's promise.
            sum = unsafe { L::multiply_add_one(a, b, sum) };
        }
        *self.sum = sum;
    }
}

/// y ← y + a·x.
pub fn add_scaled(y: &mut [f64], a: f64, x: &[f64]) {
    dispatch(AddTerms { y, a: [a], x: [x] });
}

/// y ← y + a₀x₀ + a₁x₁ + a₂x₂ + a₃x₃: one load and store of y for four terms.
///
/// # Panics
/// If one of the x is shorter than y.
pub fn add_four(y: &mut [f64], a: [f64; 4], x: [&[f64]; 4]) {
    let n = y.len();
    let [x0, x1, x2, x3] = x;
    dispatch(AddTerms { y, a, x: [&x0[..n], &x1[..n], &x2[..n], &x3[..n]] });
}

/// y ← y + Σ aₖxₖ, term by term, as far as the shortest reaches.
struct AddTerms<'a, const K: usize> {
    y: &'a mut [f64],
    a: [f64; K],
    x: [&'a [f64]; K],
}

impl<const K: usize> Work for AddTerms<'_, K> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(self) {
        let n = self.x.iter().fold(self.y.len(), |n, x| n.min(x.len()));
        let (eights, rest) = self.y[..n].as_chunks_mut::<8>();
        let whole = 8 * eights.len();
        // SAFETY: features are the caller's promise; all have n values, of which eight from each i on.
        unsafe {
            for (number, y) in eights.iter_mut().enumerate() {
                let mut sum = L::load(y.as_ptr());
                for k in 0..K {
                    let x = L::load(self.x[k].as_ptr().add(8 * number));
                    sum = x.multiply_add(L::broadcast(self.a[k]), sum);
                }
                sum.store(y.as_mut_ptr());
            }
            for (i, y) in rest.iter_mut().enumerate() {
                for k in 0..K {
                    *y = L::multiply_add_one(self.a[k], self.x[k][whole + i], *y);
                }
            }
        }
    }
}

dispatched! {
    /// The plane rotation (a, b) ← (c·a + s·b, c·b − s·a) of two rows.
    rotate(a: &mut [f64], b: &mut [f64], c: f64, s: f64), rotate_body
}

#[inline(always)]
fn rotate_body<const FUSED: bool>(a: &mut [f64], b: &mut [f64], c: f64, s: f64) {
    for (a, b) in a.iter_mut().zip(b) {
        (*a, *b) = (multiply_add::<FUSED>(s, *b, c * *a), multiply_add::<FUSED>(-s, *a, c * *b));
    }
}

dispatched! {
    /// high + low ← high + low + a·x, the rounding errors of products and sums being caught in `low`.
    add_scaled_exactly(high: &mut [f64], low: &mut [f64], a: f64, x: &[f64]), add_scaled_exactly_body
}

#[inline(always)]
fn add_scaled_exactly_body<const FUSED: bool>(
    high: &mut [f64],
    low: &mut [f64],
    a: f64,
    x: &[f64],
) {
    // The error of a product needs the fused operation itself; where it is no instruction, it is a function call.
    for ((high, low), &x) in high.iter_mut().zip(low).zip(x) {
        let product = a * x;
        let sum = *high + product;
        let of_product = sum - *high;
        *low += a.mul_add(x, -product) + ((*high - (sum - of_product)) + (product - of_product));
        *high = sum;
    }
}

/// Σ aᵢ·rowᵢ added to y, the rows taken from `row(i)`.
pub fn add_combination<'r>(y: &mut [f64], a: &[f64], row: impl Fn(usize) -> &'r [f64]) {
    let (fours, rest) = a.as_chunks::<4>();
    for (k, &a) in fours.iter().enumerate() {
        add_four(y, a, std::array::from_fn(|i| row(4 * k + i)));
    }
    for (k, &a) in rest.iter().enumerate() {
        add_scaled(y, a, row(4 * fours.len() + k));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_agree_with_plain_loops_for_every_length() {
        for n in 0..70 {
            let a: Vec<f64> = (0..n).map(|i| f64::from(i) - 3.0).collect();
            let b: Vec<f64> = (0..n).map(|i| f64::from(i * i % 7)).collect();
            // Small integers: every sum is exact, whatever the order.
            assert_eq!(dot(&a, &b), a.iter().zip(&b).map(|(a, b)| a * b).sum::<f64>());
            let rows = [&a, &b, &a, &b, &a, &b];
            let mut y = vec![1.0; a.len()];
            add_combination(&mut y, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], |i| rows[i]);
            for i in 0..a.len() {
                assert_eq!(y[i], 1.0 + 9.0 * a[i] + 12.0 * b[i]);
            }
            let (mut p, mut q) = (a.clone(), b.clone());
            rotate(&mut p, &mut q, 0.0, 1.0);
            assert_eq!((p, q), (b.clone(), a.iter().map(|v| -v).collect()));
        }
    }
}
