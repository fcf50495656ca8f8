//! Eight lanes of `f64`, and the kernels written once over them.
#![allow(unsafe_code)]

use taut_points::Scalar;

use super::Center;

/// Eight `f64` values worked on together.
pub(super) trait Lanes: Copy {
    /// How many values of this type fit in the vector registers, for the choice of how much to keep in them.
    const IN_REGISTERS: usize;
    /// All zero.
    ///
    /// # Safety
    /// As every method here: the processor has the features of the implementation.
    unsafe fn zero() -> Self;
    /// The eight values at `from`, widened.
    ///
    /// # Safety
    /// Eight values must be readable at `from`.
    unsafe fn load<T: Scalar>(from: *const T) -> Self;
    /// The `count` < 8 values at `from`, widened, then zeros.
    ///
    /// # Safety
    /// `count` is below 8, and as many values must be readable at `from`; nothing beyond is read.
    unsafe fn load_first<T: Scalar>(from: *const T, count: usize) -> Self;
    /// self − other.
    ///
    /// # Safety
    /// See [`zero`](Self::zero).
    unsafe fn sub(self, other: Self) -> Self;
    /// self + other.
    ///
    /// # Safety
    /// See [`zero`](Self::zero).
    unsafe fn add(self, other: Self) -> Self;
    /// sum + self².
    ///
    /// # Safety
    /// See [`zero`](Self::zero).
    unsafe fn square_add(self, sum: Self) -> Self;
    /// The sum of the eight lanes of each of eight vectors.
    ///
    /// # Safety
    /// See [`zero`](Self::zero).
    unsafe fn sum_each(rows: [Self; 8]) -> [f64; 8];
    /// Eight times the same value.
    ///
    /// # Safety
    /// See [`zero`](Self::zero).
    unsafe fn broadcast(value: f64) -> Self;
    /// sum + self·factor.
    ///
    /// # Safety
    /// See [`zero`](Self::zero).
    unsafe fn multiply_add(self, factor: Self, sum: Self) -> Self;
    /// sum + a·b, rounded as by [`multiply_add`](Self::multiply_add).
    ///
    /// # Safety
    /// See [`zero`](Self::zero).
    unsafe fn multiply_add_one(a: f64, b: f64, sum: f64) -> f64;
    /// Writes the eight values to `to`.
    ///
    /// # Safety
    /// Eight values must be writable at `to`.
    unsafe fn store(self, to: *mut f64);
    /// Asks for the memory at `at`, which is not read, to be brought near.
    ///
    /// # Safety
    /// See [`zero`](Self::zero); `at` may point anywhere.
    unsafe fn prefetch(at: *const u8);
    /// Bit i says whether lane i is above that of `bound`; never where either is not a number.
    ///
    /// # Safety
    /// See [`zero`](Self::zero).
    unsafe fn bits_above(self, bound: Self) -> u32;
    /// The even lanes of sixteen values in two vectors, and the odd ones.
    ///
    /// # Safety
    /// See [`zero`](Self::zero).
    unsafe fn split(first: Self, second: Self) -> (Self, Self);
    /// The first values at eight places, and the second ones.
    ///
    /// # Safety
    /// Two values must be readable at each place.
    unsafe fn pairs(starts: [*const f64; 8]) -> (Self, Self);
    /// Lane i of result j is lane j of row i.
    ///
    /// # Safety
    /// See [`zero`](Self::zero).
    unsafe fn transpose(rows: [Self; 8]) -> [Self; 8];
}

/// x − c for eight coordinates from `j` on, or for the `count` that are left.
#[inline(always)]
unsafe fn difference<L: Lanes, T: Scalar, const TWO_TERMS: bool>(
    x: *const T,
    center: &Center,
    j: usize,
    count: usize,
) -> L {
    // SAFETY: the caller keeps j + count within the row and the center.
    unsafe {
        let load = |from: *const f64| {
            if count == 8 { L::load(from.add(j)) } else { L::load_first(from.add(j), count) }
        };
        let x = if count == 8 { L::load(x.add(j)) } else { L::load_first(x.add(j), count) };
        let once = x.sub(load(center.high.as_ptr()));
        if TWO_TERMS { once.sub(load(center.low.as_ptr())) } else { once }
    }
}

