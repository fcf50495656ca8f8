//! Whether two segments meet, exactly.
//!
//! The sign of a determinant in `f64` is right when its size is above what its roundings sum to (Shewchuk, Discrete Comput. Geom.
//! 18, 1997, bound A of orient2d) and no product is so small that it lost bits; else whole numbers decide.

use std::cmp::Ordering;

use crate::arithmetic::{Integer, Ring, U, parts};

/// Greater when a, b, c turn left.
pub(super) fn orientation(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> Ordering {
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

/// Whether p, on the line through a and b, lies between them, or at one of them.
fn is_between(a: [f64; 2], b: [f64; 2], p: [f64; 2]) -> bool {
    (0..2).all(|k| a[k].min(b[k]) <= p[k] && p[k] <= a[k].max(b[k]))
}

/// Whether p lies on the segment from a to b.
pub(super) fn is_on(a: [f64; 2], b: [f64; 2], p: [f64; 2]) -> bool {
    is_between(a, b, p) && orientation(a, b, p) == Ordering::Equal
}

/// Whether the segments from a to b and from c to d have a point in common.
pub(super) fn meet(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> bool {
    let (abc, abd) = (orientation(a, b, c), orientation(a, b, d));
    let (cda, cdb) = (orientation(c, d, a), orientation(c, d, b));
    if abc != abd && cda != cdb && ![abc, abd, cda, cdb].contains(&Ordering::Equal) {
        return true;
    }
    abc == Ordering::Equal && is_between(a, b, c)
        || abd == Ordering::Equal && is_between(a, b, d)
        || cda == Ordering::Equal && is_between(c, d, a)
        || cdb == Ordering::Equal && is_between(c, d, b)
}
