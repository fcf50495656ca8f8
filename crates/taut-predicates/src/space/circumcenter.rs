//! Where a circumcenter lies, by exact signs of rational functions.

use crate::cascade;
use crate::number::{Number, Polynomial};
use crate::sign::Sign;
use crate::space::polynomials::{determinant, dot, lift, numerator};
use crate::space::{Point, orient};

/// U + 2·det(u, v, w)·(a − t) along one axis.
struct Side<const AXIS: usize>;

impl<const AXIS: usize> Polynomial<10> for Side<AXIS> {
    const DEGREE: u32 = 4;
    const ROUNDINGS: u32 = 13;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 10]) -> N {
        let [u, v, w] = [[d[0], d[1], d[2]], [d[3], d[4], d[5]], [d[6], d[7], d[8]]];
        let half = determinant(&u, &v, &w);
        numerator(&u, &v, &w, AXIS) + (half + half) * d[9]
    }
}

/// (|s|² − |r|²)·det(u, v, w) − U·(s − r), all relative to a.
struct Nearer;

impl Polynomial<15> for Nearer {
    const DEGREE: u32 = 5;
    const ROUNDINGS: u32 = 18;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 15]) -> N {
        let [u, v, w] = [[d[0], d[1], d[2]], [d[3], d[4], d[5]], [d[6], d[7], d[8]]];
        let (r, s) = ([d[9], d[10], d[11]], [d[12], d[13], d[14]]);
        let center = [0, 1, 2].map(|axis| numerator(&u, &v, &w, axis));
        let way = [s[0] - r[0], s[1] - r[1], s[2] - r[2]];
        (lift(&s) - lift(&r)) * determinant(&u, &v, &w) - dot(&center, &way)
    }
}

/// The sign of coordinate `axis` of the circumcenter of abcd, less t: on which side of a cut it lies. The tetrahedron
/// may be of either orientation; zero for four points of a plane, which have no circumcenter.
///
/// # Panics
/// If `axis` is not 0, 1 or 2.
#[must_use]
pub fn circumcenter_side(a: Point, b: Point, c: Point, d: Point, axis: usize, t: f64) -> Sign {
    let points = [b, c, d];
    let differences: [_; 10] = std::array::from_fn(|i| match i {
        0..9 => [points[i / 3][i % 3], a[i % 3]],
        _ => [a[axis], t],
    });
    let numerator = match axis {
        0 => cascade::sign::<Side<0>, 10>(&differences),
        1 => cascade::sign::<Side<1>, 10>(&differences),
        _ => cascade::sign::<Side<2>, 10>(&differences),
    };
    numerator * orient(a, b, c, d)
}

/// Tests whether the circumcenter of abcd is nearer to r (positive) or to s (negative), or as near to one as to the other.
/// The tetrahedron may be of either orientation; zero for four points of a plane, which have no circumcenter.
#[must_use]
pub fn circumcenter_nearer(a: Point, b: Point, c: Point, d: Point, r: Point, s: Point) -> Sign {
    let points = [b, c, d, r, s];
    let differences = std::array::from_fn(|i| [points[i / 3][i % 3], a[i % 3]]);
    cascade::sign::<Nearer, 15>(&differences) * orient(a, b, c, d)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::tests::constants_are_those_of;

    #[test]
    fn constants() {
        constants_are_those_of::<Side<0>, 10>();
        constants_are_those_of::<Side<1>, 10>();
        constants_are_those_of::<Side<2>, 10>();
        constants_are_those_of::<Nearer, 15>();
    }
}
