//! Squared distances from the center of a ball of a kernel, for rows that were not there when it was found.

use super::distance::{Approximate, kernel_of_itself, of_kernel, squared_distance};
use super::{Kernel, KernelBall};

/// The center of a ball of a kernel with the rows of its support, in plain double precision.
///
/// Not for a proof: [`Solution::check`](crate::Solution::check) bounds what is rounded here.
#[derive(Clone, Debug)]
pub struct KernelCenter<'a> {
    ball: &'a KernelBall,
    dim: usize,
    /// The rows of the support, one after the other.
    rows: &'a [f64],
    /// K(x, x) of the support, where the kernel needs it.
    of_support: Vec<Approximate>,
    /// D, the multipliers being taken divided by their sum.
    spread: f64,
    sum: f64,
}

impl<'a> KernelCenter<'a> {
    /// `rows` are those of the support, of `dim` numbers each, in its order. None if their number is another one, or a row of a
    /// precomputed kernel has no column for one of the support.
    pub fn of(ball: &'a KernelBall, rows: &'a [f64], dim: usize) -> Option<Self> {
        let count = ball.support.len();
        let has_columns =
            ball.kernel != Kernel::Precomputed || ball.support.iter().all(|&id| id < dim as u64);
        if ball.multipliers.len() != count || rows.len() != count * dim || dim == 0 || !has_columns
        {
            return None;
        }
        let of_row = |(row, &id): (&[f64], &u64)| match ball.kernel {
            Kernel::Precomputed => Approximate { value: row[id as usize], error: 0.0 },
            kernel => kernel_of_itself(kernel, row),
        };
        let of_support = rows.chunks_exact(dim).zip(&ball.support).map(of_row).collect();
        let sum = ball.multipliers.iter().sum();
        let mut center = KernelCenter { ball, dim, rows, of_support, spread: 0.0, sum };
        let mean = |i: usize| {
            center.mean_distance(&rows[i * dim..(i + 1) * dim], center.of_support[i].value)
        };
        let weighted = (0..count).map(|i| ball.multipliers[i] * mean(i)).sum::<f64>();
        center.spread = weighted / sum / 2.0;
        Some(center)
    }

    /// D, which is R² of the smallest ball around the support where that is on its border.
    pub fn spread(&self) -> f64 {
        self.spread
    }

    /// |φ(x) − c|² for a row x of `dim` numbers; `own` is K(x, x), which only a precomputed kernel needs.
    ///
    /// # Panics
    /// When `x` has another number of coordinates.
    pub fn squared_distance(&self, x: &[f64], own: f64) -> f64 {
        assert_eq!(x.len(), self.dim);
        self.mean_distance(x, own) - self.spread
    }

    fn mean_distance(&self, x: &[f64], own_value: f64) -> f64 {
        let kernel = self.ball.kernel;
        let of_x = match kernel {
            Kernel::Precomputed => Approximate { value: own_value, error: 0.0 },
            kernel => kernel_of_itself(kernel, x),
        };
        let rows = self.rows.chunks_exact(self.dim).zip(&self.of_support);
        let distance = |((y, &of_y), &id): ((&[f64], &Approximate), &u64)| match kernel {
            Kernel::Precomputed => {
                of_kernel(of_x, of_y, Approximate { value: x[id as usize], error: 0.0 }).value
            }
            kernel => squared_distance(kernel, (x, of_x), (y, of_y)).value,
        };
        let distances = rows.zip(&self.ball.support).map(distance);
        self.ball.multipliers.iter().zip(distances).map(|(l, rho)| l * rho).sum::<f64>() / self.sum
    }
}
