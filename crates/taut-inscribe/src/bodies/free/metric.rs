//! A metric of space around a center, as a linear map to a space in which its balls are round.

use super::super::vectors::{dot, minus, plus};

/// The part of the mean variance that is added to all variances, so that flat sets of points have a metric.
const VARIANCE_MIN: f64 = 1e-6;

/// The length of x in the metric is that of `rows`·x.
#[derive(Clone, Debug)]
pub(super) struct Metric {
    pub(super) center: [f64; 3],
    rows: [[f64; 3]; 3],
}

impl Metric {
    /// The usual metric around a point.
    pub(super) fn round(center: [f64; 3]) -> Self {
        Metric { center, rows: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] }
    }

    /// The metric of the ellipsoid of inertia of some points, around their mean; `None` for fewer than 4 points, or for points
    /// that are all equal.
    pub(super) fn of_inertia(points: &[[f64; 3]]) -> Option<Self> {
        let (mut count, mut sum) = (0.0, [0.0; 3]);
        for &p in points {
            count += 1.0;
            sum = plus(sum, 1.0, p);
        }
        if count < 4.0 {
            return None;
        }
        let center = sum.map(|x| x / count);
        // The covariance: its diagonal, and the entries (0, 1), (0, 2), (1, 2).
        let (mut diagonal, mut other) = ([0.0; 3], [0.0; 3]);
        for &p in points {
            let [x, y, z] = minus(p, center);
            diagonal = plus(diagonal, 1.0, [x * x, y * y, z * z]);
            other = plus(other, 1.0, [x * y, x * z, y * z]);
        }
        let floor = VARIANCE_MIN * (diagonal[0] + diagonal[1] + diagonal[2]) / 3.0;
        let [xx, yy, zz] = diagonal.map(|x| x + floor);
        let [xy, xz, yz] = other;
        // The factor of Cholesky, and its inverse.
        let a = xx.sqrt();
        let (b, c) = (xy / a, xz / a);
        let d = (yy - b * b).sqrt();
        let e = (yz - b * c) / d;
        let f = (zz - c * c - e * e).sqrt();
        let rows = [
            [1.0 / a, 0.0, 0.0],
            [-b / (a * d), 1.0 / d, 0.0],
            [(b * e - c * d) / (a * d * f), -e / (d * f), 1.0 / f],
        ];
        let is_finite = rows.as_flattened().iter().all(|x| x.is_finite());
        is_finite.then_some(Metric { center, rows })
    }

    /// The metric in which lengths along an axis of the mapped space are multiplied by a factor. The axis has length 1.
    pub(super) fn stretched(&self, axis: [f64; 3], factor: f64) -> Self {
        let along = self.normal(axis);
        let rows = [0, 1, 2].map(|k| plus(self.rows[k], (factor - 1.0) * axis[k], along));
        Metric { center: self.center, rows }
    }

    pub(super) fn map(&self, x: [f64; 3]) -> [f64; 3] {
        self.rows.map(|row| dot(row, x))
    }

    /// The normal, before the map, of the planes with this normal after the map.
    pub(super) fn normal(&self, y: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|c| self.rows[0][c] * y[0] + self.rows[1][c] * y[1] + self.rows[2][c] * y[2])
    }

    /// A lower bound of the squared distance from the center to a box.
    pub(super) fn to_box(&self, center: [f64; 3], half: [f64; 3]) -> f64 {
        let center = self.map(minus(center, self.center));
        let off = |k: usize| {
            let row = self.rows[k];
            let reach = row[0].abs() * half[0] + row[1].abs() * half[1] + row[2].abs() * half[2];
            (center[k].abs() - reach).max(0.0)
        };
        off(0) * off(0) + off(1) * off(1) + off(2) * off(2)
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::vectors::cross;
    use super::*;

    /// The corners of a box that is sheared.
    fn corners() -> Vec<[f64; 3]> {
        let ends = [-1.0, 1.0];
        let all = ends.iter().flat_map(|&x| ends.map(|y| ends.map(|z| [x, y, z]))).flatten();
        all.map(|[x, y, z]| [5.0 + 4.0 * x + y, 2.0 * y - z, 1.0 + 0.5 * z + x]).collect()
    }

    #[test]
    fn the_ellipsoid_of_inertia_of_a_sheared_box_maps_it_to_a_cube() {
        let points = corners();
        let metric = Metric::of_inertia(&points).unwrap();
        assert!(dot(minus(metric.center, [5.0, 0.0, 1.0]), [1.0; 3]).abs() < 1e-12);
        let lengths = points.iter().map(|&p| metric.map(minus(p, metric.center)));
        let lengths: Vec<f64> = lengths.map(|y| dot(y, y)).collect();
        // All corners of a cube are equally far from its center.
        assert!(lengths.iter().all(|l| (l / lengths[0] - 1.0).abs() < 1e-3), "{lengths:?}");
        let twice = metric.stretched([0.6, 0.0, 0.8], 2.0);
        // The unit ball has half the volume.
        let determinant =
            |metric: &Metric| dot(metric.rows[0], cross(metric.rows[1], metric.rows[2]));
        assert!((determinant(&twice) / determinant(&metric) - 2.0).abs() < 1e-12);
        assert!(Metric::of_inertia(&[[1.0; 3]; 9]).is_none());
        assert!(Metric::of_inertia(&[[1.0; 3]; 3]).is_none());
    }

    #[test]
    fn boxes_are_at_least_as_far_as_told() {
        let metric = Metric::of_inertia(&corners()).unwrap().stretched([0.0, 1.0, 0.0], 3.0);
        for x in [-20.0, -3.0, 4.0, 30.0] {
            let (center, half) = ([x, 7.0, 0.5 * x], [2.0, 1.0, 3.0]);
            let bound = metric.to_box(center, half);
            for k in 0..125 {
                let part = |n: i32| f64::from(n % 5) / 2.0 - 1.0;
                let at = [part(k) * half[0], part(k / 5) * half[1], part(k / 25) * half[2]];
                let y = metric.map(minus(plus(center, 1.0, at), metric.center));
                assert!(dot(y, y) >= bound * (1.0 - 1e-12));
            }
        }
    }
}
