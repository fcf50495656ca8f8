//! The triangular factor of a positive definite matrix, most often the Gram matrix of the points in use, grown and shrunk by one point at a
//! time or grown by several.
//!
//! R′R = H with R upper triangular, kept by rows in one square of memory. Right-hand sides w = R⁻ᵀb ride along, so
//! that the solution of Hv = b costs one back substitution. Appending a point is one forward substitution; deleting one
//! is a shift of columns and a rotation for each row below; both are O(s²) for s points. Many points at once are
//! factored in blocks, by matrix products on all threads: tiles are fixed, so that the factor does not depend on these.
//! *Reference.* Golub and Van Loan, Matrix Computations, 6.5 (updating a Cholesky factor).

use taut_kernels::matrix::{Matrix, MatrixMut, add_product};
use taut_kernels::substitution;
use taut_kernels::vector::{add_combination, dot, rotate};
use taut_points::parallel::ParallelSlice;

/// Rows of R that are made at once.
const BLOCK_ROWS: usize = 96;
/// Rows of R that are made one after the other; more of them are halved, and the second half is reduced by a product.
const PANEL_ROWS: usize = 16;
/// One task takes a block of rows of R from so many rows of what is left.
const TILE_ROWS: usize = 64;

/// R, with `SIDES` right-hand sides.
#[derive(Clone, Debug)]
pub(crate) struct Cholesky<const SIDES: usize> {
    size: usize,
    /// Row i begins at i·stride; its entries from the diagonal on are used.
    rows: Vec<f64>,
    stride: usize,
    /// R⁻ᵀb of each.
    right: [Vec<f64>; SIDES],
}

impl<const SIDES: usize> Default for Cholesky<SIDES> {
    fn default() -> Self {
        let right = std::array::from_fn(|_| vec![]);
        Cholesky { size: 0, rows: vec![], stride: 0, right }
    }
}

impl<const SIDES: usize> Cholesky<SIDES> {
    /// Forgets all points.
    pub(crate) fn clear(&mut self) {
        self.size = 0;
        self.right.iter_mut().for_each(Vec::clear);
    }

    /// Row i from the diagonal on.
    pub(crate) fn row(&self, i: usize) -> &[f64] {
        &self.rows[i * self.stride + i..i * self.stride + self.size]
    }

    /// R⁻ᵀb of a right-hand side.
    pub(crate) fn right(&self, side: usize) -> &[f64] {
        &self.right[side]
    }

    /// Replaces R⁻ᵀb of a right-hand side.
    pub(crate) fn set_right(&mut self, side: usize, right: Vec<f64>) {
        debug_assert_eq!(right.len(), self.size);
        self.right[side] = right;
    }

    /// Factors H, s × s and symmetric, of which only the upper triangle is read; `None` when the square of a pivot is at
    /// most `least` times its diagonal entry.
    pub(crate) fn of(h: Vec<f64>, b: [&[f64]; SIDES], least: f64) -> Option<Self> {
        let size = b[0].len();
        let diagonal: Vec<f64> = (0..size).map(|i| h[i * size + i]).collect();
        let mut rows = h;
        for first in (0..size).step_by(BLOCK_ROWS) {
            factor_block(&mut rows, size, first, BLOCK_ROWS)?;
        }
        for (i, &h) in diagonal.iter().enumerate() {
            let pivot = rows[i * size + i];
            if pivot.is_nan() || pivot * pivot <= least * h {
                return None;
            }
        }
        let mut factor = Cholesky { size, rows, stride: size, ..Self::default() };
        factor.right = b.map(|b| factor.forward(b));
        Some(factor)
    }

    /// z with R′z = a.
    pub(crate) fn forward(&self, a: &[f64]) -> Vec<f64> {
        let mut z = a.to_vec();
        self.forward_in_place(&mut z);
        z
    }

    /// a ← R⁻ᵀa.
    pub(crate) fn forward_in_place(&self, a: &mut [f64]) {
        debug_assert_eq!(a.len(), self.size);
        substitution::forward(&self.rows, self.stride, a);
    }

