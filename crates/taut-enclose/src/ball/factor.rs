//! The triangular factor of the support, and what an active set asks of it.
//!
//! RᵀR = A with A = G + σ11ᵀ over the support. Two right-hand sides ride along, w_b = R⁻ᵀ(b/2) and w_1 = R⁻ᵀ1, so that the
//! circumcenter of the support costs one back substitution.
//! *Small supports.* Kernels multiply by the inverses of pivots, which rounds twice. In small systems a division takes no longer, and
//! quotients that `f64` can represent are exact: the ball of two points has its center halfway.

use taut_kernels::vector::{add_scaled, dot};

use crate::cholesky::Cholesky;

/// The right-hand side b/2.
const HALF_B: usize = 0;
/// The right-hand side of ones.
const ONES: usize = 1;
/// Systems of at most so many points are solved by division.
pub(super) const DIVIDED_MAX: usize = 8;

#[derive(Clone, Debug, Default)]
pub(super) struct Factor(Cholesky<2>);

impl Factor {
    /// The factor of A, s × s, of which only the upper triangle is read; `None` when the square of a pivot is below `least` times its
    /// diagonal entry.
    pub(super) fn of(a: Vec<f64>, half_b: &[f64], least: f64) -> Option<Self> {
        Cholesky::of(a, [half_b, &vec![1.0; half_b.len()]], least).map(Factor)
    }

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// The number of points.
    fn len(&self) -> usize {
        self.0.right(ONES).len()
    }

    /// The smallest `R[i][i]`²: how near the support is to affine dependence.
    pub(super) fn smallest_pivot(&self) -> f64 {
        (0..self.len()).map(|i| self.0.row(i)[0].powi(2)).fold(f64::INFINITY, f64::min)
    }

    /// z with Rᵀz = a.
    pub(super) fn forward(&self, a: &[f64]) -> Vec<f64> {
        let mut z = a.to_vec();
        if self.len() > DIVIDED_MAX {
            self.0.forward_in_place(&mut z);
            return z;
        }
        for i in 0..self.len() {
            let row = self.0.row(i);
            z[i] /= row[0];
            let (head, tail) = z.split_at_mut(i + 1);
            add_scaled(tail, -head[i], &row[1..]);
        }
        z
    }

    /// y with Ry = z.
    pub(super) fn back(&self, z: Vec<f64>) -> Vec<f64> {
        if self.len() > DIVIDED_MAX {
            return self.0.back(z);
        }
        let mut y = z;
        for i in (0..self.len()).rev() {
            let row = self.0.row(i);
            y[i] = (y[i] - dot(&row[1..], &y[i + 1..])) / row[0];
        }
        y
    }

    /// Ry.
    pub(super) fn times(&self, y: &[f64]) -> Vec<f64> {
        (0..self.len()).map(|i| dot(self.0.row(i), &y[i..])).collect()
    }

    /// Appends a point with column z = R⁻ᵀa, pivot √(a_jj − |z|²) and right-hand side b/2.
    pub(super) fn append(&mut self, z: &[f64], pivot: f64, half_b: f64) {
        self.0.append(z, pivot, [half_b, 1.0]);
    }

    pub(super) fn delete(&mut self, position: usize) {
        self.0.delete(position);
    }

    /// Replaces the right-hand side b/2.
    pub(super) fn set_half_b(&mut self, half_b: &[f64]) {
        self.0.set_right(HALF_B, self.forward(half_b));
    }

    /// The affine combination of the support whose point has equal b-distance to all of it: the stationary point of
    /// the dual on the affine hull. ν = (1 − w_1·w_b)/|w_1|², then Rs = w_b + νw_1.
    pub(super) fn stationary(&self) -> Vec<f64> {
        let mut right = self.0.right(HALF_B).to_vec();
        add_scaled(&mut right, self.multiplier(), self.0.right(ONES));
        self.back(right)
    }

    /// ν of the stationary point s: As = b/2 + ν1.
    pub(super) fn multiplier(&self) -> f64 {
        let [w_b, w_1] = [HALF_B, ONES].map(|side| self.0.right(side));
        (1.0 - dot(w_1, w_b)) / dot(w_1, w_1)
    }

