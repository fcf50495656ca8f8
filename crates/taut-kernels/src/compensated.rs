//! Images of few points under a linear map, as if calculated with twice the digits.
//!
//! *Idea.* Differences x − c are kept as two terms, products and sums as value and error (Ogita, Rump and Oishi, SIAM J.
//! Sci. Comput. 26(6), 2005, algorithm Dot2); eight points side by side, so that the compiler uses full registers.
//! *Guarantee.* The error of a coordinate of an image is one rounding of it, and about d²·2⁻¹⁰⁴ times |M||x − c|.

#[cfg(target_arch = "x86_64")]
use taut_points::{InstructionSet, instruction_set};

use super::{Center, DoubleDouble};

/// Eight points side by side.
type Eight = [f64; 8];

/// A linear map by rows, r × d, and the center it is taken from.
#[derive(Clone, Copy)]
pub struct Map<'a> {
    /// M.
    pub matrix: &'a [f64],
    /// c.
    pub center: &'a Center,
    /// True if it is square and lower triangular; what is above the diagonal is not read then.
    pub triangular: bool,
}

impl<'a> Map<'a> {
    /// The same with another matrix.
    pub fn with<'b>(&'b self, matrix: &'b [f64]) -> Map<'b> {
        Map { matrix, ..*self }
    }

    /// The number d of coordinates.
    pub fn dim(&self) -> usize {
        self.center.dim()
    }

    /// The number r of rows.
    pub fn rank(&self) -> usize {
        self.matrix.len() / self.dim()
    }

    /// M(x − c) for each row, n × r, and |M(x − c)|² rounded up.
    pub fn images(&self, rows: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let (dim, rank) = (self.dim(), self.rank());
        let count = rows.len() / dim;
        let (mut images, mut squares) = (vec![0.0; count * rank], vec![0.0; count]);
        let (mut high, mut low) = (vec![[0.0; 8]; dim], vec![[0.0; 8]; dim]);
        for (eight, rows) in rows.chunks(8 * dim).enumerate() {
            for (i, row) in rows.chunks_exact(dim).enumerate() {
                for (j, &x) in row.iter().enumerate() {
                    let tail = self.center.low.get(j).copied().unwrap_or(0.0);
                    let difference = DoubleDouble::sum(x, -self.center.high[j]) + (-tail).into();
                    (high[j][i], low[j][i]) = (difference.high, difference.low);
                }
            }
            let here = rows.len() / dim;
            let mut sums = [DoubleDouble::ZERO; 8];
            for a in 0..rank {
                let end = if self.triangular { a + 1 } else { dim };
                let row = &self.matrix[a * dim..a * dim + end];
                let (mut value, mut error) = ([0.0; 8], [0.0; 8]);
                products(row, &high[..end], &low[..end], &mut value, &mut error);
                for i in 0..here {
                    let y = DoubleDouble::sum(value[i], error[i]);
                    images[(eight * 8 + i) * rank + a] = y.high;
                    sums[i] = sums[i] + y.square();
                }
            }
            for i in 0..here {
                squares[eight * 8 + i] = sums[i].round_up();
            }
        }
        (images, squares)
    }
}

/// Σ mⱼ(highⱼ + lowⱼ) for eight points: a value, and what it lacks.
fn products(row: &[f64], high: &[Eight], low: &[Eight], value: &mut Eight, error: &mut Eight) {
    #[cfg(target_arch = "x86_64")]
    if instruction_set() >= InstructionSet::Avx2 {
        // SAFETY: the processor has both features.
        #[allow(unsafe_code)]
        unsafe {
            products_with_fma(row, high, low, value, error)
        };
        return;
    }
    products_body(row, high, low, value, error);
}

/// The same with the multiply-add as an instruction rather than a function call.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn products_with_fma(
    row: &[f64],
    high: &[Eight],
    low: &[Eight],
    value: &mut Eight,
    error: &mut Eight,
) {
    products_body(row, high, low, value, error);
}

#[inline(always)]
fn products_body(row: &[f64], high: &[Eight], low: &[Eight], value: &mut Eight, error: &mut Eight) {
    for ((&m, high), low) in row.iter().zip(high).zip(low) {
        for i in 0..8 {
            let product = m * high[i];
            let of_product = m.mul_add(high[i], -product);
            let sum = value[i] + product;
            let part = sum - value[i];
            let of_sum = (value[i] - (sum - part)) + (product - part);
            value[i] = sum;
            error[i] += m.mul_add(low[i], of_product + of_sum);
        }
    }
}
