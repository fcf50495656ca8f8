//! The same questions in whole numbers, by other formulas.
//!
//! Coordinates are scaled by their common denominator, and other points are in homogeneous coordinates: reducing fractions would take most
//! of the time. All rows that are named must be finite.

use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};
use taut_certify::Apex;

use super::Point;

type Vector = [BigInt; 3];

/// A point in homogeneous coordinates; the divisor is never 0.
type Homogeneous = (Vector, BigInt);

/// The points, scaled by the common denominator of their coordinates.
fn whole(points: &[Point]) -> Vec<Vector> {
    crate::common::whole(points.as_flattened()).as_chunks::<3>().0.to_vec()
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

fn times(a: &Vector, factor: &BigInt) -> Vector {
    a.each_ref().map(|x| x * factor)
}

fn dot(a: &Vector, b: &Vector) -> BigInt {
    (0..3).map(|k| &a[k] * &b[k]).sum()
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|k| &a[(k + 1) % 3] * &b[(k + 2) % 3] - &a[(k + 2) % 3] * &b[(k + 1) % 3])
}

fn normal([a, b, c]: &[Vector; 3]) -> Vector {
    cross(&minus(b, a), &minus(c, a))
}

/// Tests whether a triangle has the ball named, and the ball holds no site strictly inside.
pub(crate) fn is_empty(places: &[Point], sites: &[u32], triangle: [u32; 3], apex: Apex) -> bool {
    let named = match apex {
        Apex::Row(row) if sites.contains(&row) => Some(row),
        Apex::Row(_) => return false,
        Apex::Gabriel | Apex::Hull => None,
    };
    let rows = triangle.iter().chain(sites).chain(&named);
    let points = whole(&rows.map(|&row| places[row as usize]).collect::<Vec<Point>>());
    let corners: [Vector; 3] = [0, 1, 2].map(|k| points[k].clone());
    let (n, [a, b, c]) = (normal(&corners), &corners);
    if n.iter().all(Zero::is_zero) {
        return false;
    }
    let others = || points[3..3 + sites.len()].iter();
    let circle = |q: &Vector| {
        // The center by the weights of its corners.
        let weight = |p: &Vector, q: &Vector, r: &Vector| {
            let square = |p: &Vector, q: &Vector| dot(&minus(p, q), &minus(p, q));
            square(q, r) * (square(p, q) + square(p, r) - square(q, r))
        };
        let weights = [weight(a, b, c), weight(b, c, a), weight(c, a, b)];
        let center =
            [0, 1, 2].map(|k| (0..3).map(|i| &weights[i] * &corners[i][k]).sum::<BigInt>());
        is_nearer(q, a, &(center, weights.iter().sum()))
    };
    match apex {
        Apex::Gabriel => !others().any(circle),
        Apex::Hull => [1, -1].iter().any(|&sign| {
            let height = |q: &Vector| -> BigInt { dot(&n, &minus(q, a)) * sign };
            !others().any(|q| height(q).is_positive() || height(q).is_zero() && circle(q))
        }),
        Apex::Row(_) => {
            // The center x solves 2(p − a)·x = |p|² − |a|² for the three others, by Cramer's rule.
            let d = &points[3 + sites.len()];
            let lines = [b, c, d].map(|p| times(&minus(p, a), &2.into()));
            let right = [b, c, d].map(|p| dot(p, p) - dot(a, a));
            let determinant = dot(&cross(&lines[0], &lines[1]), &lines[2]);
            if determinant.is_zero() {
                return false;
            }
            let center = [0, 1, 2].map(|k| {
                let mut replaced = lines.clone();
                (0..3).for_each(|i| replaced[i][k] = right[i].clone());
                dot(&cross(&replaced[0], &replaced[1]), &replaced[2])
            });
            !others().any(|q| is_nearer(q, a, &(center.clone(), determinant.clone())))
        }
    }
}

