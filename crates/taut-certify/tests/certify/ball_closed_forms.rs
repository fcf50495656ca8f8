//! Balls whose radius is known from geometry, near 1 and at the ends of the range of `f64`.

use common::{Case, certify, is_inside, truth};
use taut_certify::{Items, Violation};

use crate::common;

/// The case is accepted, and its bracket holds the true radius.
fn accept(case: &Case, radius: f64) {
    let verdict = case.check().unwrap_or_else(|error| panic!("{}: {error}", case.name));
    let rounding = 1.0 + 4.0 * f64::EPSILON;
    assert_eq!(verdict.upper, case.solution.answer.radius);
    assert!(verdict.lower <= radius * rounding, "{}: {} {radius}", case.name, verdict.lower);
    assert!(verdict.upper * rounding >= radius, "{}: {} {radius}", case.name, verdict.upper);
    assert!(verdict.gap <= 2e-15, "{}: {:e}", case.name, verdict.gap);
    assert!(verdict.lower >= verdict.upper * (1.0 - 4e-15), "{}", case.name);
}

fn points(name: &'static str, values: &[f64], dim: usize, support: &[u64], lambda: &[f64]) -> Case {
    certify(name, values, dim, Items::Points, support, lambda, false)
}

fn balls(
    name: &'static str,
    values: &[f64],
    columns: usize,
    support: &[u64],
    lambda: &[f64],
) -> Case {
    certify(name, values, columns, Items::Balls, support, lambda, false)
}

#[test]
fn two_points_are_exact() {
    let case = points("two points", &[1.0, 2.0, 4.0, 6.0], 2, &[0, 1], &[0.5, 0.5]);
    let verdict = case.check().unwrap();
    assert_eq!((verdict.lower, verdict.upper, verdict.gap), (2.5, 2.5, 0.0));
}

#[test]
fn one_point_and_equal_points_have_radius_zero() {
    for n in [1, 2, 1000] {
        let values = [0.1, -0.7, 3e100].repeat(n);
        let case = points("equal", &values, 3, &[n as u64 - 1], &[1.0]);
        let verdict = case.check().unwrap();
        assert_eq!((verdict.lower, verdict.upper, verdict.gap), (0.0, 0.0, 0.0));
    }
}

#[test]
fn equal_points_but_one_are_refused_at_radius_zero() {
    let mut case = points("equal", &[0.3; 40], 2, &[4], &[1.0]);
    case.values[25] = 0.3f64.next_up();
    let points = taut_points::Points::new(&case.values, 2).unwrap();
    case.solution.certificate.points_hash =
        taut_points::hash_points(&points, &taut_points::Monitor::silent()).unwrap();
    assert!(matches!(case.violation(), Violation::Outside { row: 12, excess, .. } if excess > 0.0));
}

#[test]
fn simplices() {
    for d in 1..12 {
        // e₁ … e_d and the origin's mirror image a·(1 … 1): edges √2, circumradius √(d/(d + 1)).
        let apex = (1.0 - (d as f64 + 1.0).sqrt()) / d as f64;
        let mut values = vec![0.0; d * d];
        (0..d).for_each(|i| values[i * d + i] = 1.0);
        values.extend(vec![apex; d]);
        let lambda = vec![1.0 / (d as f64 + 1.0); d + 1];
        let support: Vec<u64> = (0..=d as u64).collect();
        let radius = (d as f64 / (d as f64 + 1.0)).sqrt();
        accept(&points("simplex", &values, d, &support, &lambda), radius);
    }
}

#[test]
fn cross_polytopes() {
    for d in 1..20 {
        let mut values = vec![0.0; 2 * d * d];
        (0..2 * d).for_each(|i| values[i * d + i / 2] = if i % 2 == 0 { 3.0 } else { -3.0 });
        let support: Vec<u64> = (0..2 * d as u64).collect();
        let case = points("cross-polytope", &values, d, &support, &vec![0.5 / d as f64; 2 * d]);
        accept(&case, 3.0);
        // One axis is as good a support as all.
        assert_eq!(points("axis", &values, d, &[0, 1], &[0.5, 0.5]).check().unwrap().gap, 0.0);
    }
}

