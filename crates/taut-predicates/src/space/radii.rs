//! Radii of the smallest spheres through three and four points, compared with a given one.

use crate::cascade;
use crate::number::{Number, Polynomial};
use crate::sign::Sign;
use crate::space::Point;
use crate::space::polynomials::{cross, determinant, lift, numerator};

/// 4ρ²|n|² − |u|²|v|²|u − v|², where n = u × v: R² = |u|²|v|²|u − v|²/4|n|².
struct EquatorialRadius;

impl Polynomial<10> for EquatorialRadius {
    const DEGREE: u32 = 6;
    const ROUNDINGS: u32 = 18;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 10]) -> N {
        let [u, v, edge] = [[d[0], d[1], d[2]], [d[3], d[4], d[5]], [d[6], d[7], d[8]]];
        let diameter = d[9] + d[9];
        diameter * diameter * lift(&cross(&u, &v)) - lift(&u) * lift(&v) * lift(&edge)
    }
}

/// 4ρ²·det(u, v, w)² − |U|², where the circumcenter of 0uvw is U/2·det(u, v, w).
struct SphereRadius;

impl Polynomial<10> for SphereRadius {
    const DEGREE: u32 = 8;
    const ROUNDINGS: u32 = 28;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 10]) -> N {
        let [u, v, w] = [[d[0], d[1], d[2]], [d[3], d[4], d[5]], [d[6], d[7], d[8]]];
        let center = [0, 1, 2].map(|axis| numerator(&u, &v, &w, axis));
        let (diameter, volume) = (d[9] + d[9], determinant(&u, &v, &w));
        diameter * diameter * (volume * volume) - lift(&center)
    }
}

/// The sign of ρ − R, where R is the radius of the smallest sphere through a, b and c, and ρ is not negative: positive
/// where a sphere of radius ρ can pass through them and another one, too. Negative for three distinct points of a line,
/// whose R is infinite.
#[must_use]
pub fn equatorial_radius(a: Point, b: Point, c: Point, rho: f64) -> Sign {
    cascade::sign::<EquatorialRadius, 10>(&std::array::from_fn(|i| match i {
        0..3 => [b[i], a[i]],
        3..6 => [c[i - 3], a[i - 3]],
        6..9 => [b[i - 6], c[i - 6]],
        _ => [rho, 0.0],
    }))
}

/// The sign of ρ − R, where R is the radius of the sphere through a, b, c and d, and ρ is not negative. The tetrahedron
/// may be of either orientation; never positive for four points of a plane: there R is infinite, or they lie on a circle
/// and the sign is zero.
#[must_use]
pub fn sphere_radius(a: Point, b: Point, c: Point, d: Point, rho: f64) -> Sign {
    let points = [b, c, d];
    cascade::sign::<SphereRadius, 10>(&std::array::from_fn(|i| match i {
        0..9 => [points[i / 3][i % 3], a[i % 3]],
        _ => [rho, 0.0],
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::tests::constants_are_those_of;

    #[test]
    fn constants() {
        constants_are_those_of::<EquatorialRadius, 10>();
        constants_are_those_of::<SphereRadius, 10>();
    }
}