/// The squared distances of up to eight rows; a missing row repeats the last, so that all are summed alike.
///
/// # Safety
/// The processor has the features of `L`; `values` holds `rows` ≥ 1 rows of `stride` ≥ `center.dim()` values.
#[inline(always)]
pub(super) unsafe fn eight_rows<L: Lanes, T: Scalar>(
    values: &[T],
    rows: usize,
    stride: usize,
    center: &Center,
) -> [f64; 8] {
    // SAFETY: passed on.
    unsafe {
        if center.low.is_empty() {
            eight_rows_of::<L, T, false>(values, rows, stride, center)
        } else {
            eight_rows_of::<L, T, true>(values, rows, stride, center)
        }
    }
}

#[inline(always)]
unsafe fn eight_rows_of<L: Lanes, T: Scalar, const TWO_TERMS: bool>(
    values: &[T],
    rows: usize,
    stride: usize,
    center: &Center,
) -> [f64; 8] {
    let dim = center.dim();
    debug_assert!(rows >= 1 && values.len() >= rows * stride);
    // SAFETY: each start is that of a row within `values`; coordinates j .. j + count stay below dim ≤ stride.
    unsafe {
        let starts: [*const T; 8] =
            std::array::from_fn(|i| values.as_ptr().add(i.min(rows - 1) * stride));
        let mut sums = [L::zero(); 8];
        let whole = dim / 8 * 8;
        for j in (0..whole).step_by(8) {
            for i in 0..8 {
                sums[i] =
                    difference::<L, T, TWO_TERMS>(starts[i], center, j, 8).square_add(sums[i]);
            }
        }
        if whole < dim {
            for i in 0..8 {
                sums[i] = difference::<L, T, TWO_TERMS>(starts[i], center, whole, dim - whole)
                    .square_add(sums[i]);
            }
        }
        L::sum_each(sums)
    }
}

/// The squared distance of one long row: four accumulators hide the latency of the multiply-add.
///
/// # Safety
/// The processor has the features of `L`; `row` has `center.dim()` values.
#[inline(always)]
pub(super) unsafe fn one_row<L: Lanes, T: Scalar>(row: &[T], center: &Center) -> f64 {
    // SAFETY: passed on.
    unsafe {
        if center.low.is_empty() {
            one_row_of::<L, T, false>(row, center)
        } else {
            one_row_of::<L, T, true>(row, center)
        }
    }
}

#[inline(always)]
unsafe fn one_row_of<L: Lanes, T: Scalar, const TWO_TERMS: bool>(
    row: &[T],
    center: &Center,
) -> f64 {
    let dim = row.len();
    let x = row.as_ptr();
    // SAFETY: coordinates j .. j + count stay below dim, the length of the row and of both terms of the center.
    unsafe {
        let mut sums = [L::zero(); 4];
        let mut j = 0;
        while j + 32 <= dim {
            for (k, sum) in sums.iter_mut().enumerate() {
                *sum = difference::<L, T, TWO_TERMS>(x, center, j + 8 * k, 8).square_add(*sum);
            }
            j += 32;
        }
        let mut k = 0;
        while j < dim {
            let count = (dim - j).min(8);
            sums[k] = difference::<L, T, TWO_TERMS>(x, center, j, count).square_add(sums[k]);
            j += count;
            k += 1;
        }
        let all = sums[0].add(sums[1]).add(sums[2].add(sums[3]));
        let zero = L::zero();
        L::sum_each([all, zero, zero, zero, zero, zero, zero, zero])[0]
    }
}

/// Rows of exactly D coordinates without gaps, one after the other.
#[inline(always)]
pub(super) fn one_short_row<const D: usize, T: Scalar>(
    values: &[T],
    center: &Center,
    out: &mut [f64],
) {
    let c: [f64; D] = std::array::from_fn(|j| center.high[j]);
    for (row, out) in values.as_chunks::<D>().0.iter().zip(out) {
        let mut sum = 0.0;
        for j in 0..D {
            let difference = row[j].into() - c[j];
            sum += difference * difference;
        }
        *out = sum;
    }
}