fn is_nearer(q: &Vector, a: &Vector, (center, divisor): &Homogeneous) -> bool {
    let square = |p: &Vector| {
        let difference = minus(&times(p, divisor), center);
        dot(&difference, &difference)
    };
    square(q) < square(a)
}

/// Tests whether no triangle is flat, and no two share more than their common vertices and edges.
pub(crate) fn is_embedded(places: &[Point], triangles: &[[u32; 3]]) -> bool {
    let rows = triangles.iter().flatten().map(|&row| places[row as usize]);
    let points = whole(&rows.collect::<Vec<Point>>());
    let corners = points.as_chunks::<3>().0;
    let flat = |t: &[Vector; 3]| normal(t).iter().all(Zero::is_zero);
    let is_common = |i: usize, j: usize, k: usize| triangles[j].contains(&triangles[i][k]);
    let is_right = |i: usize, j: usize| {
        let common = (0..3).filter(|&k| is_common(i, j, k)).map(|k| &corners[i][k]);
        let common: Vec<&Vector> = common.collect();
        shared(&corners[i], &corners[j]).iter().all(|p| is_on(p, &common))
    };
    !corners.iter().any(flat) && (0..triangles.len()).all(|i| (0..i).all(|j| is_right(i, j)))
}

/// The corners of what two triangles share, with positive divisors: one is cut by the plane and by the sides of the other.
fn shared(one: &[Vector; 3], other: &[Vector; 3]) -> Vec<Homogeneous> {
    let n = normal(other);
    let mut cuts: Vec<(Vector, &Vector)> =
        vec![(n.clone(), &other[0]), (n.each_ref().map(|x| -x), &other[0])];
    for k in 0..3 {
        cuts.push((cross(&n, &minus(&other[(k + 1) % 3], &other[k])), &other[k]));
    }
    let mut polygon: Vec<Homogeneous> = one.iter().map(|p| (p.clone(), BigInt::one())).collect();
    for (inwards, at) in cuts {
        // Times the divisor.
        let height = |(p, divisor): &Homogeneous| dot(&inwards, &minus(p, &times(at, divisor)));
        let mut kept = vec![];
        for (p, q) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
            let (from, to) = (height(p), height(q));
            if !from.is_negative() {
                kept.push(p.clone());
            }
            if (&from * &to).is_negative() {
                let point = minus(&times(&q.0, &from), &times(&p.0, &to));
                let divisor = &from * &q.1 - &to * &p.1;
                let sign = divisor.signum();
                kept.push((times(&point, &sign), divisor * sign));
            }
        }
        polygon = kept;
    }
    polygon
}

/// Tests whether p, whose divisor is positive, is the common vertex, or on the common edge.
fn is_on((p, divisor): &Homogeneous, common: &[&Vector]) -> bool {
    match common {
        [a] => *p == times(a, divisor),
        [a, b] => {
            let (edge, to) = (minus(b, a), minus(p, &times(a, divisor)));
            let along = dot(&edge, &to);
            cross(&edge, &to).iter().all(Zero::is_zero)
                && !along.is_negative()
                && along <= dot(&edge, &edge) * divisor
        }
        _ => false,
    }
}

/// Where q is with respect to a tetrahedron: inside (1), on its surface (0) or outside (−1).
pub(crate) fn place_in_tetrahedron(corners: &[Point; 4], q: &Point) -> i32 {
    let all: Vec<Point> = corners.iter().chain([q]).copied().collect();
    let points = whole(&all);
    let (corners, q) = (&points[..4], &points[4]);
    let height = |k: usize, q: &Vector| {
        let [a, b, c] = [1, 2, 3].map(|i| corners[(k + i) % 4].clone());
        dot(&normal(&[a.clone(), b, c]), &minus(q, &a))
    };
    let signs = (0..4).map(|k| (height(k, q) * height(k, &corners[k])).signum());
    let least = signs.min().expect("four signs");
    if least.is_positive() {
        1
    } else if least.is_zero() {
        0
    } else {
        -1
    }
}
