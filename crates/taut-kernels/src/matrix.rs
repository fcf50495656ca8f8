//! Products of matrices.
//!
//! *Problem.* C ← C + a·AB for matrices in slices, by rows or by columns.
//! *Idea.* The product of `gemm-f64`, which packs blocks into the caches and picks the instructions of the processor, behind
//! views whose bounds are checked once for each product. The crate is called for `f64` alone: the crates for complex
//! numbers and single precision, and a library of factors on top of them, take longer to compile than all of this crate.
//! *Guarantee.* On one machine and with one set of kernels a product depends on its numbers, shapes and layout alone: the thread that
//! asks for it computes it.
#![allow(unsafe_code)]

use std::ops::Range;

use gemm_f64::gemm::f64::get_gemm_fn;

use crate::lanes::Lanes;
use crate::triangle::{Work, dispatch};

/// Sums of up to so many products are done here, fused where the kernels are: the crate does them one by one, and rounds each product.
const SHORT_TERMS_MAX: usize = 2;

/// A read-only view of a matrix; entry (i, j) stands at i·`row_step` + j·`column_step`.
#[derive(Clone, Copy, Debug)]
pub struct Matrix<'a> {
    values: &'a [f64],
    rows: usize,
    columns: usize,
    row_step: usize,
    column_step: usize,
}

impl<'a> Matrix<'a> {
    /// Views values as a matrix by rows, without gaps.
    ///
    /// # Panics
    /// If there are not rows·columns values.
    #[must_use]
    pub fn from_rows(values: &'a [f64], rows: usize, columns: usize) -> Self {
        assert_eq!(Some(values.len()), rows.checked_mul(columns));
        Matrix { values, rows, columns, row_step: columns, column_step: 1 }
    }

    /// The first `columns` numbers of rows that are `stride` apart; the last row may end after these.
    ///
    /// # Panics
    /// If rows are longer than the stride or than what there is.
    #[must_use]
    pub fn with_stride(values: &'a [f64], rows: usize, columns: usize, stride: usize) -> Self {
        let matrix = Matrix { values, rows, columns, row_step: stride, column_step: 1 };
        assert!(columns <= stride && matrix.is_within());
        matrix
    }

    /// Returns the transpose.
    #[must_use]
    pub fn transpose(self) -> Self {
        Matrix {
            values: self.values,
            rows: self.columns,
            columns: self.rows,
            row_step: self.column_step,
            column_step: self.row_step,
        }
    }

    /// Returns the rows of a range.
    ///
    /// # Panics
    /// If the range is not within the rows.
    #[must_use]
    pub fn row_range(self, range: Range<usize>) -> Self {
        assert!(range.start <= range.end && range.end <= self.rows);
        let values = &self.values[(range.start * self.row_step).min(self.values.len())..];
        Matrix { values, rows: range.len(), ..self }
    }

    /// Returns the columns of a range.
    ///
    /// # Panics
    /// If the range is not within the columns.
    #[must_use]
    pub fn column_range(self, range: Range<usize>) -> Self {
        self.transpose().row_range(range).transpose()
    }

    /// Tests that the last entry is one of the values; then all are.
    fn is_within(&self) -> bool {
        if self.rows == 0 || self.columns == 0 {
            return true;
        }
        let down = (self.rows - 1).checked_mul(self.row_step);
        let along = (self.columns - 1).checked_mul(self.column_step);
        let last = down.and_then(|down| down.checked_add(along?));
        last.is_some_and(|last| last < self.values.len())
    }
}

/// Rows of a matrix that is written, `stride` apart.
#[derive(Debug)]
pub struct MatrixMut<'a> {
    values: &'a mut [f64],
    rows: usize,
    columns: usize,
    stride: usize,
}

impl<'a> MatrixMut<'a> {
    /// Views values as a matrix by rows, without gaps.
    ///
    /// # Panics
    /// If there are not rows·columns values.
    #[must_use]
    pub fn from_rows(values: &'a mut [f64], rows: usize, columns: usize) -> Self {
        assert_eq!(Some(values.len()), rows.checked_mul(columns));
        MatrixMut { values, rows, columns, stride: columns }
    }