    /// Solves R′z = a for several a at once, the rows of `z`, block by block of the rows of R.
    fn forward_all(&self, z: &mut [f64]) {
        let (s, stride) = (self.size, self.stride);
        let count = z.len() / s;
        let all = Matrix::from_rows(&self.rows, stride, stride);
        for first in (0..s).step_by(BLOCK_ROWS) {
            let end = s.min(first + BLOCK_ROWS);
            let mut solved = Vec::with_capacity(count * (end - first));
            for z in z.chunks_exact_mut(s) {
                let z = &mut z[first..end];
                substitution::forward(&self.rows[first * stride + first..], stride, z);
                solved.extend_from_slice(z);
            }
            let solved = Matrix::from_rows(&solved, count, end - first);
            let target = MatrixMut::from_rows(z, count, s).columns_from(end);
            add_product(target, -1.0, solved, all.row_range(first..end).column_range(end..s));
        }
    }

    /// y with Ry = z.
    pub(crate) fn back(&self, mut z: Vec<f64>) -> Vec<f64> {
        debug_assert_eq!(z.len(), self.size);
        substitution::back(&self.rows, self.stride, &mut z);
        z
    }

    /// |Rd|² = d′Hd.
    pub(crate) fn square(&self, d: &[f64]) -> f64 {
        (0..self.size).map(|i| dot(self.row(i), &d[i..]).powi(2)).sum()
    }

    /// Appends a point with column z = R⁻ᵀh, pivot √(h_jj − |z|²) and entries b of the right-hand sides.
    pub(crate) fn append(&mut self, z: &[f64], pivot: f64, b: [f64; SIDES]) {
        self.grow(1);
        let s = self.size;
        for (i, &z) in z.iter().enumerate() {
            self.rows[i * self.stride + s] = z;
        }
        self.rows[s * self.stride + s] = pivot;
        for (right, b) in self.right.iter_mut().zip(b) {
            right.push((b - dot(z, right)) / pivot);
        }
        self.size += 1;
    }

    /// Makes room for more points.
    fn grow(&mut self, more: usize) {
        if self.size + more <= self.stride {
            return;
        }
        // A little at a time: most factors of many points are made at once, and gain few.
        let spare = (self.stride / 8).max(16).max(more);
        self.widen((self.stride + spare).next_multiple_of(8));
    }

    /// Makes room for so many points in all.
    pub(crate) fn reserve(&mut self, count: usize) {
        if count > self.stride {
            self.widen(count.next_multiple_of(8));
        }
    }

    fn widen(&mut self, stride: usize) {
        let mut rows = vec![0.0; stride * stride];
        for i in 0..self.size {
            rows[i * stride + i..i * stride + self.size].copy_from_slice(self.row(i));
        }
        (self.rows, self.stride) = (rows, stride);
    }

    pub(crate) fn delete(&mut self, position: usize) {
        let (stride, size) = (self.stride, self.size);
        for i in 0..position {
            self.rows
                .copy_within(i * stride + position + 1..i * stride + size, i * stride + position);
        }
        // The row of the deleted point lives on as a carry: rotated with the next row it clears what that row has
        // below the diagonal, which is its own old diagonal entry, and becomes the row above it.
        let mut carries: [f64; SIDES] =
            std::array::from_fn(|side| self.right[side].remove(position));
        for i in position..size - 1 {
            let (upper, lower) = self.rows.split_at_mut((i + 1) * stride);
            let a = &mut upper[i * stride + i + 1..i * stride + size];
            let b = &mut lower[i + 1..size];
            let length = a[0].hypot(b[0]);
            let (c, s) = (a[0] / length, b[0] / length);
            rotate(a, b, c, s);
            // Row i is now c·carry + s·row; what is left of the carry stands in the place of row i + 1.
            upper.copy_within(i * stride + i + 1..i * stride + size, i * stride + i);
            for (right, carry) in self.right.iter_mut().zip(&mut carries) {
                let next = right[i];
                right[i] = c * *carry + s * next;
                *carry = c * next - s * *carry;
            }
        }
        self.size -= 1;
    }
}

impl Cholesky<1> {
    /// v with Hv = b.
    pub(crate) fn solution(&self) -> Vec<f64> {
        let mut v = vec![];
        self.solution_into(&mut v);
        v
    }