#[test]
fn cubes() {
    for d in 1..11 {
        let values: Vec<f64> =
            (0..1usize << d).flat_map(|v| (0..d).map(move |j| (v >> j & 1) as f64)).collect();
        let last = (1u64 << d) - 1;
        let case = points("cube", &values, d, &[0, last], &[0.5, 0.5]);
        accept(&case, (d as f64).sqrt() / 2.0);
    }
}

#[test]
fn circles() {
    let n = 600;
    let values: Vec<f64> = (0..n)
        .flat_map(|i| {
            let angle = std::f64::consts::TAU * i as f64 / n as f64;
            [angle.cos(), angle.sin()]
        })
        .collect();
    accept(&points("circle", &values, 2, &[0, 200, 400], &[1.0 / 3.0; 3]), 1.0);
    accept(&points("circle", &values, 2, &[0, 300], &[0.5; 2]), 1.0);
}

#[test]
fn two_balls_inside_one() {
    // (|c₁ − c₂| + r₁ + r₂)/2 = (5 + 1 + 2)/2; the center lies 3 from the first and 2 from the second.
    let case = balls("two balls", &[0.0, 0.0, 1.0, 3.0, 4.0, 2.0], 3, &[0, 1], &[0.4, 0.6]);
    accept(&case, 4.0);
}

#[test]
fn one_ball_and_one_inside_another() {
    let alone = balls("one ball", &[0.1, 0.7, 0.3], 3, &[0], &[1.0]);
    assert_eq!(alone.check().unwrap().gap, 0.0);
    assert_eq!(alone.check().unwrap().lower, 0.3);
    // The second and third touch the first from inside, the fourth is a point.
    let values = [0.0, 0.0, 5.0, 3.0, 0.0, 2.0, 0.0, -4.5, 0.5, 3.0, 4.0, 0.0];
    let case = balls("nested", &values, 3, &[0], &[1.0]);
    let verdict = case.check().unwrap();
    assert_eq!((verdict.lower, verdict.upper, verdict.gap), (5.0, 5.0, 0.0));
}

#[test]
fn nearly_internal_tangency_loses_nothing() {
    for eta in [1e-4, 1e-8, 1e-11, 1e-13] {
        for r in [0.5, 0.25, 1e-6] {
            // A unit ball, and one of radius r that stands out by about η.
            let x = 1.0 - r + eta;
            let values = [0.0, 0.0, 1.0, x, 0.0, r];
            let radius = (x + r + 1.0) / 2.0;
            let second = (x + r - 1.0) / 2.0 / x;
            let case = balls("tangent", &values, 3, &[0, 1], &[1.0 - second, second]);
            accept(&case, radius);
        }
    }
}

#[test]
fn balls_of_radius_zero_are_points() {
    let flat = [0.0, 0.0, 4.0, 0.0, 1.0, 1.5];
    let with_radius = [0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 1.0, 1.5, 0.0];
    let of_points = points("points", &flat, 2, &[0, 1], &[0.5, 0.5]).check().unwrap();
    let of_balls = balls("balls", &with_radius, 3, &[0, 1], &[0.5, 0.5]).check().unwrap();
    assert_eq!(of_points, of_balls);
}

#[test]
fn any_scale() {
    let flat = [0.3, 0.1, -0.7, 0.9, 0.2, -0.8, -0.4, 0.35];
    let (support, lambda) = common::brute_force(&flat, 2).unwrap();
    let unit = points("scale", &flat, 2, &support, &lambda);
    for scale in [1e300, 1.7e308, 1e150, 1e62, 1e-62, 1e-150, 1e-290, 2f64.powi(-1021)] {
        let values: Vec<f64> = flat.iter().map(|v| v * scale).collect();
        // The fractions round correctly at any scale only where f64 does; so the center is scaled, too, and the
        // radius is enlarged by two ulps, which the gap then says.
        let mut case = Case { values, ..unit.clone() };
        let points = taut_points::Points::new(&case.values, 2).unwrap();
        let hash = taut_points::hash_points(&points, &taut_points::Monitor::silent()).unwrap();
        case.solution.certificate.points_hash = hash;
        let ball = &mut case.solution.answer;
        ball.center.iter_mut().for_each(|c| *c *= scale);
        ball.radius = (ball.radius * scale).next_up().next_up();
        case.solution.certificate.gap = 3e-15;
        let verdict = case.check().unwrap_or_else(|error| panic!("{scale:e}: {error}"));
        assert!(verdict.gap <= 3e-15 && verdict.lower > 0.0, "{scale:e}");
        let mut small = case.clone();
        small.solution.answer.radius *= 1.0 - 1e-14;
        assert!(matches!(small.violation(), Violation::Outside { .. }), "{scale:e}");
        let mut large = case.clone();
        large.solution.answer.radius *= 1.0 + 1e-9;
        assert!(matches!(large.violation(), Violation::Gap { .. }), "{scale:e}");
    }
}

