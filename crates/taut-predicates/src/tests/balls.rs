//! Circumcenters and smallest balls: 350 000 cases.

use num_bigint::BigInt;

use crate::Sign;
use crate::tests::cases::{case, lattice_sphere};
use crate::tests::oracle::{self, Exactly};
use crate::tests::{Met, Random, test_length::long_or};
use crate::{plane, space};

/// q − a by b − q, added up.
fn in_diametral(truth: &Exactly, a: usize, b: usize, q: usize) -> Sign {
    let p = &truth.points;
    let terms = (0..truth.dim).map(|i| (&p[q][i] - &p[a][i]) * (&p[b][i] - &p[q][i]));
    oracle::sign(&terms.sum::<BigInt>())
}

/// Tests whether the circumcenter of the simplex `vertices` is beyond coordinate `axis` of point t.
fn side(truth: &Exactly, vertices: &[usize], axis: usize, t: usize) -> Sign {
    let (numerators, denominator) = truth.circumcenter(vertices);
    let beyond = &numerators[axis] - &truth.points[t][axis] * &denominator;
    oracle::sign(&beyond) * oracle::sign(&denominator)
}

fn nearer(truth: &Exactly, vertices: &[usize], r: usize, s: usize) -> Sign {
    let center = truth.circumcenter(vertices);
    let sign = oracle::sign(&(truth.distance2(s, &center) - truth.distance2(r, &center)));
    if oracle::sign(&center.1).is_zero() { Sign::Zero } else { sign }
}

#[test]
fn plane_agrees_with_exact_integers() {
    let (mut random, sphere) = (Random(4), lattice_sphere::<2>());
    let [mut diametral, mut sides, mut distances] = [(); 3].map(|()| Met::default());
    for number in 0..long_or(150_000, 15_000) {
        let points = case::<2, 5>(number, &mut random, &sphere).points;
        let [a, b, c, r, s] = points;
        let truth = Exactly::new(&points);
        let sign = in_diametral(&truth, 0, 1, 3);
        diametral.count(sign);
        assert_eq!(plane::in_diametral_circle(a, b, r), sign, "{points:?}");
        assert_eq!(plane::in_diametral_circle(b, a, r), sign, "{points:?}");
        for axis in 0..2 {
            let sign = side(&truth, &[0, 1, 2], axis, 3);
            sides.count(sign);
            assert_eq!(plane::circumcenter_side(a, b, c, axis, r[axis]), sign, "{points:?}");
            assert_eq!(plane::circumcenter_side(c, b, a, axis, r[axis]), sign, "{points:?}");
        }
        let sign = nearer(&truth, &[0, 1, 2], 3, 4);
        distances.count(sign);
        assert_eq!(plane::circumcenter_nearer(a, b, c, r, s), sign, "{points:?}");
        assert_eq!(plane::circumcenter_nearer(b, a, c, s, r), -sign, "{points:?}");
    }
    for met in [diametral, sides, distances] {
        assert!(met.is_balanced(50), "{met:?}");
    }
}

#[test]
fn space_agrees_with_exact_integers() {
    let (mut random, sphere) = (Random(5), lattice_sphere::<3>());
    let [mut diametral, mut sides, mut distances] = [(); 3].map(|()| Met::default());
    for number in 0..long_or(100_000, 10_000) {
        let points = case::<3, 6>(number, &mut random, &sphere).points;
        let [a, b, c, d, r, s] = points;
        let truth = Exactly::new(&points);
        let sign = in_diametral(&truth, 0, 1, 4);
        diametral.count(sign);
        assert_eq!(space::in_diametral_sphere(a, b, r), sign, "{points:?}");
        let axis = random.below(3) as usize;
        let sign = side(&truth, &[0, 1, 2, 3], axis, 4);
        sides.count(sign);
        assert_eq!(space::circumcenter_side(a, b, c, d, axis, r[axis]), sign, "{points:?}");
        assert_eq!(space::circumcenter_side(d, b, c, a, axis, r[axis]), sign, "{points:?}");
        let sign = nearer(&truth, &[0, 1, 2, 3], 4, 5);
        distances.count(sign);
        assert_eq!(space::circumcenter_nearer(a, b, c, d, r, s), sign, "{points:?}");
        assert_eq!(space::circumcenter_nearer(b, a, c, d, s, r), -sign, "{points:?}");
    }
    for met in [diametral, sides, distances] {
        assert!(met.is_balanced(50), "{met:?}");
    }
}

