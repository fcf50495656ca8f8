//! The triangular factor of the support, grown and shrunk by one point at a time.
//!
//! RᵀR = A with A = G + σ11ᵀ over the support, R upper triangular and kept by rows. Two right-hand sides ride along,
//! w_b = R⁻ᵀ(b/2) and w_1 = R⁻ᵀ1, so that the circumcenter of the support costs one back substitution.
//! Appending a point is one forward substitution; deleting one is a shift of columns and a rotation for each row
//! below, which works on contiguous rows. Both are O(s²) for s points.
//! *Reference.* Golub and Van Loan, Matrix Computations, 6.5 (updating a Cholesky factor).

use taut_kernels::vector::{add_scaled, dot, rotate};

#[derive(Clone, Debug, Default)]
pub(super) struct Factor {
    /// Row i holds `R[i][i..s]`.
    rows: Vec<Vec<f64>>,
    w_b: Vec<f64>,
    w_1: Vec<f64>,
}

impl Factor {
    pub(super) fn clear(&mut self) {
        self.rows.clear();
        self.w_b.clear();
        self.w_1.clear();
    }

    /// The smallest `R[i][i]`²: how near the support is to affine dependence.
    pub(super) fn smallest_pivot(&self) -> f64 {
        self.rows.iter().map(|row| row[0] * row[0]).fold(f64::INFINITY, f64::min)
    }

    /// z with Rᵀz = a.
    pub(super) fn forward(&self, a: &[f64]) -> Vec<f64> {
        let mut z = a.to_vec();
        for (i, row) in self.rows.iter().enumerate() {
            z[i] /= row[0];
            let (head, tail) = z.split_at_mut(i + 1);
            add_scaled(tail, -head[i], &row[1..]);
        }
        z
    }

    /// y with Ry = z.
    pub(super) fn back(&self, z: &[f64]) -> Vec<f64> {
        let mut y = z.to_vec();
        for (i, row) in self.rows.iter().enumerate().rev() {
            y[i] = (y[i] - dot(&row[1..], &y[i + 1..])) / row[0];
        }
        y
    }

    /// Ry.
    pub(super) fn times(&self, y: &[f64]) -> Vec<f64> {
        self.rows.iter().enumerate().map(|(i, row)| dot(row, &y[i..])).collect()
    }

    /// Appends a point with column z = R⁻ᵀa, pivot √(a_jj − |z|²) and right-hand side b/2.
    pub(super) fn append(&mut self, z: &[f64], pivot: f64, half_b: f64) {
        self.w_b.push((half_b - dot(z, &self.w_b)) / pivot);
        self.w_1.push((1.0 - dot(z, &self.w_1)) / pivot);
        for (row, &z) in self.rows.iter_mut().zip(z) {
            row.push(z);
        }
        self.rows.push(vec![pivot]);
    }

    pub(super) fn delete(&mut self, position: usize) {
        for (i, row) in self.rows.iter_mut().enumerate().take(position) {
            row.remove(position - i);
        }
        // The deleted column leaves its own row and those below one entry below the diagonal each: rotate it away.
        let mut carry = self.rows.remove(position);
        carry.remove(0);
        let (mut carry_b, mut carry_1) = (self.w_b.remove(position), self.w_1.remove(position));
        for i in position..self.rows.len() {
            let next = &mut self.rows[i];
            let length = carry[0].hypot(next[0]);
            let (c, s) = (carry[0] / length, next[0] / length);
            rotate(&mut carry, next, c, s);
            std::mem::swap(&mut carry, next);
            carry.remove(0);
            (self.w_b[i], carry_b) = (c * carry_b + s * self.w_b[i], c * self.w_b[i] - s * carry_b);
            (self.w_1[i], carry_1) = (c * carry_1 + s * self.w_1[i], c * self.w_1[i] - s * carry_1);
        }
    }

    /// Replaces the right-hand side b/2.
    pub(super) fn set_half_b(&mut self, half_b: &[f64]) {
        self.w_b = self.forward(half_b);
    }

    /// The affine combination of the support whose point has equal b-distance to all of it: the stationary point of
    /// the dual on the affine hull. ν = (1 − w_1·w_b)/|w_1|², then Rs = w_b + νw_1.
    pub(super) fn stationary(&self) -> Vec<f64> {
        let mut right = self.w_b.clone();
        add_scaled(&mut right, self.multiplier(), &self.w_1);
        self.back(&right)
    }

    /// ν of the stationary point s: As = b/2 + ν1.
    pub(super) fn multiplier(&self) -> f64 {
        (1.0 - dot(&self.w_1, &self.w_b)) / dot(&self.w_1, &self.w_1)
    }

    /// x with Ax = v + ν1 and Σx = 0: the correction of multipliers that evens out v.
    pub(super) fn correction(&self, v: &[f64]) -> Vec<f64> {
        let mut right = self.forward(v);
        let nu = -dot(&self.w_1, &right) / dot(&self.w_1, &self.w_1);
        add_scaled(&mut right, nu, &self.w_1);
        self.back(&right)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A = rows·rowsᵀ + σ of given points, and its factor by appending one after the other.
    fn factor_of(points: &[Vec<f64>], sigma: f64) -> Factor {
        let mut factor = Factor::default();
        for (j, p) in points.iter().enumerate() {
            let a: Vec<f64> = points[..j].iter().map(|q| dot(p, q) + sigma).collect();
            let z = factor.forward(&a);
            let pivot = (dot(p, p) + sigma - dot(&z, &z)).sqrt();
            factor.append(&z, pivot, dot(p, p) / 2.0);
        }
        factor
    }

    fn points() -> Vec<Vec<f64>> {
        let values: Vec<f64> =
            taut_points::generate(taut_points::Distribution::Normal, 6, 8, 1).unwrap();
        values.chunks(8).map(<[f64]>::to_vec).collect()
    }

    #[test]
    fn the_stationary_point_is_equally_far_from_the_support() {
        let points = points();
        let s = factor_of(&points, 2.0).stationary();
        assert!((s.iter().sum::<f64>() - 1.0).abs() < 1e-13);
        let center: Vec<f64> =
            (0..8).map(|j| points.iter().zip(&s).map(|(p, s)| s * p[j]).sum()).collect();
        let distances: Vec<f64> = points
            .iter()
            .map(|p| p.iter().zip(&center).map(|(p, c)| (p - c) * (p - c)).sum())
            .collect();
        for d in &distances {
            assert!((d - distances[0]).abs() < 1e-12, "{distances:?}");
        }
    }

    #[test]
    fn deleting_gives_the_factor_of_what_is_left() {
        for position in 0..6 {
            let mut points = points();
            let mut factor = factor_of(&points, 2.0);
            factor.delete(position);
            points.remove(position);
            let fresh = factor_of(&points, 2.0);
            for (a, b) in factor.stationary().iter().zip(fresh.stationary()) {
                assert!((a - b).abs() < 1e-12);
            }
            let v = [1.0, -2.0, 0.5, 3.0, 1.0];
            for (a, b) in factor.correction(&v).iter().zip(fresh.correction(&v)) {
                assert!((a - b).abs() < 1e-12);
            }
            for (a, b) in factor.times(&v).iter().zip(factor.forward(&v)) {
                assert!(a.is_finite() && b.is_finite());
            }
            let y = factor.back(&factor.times(&v));
            assert!(y.iter().zip(v).all(|(y, v)| (y - v).abs() < 1e-12));
        }
    }
}
