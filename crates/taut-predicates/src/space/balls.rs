//! The smallest spheres through two and three points, and one that is shrunk a little.

use std::array::from_fn;

use crate::cascade;
use crate::number::{Number, Polynomial};
use crate::sign::Sign;
use crate::space::Point;
use crate::space::polynomials::{cross, dot, lift};

/// (q − a)·(b − q).
struct InDiametralSphere;

impl Polynomial<6> for InDiametralSphere {
    const DEGREE: u32 = 2;
    const ROUNDINGS: u32 = 5;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 6]) -> N {
        dot(&[d[0], d[1], d[2]], &[d[3], d[4], d[5]])
    }
}

/// w·N − |n|²|w|², where n = u × v and C = a + N/2|n|² is the center of the facet's circumcircle: the power of q with
/// respect to its equatorial sphere is |w|² − w·N/|n|².
struct InEquatorialSphere;

impl Polynomial<9> for InEquatorialSphere {
    const DEGREE: u32 = 6;
    const ROUNDINGS: u32 = 19;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 9]) -> N {
        let [u, v, w] = [[d[0], d[1], d[2]], [d[3], d[4], d[5]], [d[6], d[7], d[8]]];
        let (n, numerator) = circle(&u, &v);
        dot(&w, &numerator) - lift(&n) * lift(&w)
    }
}

/// 4(w·N − |n|²|w|²) − |u|²|v|²|u − v|²·ε(2 − ε), made homogeneous with two factors 1.
///
/// From |w − N/2|n|²| < (1 − ε)R, as |N|² = |n|²|u|²|v|²|u − v|² and R² = |u|²|v|²|u − v|²/4|n|².
struct ShrunkSphere;

impl Polynomial<15> for ShrunkSphere {
    const DEGREE: u32 = 8;
    const ROUNDINGS: u32 = 26;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 15]) -> N {
        let [u, v, w] = [[d[0], d[1], d[2]], [d[3], d[4], d[5]], [d[6], d[7], d[8]]];
        let (edge, epsilon, rest, one) = ([d[9], d[10], d[11]], d[12], d[13], d[14]);
        let (n, numerator) = circle(&u, &v);
        let power = dot(&w, &numerator) - lift(&n) * lift(&w);
        let (twice, shrink) = (power + power, epsilon * rest);
        (twice + twice) * (one * one) - lift(&u) * lift(&v) * lift(&edge) * shrink
    }
}

/// Normal n = u × v of the triangle 0uv, and N = (n × u)|v|² + (v × n)|u|², where N/2|n|² is its circumcenter.
#[inline(always)]
fn circle<N: Number>(u: &[N; 3], v: &[N; 3]) -> ([N; 3], [N; 3]) {
    let n = cross(u, v);
    let (nu, vn, u2, v2) = (cross(&n, u), cross(v, &n), lift(u), lift(v));
    (n, [0, 1, 2].map(|i| nu[i] * v2 + vn[i] * u2))
}

/// Tests whether q lies inside (positive), on (zero) or outside the sphere with diameter ab, the smallest one through a and
/// b.
#[must_use]
pub fn in_diametral_sphere(a: Point, b: Point, q: Point) -> Sign {
    cascade::sign::<InDiametralSphere, 6>(&[
        [q[0], a[0]],
        [q[1], a[1]],
        [q[2], a[2]],
        [b[0], q[0]],
        [b[1], q[1]],
        [b[2], q[2]],
    ])
}

/// Tests whether q lies inside (positive), on (zero) or outside the smallest sphere through a, b and c. A facet of a Delaunay
/// triangulation with no vertex inside it is a Gabriel facet. Zero for three points of a line.
#[must_use]
pub fn in_equatorial_sphere(a: Point, b: Point, c: Point, q: Point) -> Sign {
    let points = [b, c, q];
    cascade::sign::<InEquatorialSphere, 9>(&from_fn(|i| [points[i / 3][i % 3], a[i % 3]]))
}

/// The smallest sphere through three points, to be asked about several: as [`in_equatorial_sphere`], with what does not depend on the
/// point asked about at hand.
#[derive(Clone, Copy, Debug)]
pub struct EquatorialSphere {
    corners: [Point; 3],
    /// N.
    numerator: Point,
    /// |n|².
    squared: f64,
    /// Of the differences of corners.
    largest: f64,
}

impl EquatorialSphere {
    /// That through a, b and c.
    #[must_use]
    #[inline]
    pub fn new(a: Point, b: Point, c: Point) -> Self {
        let [u, v] = [b, c].map(|p| from_fn(|k| p[k] - a[k]));
        let (n, numerator) = circle(&u, &v);
        let largest = cascade::largest(&[u[0], u[1], u[2], v[0], v[1], v[2]]);
        Self { corners: [a, b, c], numerator, squared: lift(&n), largest }
    }

    /// Tests whether q lies inside (positive), on (zero) or outside.
    #[must_use]
    #[inline]
    pub fn side(&self, q: Point) -> Sign {
        let [a, b, c] = self.corners;
        let w = from_fn(|k| q[k] - a[k]);
        let value = dot(&w, &self.numerator) - self.squared * lift(&w);
        let largest = cascade::largest(&[w[0], w[1], w[2], self.largest]);
        cascade::coarse_sign::<InEquatorialSphere, 9>(value, largest)
            .unwrap_or_else(|| in_equatorial_sphere(a, b, c, q))
    }
}

/// Tests whether d lies inside (positive), on (zero) or outside the smallest sphere through a, b and c, shrunk about its
/// center by the factor 1 − ε, ε in [0, 1]. Never positive for three points of a line, which have no such sphere.
#[must_use]
pub fn shrunk_sphere(a: Point, b: Point, c: Point, d: Point, epsilon: f64) -> Sign {
    let points = [b, c, d];
    cascade::sign::<ShrunkSphere, 15>(&from_fn(|i| match i {
        0..9 => [points[i / 3][i % 3], a[i % 3]],
        9..12 => [b[i % 3], c[i % 3]],
        12 => [epsilon, 0.0],
        13 => [2.0, epsilon],
        _ => [1.0, 0.0],
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::tests::constants_are_those_of;

    #[test]
    fn constants() {
        constants_are_those_of::<InDiametralSphere, 6>();
        constants_are_those_of::<InEquatorialSphere, 9>();
        constants_are_those_of::<ShrunkSphere, 15>();
    }

    /// Small integers bring ties, lines and equal points; what is far off, differences of all magnitudes.
    #[test]
    fn a_sphere_at_hand_gives_the_same_signs() {
        let (mut state, mut seen) = (1u64, [0; 3]);
        let mut next = |most: u64| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 33) % most
        };
        for _ in 0..20_000 {
            let unit = 2f64.powi(next(400) as i32 - 200);
            let shift = [0.0, 1e-17, 1e150][next(3) as usize] * unit;
            let [a, b, c, mut q] = from_fn(|_| from_fn(|_| (next(6) as f64 - 3.0) * unit));
            q[0] += shift;
            let sign = EquatorialSphere::new(a, b, c).side(q);
            assert_eq!(sign, in_equatorial_sphere(a, b, c, q));
            seen[if sign.is_positive() { 0 } else { 1 + usize::from(sign.is_zero()) }] += 1;
        }
        assert!(seen.into_iter().all(|count| count > 500), "{seen:?}");
    }
}
