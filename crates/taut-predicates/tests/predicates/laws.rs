//! Tests what has to hold whatever the answer is: moving and scaling a point set, and who asks whom.

use taut_predicates::{Exact, Sign, Stages, plane, space};

/// Whole numbers in [−m, m], by a linear congruence (Knuth, MMIX).
struct Whole(u64);

impl Whole {
    fn next(&mut self, m: i64) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as i64 % (2 * m + 1) - m) as f64
    }

    fn point<const D: usize>(&mut self, m: i64) -> [f64; D] {
        [(); D].map(|()| self.next(m))
    }
}

/// Exact images of whole points: moved far away, and scaled as far as the exponents go.
const MOVES: [(f64, f64); 9] = [
    (0.0, 1.0),
    (1.0, 1.0),
    (1099511627776.0, 1.0),
    (-4503599627370496.0, 1.0),
    (0.0, 5e-324),
    (0.0, 1e-300),
    (3.0, 1.4916681462400413e-154),
    (0.0, 1.3407807929942597e154),
    (3.0, 2.247116418577895e307),
];

fn moved<const D: usize>(p: [f64; D], (by, times): (f64, f64)) -> [f64; D] {
    // Powers of two, so that no rounding changes the set.
    let exponent = times.to_bits() >> 52;
    let times = if exponent == 0 { times } else { f64::from_bits(exponent << 52) };
    p.map(|x| (x + by) * times)
}

#[test]
fn moving_and_scaling_change_nothing_in_the_plane() {
    let mut random = Whole(1);
    for m in [1, 2, 3] {
        for _ in 0..2000 {
            let points: [[f64; 2]; 4] = [(); 4].map(|()| random.point(m));
            let signs = MOVES.map(|way| {
                let [a, b, c, q] = points.map(|p| moved(p, way));
                let ccw = plane::orient(a, b, c).is_positive() && ![a, b, c].contains(&q);
                let inside = ccw && plane::conflict(a, b, c, q);
                (plane::orient(a, b, c), plane::in_circle(a, b, c, q), inside)
            });
            assert!(signs.iter().all(|s| *s == signs[0]), "{points:?}: {signs:?}");
        }
    }
}

#[test]
fn moving_and_scaling_change_nothing_in_space() {
    let mut random = Whole(2);
    for m in [1, 2] {
        for _ in 0..2000 {
            let points: [[f64; 3]; 5] = [(); 5].map(|()| random.point(m));
            let signs = MOVES.map(|way| {
                let [a, b, c, d, q] = points.map(|p| moved(p, way));
                let positive = space::orient(a, b, c, d).is_positive();
                let distinct = ![a, b, c, d].contains(&q);
                let inside = positive && distinct && space::conflict(a, b, c, d, q);
                let facet = space::in_equatorial_sphere(a, b, c, q);
                (space::orient(a, b, c, d), space::in_sphere(a, b, c, d, q), inside, facet)
            });
            assert!(signs.iter().all(|s| *s == signs[0]), "{points:?}: {signs:?}");
        }
    }
}

/// Two simplices that share a facet ask for each other's apex: both say the same, also where it is a tie.
#[test]
fn neighbors_agree() {
    let (mut random, mut ties) = (Whole(3), 0);
    for _ in 0..100_000 {
        let [a, b, c, q]: [[f64; 2]; 4] = [(); 4].map(|()| random.point(2));
        // abc and bqc, the apex on either side of bc.
        if plane::orient(a, b, c).is_positive() && plane::orient(b, q, c).is_positive() {
            assert_eq!(
                plane::conflict(a, b, c, q),
                plane::conflict(b, q, c, a),
                "{a:?}{b:?}{c:?}{q:?}"
            );
            ties += u32::from(plane::in_circle(a, b, c, q).is_zero());
        }
        let [a, b, c, d, q]: [[f64; 3]; 5] = [(); 5].map(|()| random.point(1));
        if space::orient(a, b, c, d).is_positive() && space::orient(q, b, d, c).is_positive() {
            let (one, other) = (space::conflict(a, b, c, d, q), space::conflict(q, b, d, c, a));
            assert_eq!(one, other, "{a:?}{b:?}{c:?}{d:?}{q:?}");
            ties += u32::from(space::in_sphere(a, b, c, d, q).is_zero());
        }
    }
    assert!(ties > 2000, "{ties} ties");
}

#[test]
fn each_call_counts_once_at_the_stage_that_decided() {
    let ([a, b, c], q) = ([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]], [0.0, 1.0]);
    let asked = |integral: bool, times: f64| {
        let mut exact = Exact::new(integral);
        let [a, b, c, q] = [a, b, c, q].map(|p| p.map(|x| x * times));
        assert!(plane::conflict_exact(a, b, c, q, &mut exact));
        exact.stages
    };
    assert_eq!(asked(true, 1.0), Stages { integer: 1, ties: 1, ..Stages::default() });
    assert_eq!(asked(true, 1e6), Stages { wide: 1, ties: 1, ..Stages::default() });
    assert_eq!(asked(false, 0.1), Stages { wide: 1, ties: 1, ..Stages::default() });

    let mut exact = Exact::default();
    let sign = plane::in_circle_exact(a, b, [1.0, 1e-30], [0.3, 0.0], &mut exact);
    assert_eq!((sign, exact.stages.double_double), (Sign::Positive, 1));
    let sign = plane::in_circle_exact(a, b, [1.0, 1e-200], [0.0, 1e-200], &mut exact);
    assert_eq!((sign, exact.stages.unbounded, exact.stages.ties), (Sign::Zero, 1, 0));
    let mut sum = exact.stages;
    sum += Stages { filter: 3, ..exact.stages };
    assert_eq!((sum.calls(), sum.unbounded, sum.double_double), (7, 2, 2));
}