    /// The first `columns` numbers of rows that are `stride` apart; the last row may end after these.
    ///
    /// # Panics
    /// If rows are longer than the stride or than what there is.
    #[must_use]
    pub fn with_stride(values: &'a mut [f64], rows: usize, columns: usize, stride: usize) -> Self {
        let target = MatrixMut { values, rows, columns, stride };
        assert!(columns <= stride && target.view().is_within());
        target
    }

    /// Returns the columns from `first` on.
    ///
    /// # Panics
    /// If there are not so many columns.
    #[must_use]
    pub fn columns_from(self, first: usize) -> Self {
        assert!(first <= self.columns);
        let first_value = first.min(self.values.len());
        MatrixMut { values: &mut self.values[first_value..], columns: self.columns - first, ..self }
    }

    fn view(&self) -> Matrix<'_> {
        Matrix {
            values: self.values,
            rows: self.rows,
            columns: self.columns,
            row_step: self.stride,
            column_step: 1,
        }
    }
}

/// C ← AB with A of m×k, B of k×n and the target C of m×n entries, in m·n·k multiplications.
///
/// # Panics
/// If the shapes do not fit.
pub fn set_product(target: MatrixMut<'_>, left: Matrix<'_>, right: Matrix<'_>) {
    product(target, false, 1.0, left, right);
}

/// C ← C + a·AB, with shapes and cost as in [`set_product`].
///
/// # Panics
/// If the shapes do not fit.
pub fn add_product(target: MatrixMut<'_>, a: f64, left: Matrix<'_>, right: Matrix<'_>) {
    product(target, true, a, left, right);
}

fn product(target: MatrixMut<'_>, adds: bool, a: f64, left: Matrix<'_>, right: Matrix<'_>) {
    assert_eq!((left.rows, right.columns), (target.rows, target.columns));
    assert_eq!(left.columns, right.rows);
    assert!(target.view().is_within() && left.is_within() && right.is_within());
    if target.rows == 0 || target.columns == 0 {
        return;
    }
    if left.columns <= SHORT_TERMS_MAX {
        return dispatch(ShortSums { target, adds, a, left, right });
    }
    // The crate wants the target by columns: C′ = B′A′. A step that is used is less than the length of its slice; one that is not is
    // multiplied by zero.
    let step = |step: usize| step as isize;
    // SAFETY: all entries of the three are within their slices, and the target is borrowed exclusively; the function is one for this
    // processor.
    unsafe {
        get_gemm_fn()(
            target.columns,
            target.rows,
            left.columns,
            target.values.as_mut_ptr(),
            step(target.stride),
            1,
            adds,
            right.values.as_ptr(),
            step(right.row_step),
            step(right.column_step),
            left.values.as_ptr(),
            step(left.row_step),
            step(left.column_step),
            1.0,
            a,
            false,
            false,
            false,
            gemm_common::Parallelism::None,
        );
    }
}

struct ShortSums<'a> {
    target: MatrixMut<'a>,
    adds: bool,
    a: f64,
    left: Matrix<'a>,
    right: Matrix<'a>,
}