#[test]
fn subnormal_points() {
    let least = f64::from_bits(1);
    // 0, 2 and 4 times the least number: center 2, radius 2.
    let values = [0.0, 2.0 * least, 4.0 * least];
    let mut case = points("subnormal", &[0.0, 2.0, 4.0], 1, &[0, 2], &[0.5, 0.5]);
    case.values = values.to_vec();
    let points = taut_points::Points::new(&values, 1).unwrap();
    case.solution.certificate.points_hash =
        taut_points::hash_points(&points, &taut_points::Monitor::silent()).unwrap();
    case.solution.answer.center = vec![2.0 * least];
    case.solution.answer.radius = 2.0 * least;
    let verdict = case.check().unwrap();
    assert!(verdict.gap <= 1e-100 && verdict.lower <= 2.0 * least);
    case.solution.answer.radius = least;
    assert!(matches!(case.violation(), Violation::Outside { row: 0, .. }));
}

#[test]
fn far_from_the_origin_with_and_without_a_tail() {
    let flat = [0.3, 0.1, -0.7, 0.9, 0.2, -0.8, -0.4, 0.35, 0.5, 0.5];
    for shift in [1e8, 1e12] {
        let values: Vec<f64> = flat.iter().map(|v| v + shift).collect();
        let near: Vec<f64> = values.iter().map(|v| v - shift).collect();
        let (support, lambda) = common::brute_force(&near, 2).unwrap();
        let plain = certify("shift", &values, 2, Items::Points, &support, &lambda, false);
        let tailed = certify("shift", &values, 2, Items::Points, &support, &lambda, true);
        let (plain, tailed) = (plain.check().unwrap(), tailed.check().unwrap());
        assert!(tailed.gap <= 1e-15, "{shift:e}: {:e}", tailed.gap);
        assert!(plain.gap <= shift * 1e-15, "{shift:e}: {:e}", plain.gap);
        assert!(plain.gap >= tailed.gap && plain.lower <= tailed.upper);
    }
}

#[test]
fn the_first_row_outside_is_named_with_its_excess() {
    let values = [0.0, 0.0, 2.0, 0.0, 1.0, 1.5, 1.0, 3.0];
    let mut case = points("outside", &values, 2, &[0, 1], &[0.5, 0.5]);
    case.solution.answer.radius = 1.0;
    let expected = Violation::Outside { row: 2, distance: 1.5, radius: 1.0, excess: 0.5 };
    assert_eq!(case.violation(), expected);
    case.solution.answer.radius = 0.0;
    assert!(matches!(case.violation(), Violation::Outside { row: 0, .. }));
    let mut case = balls("outside", &[0.0, 0.0, 1.0, 3.0, 4.0, 2.0], 3, &[0, 1], &[0.4, 0.6]);
    case.solution.answer.radius = 1.5;
    assert!(matches!(case.violation(),
        Violation::Outside { row: 0, excess, .. } if (excess - 2.5).abs() < 1e-15));
}

#[test]
fn gaps_agree_with_fractions() {
    let values = common::numbers(60, 7);
    for (items, columns) in [(Items::Points, 5), (Items::Points, 3), (Items::Balls, 5)] {
        let mut values = values.clone();
        if items == Items::Balls {
            values.iter_mut().skip(columns - 1).step_by(columns).for_each(|r| *r = r.abs());
        }
        let lambda = common::normalized(&[1.0, 2.0, 3.0, 5.0]);
        let case = certify("weak", &values, columns, items, &[0, 3, 4, 9], &lambda, false);
        let verdict = case.check().unwrap();
        let claimed = case.solution.certificate.gap;
        assert!(verdict.gap >= claimed * (1.0 - 1e-15) && verdict.gap <= claimed * (1.0 + 1e-12));
        let rows = truth(&values, columns, &case.solution.answer, &case.solution.certificate).rows;
        assert!(rows.iter().all(|row| is_inside(row, verdict.upper)));
    }
}
