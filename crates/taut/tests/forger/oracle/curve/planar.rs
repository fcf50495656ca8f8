//! Segments of the plane in whole numbers: whether they meet, and whether a point is near one.

use num_bigint::{BigInt, Sign};
use num_traits::{Signed, Zero};

use super::super::lattice::{Lattice, difference, dot};

pub(super) type Point = [f64; 2];

fn cross(a: &[BigInt], b: &[BigInt]) -> BigInt {
    &a[0] * &b[1] - &a[1] * &b[0]
}

/// Tests whether two closed segments have a point in common; either may be a point.
pub(super) fn segments_meet([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
    let are_apart = |k: usize| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k]);
    // Comparisons of doubles are exact, and boxes that are apart settle most pairs.
    if are_apart(0) || are_apart(1) {
        return false;
    }
    let at = Lattice::of(&[a, b, c, d].concat(), 2).points;
    let [ab, cd] = [[1, 0], [3, 2]].map(|[to, from]| difference(&at[to], &at[from]));
    let side =
        |edge: &[BigInt], from: usize, p: usize| cross(edge, &difference(&at[p], &at[from])).sign();
    let strictly_apart = |s: Sign, t: Sign| s == t && s != Sign::NoSign;
    // With boxes that meet, segments meet unless one is strictly on one side of the other's line. Of two on one line, boxes
    // that meet are enough; a point has no line, and lies on the other's line or is told by that.
    !strictly_apart(side(&ab, 0, 2), side(&ab, 0, 3))
        && !strictly_apart(side(&cd, 2, 0), side(&cd, 2, 1))
}

/// Tests whether a point is within `distance` of a segment.
pub(super) fn is_within(p: Point, [a, b]: [Point; 2], distance: f64) -> bool {
    if distance.is_nan() || distance < 0.0 {
        return false;
    }
    if distance == f64::INFINITY {
        return true;
    }
    let at = Lattice::of(&[p, a, b, [distance, 0.0]].concat(), 2).points;
    let most = dot(&at[3], &at[3]);
    let (e, r) = (difference(&at[2], &at[1]), difference(&at[0], &at[1]));
    let (along, length) = (dot(&e, &r), dot(&e, &e));
    if !along.is_positive() || length.is_zero() {
        return dot(&r, &r) <= most;
    }
    if along >= length {
        let r = difference(&at[0], &at[2]);
        return dot(&r, &r) <= most;
    }
    let off = cross(&e, &r);
    &off * &off <= most * length
}
