//! Triangles, and how much they can grow.

use crate::polygon::Segment;

/// The corners of a triangle, counterclockwise where it has an area above 0.
pub(super) type Triangle = [[f64; 2]; 3];

pub(super) fn cross(p: [f64; 2], q: [f64; 2]) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}

pub(super) fn minus(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    [p[0] - q[0], p[1] - q[1]]
}

/// Twice the area of the triangle p, q, w: above 0 where w is left of the line from p to q.
pub(super) fn turn(p: [f64; 2], q: [f64; 2], w: [f64; 2]) -> f64 {
    cross(minus(p, w), minus(q, w))
}

pub(super) fn doubled_area(&[p, q, r]: &Triangle) -> f64 {
    turn(q, r, p)
}

pub(super) fn centroid(&[p, q, r]: &Triangle) -> [f64; 2] {
    [0, 1].map(|k| (p[k] + q[k] + r[k]) / 3.0)
}

/// The image of a triangle, scaled from its centroid.
pub(super) fn scaled(triangle: &Triangle, scale: f64) -> Triangle {
    let c = centroid(triangle);
    triangle.map(|p| [0, 1].map(|k| c[k] + scale * (p[k] - c[k])))
}

/// The norm, without symmetry, of which a triangle is the unit disk around its centroid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gauge {
    center: [f64; 2],
    /// For each side the linear function that is 0 in the centroid and 1 on the side.
    sides: [[f64; 2]; 3],
}

impl Gauge {
    /// The gauge of a triangle with an area above 0.
    pub(super) fn of(triangle: &Triangle) -> Self {
        let factor = -3.0 / doubled_area(triangle);
        let side = |k: usize| {
            let (p, q) = (triangle[k], triangle[(k + 1) % 3]);
            [factor * (p[1] - q[1]), factor * (q[0] - p[0])]
        };
        Gauge { center: centroid(triangle), sides: [side(0), side(1), side(2)] }
    }

    /// How much the functions of the sides change, at most, when both coordinates change by 1; infinite where there is no area.
    pub(super) fn slope(&self) -> f64 {
        let slopes = self.sides.map(|g| g[0].abs() + g[1].abs());
        // Products of 0 and an infinite factor are NaN.
        let is_known = slopes.iter().all(|slope| !slope.is_nan());
        if is_known { slopes.into_iter().fold(0.0, f64::max) } else { f64::INFINITY }
    }

    /// The scale at which each side passes through a point.
    #[inline(always)]
    fn scales(&self, w: [f64; 2]) -> [f64; 3] {
        let d = minus(w, self.center);
        self.sides.map(|g| g[0] * d[0] + g[1] * d[1])
    }

    /// The scale at which the triangle reaches an edge, or `most` if that is less.
    #[inline]
    pub(super) fn scale(&self, [a, b]: Segment, most: f64) -> f64 {
        let (from, to) = (self.scales(a), self.scales(b));
        if (0..3).any(|k| from[k] >= most && to[k] >= most) {
            return most;
        }
        most.min(least_between(from, to))
    }

    /// The least scale at which the triangle reaches a box, or less.
    pub(super) fn least_over(&self, center: [f64; 2], half: [f64; 2]) -> f64 {
        let reach = self.sides.map(|g| g[0].abs() * half[0] + g[1].abs() * half[1]);
        let scales = self.scales(center);
        (scales[0] - reach[0]).max(scales[1] - reach[1]).max(scales[2] - reach[2])
    }
}

/// The least value, between two points, of the largest of three linear functions with these values in the points.
#[inline(always)]
pub(super) fn least_between(from: [f64; 3], to: [f64; 3]) -> f64 {
    let largest = |x: [f64; 3]| x[0].max(x[1]).max(x[2]);
    let mut least = largest(from).min(largest(to));
    // Between its ends the largest of three linear functions is least where two of them are equal.
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        let (one, other) = (from[i] - from[j], to[i] - to[j]);
        if one * other < 0.0 {
            let t = one / (one - other);
            least = least.min(largest([0, 1, 2].map(|k| from[k] + t * (to[k] - from[k]))));
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_are_reached_at_their_scale() {
        let triangle = [[0.0, 0.0], [3.0, 0.0], [0.0, 3.0]];
        let gauge = Gauge::of(&triangle);
        for (edge, scale) in [
            ([[-1.0, 0.0], [9.0, 0.0]], 1.0),
            ([[-5.0, -1.0], [9.0, -1.0]], 2.0),
            ([[1.0, -2.0], [1.0, -9.0]], 3.0),
            ([[0.0, 0.0], [0.0, 0.0]], 1.0),
            ([[-2.0, 0.0], [0.0, -2.0]], 2.0),
            ([[1.0, 1.0], [4.0, 9.0]], 0.0),
        ] {
            let found = gauge.scale(edge, 100.0);
            assert!((found - scale).abs() < 1e-14, "{edge:?}: {found}");
            assert_eq!(gauge.scale(edge, 0.5), scale.min(0.5), "{edge:?}");
        }
        assert_eq!(doubled_area(&scaled(&triangle, 2.0)), 36.0);
    }
}