impl Work for ShortSums<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(self) {
        let ShortSums { target, adds, a, left, right } = self;
        for i in 0..target.rows {
            let mut factors = [0.0; SHORT_TERMS_MAX];
            for (k, factor) in factors[..left.columns].iter_mut().enumerate() {
                *factor = a * left.values[i * left.row_step + k * left.column_step];
            }
            let row = &mut target.values[i * target.stride..][..target.columns];
            for (j, entry) in row.iter_mut().enumerate() {
                let mut sum = if adds { *entry } else { 0.0 };
                for (k, &factor) in factors[..left.columns].iter().enumerate() {
                    let value = right.values[k * right.row_step + j * right.column_step];
                    // SAFETY: features are the caller's promise.
                    sum = unsafe { L::multiply_add_one(factor, value, sum) };
                }
                *entry = sum;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small integers, so that every sum is exact.
    fn integers(count: usize, seed: usize) -> Vec<f64> {
        (0..count).map(|at| ((at * 7 + seed * 3) % 11) as f64 - 5.0).collect()
    }

    fn entry(matrix: &Matrix<'_>, i: usize, j: usize) -> f64 {
        matrix.values[i * matrix.row_step + j * matrix.column_step]
    }

    fn expected(left: Matrix<'_>, right: Matrix<'_>, i: usize, j: usize) -> f64 {
        (0..left.columns).map(|k| entry(&left, i, k) * entry(&right, k, j)).sum()
    }

    #[test]
    fn products_of_every_layout_are_exact() {
        let sizes = [0, 1, 2, 3, 7, 17, 33, 70];
        for (m, n, k) in sizes
            .iter()
            .flat_map(|&m| sizes.iter().map(move |&n| (m, n)))
            .flat_map(|(m, n)| [0, 1, 2, 5, 40, 129].map(|k| (m, n, k)))
        {
            let (a, b) = (integers(m * k, 1), integers(k * n, 2));
            for (by_columns, right_by_columns) in
                [(false, false), (false, true), (true, false), (true, true)]
            {
                let left = if by_columns {
                    Matrix::from_rows(&a, k, m).transpose()
                } else {
                    Matrix::from_rows(&a, m, k)
                };
                let right = if right_by_columns {
                    Matrix::from_rows(&b, n, k).transpose()
                } else {
                    Matrix::from_rows(&b, k, n)
                };
                let mut set = vec![f64::NAN; m * n];
                set_product(MatrixMut::from_rows(&mut set, m, n), left, right);
                let mut added = integers(m * n, 3);
                add_product(MatrixMut::from_rows(&mut added, m, n), -2.0, left, right);
                let before = integers(m * n, 3);
                for (at, (set, added)) in set.into_iter().zip(added).enumerate() {
                    let product = expected(left, right, at / n, at % n);
                    assert_eq!((set, added), (product, before[at] - 2.0 * product), "{m} {n} {k}");
                }
            }
        }
    }

    #[test]
    fn parts_are_multiplied_and_what_is_beside_them_is_left() {
        let (a, b) = (integers(20 * 9, 4), integers(9 * 30, 5));
        let left = Matrix::from_rows(&a, 20, 9).row_range(3..14).column_range(2..7);
        let right = Matrix::from_rows(&b, 9, 30).row_range(1..6).column_range(10..28);
        // Eleven rows of eighteen numbers, 25 apart, behind two others.
        let before = integers(2 + 10 * 25 + 18, 6);
        let mut values = before.clone();
        add_product(MatrixMut::with_stride(&mut values[2..], 11, 18, 25), 1.0, left, right);
        for (at, (&value, &before)) in values.iter().zip(&before).enumerate() {
            let (i, j) = (at.wrapping_sub(2) / 25, at.wrapping_sub(2) % 25);
            let is_target = at >= 2 && j < 18;
            let added = if is_target { expected(left, right, i, j) } else { 0.0 };
            assert_eq!(value, before + added, "{at}");
        }
        let mut values = vec![1.0; 11 * 20];
        let target = MatrixMut::from_rows(&mut values, 11, 20).columns_from(2);
        set_product(target, left, right);
        for (at, value) in values.into_iter().enumerate() {
            let (i, j) = (at / 20, at % 20);
            assert_eq!(value, if j < 2 { 1.0 } else { expected(left, right, i, j - 2) });
        }
    }

    /// More rows, columns and terms than the crate takes at once.
    #[test]
    fn large_products_are_exact() {
        let (m, n, k) = (290, 270, 530);
        let (a, b) = (integers(m * k, 7), integers(n * k, 8));
        let (left, right) = (Matrix::from_rows(&a, m, k), Matrix::from_rows(&b, n, k).transpose());
        let mut found = vec![f64::NAN; m * n];
        set_product(MatrixMut::from_rows(&mut found, m, n), left, right);
        let is_exact = |(at, &value): (usize, &f64)| value == expected(left, right, at / n, at % n);
        assert!(found.iter().enumerate().all(is_exact));
        let no_column = Matrix::from_rows(&[], 1, 0);
        set_product(
            MatrixMut::with_stride(&mut [], 2, 0, 8),
            Matrix::from_rows(&[0.0; 2], 2, 1),
            no_column,
        );
    }

    #[test]
    #[should_panic(expected = "left == right")]
    fn shapes_that_do_not_fit_are_refused() {
        let values = [0.0; 12];
        let (left, right) = (Matrix::from_rows(&values, 3, 4), Matrix::from_rows(&values, 3, 4));
        set_product(MatrixMut::from_rows(&mut [0.0; 12], 3, 4), left, right);
    }

    #[test]
    #[should_panic(expected = "is_within")]
    fn rows_beyond_the_values_are_refused() {
        let _ = MatrixMut::with_stride(&mut [0.0; 20], 3, 5, 8);
    }
}
