//! The triangular factor of the Gram matrix of the points in use, grown and shrunk by one point at a time.
//!
//! R′R = H with R upper triangular, kept by rows in one square of memory. The right-hand side w = R⁻ᵀb rides along, so
//! that the solution of Hv = b costs one back substitution. Appending a point is one forward substitution; deleting one
//! is a shift of columns and a rotation for each row below; both are O(s²) for s points. Many points at once are
//! factored in blocks, by matrix products.
//! *Reference.* Golub and Van Loan, Matrix Computations, 6.5 (updating a Cholesky factor).

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::{MatMut, Par};
use taut_kernels::vector::{add_scaled, dot, rotate};

#[derive(Clone, Debug, Default)]
pub(crate) struct Factor {
    size: usize,
    /// Row i begins at i·stride; its entries from the diagonal on are used.
    rows: Vec<f64>,
    stride: usize,
    /// R⁻ᵀb.
    right: Vec<f64>,
}

impl Factor {
    fn row(&self, i: usize) -> &[f64] {
        &self.rows[i * self.stride + i..i * self.stride + self.size]
    }

    /// Factors H, s × s and symmetric, of which only the upper triangle is read; false when a pivot falls below
    /// `least` times its diagonal entry.
    pub(crate) fn of(h: Vec<f64>, b: &[f64], least: f64) -> Option<Factor> {
        let size = b.len();
        let diagonal: Vec<f64> = (0..size).map(|i| h[i * size + i]).collect();
        let mut rows = h;
        // A lower triangle by columns is an upper one by rows.
        let matrix = MatMut::from_column_major_slice_mut(&mut rows, size, size);
        let room = cholesky_in_place_scratch::<f64>(size, Par::Seq, Default::default());
        let mut memory = MemBuffer::new(room);
        cholesky_in_place(
            matrix,
            Default::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        )
        .ok()?;
        for (i, &h) in diagonal.iter().enumerate() {
            let pivot = rows[i * size + i];
            if pivot.is_nan() || pivot * pivot <= least * h {
                return None;
            }
        }
        let mut factor = Factor { size, rows, stride: size, right: vec![] };
        factor.right = factor.forward(b);
        Some(factor)
    }

    /// z with R′z = a.
    pub(crate) fn forward(&self, a: &[f64]) -> Vec<f64> {
        let mut z = a.to_vec();
        for i in 0..self.size {
            let row = self.row(i);
            z[i] /= row[0];
            let (head, tail) = z.split_at_mut(i + 1);
            add_scaled(tail, -head[i], &row[1..]);
        }
        z
    }

    /// y with Ry = z.
    pub(crate) fn back(&self, mut z: Vec<f64>) -> Vec<f64> {
        for i in (0..self.size).rev() {
            let row = self.row(i);
            z[i] = (z[i] - dot(&row[1..], &z[i + 1..])) / row[0];
        }
        z
    }

    /// v with Hv = b.
    pub(crate) fn solution(&self) -> Vec<f64> {
        self.back(self.right.clone())
    }

    /// Appends a point with column z = R⁻ᵀh, pivot √(h_jj − |z|²) and entry b of the right-hand side.
    pub(super) fn append(&mut self, z: &[f64], pivot: f64, b: f64) {
        self.grow();
        let s = self.size;
        for (i, &z) in z.iter().enumerate() {
            self.rows[i * self.stride + s] = z;
        }
        self.rows[s * self.stride + s] = pivot;
        self.right.push((b - dot(z, &self.right)) / pivot);
        self.size += 1;
    }

    fn grow(&mut self) {
        if self.size < self.stride {
            return;
        }
        let stride = (self.stride + self.stride / 2).max(self.stride + 16).next_multiple_of(8);
        let mut rows = vec![0.0; stride * stride];
        for i in 0..self.size {
            rows[i * stride + i..i * stride + self.size].copy_from_slice(self.row(i));
        }
        (self.rows, self.stride) = (rows, stride);
    }

    pub(super) fn delete(&mut self, position: usize) {
        let (stride, size) = (self.stride, self.size);
        for i in 0..position {
            self.rows
                .copy_within(i * stride + position + 1..i * stride + size, i * stride + position);
        }
        // The row of the deleted point lives on as a carry: rotated with the next row it clears what that row has
        // below the diagonal, which is its own old diagonal entry, and becomes the row above it.
        let mut carry = self.right.remove(position);
        for i in position..size - 1 {
            let (upper, lower) = self.rows.split_at_mut((i + 1) * stride);
            let a = &mut upper[i * stride + i + 1..i * stride + size];
            let b = &mut lower[i + 1..size];
            let length = a[0].hypot(b[0]);
            let (c, s) = (a[0] / length, b[0] / length);
            rotate(a, b, c, s);
            // Row i is now c·carry + s·row; what is left of the carry stands in the place of row i + 1.
            upper.copy_within(i * stride + i + 1..i * stride + size, i * stride + i);
            let right = self.right[i];
            self.right[i] = c * carry + s * right;
            carry = c * right - s * carry;
        }
        self.size -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(i: usize, j: usize) -> f64 {
        let (a, b) = (i as f64, j as f64);
        1.0 / (1.0 + (a - b).abs()) + if i == j { 1.5 + (3.0 * a).sin() } else { 0.0 }
    }

    fn check(factor: &Factor, points: &[usize]) {
        let v = factor.solution();
        for &i in points {
            let product: f64 = points.iter().zip(&v).map(|(&j, v)| entry(i, j) * v).sum();
            assert!((product - (i as f64).cos()).abs() < 1e-12, "{points:?}");
        }
    }

    fn appended(points: &[usize]) -> Factor {
        let mut factor = Factor::default();
        for (s, &j) in points.iter().enumerate() {
            let column: Vec<f64> = points[..s].iter().map(|&i| entry(i, j)).collect();
            let z = factor.forward(&column);
            let pivot = (entry(j, j) - dot(&z, &z)).sqrt();
            factor.append(&z, pivot, (j as f64).cos());
        }
        factor
    }

    #[test]
    fn appended_deleted_and_factored_at_once_solve_alike() {
        let mut points: Vec<usize> = (0..40).collect();
        let mut factor = appended(&points);
        check(&factor, &points);
        for position in [39, 0, 17, 30, 1, 34] {
            factor.delete(position);
            points.remove(position);
            check(&factor, &points);
        }
        let h = points.iter().flat_map(|&i| points.iter().map(move |&j| entry(i, j))).collect();
        let b: Vec<f64> = points.iter().map(|&i| (i as f64).cos()).collect();
        let mut factor = Factor::of(h, &b, 1e-11).unwrap();
        check(&factor, &points);
        factor.delete(3);
        points.remove(3);
        check(&factor, &points);
        let z = factor.forward(&points.iter().map(|&i| entry(i, 70)).collect::<Vec<_>>());
        factor.append(&z, (entry(70, 70) - dot(&z, &z)).sqrt(), 70f64.cos());
        points.push(70);
        check(&factor, &points);
    }

    #[test]
    fn dependent_points_are_not_factored() {
        assert!(Factor::of(vec![1.0, 1.0, 1.0, 1.0], &[1.0, 1.0], 1e-11).is_none());
    }
}
