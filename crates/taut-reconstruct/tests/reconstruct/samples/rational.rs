//! Facets and their spheres in fractions, by other formulas than those of the predicates.
//!
//! The spheres through a, b and c have their centers on a line, C + s·n. A point p is not inside the one at s if
//! 2s·n·(p − C) ≤ |p − C|² − R²: so the empty ones are an interval of s, and at its ends lie the spheres of the cells.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use super::Point;

pub type Fraction = BigRational;
pub type Vector = [Fraction; 3];

pub fn fraction(x: f64) -> Fraction {
    Fraction::from_float(x).expect("a finite number")
}

pub fn vector(p: Point) -> Vector {
    p.map(fraction)
}

fn minus(p: &Vector, q: &Vector) -> Vector {
    [0, 1, 2].map(|i| &p[i] - &q[i])
}

fn dot(p: &Vector, q: &Vector) -> Fraction {
    &p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2]
}

fn cross(p: &Vector, q: &Vector) -> Vector {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &p[j] * &q[k] - &p[k] * &q[j]
    })
}

/// The circle of a facet, and the interval of its empty spheres among some points.
pub struct Pencil {
    center: Vector,
    normal: Vector,
    /// R².
    pub square: Fraction,
    /// True if there is an empty sphere at all.
    pub is_delaunay: bool,
    /// The ends of the interval, on the side away from the normal and on the side of the normal.
    ends: [Option<Fraction>; 2],
}

impl Pencil {
    /// None for points of a line.
    pub fn of(facet: [usize; 3], points: &[Vector]) -> Option<Self> {
        let [a, b, c] = facet.map(|i| &points[i]);
        let (u, v) = (minus(b, a), minus(c, a));
        let normal = cross(&u, &v);
        if normal.iter().all(Zero::is_zero) {
            return None;
        }
        // C = a + x·u + y·v with |C − a|² = |C − b|² = |C − c|²: two equations, by Cramer's rule.
        let two = Fraction::from_integer(BigInt::from(2));
        let (uu, uv, vv) = (dot(&u, &u), dot(&u, &v), dot(&v, &v));
        let det = &two * (&uu * &vv - &uv * &uv);
        let x = (&uu * &vv - &vv * &uv) / &det;
        let y = (&uu * &vv - &uu * &uv) / &det;
        let center = [0, 1, 2].map(|i| &a[i] + &x * &u[i] + &y * &v[i]);
        let way = minus(a, &center);
        let square = dot(&way, &way);
        let mut found = Self { center, normal, square, is_delaunay: true, ends: [None, None] };
        for (i, p) in points.iter().enumerate().filter(|(i, _)| !facet.contains(i)) {
            debug_assert!(i < points.len());
            found.restrict(p);
        }
        if let [Some(low), Some(high)] = &found.ends {
            found.is_delaunay &= low <= high;
        }
        Some(found)
    }

    fn restrict(&mut self, p: &Vector) {
        let way = minus(p, &self.center);
        let (power, along) = (dot(&way, &way) - &self.square, dot(&self.normal, &way));
        if along.is_zero() {
            self.is_delaunay &= !power.is_negative();
            return;
        }
        let bound = power / (Fraction::from_integer(BigInt::from(2)) * &along);
        let [low, high] = &mut self.ends;
        if along.is_positive() {
            *high = Some(high.take().map_or(bound.clone(), |old| old.min(bound)));
        } else {
            *low = Some(low.take().map_or(bound.clone(), |old| old.max(bound)));
        }
    }

    /// The squares of the radii of the two cells, of that away from the normal first; none on the hull.
    pub fn cells(&self) -> [Option<Fraction>; 2] {
        let square = |s: &Fraction| &self.square + s * s * dot(&self.normal, &self.normal);
        [0, 1].map(|k| self.ends[k].as_ref().map(square))
    }

    /// Returns true if the smallest sphere through the facet is empty.
    pub fn is_gabriel(&self) -> bool {
        let [low, high] = &self.ends;
        self.is_delaunay
            && low.as_ref().is_none_or(|s| !s.is_positive())
            && high.as_ref().is_none_or(|s| !s.is_negative())
    }

    /// Returns true if p lies inside the smallest sphere, shrunk by 1 − ε.
    pub fn shrunk_holds(&self, p: &Vector, epsilon: f64) -> bool {
        let way = minus(p, &self.center);
        let rest = Fraction::one() - fraction(epsilon);
        dot(&way, &way) < &rest * &rest * &self.square
    }
}
