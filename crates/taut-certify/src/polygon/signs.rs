//! On which side of an edge a corner of a cell lies, exactly.
//!
//! *Idea.* Corners are moved by (δ, δ²) for an infinitely small δ > 0, so that none lies on an edge, at the height of a vertex or
//! below one. Every question about a moved corner has an answer in terms of the corner itself.
//! *Reference.* Edelsbrunner and Mücke, Simulation of Simplicity, ACM Trans. Graph. 9, 1990. The filter: Shewchuk, Discrete
//! Comput. Geom. 18, 1997, bound A of orient2d.

use std::cmp::Ordering;

use crate::arithmetic::{Integer, Ring, U, parts};

/// Returns `Greater` when a, b, c turn left, `Equal` when they are on one line.
pub(crate) fn orientation(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Ordering {
    let left = (a[0] - c[0]) * (b[1] - c[1]);
    let right = (a[1] - c[1]) * (b[0] - c[0]);
    let (value, size) = (left - right, left.abs() + right.abs());
    if value.abs() > (3.0 + 16.0 * U) * U * size && size > 1e-280 && size < f64::INFINITY {
        return if value > 0.0 { Ordering::Greater } else { Ordering::Less };
    }
    let all = [a, b, c];
    let least = all.iter().flatten().filter(|x| **x != 0.0).map(|x| parts(*x).1).min().unwrap_or(0);
    let [a, b, c] = all.map(|point| point.map(|x| Integer::scaled(x, least)));
    let left = a[0].minus(&c[0]).times(&b[1].minus(&c[1]));
    left.minus(&a[1].minus(&c[1]).times(&b[0].minus(&c[0]))).sign()
}

/// Whether the edge crosses the horizontal line through the moved p, to the left of it.
pub(crate) fn crosses_left_of([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> bool {
    if (a[1] <= p[1]) == (b[1] <= p[1]) {
        return false;
    }
    let (low, high) = if a[1] <= p[1] { (a, b) } else { (b, a) };
    // A p on the edge is moved to the right, and that counts for more than the move up.
    orientation(low, high, p) != Ordering::Greater
}

/// Whether the edge crosses the vertical line through the moved p, below it.
pub(crate) fn crosses_below([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> bool {
    if (a[0] <= p[0]) == (b[0] <= p[0]) {
        return false;
    }
    let (left, right) = if a[0] <= p[0] { (a, b) } else { (b, a) };
    match orientation(left, right, p) {
        Ordering::Greater => true,
        Ordering::Less => false,
        // Moved along an edge that rises, p comes to lie below it; else above it.
        Ordering::Equal => right[1] <= left[1],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_on_an_edge_is_moved_to_one_side() {
        // Rising, falling and level edges through the origin, of both directions.
        for (edge, left, below) in [
            ([[-1.0, -1.0], [1.0, 1.0]], true, false),
            ([[-1.0, 1.0], [1.0, -1.0]], true, true),
            ([[-1.0, 0.0], [1.0, 0.0]], false, true),
            ([[0.0, -1.0], [0.0, 1.0]], true, false),
        ] {
            for edge in [edge, [edge[1], edge[0]]] {
                assert_eq!(crosses_left_of(edge, [0.0, 0.0]), left, "{edge:?}");
                assert_eq!(crosses_below(edge, [0.0, 0.0]), below, "{edge:?}");
            }
        }
    }

    #[test]
    fn signs_of_extreme_numbers_are_exact() {
        let (tiny, huge) = (f64::from_bits(1), f64::MAX);
        assert_eq!(orientation([0.0, 0.0], [huge, huge], [tiny, 0.0]), Ordering::Less);
        assert_eq!(orientation([0.0, 0.0], [huge, huge], [tiny, tiny]), Ordering::Equal);
        assert_eq!(orientation([-huge, -huge], [huge, huge], [0.0, tiny]), Ordering::Greater);
    }
}