    /// Writes v with Hv = b.
    pub(crate) fn solution_into(&self, v: &mut Vec<f64>) {
        v.clone_from(&self.right[0]);
        substitution::back(&self.rows, self.stride, v);
    }

    /// Appends several points at once, whose rows of H over the points in use are in `z`, over each other in `square`; returns
    /// false, with all as it was, if the square of a pivot is at most `least` times its entry.
    pub(crate) fn append_all(
        &mut self,
        mut z: Vec<f64>,
        mut square: Vec<f64>,
        b: &[f64],
        least: f64,
    ) -> bool {
        let (s, count) = (self.size, b.len());
        debug_assert!(s > 0 && count > 0);
        z.par_chunks_mut(TILE_ROWS * s).for_each(|z| self.forward_all(z));
        let diagonal: Vec<f64> = (0..count).map(|i| square[i * count + i]).collect();
        let explained = Matrix::from_rows(&z, count, s);
        let target = MatrixMut::from_rows(&mut square, count, count);
        add_product(target, -1.0, explained, explained.transpose());
        if factor_block(&mut square, count, 0, count).is_none() {
            return false;
        }
        let pivots = (0..count).map(|i| square[i * count + i]);
        if pivots.zip(&diagonal).any(|(pivot, h)| pivot.is_nan() || pivot * pivot <= least * h) {
            return false;
        }
        self.grow(count);
        for (i, row) in self.rows.chunks_exact_mut(self.stride).take(s).enumerate() {
            row[s..s + count].iter_mut().zip(z[i..].iter().step_by(s)).for_each(|(r, z)| *r = *z);
        }
        for (i, row) in square.chunks_exact(count).enumerate() {
            self.rows[(s + i) * self.stride + s + i..][..count - i].copy_from_slice(&row[i..]);
        }
        let mut right: Vec<f64> =
            b.iter().zip(z.chunks_exact(s)).map(|(b, z)| b - dot(z, &self.right[0])).collect();
        substitution::forward(&square, count, &mut right);
        self.right[0].extend(right);
        self.size += count;
        true
    }
}

/// Makes `most` rows of R out of those of H from `first` on, less what the rows of R before them explain, and takes from what
/// is left what these explain; `None` where H is not positive definite.
fn factor_block(rows: &mut [f64], size: usize, first: usize, most: usize) -> Option<()> {
    let end = size.min(first + most);
    let count = end - first;
    let (block, rest) = rows[first * size..].split_at_mut(count * size);
    factor_panel(&mut block[first..], count, size - first, size)?;
    let block = Matrix::from_rows(block, count, size);
    rest.par_chunks_mut(TILE_ROWS * size).enumerate().for_each(|(tile, rows)| {
        let (from, count) = (end + tile * TILE_ROWS, rows.len() / size);
        // Only what is right of the diagonal of the tile.
        let target = MatrixMut::from_rows(rows, count, size).columns_from(from);
        let left = block.column_range(from..from + count).transpose();
        add_product(target, -1.0, left, block.column_range(from..size));
    });
    Some(())
}

/// Makes R of the first `count` rows of H in place; each has `width` entries from the column of the first diagonal entry on. `None`
/// where a pivot is not positive.
fn factor_panel(rows: &mut [f64], count: usize, width: usize, stride: usize) -> Option<()> {
    if count <= PANEL_ROWS {
        return factor_rows(rows, count, width, stride);
    }
    // A multiple of the rows of a panel.
    let half = (count / 2).next_multiple_of(PANEL_ROWS);
    factor_panel(rows, half, width, stride)?;
    let (above, below) = rows.split_at_mut(half * stride);
    let below = &mut below[half..];
    let (count, width) = (count - half, width - half);
    let above = Matrix::with_stride(&above[half..], half, width, stride);
    let target = MatrixMut::with_stride(below, count, width, stride);
    add_product(target, -1.0, above.column_range(0..count).transpose(), above);
    factor_panel(below, count, width, stride)
}

