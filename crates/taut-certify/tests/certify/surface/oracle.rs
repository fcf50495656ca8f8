//! The same questions in fractions, by other formulas.

use num_rational::BigRational;
use num_traits::{Signed, Zero};
use taut_certify::Apex;

use super::Point;

type Q = BigRational;
type Vector = [Q; 3];

fn exact(p: &Point) -> Vector {
    p.map(|x| Q::from_float(x).expect("finite"))
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

fn dot(a: &Vector, b: &Vector) -> Q {
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
    let corners = triangle.map(|row| exact(&places[row as usize]));
    let (n, [a, b, c]) = (normal(&corners), &corners);
    if n.iter().all(Zero::is_zero) {
        return false;
    }
    let others = || sites.iter().map(|&row| exact(&places[row as usize]));
    let circle = |q: &Vector| {
        // The center by the weights of its corners.
        let weight = |p: &Vector, q: &Vector, r: &Vector| {
            let square = |p: &Vector, q: &Vector| dot(&minus(p, q), &minus(p, q));
            square(q, r) * (square(p, q) + square(p, r) - square(q, r))
        };
        let weights = [weight(a, b, c), weight(b, c, a), weight(c, a, b)];
        let sum: Q = weights.iter().sum();
        let center: Vector =
            [0, 1, 2].map(|k| (0..3).map(|i| &weights[i] * &corners[i][k]).sum::<Q>() / &sum);
        is_nearer(q, a, &center)
    };
    match apex {
        Apex::Gabriel => !others().any(|q| circle(&q)),
        Apex::Hull => [1, -1].iter().any(|&sign| {
            let height = |q: &Vector| dot(&n, &minus(q, a)) * Q::from_integer(sign.into());
            !others().any(|q| height(&q).is_positive() || height(&q).is_zero() && circle(&q))
        }),
        Apex::Row(row) => {
            if !sites.contains(&row) {
                return false;
            }
            // The center x solves 2(p − a)·x = |p|² − |a|² for the three others, by Cramer's rule.
            let d = exact(&places[row as usize]);
            let lines = [b, c, &d].map(|p| minus(p, a));
            let right = [b, c, &d].map(|p| (dot(p, p) - dot(a, a)) / Q::from_integer(2.into()));
            let determinant = dot(&cross(&lines[0], &lines[1]), &lines[2]);
            if determinant.is_zero() {
                return false;
            }
            let center = [0, 1, 2].map(|k| {
                let mut replaced = lines.clone();
                (0..3).for_each(|i| replaced[i][k] = right[i].clone());
                dot(&cross(&replaced[0], &replaced[1]), &replaced[2]) / &determinant
            });
            !others().any(|q| is_nearer(&q, a, &center))
        }
    }
}

fn is_nearer(q: &Vector, a: &Vector, center: &Vector) -> bool {
    let square = |p: &Vector| dot(&minus(p, center), &minus(p, center));
    square(q) < square(a)
}

/// Tests whether no triangle is flat, and no two share more than their common vertices and edges.
pub(crate) fn is_embedded(places: &[Point], triangles: &[[u32; 3]]) -> bool {
    let corners = |t: &[u32; 3]| t.map(|row| exact(&places[row as usize]));
    let flat = |t: &[u32; 3]| normal(&corners(t)).iter().all(Zero::is_zero);
    !triangles.iter().any(flat)
        && triangles.iter().enumerate().all(|(i, one)| {
            triangles[..i].iter().all(|other| {
                let common: Vec<Vector> = one
                    .iter()
                    .filter(|row| other.contains(row))
                    .map(|&row| exact(&places[row as usize]))
                    .collect();
                shared(&corners(one), &corners(other)).iter().all(|p| is_on(p, &common))
            })
        })
}

/// The corners of what two triangles share: one is cut by the plane and by the sides of the other.
fn shared(one: &[Vector; 3], other: &[Vector; 3]) -> Vec<Vector> {
    let n = normal(other);
    let mut cuts: Vec<(Vector, &Vector)> =
        vec![(n.clone(), &other[0]), (n.clone().map(|x| -x), &other[0])];
    for k in 0..3 {
        cuts.push((cross(&n, &minus(&other[(k + 1) % 3], &other[k])), &other[k]));
    }
    let mut polygon = one.to_vec();
    for (inwards, at) in cuts {
        let height = |p: &Vector| dot(&inwards, &minus(p, at));
        let mut kept = vec![];
        for (p, q) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
            let (from, to) = (height(p), height(q));
            if !from.is_negative() {
                kept.push(p.clone());
            }
            if (&from * &to).is_negative() {
                let share = &from / (&from - &to);
                kept.push([0, 1, 2].map(|k| &p[k] + &share * (&q[k] - &p[k])));
            }
        }
        polygon = kept;
    }
    polygon
}

/// Tests whether p is the common vertex, or on the common edge.
fn is_on(p: &Vector, common: &[Vector]) -> bool {
    match common {
        [a] => p == a,
        [a, b] => {
            let (edge, to) = (minus(b, a), minus(p, a));
            let along = dot(&edge, &to);
            cross(&edge, &to).iter().all(Zero::is_zero)
                && !along.is_negative()
                && along <= dot(&edge, &edge)
        }
        _ => false,
    }
}

/// Where q is with respect to a tetrahedron: inside (1), on its surface (0) or outside (−1).
pub(crate) fn place_in_tetrahedron(corners: &[Point; 4], q: &Point) -> i32 {
    let (corners, q) = (corners.map(|p| exact(&p)), exact(q));
    let height = |k: usize, q: &Vector| {
        let [a, b, c] = [1, 2, 3].map(|i| corners[(k + i) % 4].clone());
        dot(&normal(&[a.clone(), b, c]), &minus(q, &a))
    };
    let signs = (0..4).map(|k| (height(k, &q) * height(k, &corners[k])).signum());
    let least = signs.min().expect("four signs");
    if least.is_positive() {
        1
    } else if least.is_zero() {
        0
    } else {
        -1
    }
}
