//! Decides whether convex hulls of a few points of space are apart, by planes between them.
//!
//! *Separation.* Two disjoint polytopes are strictly apart along the normal of a facet of their Minkowski difference: of
//! triangles and segments that is a normal of one, a product of an edge of either, or, where all is in one plane, a normal
//! times an edge.

use num_bigint::BigInt;
use num_traits::Zero;

use super::super::lattice::{difference, dot};

pub(super) type Place = Vec<BigInt>;

pub(super) fn cross(a: &[BigInt], b: &[BigInt]) -> Place {
    let minor = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    vec![minor(1, 2), minor(2, 0), minor(0, 1)]
}

pub(super) fn is_zero(a: &[BigInt]) -> bool {
    a.iter().all(Zero::is_zero)
}

/// (b − a) × (c − a).
pub(super) fn normal([a, b, c]: [&Place; 3]) -> Place {
    cross(&difference(b, a), &difference(c, a))
}

/// Returns true if all points of one are on one side of a plane with this normal, and all of the other beyond it.
fn are_apart_along(axis: &[BigInt], one: &[&Place], other: &[&Place]) -> bool {
    if is_zero(axis) {
        return false;
    }
    let range = |points: &[&Place]| {
        let heights: Vec<BigInt> = points.iter().map(|p| dot(axis, p)).collect();
        let (least, most) = (heights.iter().min().cloned(), heights.iter().max().cloned());
        (least, most)
    };
    let ((low, high), (other_low, other_high)) = (range(one), range(other));
    high < other_low || other_high < low
}

fn sides<'a>(points: &[&'a Place]) -> Vec<[&'a Place; 2]> {
    match points {
        [a, b] => vec![[a, b]],
        [a, b, c] => vec![[a, b], [b, c], [c, a]],
        _ => vec![],
    }
}

/// Tests whether a triangle with an area and a point, a segment or a triangle with an area have a point in common.
pub(super) fn meet(triangle: [&Place; 3], other: &[&Place]) -> bool {
    let n = normal(triangle);
    if are_apart_along(&n, &triangle, other) {
        return false;
    }
    let edges = |points: &[&Place]| -> Vec<Place> {
        sides(points).into_iter().map(|[a, b]| difference(b, a)).collect()
    };
    let (own, others) = (edges(&triangle), edges(other));
    let normals = match other {
        [a, b, c] => vec![normal([a, b, c])],
        _ => vec![],
    };
    let products = own.iter().flat_map(|e| others.iter().map(move |f| cross(e, f)));
    let in_plane = own.iter().chain(&others).map(|e| cross(&n, e));
    let mut axes = normals.into_iter().chain(products).chain(in_plane);
    !axes.any(|axis| are_apart_along(&axis, &triangle, other))
}

/// Returns true if p is on the segment from a to b.
pub(super) fn is_on(p: &Place, a: &Place, b: &Place) -> bool {
    let is_between = |k: usize| (&a[k]).min(&b[k]) <= &p[k] && &p[k] <= (&a[k]).max(&b[k]);
    is_zero(&normal([a, b, p])) && (0..3).all(is_between)
}