    /// x with Ax = v + ν1 and Σx = 0: the correction of multipliers that evens out v.
    pub(super) fn correction(&self, v: &[f64]) -> Vec<f64> {
        let (mut right, w_1) = (self.forward(v), self.0.right(ONES));
        let nu = -dot(w_1, &right) / dot(w_1, w_1);
        add_scaled(&mut right, nu, w_1);
        self.back(right)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Few points, which are solved by division, and one more than that.
    const COUNTS: [usize; 3] = [6, DIVIDED_MAX + 1, 20];
    const DIM: usize = 24;
    const SIGMA: f64 = 2.0;

    /// Appends points one after the other to an empty factor of A = rows·rowsᵀ + σ.
    fn append_all(factor: &mut Factor, points: &[Vec<f64>]) {
        for (j, p) in points.iter().enumerate() {
            let a: Vec<f64> = points[..j].iter().map(|q| dot(p, q) + SIGMA).collect();
            let z = factor.forward(&a);
            let pivot = (dot(p, p) + SIGMA - dot(&z, &z)).sqrt();
            factor.append(&z, pivot, dot(p, p) / 2.0);
        }
    }

    fn factor_of(points: &[Vec<f64>]) -> Factor {
        let mut factor = Factor::default();
        append_all(&mut factor, points);
        factor
    }

    fn points(count: usize) -> Vec<Vec<f64>> {
        let values: Vec<f64> =
            taut_points::generate(taut_points::Distribution::Normal, count, DIM, 1).unwrap();
        values.chunks(DIM).map(<[f64]>::to_vec).collect()
    }

    fn are_near(a: &[f64], b: &[f64]) -> bool {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12)
    }

    #[test]
    fn the_stationary_point_is_equally_far_from_the_support() {
        for count in COUNTS {
            let points = points(count);
            let s = factor_of(&points).stationary();
            assert!((s.iter().sum::<f64>() - 1.0).abs() < 1e-13);
            let coordinate = |j| points.iter().zip(&s).map(|(p, s): (&Vec<f64>, _)| s * p[j]).sum();
            let center: Vec<f64> = (0..DIM).map(coordinate).collect();
            let distance =
                |p: &Vec<f64>| p.iter().zip(&center).map(|(p, c)| (p - c) * (p - c)).sum();
            let distances: Vec<f64> = points.iter().map(distance).collect();
            assert!(are_near(&distances, &vec![distances[0]; count]), "{distances:?}");
        }
    }

    #[test]
    fn deleting_gives_the_factor_of_what_is_left() {
        for (count, position) in COUNTS.iter().flat_map(|&n| (0..n).map(move |k| (n, k))) {
            let mut points = points(count);
            let mut factor = factor_of(&points);
            factor.delete(position);
            points.remove(position);
            let fresh = factor_of(&points);
            assert!(are_near(&factor.stationary(), &fresh.stationary()));
            let v: Vec<f64> = (0..count - 1).map(|k| (k as f64).cos()).collect();
            assert!(are_near(&factor.correction(&v), &fresh.correction(&v)));
            assert!(are_near(&factor.back(factor.times(&v)), &v));
        }
    }

    #[test]
    fn a_factor_of_all_points_at_once_is_that_of_one_after_the_other() {
        for count in COUNTS {
            let points = points(count);
            let row = |p: &Vec<f64>| points.iter().map(|q| dot(p, q) + SIGMA).collect::<Vec<_>>();
            let half_b: Vec<f64> = points.iter().map(|p| dot(p, p) / 2.0).collect();
            let factor = Factor::of(points.iter().flat_map(row).collect(), &half_b, 1e-9).unwrap();
            let (wanted, v) = (factor_of(&points), &half_b);
            assert!(are_near(&factor.stationary(), &wanted.stationary()));
            assert!(are_near(&factor.correction(v), &wanted.correction(v)));
        }
        assert!(Factor::of(vec![3.0; 4], &[1.0, 1.0], 1e-9).is_none());
    }

    #[test]
    fn a_factor_that_was_cleared_is_that_of_its_new_points() {
        let mut factor = factor_of(&points(20));
        factor.clear();
        append_all(&mut factor, &points(9));
        assert_eq!(factor.stationary(), factor_of(&points(9)).stationary());
    }
}
