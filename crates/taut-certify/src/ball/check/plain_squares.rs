//! Squared distances of rows to a center in plain arithmetic, by vector instructions.
//!
//! *Idea.* Two registers of partial sums, whatever their width, hide the latency of the additions. Which products are fused
//! with their sums depends on the processor; the caller's bound holds for all.

use pulp::{Simd, WithSimd};
use taut_points::{Scalar, ScalarKind, vectors};

/// Writes Σ ((pⱼ − cⱼ)·factor)² for each row to `squares`, of which there are as many as rows; the factor is a power of two. A
/// row begins with the d coordinates of p. `wide` is room for the rows in double precision.
pub(super) fn plain_squares<T: Scalar>(
    values: &[T],
    center: &[f64],
    factor: f64,
    wide: &mut Vec<f64>,
    squares: &mut [f64],
) {
    let rows = match T::KIND {
        ScalarKind::F64 => bytemuck::cast_slice(values),
        ScalarKind::F32 => {
            wide.clear();
            wide.extend(values.iter().map(|&v| -> f64 { v.into() }));
            wide.as_slice()
        }
    };
    let stride = rows.len() / squares.len().max(1);
    if stride > 0 {
        vectors().dispatch(PlainSquares { rows, stride, center, factor, squares });
    }
}

struct PlainSquares<'a> {
    rows: &'a [f64],
    stride: usize,
    center: &'a [f64],
    factor: f64,
    squares: &'a mut [f64],
}

impl WithSimd for PlainSquares<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        // Rows shorter than a register.
        let rows = self.rows.chunks_exact(self.stride);
        let term = |x: f64, c: f64| ((x - c) * self.factor) * ((x - c) * self.factor);
        match *self.center {
            [a, b] => {
                for (row, square) in rows.zip(self.squares) {
                    *square = term(row[0], a) + term(row[1], b);
                }
                return;
            }
            [a, b, c] => {
                for (row, square) in rows.zip(self.squares) {
                    *square = term(row[0], a) + term(row[1], b) + term(row[2], c);
                }
                return;
            }
            _ => {}
        }
        let factor = simd.splat_f64s(self.factor);
        let (center, center_rest) = S::as_simd_f64s(self.center);
        let (center_pairs, center_last) = center.as_chunks::<2>();
        for (row, square) in rows.zip(self.squares) {
            let (x, rest) = S::as_simd_f64s(&row[..self.center.len()]);
            let (pairs, last) = x.as_chunks::<2>();
            let (mut even, mut odd) = (simd.splat_f64s(0.0), simd.splat_f64s(0.0));
            for (x, c) in pairs.iter().zip(center_pairs) {
                let first = simd.mul_f64s(simd.sub_f64s(x[0], c[0]), factor);
                even = simd.mul_add_e_f64s(first, first, even);
                let second = simd.mul_f64s(simd.sub_f64s(x[1], c[1]), factor);
                odd = simd.mul_add_e_f64s(second, second, odd);
            }
            if let ([x], [c]) = (last, center_last) {
                let only = simd.mul_f64s(simd.sub_f64s(*x, *c), factor);
                even = simd.mul_add_e_f64s(only, only, even);
            }
            if !rest.is_empty() {
                let (x, c) = (simd.partial_load_f64s(rest), simd.partial_load_f64s(center_rest));
                let only = simd.mul_f64s(simd.sub_f64s(x, c), factor);
                odd = simd.mul_add_e_f64s(only, only, odd);
            }
            *square = simd.reduce_sum_f64s(simd.add_f64s(even, odd));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_are_those_of_plain_loops() {
        for dim in 1..40 {
            for stride in [dim, dim + 1] {
                let values: Vec<f64> = (0..7 * stride).map(|i| f64::from(i as u32 % 11)).collect();
                let narrow: Vec<f32> = values.iter().map(|&v| v as f32).collect();
                let center: Vec<f64> = (0..dim).map(|j| j as f64 / 4.0).collect();
                let (mut squares, mut wide, mut of_narrow) = ([0.0; 7], vec![], [0.0; 7]);
                plain_squares(&values, &center, 0.5, &mut wide, &mut squares);
                plain_squares(&narrow, &center, 0.5, &mut wide, &mut of_narrow);
                // Few bits: every sum is exact, in whatever order.
                for (row, square) in values.chunks_exact(stride).zip(squares) {
                    let terms = row.iter().zip(&center).map(|(x, c)| ((x - c) * 0.5).powi(2));
                    assert_eq!(square, terms.sum::<f64>(), "dimension {dim}");
                }
                assert_eq!(squares, of_narrow);
            }
        }
    }

    /// The bound of the caller, tried: squares of rows with full mantissas against doubled precision.
    #[test]
    fn squares_are_as_near_as_the_bound_says() {
        use crate::arithmetic::{DoubleDouble, Field, Ring, U};
        let mut state = 5u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        for dim in 1..200 {
            let values: Vec<f64> = (0..5 * dim).map(|_| next()).collect();
            let center: Vec<f64> = (0..dim).map(|_| next()).collect();
            let (mut squares, mut wide) = ([0.0; 5], vec![]);
            plain_squares(&values, &center, 4.0, &mut wide, &mut squares);
            let kappa = (dim / 2 + 32) as f64 * U;
            for (row, square) in values.chunks_exact(dim).zip(squares) {
                let exact = row.iter().zip(&center).fold(DoubleDouble::of(0.0), |sum, (&x, &c)| {
                    let difference = DoubleDouble::of(x).minus(&DoubleDouble::of(c));
                    sum.plus(&difference.times(&difference))
                });
                let exact = 16.0 * exact.rounded();
                assert!((square / exact - 1.0).abs() <= 2.0 * kappa, "{square} {exact}");
            }
        }
    }
}
