//! Whether an edge enters a triangle, exactly, and how large the triangle is.
//!
//! *Idea.* An edge stays out of an open triangle when a line separates them, and one of the lines through the sides and the edge then
//! does. An edge of no length has no line, only the sides count. Signs are exact.
//! *Area.* The determinant is evaluated in doubled precision. With relative errors ε of single operations it is off by less than 8ε of
//! the sum of the sizes of its two terms: [`ERRORS`] is eight times that. What underflows is less than [`UNDERFLOW`].

use std::cmp::Ordering::{self, Greater, Less};

use crate::arithmetic::{DoubleDouble, Field, Ring, U};
use crate::polygon::{Units, orientation};

/// Errors of the determinant, in relative errors of operations and sums of the sizes of terms.
const ERRORS: f64 = 64.0;

/// Bound of what underflow can change, coordinates being below 2 in size: 2⁻⁹⁰⁰.
const UNDERFLOW: f64 = f64::from_bits((1023 - 900) << 52);

/// A triangle with its corners in counterclockwise order.
pub(super) struct Triangle {
    corners: [[f64; 2]; 3],
}

impl Triangle {
    /// Takes corners that turn left.
    pub(super) fn of(corners: [[f64; 2]; 3]) -> Option<Self> {
        let [p, q, r] = corners;
        (orientation(p, q, r) == Greater).then_some(Triangle { corners })
    }

    /// The centroid, up to rounding.
    pub(super) fn centroid(&self) -> [f64; 2] {
        let [p, q, r] = self.corners;
        [0, 1].map(|k| p[k] / 3.0 + q[k] / 3.0 + r[k] / 3.0)
    }

    /// The sides, each from a corner to the next.
    fn sides(&self) -> [[[f64; 2]; 2]; 3] {
        let [p, q, r] = self.corners;
        [[p, q], [q, r], [r, p]]
    }

    /// Whether a point is in the open triangle.
    pub(super) fn holds(&self, point: [f64; 2]) -> bool {
        self.sides().iter().all(|&[p, q]| orientation(p, q, point) == Greater)
    }

    /// Whether an edge of the polygon meets the open triangle.
    pub(super) fn is_entered(&self, [a, b]: [[f64; 2]; 2]) -> bool {
        let are_all =
            |side: Ordering| self.corners.iter().all(|&corner| orientation(a, b, corner) != side);
        let is_right_of_a_side = self
            .sides()
            .iter()
            .any(|&[p, q]| orientation(p, q, a) != Greater && orientation(p, q, b) != Greater);
        let is_apart = is_right_of_a_side || a != b && (are_all(Greater) || are_all(Less));
        !is_apart
    }

    /// A lower and an upper bound of twice the area in units; 0 and infinity where the sign of the determinant is not known.
    pub(super) fn doubled_area(&self, units: &Units) -> [f64; 2] {
        let [p, q, r] = self.scaled(units);
        let difference =
            |p: [f64; 2], q: [f64; 2]| [0, 1].map(|k| DoubleDouble::difference(p[k], q[k]));
        let (d, e) = (difference(q, p), difference(r, p));
        let (one, other) = (d[0].times(&e[1]), d[1].times(&e[0]));
        let error = ERRORS * DoubleDouble::ROUNDOFF * (one.high.abs() + other.high.abs());
        let determinant = one.minus(&other).high;
        let lower = determinant * (1.0 - 4.0 * U) - error - UNDERFLOW;
        let upper = determinant * (1.0 + 4.0 * U) + error + UNDERFLOW;
        // Subnormal numbers would be rounded when they are grown.
        match lower > UNDERFLOW {
            true => [units.grown(lower) * (1.0 - 4.0 * U), units.grown(upper) * (1.0 + 4.0 * U)],
            false => [0.0, f64::INFINITY],
        }
    }

    fn scaled(&self, units: &Units) -> [[f64; 2]; 3] {
        self.corners.map(|p| [0, 1].map(|k| units.scaled(k, p[k])))
    }

    /// The scale of the smallest image of the triangle, from its centroid, that an edge meets: 1 if the edge touches the triangle.
    pub(super) fn scale_to_reach(&self, edge: [[f64; 2]; 2], units: &Units) -> f64 {
        let corners = self.scaled(units);
        let ends = edge.map(|p| [0, 1].map(|k| units.scaled(k, p[k])));
        let cross = |p: [f64; 2], q: [f64; 2], w: [f64; 2]| {
            let difference = |p: [f64; 2]| [0, 1].map(|k| DoubleDouble::difference(p[k], w[k]));
            let (d, e) = (difference(p), difference(q));
            d[0].times(&e[1]).minus(&d[1].times(&e[0])).rounded()
        };
        let [p, q, r] = corners;
        let whole = cross(p, q, r);
        // For each side the scale at which it passes through each end.
        let scales = [[p, q], [q, r], [r, p]]
            .map(|[p, q]| ends.map(|end| 1.0 - 3.0 * cross(p, q, end) / whole));
        let most = |t: f64| {
            let at = |[from, to]: [f64; 2]| from + t * (to - from);
            scales.into_iter().map(at).fold(f64::NEG_INFINITY, f64::max)
        };
        let mut least = most(0.0).min(most(1.0));
        for (i, one) in scales.iter().enumerate() {
            for other in &scales[..i] {
                let [from, to] = [one[0] - other[0], one[1] - other[1]];
                if from * to < 0.0 {
                    least = least.min(most(from / (from - to)));
                }
            }
        }
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_enter_or_only_touch() {
        let triangle = Triangle::of([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]]).unwrap();
        let (tiny, up) = (f64::from_bits(1), 4f64.next_up());
        for (edge, enters) in [
            // Through the triangle, within it, and with an end in it.
            ([[-1.0, 1.0], [5.0, 1.0]], true),
            ([[1.0, 1.0], [1.5, 1.0]], true),
            ([[1.0, 1.0], [9.0, 9.0]], true),
            // A point in it, and on its border.
            ([[1.0, 1.0], [1.0, 1.0]], true),
            ([[2.0, 2.0], [2.0, 2.0]], false),
            // Along a side, through a corner, from corner to corner, up to a side.
            ([[-1.0, 0.0], [9.0, 0.0]], false),
            ([[-1.0, 1.0], [1.0, -1.0]], false),
            ([[4.0, 0.0], [0.0, 4.0]], false),
            ([[2.0, 2.0], [9.0, 9.0]], false),
            ([[-1.0, 2.0], [0.0, 2.0]], false),
            // Across a corner, by as little as there is.
            ([[0.0, tiny], [tiny, 0.0]], true),
            ([[0.0, up], [up, 0.0]], false),
        ] {
            let [a, b] = edge;
            assert_eq!(triangle.is_entered([a, b]), enters, "{edge:?}");
            assert_eq!(triangle.is_entered([b, a]), enters, "{edge:?}");
        }
        assert!(Triangle::of([[0.0, 0.0], [0.0, 4.0], [4.0, 0.0]]).is_none());
        assert!(Triangle::of([[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]]).is_none());
    }
}
