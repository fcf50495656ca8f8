//! Where a circumcenter lies, and the smallest circle of an edge, by exact signs of rational functions.

use crate::cascade;
use crate::number::{Number, Polynomial};
use crate::plane::polynomials::{dot, lift, minor, numerator};
use crate::plane::{Point, orient};
use crate::sign::Sign;

/// −(a − q)·(b − q).
struct InDiametralCircle;

impl Polynomial<4> for InDiametralCircle {
    const DEGREE: u32 = 2;
    const ROUNDINGS: u32 = 4;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 4]) -> N {
        // (q − a)·(b − q), the sign for free.
        dot(&[d[0], d[1]], &[d[2], d[3]])
    }
}

/// U + 2[uv]·(a − t) along one axis.
struct Side<const AXIS: usize>;

impl<const AXIS: usize> Polynomial<5> for Side<AXIS> {
    const DEGREE: u32 = 3;
    const ROUNDINGS: u32 = 8;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 5]) -> N {
        let (u, v) = ([d[0], d[1]], [d[2], d[3]]);
        let half = minor(&u, &v);
        numerator(&u, &v, AXIS) + (half + half) * d[4]
    }
}

/// (|s|² − |r|²)·[uv] − U·(s − r), all relative to a.
struct Nearer;

impl Polynomial<8> for Nearer {
    const DEGREE: u32 = 4;
    const ROUNDINGS: u32 = 12;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 8]) -> N {
        let (u, v, r, s) = ([d[0], d[1]], [d[2], d[3]], [d[4], d[5]], [d[6], d[7]]);
        let center = [0, 1].map(|axis| numerator(&u, &v, axis));
        (lift(&s) - lift(&r)) * minor(&u, &v) - dot(&center, &[s[0] - r[0], s[1] - r[1]])
    }
}

/// Tests whether q lies inside (positive), on (zero) or outside the circle with diameter ab, the smallest one through a
/// and b. An edge of a Delaunay triangulation with no vertex inside it is a Gabriel edge.
#[must_use]
pub fn in_diametral_circle(a: Point, b: Point, q: Point) -> Sign {
    cascade::sign::<InDiametralCircle, 4>(&[[q[0], a[0]], [q[1], a[1]], [b[0], q[0]], [b[1], q[1]]])
}

/// The sign of coordinate `axis` of the circumcenter of abc, less t: on which side of a cut it lies. The triangle may
/// turn either way; zero for three points of a line, which have no circumcenter.
///
/// # Panics
/// If `axis` is not 0 or 1.
#[must_use]
pub fn circumcenter_side(a: Point, b: Point, c: Point, axis: usize, t: f64) -> Sign {
    let differences = [[b[0], a[0]], [b[1], a[1]], [c[0], a[0]], [c[1], a[1]], [a[axis], t]];
    let numerator = match axis {
        0 => cascade::sign::<Side<0>, 5>(&differences),
        _ => cascade::sign::<Side<1>, 5>(&differences),
    };
    numerator * orient(a, b, c)
}

/// Tests whether the circumcenter of abc is nearer to r (positive) or to s (negative), or as near to one as to the other.
/// The triangle may turn either way; zero for three points of a line, which have no circumcenter.
#[must_use]
pub fn circumcenter_nearer(a: Point, b: Point, c: Point, r: Point, s: Point) -> Sign {
    let [b_, c_, r_, s_] = [b, c, r, s].map(|p| [[p[0], a[0]], [p[1], a[1]]]);
    let differences = [b_[0], b_[1], c_[0], c_[1], r_[0], r_[1], s_[0], s_[1]];
    cascade::sign::<Nearer, 8>(&differences) * orient(a, b, c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::tests::constants_are_those_of;

    #[test]
    fn constants() {
        constants_are_those_of::<InDiametralCircle, 4>();
        constants_are_those_of::<Side<0>, 5>();
        constants_are_those_of::<Side<1>, 5>();
        constants_are_those_of::<Nearer, 8>();
    }
}
