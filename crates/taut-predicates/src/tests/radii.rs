//! Radii of spheres beside given ones: 200 000 cases.

use num_bigint::BigInt;
use num_traits::{ToPrimitive, Zero};

use crate::Sign;
use crate::space::{self, Point};
use crate::tests::cases::{case, lattice_sphere};
use crate::tests::oracle::{self, Exactly};
use crate::tests::{Met, Random, test_length::long_or};

/// The sign of ρ − R for the sphere with this center, in integers: ρ²·denominator² against |p·denominator − numerators|².
/// The last point of `truth` is (ρ, 0, 0), so that ρ is in the same unit.
fn against(truth: &Exactly, vertices: &[usize]) -> Sign {
    let center = truth.circumcenter(vertices);
    let rho = &truth.points[truth.points.len() - 1][0];
    oracle::sign(&(rho * rho * &center.1 * &center.1 - truth.distance2(vertices[0], &center)))
}

/// R as a number, or none where it is infinite or beyond all numbers.
fn radius(truth: &Exactly, vertices: &[usize]) -> Option<f64> {
    let center = truth.circumcenter(vertices);
    if center.1.is_zero() {
        return None;
    }
    // 2²⁰⁰ times the square leaves room for its root.
    let square: BigInt = (truth.distance2(vertices[0], &center) << 200) / (&center.1 * &center.1);
    let root = square.sqrt().to_f64()? * 2f64.powi(-100) * 2f64.powi(truth.unit);
    root.is_finite().then_some(root)
}

/// Radii next to R and far from it.
fn radii(near: Option<f64>, random: &mut Random) -> [f64; 4] {
    let near = near.unwrap_or(1.0);
    [near, near.next_up(), near.next_down().max(0.0), near * random.pick(&[0.0, 0.5, 3.0, 1e9])]
        .map(|rho| rho.min(1e300))
}

#[test]
fn radii_agree_with_exact_integers() {
    let (mut random, sphere) = (Random(11), lattice_sphere::<3>());
    let (mut facets, mut cells) = (Met::default(), Met::default());
    for number in 0..long_or(25_000, 2_500) {
        let points = case::<3, 4>(number, &mut random, &sphere).points;
        let [a, b, c, d] = points;
        let plain = Exactly::new(&points);
        for rho in radii(radius(&plain, &[0, 1, 2]), &mut random) {
            let truth = Exactly::new(&[a, b, c, d, [rho, 0.0, 0.0]]);
            let flat = a != b && b != c && c != a && plain.circumcenter(&[0, 1, 2]).1.is_zero();
            let sign = if flat { Sign::Negative } else { against(&truth, &[0, 1, 2]) };
            facets.count(sign);
            assert_eq!(space::equatorial_radius(a, b, c, rho), sign, "{points:?} {rho}");
            assert_eq!(space::equatorial_radius(c, a, b, rho), sign, "{points:?} {rho}");
        }
        for rho in radii(radius(&plain, &[0, 1, 2, 3]), &mut random) {
            let truth = Exactly::new(&[a, b, c, d, [rho, 0.0, 0.0]]);
            let sign = against(&truth, &[0, 1, 2, 3]);
            cells.count(sign);
            assert_eq!(space::sphere_radius(a, b, c, d, rho), sign, "{points:?} {rho}");
            assert_eq!(space::sphere_radius(d, b, a, c, rho), sign, "{points:?} {rho}");
        }
    }
    // Of few facets fewer than 1 in 100 have a sign of zero.
    let one_in = long_or(100, 150);
    assert!(facets.is_balanced(one_in) && cells.is_balanced(one_in), "{facets:?} {cells:?}");
}

/// The ends of the exponent range in one call, and what is not a number.
#[test]
fn extremes_fit() {
    let (max, min) = (f64::MAX, f64::from_bits(1));
    let [a, b, c, d]: [Point; 4] =
        [[max, min, -max], [-max, max, min], [-min, -max, max], [max, -max, -min]];
    for rho in [0.0, min, 1.0, max] {
        let truth = Exactly::new(&[a, b, c, d, [rho, 0.0, 0.0]]);
        assert_eq!(space::equatorial_radius(a, b, c, rho), against(&truth, &[0, 1, 2]));
        assert_eq!(space::sphere_radius(a, b, c, d, rho), against(&truth, &[0, 1, 2, 3]));
    }
    for strange in [f64::NAN, f64::INFINITY] {
        std::hint::black_box((
            space::equatorial_radius(a, b, c, strange),
            space::equatorial_radius([strange; 3], b, c, 1.0),
            space::sphere_radius(a, b, c, d, strange),
            space::sphere_radius(a, [strange; 3], c, d, 1.0),
        ));
    }
}
