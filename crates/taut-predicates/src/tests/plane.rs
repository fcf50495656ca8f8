//! The plane: 400 000 cases.

use crate::plane::exact::{InCircle, Orient, any_length, fixed, relative, whole};
use crate::plane::*;
use crate::tests::cases::{case, lattice_sphere};
use crate::tests::oracle::{self, Exactly};
use crate::tests::{Met, Random, test_length::long_or};
use crate::{Exact, Fused, Separate, Sign, double_double, unbounded};

#[test]
fn plane_agrees_with_exact_integers() {
    let (mut random, sphere) = (Random(2), lattice_sphere::<2>());
    let (mut met, mut oriented) = (Met::default(), Met::default());
    let (mut broken, mut exact) = (0, Exact::default());
    for number in 0..long_or(400_000, 30_000) {
        let case = case::<2, 4>(number, &mut random, &sphere);
        let [mut a, mut b, c, q] = case.points;
        let mut truth = Exactly::new(&[a, b, c, q]);

        let turn = oracle::sign(&truth.orient(&[0, 1, 2]));
        oriented.count(turn);
        check_orient([a, b, c], turn, case.integral, &mut random);
        if turn.is_negative() {
            (a, b) = (b, a);
            truth.points.swap(0, 1);
        }
        let sign = oracle::sign(&truth.in_sphere());
        met.count(sign);
        exact.integral = case.integral;
        check_in_circle([a, b, c, q], sign, &mut exact, &mut random);
        let distinct = ![a, b, c].contains(&q);
        if !turn.is_zero() && distinct {
            let inside = if sign.is_zero() { truth.in_sphere_perturbed() } else { sign };
            broken += u64::from(sign.is_zero());
            check_conflict([a, b, c, q], inside, &mut exact);
        }
    }
    assert!(met.is_balanced(50) && oriented.is_balanced(50), "{met:?} {oriented:?}");
    assert!(broken > long_or(25_000, 1_600), "{broken} ties");
    let stages = exact.stages;
    for count in [stages.integer, stages.wide, stages.double_double, stages.unbounded] {
        assert!(count > long_or(10_000, 600), "{stages:?}");
    }
}

fn check_orient(points: [Point; 3], sign: Sign, integral: bool, random: &mut Random) {
    let [a, b, c] = points;
    assert_eq!(orient(a, b, c), sign, "{points:?}");
    assert_eq!(orient_exact(a, b, c, &mut Exact::new(integral)), sign, "{points:?}");
    assert_eq!(orient_exact(a, b, c, &mut Exact::new(false)), sign, "{points:?}");
    let differences = relative([b, c], a);
    assert_eq!(unbounded::sign::<Orient, 4>(&differences), sign, "{points:?}");
    if let Some(found) = double_double::sign::<Orient, 4>(&differences) {
        assert_eq!(found, sign, "{points:?}");
    }
    if points.as_flattened().iter().all(|x| x.abs() <= (1u64 << 40) as f64) {
        for det in [orient_filter::<Separate>(a, b, c), orient_filter::<Fused>(a, b, c)] {
            assert!(det == 0.0 || Sign::from(det) == sign, "{points:?}");
        }
    }
    let mut shuffled = points;
    let odd = random.shuffle(&mut shuffled);
    let [a, b, c] = shuffled;
    assert_eq!(orient(a, b, c), if odd { -sign } else { sign }, "{points:?}");
}

fn check_in_circle(points: [Point; 4], sign: Sign, exact: &mut Exact, random: &mut Random) {
    let [a, b, c, q] = points;
    assert_eq!(in_circle(a, b, c, q), sign, "{points:?}");
    assert_eq!(in_circle_exact(a, b, c, q, exact), sign, "{points:?}");
    assert_eq!(any_length::<false>([a, b, c], q, &mut 0), sign, "{points:?}");
    let differences = relative([a, b, c], q);
    if let Some(found) = double_double::sign::<InCircle, 6>(&differences) {
        assert_eq!(found, sign, "{points:?}");
    }
    if let Some(found) = fixed::<false>([a, b, c], q, &mut 0) {
        assert_eq!(found, sign, "{points:?}");
    }
    if exact.integral
        && let Some(found) = whole::<false>([a, b, c], q, &mut 0)
    {
        assert_eq!(found, sign, "{points:?}");
    }
    if points.as_flattened().iter().all(|x| x.abs() <= (1u64 << 40) as f64) {
        for det in [in_circle_filter::<Separate>(a, b, c, q), in_circle_filter::<Fused>(a, b, c, q)]
        {
            assert!(det == 0.0 || Sign::from(det) == sign, "{points:?}");
        }
    }
    // Antisymmetric in all four points.
    let mut shuffled = points;
    let odd = random.shuffle(&mut shuffled);
    let [a, b, c, q] = shuffled;
    assert_eq!(in_circle(a, b, c, q), if odd { -sign } else { sign }, "{points:?}");
}

fn check_conflict(points: [Point; 4], inside: Sign, exact: &mut Exact) {
    let [a, b, c, q] = points;
    assert!(!inside.is_zero(), "the perturbation leaves no tie: {points:?}");
    let truth = inside.is_positive();
    assert_eq!(conflict(a, b, c, q), truth, "{points:?}");
    assert_eq!(conflict_exact(a, b, c, q, exact), truth, "{points:?}");
    assert_eq!(conflict_exact(b, c, a, q, exact), truth, "{points:?}");
    assert_eq!(conflict_exact(c, a, b, q, exact), truth, "{points:?}");
    assert_eq!(any_length::<true>([a, b, c], q, &mut 0), inside, "{points:?}");
    if let Some(found) = fixed::<true>([a, b, c], q, &mut 0) {
        assert_eq!(found, inside, "{points:?}");
    }
    if exact.integral
        && let Some(found) = whole::<true>([a, b, c], q, &mut 0)
    {
        assert_eq!(found, inside, "{points:?}");
    }
}

#[test]
fn order_is_lexicographic_and_knows_one_zero() {
    use std::cmp::Ordering::{Equal, Greater, Less};
    assert_eq!(lexicographic([0.0, -0.0], [-0.0, 0.0]), Equal);
    assert_eq!(lexicographic([0.0, 1.0], [-0.0, 2.0]), Less);
    assert_eq!(lexicographic([1.0, 1.0], [0.0, 2.0]), Greater);
}
