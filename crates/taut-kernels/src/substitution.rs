//! Triangular systems and products with many rows, eight rows at a time.
//!
//! *Problem.* An active set solves with a triangular factor at every step. Row by row that is a dot product or a sum of a few
//! hundred numbers each, of which adding up the lanes takes longer than the products.
//! *Idea.* Eight rows share each load of the vector, and one transposing sum; within a block of eight rows only 28 products are
//! left to do one by one.
//! *Guarantee.* The order of the sums depends on positions alone, not on the instruction set.
#![allow(unsafe_code)]

use crate::lanes::Lanes;
use crate::triangle::{Work, dispatch};

/// Rows of a block.
const ROWS: usize = 8;

/// outᵢ = rowᵢ·x for rows `stride` apart, of which the first numbers count, as many as x has.
///
/// # Panics
/// If the lengths do not fit.
pub fn products(rows: &[f64], stride: usize, x: &[f64], out: &mut [f64]) {
    assert!(x.len() <= stride && Some(rows.len()) == stride.checked_mul(out.len()));
    dispatch(Products { rows, stride, x, out });
}

/// z ← R⁻¹z for an upper triangular R by rows, `stride` apart, of which nothing below the diagonal is read.
///
/// # Panics
/// If R is smaller than z.
pub fn back(rows: &[f64], stride: usize, z: &mut [f64]) {
    assert!(z.is_empty() || is_square(rows, stride, z.len()));
    dispatch(Back { rows, stride, z });
}

/// z ← R⁻ᵀz for the same R.
///
/// # Panics
/// If R is smaller than z.
pub fn forward(rows: &[f64], stride: usize, z: &mut [f64]) {
    assert!(z.is_empty() || is_square(rows, stride, z.len()));
    dispatch(Forward { rows, stride, z });
}

/// Tests whether there are `size` rows of as many numbers.
fn is_square(rows: &[f64], stride: usize, size: usize) -> bool {
    let needed = (size - 1).checked_mul(stride).and_then(|before| before.checked_add(size));
    size <= stride && needed.is_some_and(|needed| needed <= rows.len())
}

pub(super) struct Products<'a> {
    rows: &'a [f64],
    stride: usize,
    x: &'a [f64],
    out: &'a mut [f64],
}

impl Work for Products<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(self) {
        let (count, size) = (self.out.len(), self.x.len());
        for (block, out) in self.out.chunks_mut(ROWS).enumerate() {
            // SAFETY: features are the caller's promise; each start is that of a row, of which a missing one repeats the
            // last, and `size` values can be read at each and at x.
            unsafe {
                let mut starts = [self.rows.as_ptr(); ROWS];
                for (k, start) in starts.iter_mut().enumerate() {
                    *start = start.add((block * ROWS + k).min(count - 1) * self.stride);
                }
                let sums = sums::<L>(starts, self.x.as_ptr(), size);
                out.copy_from_slice(&sums[..out.len()]);
            }
        }
    }
}

pub(super) struct Back<'a> {
    rows: &'a [f64],
    stride: usize,
    z: &'a mut [f64],
}

impl Work for Back<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(self) {
        let (rows, stride, size) = (self.rows.as_ptr(), self.stride, self.z.len());
        let z = self.z.as_mut_ptr();
        for block in (0..size.div_ceil(ROWS)).rev() {
            let first = block * ROWS;
            let end = size.min(first + ROWS);
            // SAFETY: features are the caller's promise; entries (i, j) with i, j < size are within `rows`.
            unsafe {
                let mut right = [0.0; ROWS];
                if end < size {
                    let mut starts = [rows.add(first * stride + end); ROWS];
                    for (k, start) in starts.iter_mut().enumerate() {
                        *start = start.add(k * stride);
                    }
                    right = sums::<L>(starts, z.add(end), size - end);
                }
                // Columns within the block: a row waits for one product then, and not for those of all rows below it.
                let mut inverse = [0.0; ROWS];
                for i in first..end {
                    inverse[i - first] = 1.0 / *rows.add(i * stride + i);
                }
                for i in (first..end).rev() {
                    let solved = (*z.add(i) - right[i - first]) * inverse[i - first];
                    *z.add(i) = solved;
                    for k in first..i {
                        let entry = *rows.add(k * stride + i);
                        right[k - first] = L::multiply_add_one(entry, solved, right[k - first]);
                    }
                }
            }
        }
    }
}

pub(super) struct Forward<'a> {
    rows: &'a [f64],
    stride: usize,
    z: &'a mut [f64],
}

impl Work for Forward<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(self) {
        let (rows, stride, size) = (self.rows.as_ptr(), self.stride, self.z.len());
        let z = self.z.as_mut_ptr();
        for first in (0..size).step_by(ROWS) {
            let end = size.min(first + ROWS);
            // SAFETY: features are the caller's promise; entries (i, j) with i, j < size are within `rows`.
            unsafe {
                let (mut left, mut inverse) = ([0.0; ROWS], [0.0; ROWS]);
                for i in first..end {
                    left[i - first] = *z.add(i);
                    inverse[i - first] = 1.0 / *rows.add(i * stride + i);
                }
                for i in first..end {
                    let solved = left[i - first] * inverse[i - first];
                    *z.add(i) = solved;
                    for j in i + 1..end {
                        let entry = *rows.add(i * stride + j);
                        left[j - first] = L::multiply_add_one(-solved, entry, left[j - first]);
                    }
                }
                if end == size {
                    break;
                }
                let mut solved = [0.0; ROWS];
                let mut factors = [L::zero(); ROWS];
                for k in 0..ROWS {
                    solved[k] = -*z.add(first + k);
                    factors[k] = L::broadcast(solved[k]);
                }
                let block = rows.add(first * stride);
                let mut j = end;
                while j + 8 <= size {
                    let mut sum = L::load(z.add(j).cast_const());
                    for (k, factor) in factors.iter().enumerate() {
                        sum = L::load(block.add(k * stride + j)).multiply_add(*factor, sum);
                    }
                    sum.store(z.add(j));
                    j += 8;
                }
                for j in j..size {
                    for (k, &solved) in solved.iter().enumerate() {
                        let entry = *block.add(k * stride + j);
                        *z.add(j) = L::multiply_add_one(solved, entry, *z.add(j));
                    }
                }
            }
        }
    }
}