/// Makes the same row by row.
fn factor_rows(rows: &mut [f64], count: usize, width: usize, stride: usize) -> Option<()> {
    let mut factors = Vec::with_capacity(count);
    for k in 0..count {
        let (above, row) = rows.split_at_mut(k * stride);
        let row = &mut row[k..width];
        factors.clear();
        factors.extend((0..k).map(|i| -above[i * stride + k]));
        add_combination(row, &factors, |i| &above[i * stride + k..i * stride + width]);
        // Not a number is no pivot either.
        if row[0].is_nan() || row[0] <= 0.0 {
            return None;
        }
        let (pivot, rest) = row.split_first_mut().expect("the diagonal");
        *pivot = pivot.sqrt();
        rest.iter_mut().for_each(|r| *r /= *pivot);
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(i: usize, j: usize) -> f64 {
        let (a, b) = (i as f64, j as f64);
        1.0 / (1.0 + (a - b).abs()) + if i == j { 1.5 + (3.0 * a).sin() } else { 0.0 }
    }

    fn check(factor: &Cholesky<1>, points: &[usize]) {
        let v = factor.solution();
        for &i in points {
            let product: f64 = points.iter().zip(&v).map(|(&j, v)| entry(i, j) * v).sum();
            assert!((product - (i as f64).cos()).abs() < 1e-12, "{points:?}");
        }
    }

    fn appended(points: &[usize]) -> Cholesky<1> {
        let mut factor = Cholesky::default();
        for (s, &j) in points.iter().enumerate() {
            let column: Vec<f64> = points[..s].iter().map(|&i| entry(i, j)).collect();
            let z = factor.forward(&column);
            let pivot = (entry(j, j) - dot(&z, &z)).sqrt();
            factor.append(&z, pivot, [(j as f64).cos()]);
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
        let mut factor = Cholesky::of(h, [&b], 1e-11).unwrap();
        check(&factor, &points);
        factor.delete(3);
        points.remove(3);
        check(&factor, &points);
        let z = factor.forward(&points.iter().map(|&i| entry(i, 70)).collect::<Vec<_>>());
        factor.append(&z, (entry(70, 70) - dot(&z, &z)).sqrt(), [70f64.cos()]);
        points.push(70);
        check(&factor, &points);
    }

    /// More rows than a block and than a tile, and not a multiple of either.
    #[test]
    fn factors_of_several_blocks_solve() {
        let points: Vec<usize> = (0..2 * BLOCK_ROWS + TILE_ROWS + 5).collect();
        let h = points.iter().flat_map(|&i| points.iter().map(move |&j| entry(i, j))).collect();
        let b: Vec<f64> = points.iter().map(|&i| (i as f64).cos()).collect();
        let factor = Cholesky::of(h, [&b], 1e-11).unwrap();
        check(&factor, &points);
        let d: Vec<f64> = points.iter().map(|&i| (2.0 * i as f64).sin()).collect();
        let product = |i: usize| points.iter().map(|&j| entry(i, j) * d[j]).sum::<f64>();
        let square: f64 = points.iter().map(|&i| d[i] * product(i)).sum();
        assert!((factor.square(&d) - square).abs() < 1e-11 * square);
    }

    #[test]
    fn points_appended_at_once_solve_as_those_one_by_one() {
        for (known, count) in [(1, 1), (5, 40), (130, 70)] {
            let points: Vec<usize> = (0..known + count).collect();
            let mut factor = appended(&points[..known]);
            let of = |rows: &[usize], columns: &[usize]| -> Vec<f64> {
                rows.iter().flat_map(|&i| columns.iter().map(move |&j| entry(i, j))).collect()
            };
            let (old, new) = points.split_at(known);
            let b: Vec<f64> = new.iter().map(|&i| (i as f64).cos()).collect();
            assert!(factor.append_all(of(new, old), of(new, new), &b, 1e-11));
            check(&factor, &points);
            // A copy of a point depends on it, and leaves all as it was.
            let copy = [points[known]];
            assert!(!factor.append_all(of(&copy, &points), of(&copy, &copy), &b[..1], 1e-11));
            check(&factor, &points);
        }
    }

    #[test]
    fn dependent_points_are_not_factored() {
        assert!(Cholesky::of(vec![1.0, 1.0, 1.0, 1.0], [&[1.0, 1.0]], 1e-11).is_none());
    }
}