#[test]
fn facets_agree_with_exact_integers() {
    let (mut random, sphere) = (Random(6), lattice_sphere::<3>());
    let (mut whole, mut shrunk) = (Met::default(), Met::default());
    for number in 0..long_or(100_000, 10_000) {
        let points = case::<3, 4>(number, &mut random, &sphere).points;
        let [a, b, c, q] = points;
        let truth = Exactly::new(&points);
        let center = truth.circumcenter(&[0, 1, 2]);
        let (radius2, distance2) = (truth.distance2(0, &center), truth.distance2(3, &center));
        let flat = oracle::sign(&center.1).is_zero();
        let sign = if flat { Sign::Zero } else { oracle::sign(&(&radius2 - &distance2)) };
        whole.count(sign);
        assert_eq!(space::in_equatorial_sphere(a, b, c, q), sign, "{points:?}");
        assert_eq!(space::in_equatorial_sphere(c, b, a, q), sign, "{points:?}");

        // 1 − ε and 1 in one unit.
        let epsilon = random.pick(&[0.0, 2e-5, 0.25, 0.5, 1e-300, 1.0, f64::EPSILON]);
        let scale = oracle::integers(&[1.0, epsilon]);
        let (one, rest) = (&scale[0], &scale[0] - &scale[1]);
        let sign = match (flat, a != b && b != c && c != a && epsilon > 0.0) {
            (false, _) => oracle::sign(&(radius2 * &rest * &rest - distance2 * one * one)),
            (true, true) => Sign::Negative,
            (true, false) => Sign::Zero,
        };
        shrunk.count(sign);
        assert_eq!(space::shrunk_sphere(a, b, c, q, epsilon), sign, "{points:?} {epsilon}");
        assert_eq!(space::shrunk_sphere(b, a, c, q, epsilon), sign, "{points:?} {epsilon}");
    }
    assert!(whole.is_balanced(100) && shrunk.is_balanced(100), "{whole:?} {shrunk:?}");
}

/// The ends of the exponent range in one call: the longest integers there are. What is not a number has no sign, but
/// an end.
#[test]
fn extremes_fit() {
    let (max, min) = (f64::MAX, f64::from_bits(1));
    let plane = [[max, min], [-max, max], [-min, -max], [max, -max], [min, max]];
    let [a, b, c, r, s] = plane;
    let truth = Exactly::new(&plane);
    assert_eq!(plane::in_diametral_circle(a, b, r), in_diametral(&truth, 0, 1, 3));
    assert_eq!(plane::circumcenter_side(a, b, c, 1, r[1]), side(&truth, &[0, 1, 2], 1, 3));
    assert_eq!(plane::circumcenter_nearer(a, b, c, r, s), nearer(&truth, &[0, 1, 2], 3, 4));

    let space = [
        [max, min, -max],
        [-max, max, min],
        [-min, -max, max],
        [max, -max, -min],
        [min, max, max],
        [-max, -max, min],
    ];
    let [a, b, c, d, r, s] = space;
    let truth = Exactly::new(&space);
    let all = [0, 1, 2, 3];
    assert_eq!(space::circumcenter_side(a, b, c, d, 1, r[1]), side(&truth, &all, 1, 4));
    assert_eq!(space::circumcenter_nearer(a, b, c, d, r, s), nearer(&truth, &all, 4, 5));
    assert_eq!(space::in_sphere(a, b, c, d, r), oracle::sign(&truth.in_sphere()));
    let center = truth.circumcenter(&[0, 1, 2]);
    let power = truth.distance2(0, &center) - truth.distance2(3, &center);
    assert_eq!(space::in_equatorial_sphere(a, b, c, d), oracle::sign(&power));
    assert_eq!(space::shrunk_sphere(a, b, c, d, 0.0), oracle::sign(&power));
    assert_eq!(space::shrunk_sphere(a, b, c, d, min), oracle::sign(&power));

    for strange in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for i in 0..3 {
            let mut a = a;
            a[i] = strange;
            std::hint::black_box((
                space::conflict(a, b, c, d, r),
                space::conflict(d, b, c, r, a),
                space::orient(a, b, c, d),
                space::in_equatorial_sphere(a, b, c, d),
                space::shrunk_sphere(a, b, c, d, strange),
                space::circumcenter_side(a, b, c, d, 2, strange),
                space::circumcenter_nearer(a, b, c, d, r, a),
            ));
        }
    }
}