/// The products of eight rows with x, of `size` numbers each.
///
/// # Safety
/// The processor has the features of `L`; `size` values can be read at each start and at `x`.
#[inline(always)]
unsafe fn sums<L: Lanes>(starts: [*const f64; ROWS], x: *const f64, size: usize) -> [f64; ROWS] {
    // SAFETY: passed on.
    unsafe {
        let mut sums = [L::zero(); ROWS];
        let whole = size / 8 * 8;
        for j in (0..whole).step_by(8) {
            let x = L::load(x.add(j));
            for k in 0..ROWS {
                sums[k] = L::load(starts[k].add(j)).multiply_add(x, sums[k]);
            }
        }
        if whole < size {
            let x = L::load_first(x.add(whole), size - whole);
            for k in 0..ROWS {
                let row = L::load_first(starts[k].add(whole), size - whole);
                sums[k] = row.multiply_add(x, sums[k]);
            }
        }
        // Not `sum_each`, whose order is that of the shuffles of each instruction set.
        let [a, b, c, d, e, f, g, h] = L::transpose(sums);
        let all = a.add(b).add(c.add(d)).add(e.add(f).add(g.add(h)));
        let mut products = [0.0; ROWS];
        all.store(products.as_mut_ptr());
        products
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small integers, ones on the diagonal, and numbers below it that must not be read.
    fn factor(size: usize, stride: usize) -> Vec<f64> {
        let entry = |i: usize, j: usize| match (i, j) {
            (i, j) if i == j => 1.0,
            (i, j) if j > i && j < size => ((3 * i + 5 * j) % 3) as f64 - 1.0,
            _ => f64::NAN,
        };
        (0..size * stride).map(|at| entry(at / stride, at % stride)).collect()
    }

    #[test]
    fn systems_of_every_size_are_solved() {
        for (size, stride) in (0..40).flat_map(|size| [(size, size), (size, size + 5)]) {
            let rows = factor(size, stride);
            // Integers small enough for every sum to be exact.
            let solution: Vec<f64> = (0..size).map(|i| (i % 5) as f64 - 2.0).collect();
            let entry = |i: usize, j: usize| if j < i { 0.0 } else { rows[i * stride + j] };
            let mut z: Vec<f64> =
                (0..size).map(|i| (i..size).map(|j| entry(i, j) * solution[j]).sum()).collect();
            back(&rows, stride, &mut z);
            assert_eq!(z, solution, "{size}");
            let mut z: Vec<f64> =
                (0..size).map(|j| (0..=j).map(|i| entry(i, j) * solution[i]).sum()).collect();
            forward(&rows, stride, &mut z);
            assert_eq!(z, solution, "{size}");
        }
    }

    #[test]
    fn products_of_every_size_are_exact() {
        for (count, size) in (0..20).flat_map(|count| [(count, 0), (count, 3), (count, 29)]) {
            let stride = size + 2;
            let rows: Vec<f64> = (0..count * stride).map(|at| (at % 11) as f64 - 4.0).collect();
            let x: Vec<f64> = (0..size).map(|j| (j % 7) as f64 - 3.0).collect();
            let mut out = vec![f64::NAN; count];
            products(&rows, stride, &x, &mut out);
            for (row, product) in rows.chunks_exact(stride).zip(out) {
                assert_eq!(product, row.iter().zip(&x).map(|(a, b)| a * b).sum::<f64>());
            }
        }
    }

    /// Thirds, whose sums are rounded: every set rounds alike.
    #[test]
    #[cfg(target_arch = "x86_64")]
    fn instruction_sets_agree_to_the_last_bit() {
        use crate::x86::{Set, run_as};
        let size = 37;
        let rows: Vec<f64> = (0..size * size).map(|at| (at % 13) as f64 / 3.0 + 1.0).collect();
        let start: Vec<f64> = (0..size).map(|i| (i % 5) as f64 / 7.0).collect();
        let mut answers = vec![];
        for set in [Set::Avx512, Set::Avx2] {
            let (mut a, mut b, mut c) = (start.clone(), start.clone(), start.clone());
            let ran = [
                run_as(set, Back { rows: &rows, stride: size, z: &mut a }).is_none(),
                run_as(set, Forward { rows: &rows, stride: size, z: &mut b }).is_none(),
                run_as(set, Products { rows: &rows, stride: size, x: &start, out: &mut c })
                    .is_none(),
            ];
            if ran == [true; 3] {
                answers.push((a, b, c));
            }
        }
        assert!(answers.windows(2).all(|pair| pair[0] == pair[1]));
    }
}
