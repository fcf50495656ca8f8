//! Space: 250 000 cases.

use crate::space::exact::{InSphere, Orient, any_length, fixed, relative, whole};
use crate::space::*;
use crate::tests::cases::{case, lattice_sphere};
use crate::tests::oracle::{self, Exactly};
use crate::tests::{Met, Random, test_length::long_or};
use crate::{Exact, Fused, Separate, Sign, double_double, unbounded};

#[test]
fn space_agrees_with_exact_integers() {
    let (mut random, sphere) = (Random(3), lattice_sphere::<3>());
    let (mut met, mut oriented) = (Met::default(), Met::default());
    let (mut broken, mut exact) = (0, Exact::default());
    for number in 0..long_or(250_000, 18_000) {
        let case = case::<3, 5>(number, &mut random, &sphere);
        let [mut a, mut b, c, d, q] = case.points;
        let mut truth = Exactly::new(&[a, b, c, d, q]);

        let turn = oracle::sign(&truth.orient(&[0, 1, 2, 3]));
        oriented.count(turn);
        check_orient([a, b, c, d], turn, case.integral, &mut random);
        if turn.is_negative() {
            (a, b) = (b, a);
            truth.points.swap(0, 1);
        }
        let sign = oracle::sign(&truth.in_sphere());
        met.count(sign);
        exact.integral = case.integral;
        check_in_sphere([a, b, c, d, q], sign, &mut exact, &mut random);
        let distinct = ![a, b, c, d].contains(&q);
        if !turn.is_zero() && distinct {
            let inside = if sign.is_zero() { truth.in_sphere_perturbed() } else { sign };
            broken += u64::from(sign.is_zero());
            check_conflict([a, b, c, d, q], inside, &mut exact);
        }
    }
    assert!(met.is_balanced(50) && oriented.is_balanced(50), "{met:?} {oriented:?}");
    assert!(broken > long_or(15_000, 900), "{broken} ties");
    let stages = exact.stages;
    for count in [stages.integer, stages.wide, stages.double_double, stages.unbounded] {
        assert!(count > long_or(10_000, 600), "{stages:?}");
    }
}

fn check_orient(points: [Point; 4], sign: Sign, integral: bool, random: &mut Random) {
    let [a, b, c, d] = points;
    assert_eq!(orient(a, b, c, d), sign, "{points:?}");
    assert_eq!(orient_exact(a, b, c, d, &mut Exact::new(integral)), sign, "{points:?}");
    assert_eq!(orient_exact(a, b, c, d, &mut Exact::new(false)), sign, "{points:?}");
    let differences = relative([b, c, d], a);
    assert_eq!(unbounded::sign::<Orient, 9>(&differences), sign, "{points:?}");
    if let Some(found) = double_double::sign::<Orient, 9>(&differences) {
        assert_eq!(found, sign, "{points:?}");
    }
    if points.as_flattened().iter().all(|x| x.abs() <= (1u64 << 40) as f64) {
        for det in [orient_filter::<Separate>(a, b, c, d), orient_filter::<Fused>(a, b, c, d)] {
            assert!(det == 0.0 || Sign::from(det) == sign, "{points:?}");
        }
    }
    let mut shuffled = points;
    let odd = random.shuffle(&mut shuffled);
    let [a, b, c, d] = shuffled;
    assert_eq!(orient(a, b, c, d), if odd { -sign } else { sign }, "{points:?}");
}

fn check_in_sphere(points: [Point; 5], sign: Sign, exact: &mut Exact, random: &mut Random) {
    let [a, b, c, d, q] = points;
    assert_eq!(in_sphere(a, b, c, d, q), sign, "{points:?}");
    assert_eq!(in_sphere_exact(a, b, c, d, q, exact), sign, "{points:?}");
    assert_eq!(any_length::<false>([a, b, c, d], q, &mut 0), sign, "{points:?}");
    let differences = relative([a, b, c, d], q);
    if let Some(found) = double_double::sign::<InSphere, 12>(&differences) {
        assert_eq!(found, sign, "{points:?}");
    }
    if let Some(found) = fixed::<false>([a, b, c, d], q, &mut 0) {
        assert_eq!(found, sign, "{points:?}");
    }
    if exact.integral
        && let Some(found) = whole::<false>([a, b, c, d], q, &mut 0)
    {
        assert_eq!(found, sign, "{points:?}");
    }
    if points.as_flattened().iter().all(|x| x.abs() <= (1u64 << 40) as f64) {
        for det in
            [in_sphere_filter::<Separate>(a, b, c, d, q), in_sphere_filter::<Fused>(a, b, c, d, q)]
        {
            assert!(det == 0.0 || Sign::from(det) == sign, "{points:?}");
        }
    }
    // Antisymmetric in all five points.
    let mut shuffled = points;
    let odd = random.shuffle(&mut shuffled);
    let [a, b, c, d, q] = shuffled;
    assert_eq!(in_sphere(a, b, c, d, q), if odd { -sign } else { sign }, "{points:?}");
}

fn check_conflict(points: [Point; 5], inside: Sign, exact: &mut Exact) {
    let [a, b, c, d, q] = points;
    assert!(!inside.is_zero(), "the perturbation leaves no tie: {points:?}");
    let truth = inside.is_positive();
    assert_eq!(conflict(a, b, c, d, q), truth, "{points:?}");
    assert_eq!(conflict_exact(a, b, c, d, q, exact), truth, "{points:?}");
    assert_eq!(conflict_exact(b, c, a, d, q, exact), truth, "{points:?}");
    assert_eq!(conflict_exact(d, b, a, c, q, exact), truth, "{points:?}");
    assert_eq!(any_length::<true>([a, b, c, d], q, &mut 0), inside, "{points:?}");
    if let Some(found) = fixed::<true>([a, b, c, d], q, &mut 0) {
        assert_eq!(found, inside, "{points:?}");
    }
    if exact.integral
        && let Some(found) = whole::<true>([a, b, c, d], q, &mut 0)
    {
        assert_eq!(found, inside, "{points:?}");
    }
}

#[test]
fn order_is_lexicographic_and_knows_one_zero() {
    use std::cmp::Ordering::{Equal, Greater, Less};
    assert_eq!(lexicographic([0.0, 1.0, -0.0], [-0.0, 1.0, 0.0]), Equal);
    assert_eq!(lexicographic([0.0, 1.0, 0.0], [-0.0, 1.0, 5e-324]), Less);
    assert_eq!(lexicographic([0.0, 2.0, 0.0], [0.0, 1.0, 9.0]), Greater);
}
