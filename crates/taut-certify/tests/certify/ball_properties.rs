//! The checker against exact fractions: what is inside, ties included, and what multipliers prove.

use std::sync::atomic::{AtomicUsize, Ordering};

use common::{Case, brute_force, certify, is_inside, normalized, truth};
use proptest::collection::vec;
use proptest::prelude::*;
use taut_certify::{Ball, BallCertificate, CheckError, Items, Solution, Trace, Violation};
use taut_points::{Monitor, Points, hash_points};

use crate::common;

/// The first row outside according to the checker; the center and gap may be as wrong as they like.
fn first_outside(values: &[f64], columns: usize, items: Items, ball: Ball) -> Option<u64> {
    let points = Points::new(values, columns).unwrap();
    let certificate = BallCertificate {
        items,
        support: vec![0],
        multipliers: vec![1.0],
        directions: vec![],
        gap: 0.0,
        points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
    };
    match (Solution { answer: ball, certificate, trace: Trace::default() }).check(&points) {
        Err(CheckError::Rejected(Violation::Outside { row, distance, radius, excess })) => {
            assert!(excess >= 0.0 && distance >= radius * (1.0 - 1e-15), "{distance} {radius}");
            Some(row)
        }
        Ok(_) | Err(CheckError::Rejected(Violation::Center { .. } | Violation::Gap { .. })) => None,
        Err(other) => panic!("{other}"),
    }
}

/// The same by fractions.
fn first_outside_truly(values: &[f64], columns: usize, items: Items, ball: &Ball) -> Option<u64> {
    let certificate = BallCertificate {
        items,
        support: vec![0],
        multipliers: vec![1.0],
        directions: vec![],
        gap: 0.0,
        points_hash: taut_points::PointsHash(0),
    };
    let rows = truth(values, columns, ball, &certificate).rows;
    rows.iter().position(|row| !is_inside(row, ball.radius)).map(|row| row as u64)
}

fn agree(values: &[f64], columns: usize, items: Items, ball: Ball) {
    let expected = first_outside_truly(values, columns, items, &ball);
    assert_eq!(
        first_outside(values, columns, items, ball.clone()),
        expected,
        "{values:?} {ball:?}"
    );
}

/// A number of one of the kinds that trouble arithmetic.
fn odd_number() -> impl Strategy<Value = f64> {
    prop_oneof![
        -1.0..1.0,
        (-8i32..8).prop_map(f64::from),
        (-40i32..40, 0u64..4).prop_map(|(k, ulps)| f64::from_bits(2f64.powi(k).to_bits() + ulps)),
        (-1074i32..1000).prop_map(|k| 2f64.powi(k)),
        Just(0.0),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: crate::test_length::long_or(400, 150), failure_persistence: None, ..ProptestConfig::default() })]

    /// Small integers with radii from Pythagorean squares bring exact ties; one ulp beside them decides.
    #[test]
    fn ties_of_integers(flat in vec(-5i32..6, 3..60), square in 0u32..120, ulps in -1i64..2, halves in any::<bool>()) {
        let unit = if halves { 0.5 } else { 1.0 };
        let values: Vec<f64> = flat.chunks_exact(3).flatten().map(|&v| f64::from(v) * unit).collect();
        let radius = f64::from(square).sqrt() * unit;
        let radius = if radius == 0.0 { 0.0 } else { f64::from_bits((radius.to_bits() as i64 + ulps) as u64) };
        let ball = Ball { center: vec![unit, 0.0, -unit], center_tail: vec![], radius };
        agree(&values, 3, Items::Points, ball);
    }

    /// Rows whose distance is the radius to within ulps, with a tail of the center or without, near 0 or far away.
    #[test]
    fn nearly_cospherical(
        directions in vec(-1.0f64..1.0, 8..80), shift in prop_oneof![Just(0.0), Just(3.0), Just(1e8), Just(1e15)],
        radius in 0.5f64..2.0, tail in -0.5f64..0.5, ulps in -2i64..3,
    ) {
        let center = vec![shift + 0.1, 0.3 - shift, shift, 0.7];
        let center_tail: Vec<f64> = match ulps {
            0 => vec![],
            _ => center.iter().map(|c: &f64| (c.next_up() - c) * tail * 0.99).collect(),
        };
        let values: Vec<f64> = directions
            .chunks_exact(4)
            .flat_map(|v| {
                let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt().max(1e-3);
                v.iter().zip(&center).map(|(x, c)| c + x / norm * radius).collect::<Vec<_>>()
            })
            .collect();
        let radius = f64::from_bits((radius.to_bits() as i64 + ulps) as u64);
        agree(&values, 4, Items::Points, Ball { center, center_tail, radius });
    }

    /// The radius is the true distance of one row, rounded down or up.
    #[test]
    fn the_least_enclosing_number(flat in vec(-1.0f64..1.0, 12..60), shift in prop_oneof![Just(0.0), Just(1e6)]) {
        let values: Vec<f64> = flat.chunks_exact(6).flatten().map(|v| v + shift).collect();
        let case = certify("", &values, 6, Items::Points, &[0, 1], &[0.25, 0.75], shift > 0.0);
        let ball = case.solution.answer;
        prop_assert_eq!(first_outside(&values, 6, Items::Points, ball.clone()), None);
        let smaller = Ball { radius: ball.radius.next_down(), ..ball };
        prop_assert!(first_outside(&values, 6, Items::Points, smaller).is_some());
    }

    /// Balls, whose radii and the ball's may be equal, tiny or far apart.
    #[test]
    fn balls_of_odd_numbers(rows in vec((odd_number(), odd_number(), odd_number()), 1..12),
                            center in (odd_number(), odd_number()), radius in odd_number()) {
        let values: Vec<f64> = rows.iter().flat_map(|(x, y, r)| [*x, *y, r.abs()]).collect();
        let center = vec![center.0, center.1];
        agree(&values, 3, Items::Balls, Ball { center, center_tail: vec![], radius: radius.abs() });
    }

    /// Balls that touch the ball from inside, exactly or nearly.
    #[test]
    fn balls_that_touch(rows in vec((-4i32..5, -4i32..5, -1i64..2), 1..20), square in 0u32..50) {
        let radius = 8.0 + f64::from(square).sqrt();
        let values: Vec<f64> = rows
            .iter()
            .flat_map(|&(x, y, ulps)| {
                let (x, y) = (f64::from(x), f64::from(y));
                let r = radius - (x * x + y * y).sqrt();
                [x, y, f64::from_bits((r.to_bits() as i64 + ulps) as u64)]
            })
            .collect();
        agree(&values, 3, Items::Balls, Ball { center: vec![0.0, 0.0], center_tail: vec![], radius });
    }

    /// Points of any size, the whole range of f64.
    #[test]
    fn points_of_odd_numbers(rows in vec((odd_number(), odd_number()), 1..12), center in (odd_number(), odd_number()),
                             radius in odd_number(), tie in any::<bool>()) {
        let values: Vec<f64> = rows.iter().flat_map(|(x, y)| [*x, *y]).collect();
        let radius = if tie { (values[0] - center.0).hypot(values[1] - center.1) } else { radius.abs() };
        prop_assume!(radius.is_finite());
        let center = vec![center.0, center.1];
        agree(&values, 2, Items::Points, Ball { center, center_tail: vec![], radius });
    }

    /// Any multipliers make a certificate, with a gap; the checker must find the gap that fractions find.
    #[test]
    fn any_multipliers_prove_their_gap(
        flat in vec(-1.0f64..1.0, 24..80), weights in vec(1e-3f64..1.0, 1..6), columns in 2usize..5,
        of_balls in any::<bool>(), radii in prop_oneof![Just(1e-6), Just(0.1), Just(1.0), Just(30.0)], tail in any::<bool>(),
    ) {
        let mut values = flat[..flat.len() / columns * columns].to_vec();
        let items = if of_balls { Items::Balls } else { Items::Points };
        if of_balls {
            values.iter_mut().skip(columns - 1).step_by(columns).for_each(|r| *r = r.abs() * radii);
        }
        let support: Vec<u64> = (0..weights.len() as u64).collect();
        let case = certify("any", &values, columns, items, &support, &normalized(&weights), tail);
        let claimed = case.solution.certificate.gap;
        if claimed.is_infinite() {
            let refused = matches!(case.violation(), Violation::Number { .. });
            prop_assert!(refused);
            return Ok(());
        }
        // A bound thousands of times weaker than the radius holds as any other, but roundings of R weigh in it.
        prop_assume!(claimed < 1e4);
        let verdict = case.check().unwrap();
        let rounding = 1e-13 * claimed * (1.0 + claimed) + 1e-26;
        prop_assert!((verdict.gap - claimed).abs() <= rounding, "{:e} {:e}", verdict.gap, claimed);
        prop_assert!(verdict.gap >= claimed * (1.0 - 1e-15));
    }
}

/// Ties, and departures from them so small that only exact arithmetic sees them, in squares that do not fit one `f64`.
#[test]
fn departures_below_the_reach_of_rounded_sums() {
    for (x, radius) in [([0.1, 0.0], 0.1), ([0.3, 0.4], 0.5), ([-0.7e-5, 0.0], 0.7e-5)] {
        let values = [0.0, 0.0, x[0], x[1], -x[0], x[1]];
        for tail in [0.0, 1e-40, -1e-40, 1e-300, -5e-324] {
            let (center, center_tail) = (vec![0.0, 0.0], vec![0.0, 0.0]);
            let mut ball = Ball { center, center_tail, radius };
            agree(&values, 2, Items::Points, ball.clone());
            // Moved away from 0, so that the tail is one: row 1 or row 2 now stands out by the tail.
            ball.center = vec![0.0, 1.0];
            ball.center_tail = vec![0.0, tail];
            let shifted = [0.0, 1.0, 0.0, 1.0 + x[0], 0.0, 1.0 - x[0]];
            agree(&shifted, 2, Items::Points, ball);
        }
    }
    // Without a tail: balls whose radius is far below the rounding of the sum.
    for r in [0.0, 5e-324, 1e-300, 1e-40] {
        let values = [0.1, 0.0, 0.0, 0.0, 0.1, r, 0.1, 0.0, 2.0 * r];
        let ball = Ball { center: vec![0.0, 0.0], center_tail: vec![], radius: 0.1 };
        let expected = if r == 0.0 { None } else { Some(1) };
        assert_eq!(first_outside(&values, 3, Items::Balls, ball), expected, "{r:e}");
    }
    // The same at powers of two, where squares are exact and only the radius is not.
    let unit = 2f64.powi(-100);
    let values = [unit, 0.0, 0.0, 0.0, unit, f64::from_bits(1)];
    let ball = Ball { center: vec![0.0, 0.0], center_tail: vec![], radius: unit };
    assert_eq!(first_outside(&values, 3, Items::Balls, ball), Some(1));
}

/// Small integers bring ties, duplicates and lines; the smallest ball must be accepted, and its gap be rounding.
#[test]
fn smallest_balls_by_brute_force_are_accepted() {
    let seen = AtomicUsize::new(0);
    let config =
        ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() };
    proptest!(config, |(flat in vec(-6i32..7, 2..24), dim in 1usize..4, noise in any::<bool>(), tail in any::<bool>())| {
        let n = (flat.len() / dim).min(8);
        let noise = if noise { common::numbers(n * dim, 5) } else { vec![0.0; n * dim] };
        let values: Vec<f64> = flat[..n * dim].iter().zip(&noise).map(|(&v, e)| f64::from(v) + 0.1 * e).collect();
        prop_assume!(n > 0);
        if let Some((support, lambda)) = brute_force(&values, dim) {
            let case: Case = certify("brute force", &values, dim, Items::Points, &support, &lambda, tail);
            let verdict = case.check().unwrap();
            prop_assert!(verdict.gap <= 1e-13, "{:e}", verdict.gap);
            seen.fetch_add(1, Ordering::Relaxed);
        }
    });
    assert!(seen.load(Ordering::Relaxed) > 250, "brute force gave up too often: {seen:?}");
}

/// Rows in single precision are judged as their exact copies in double precision.
#[test]
fn single_precision_is_judged_the_same() {
    let narrow: Vec<f32> = common::numbers(3000, 3).iter().map(|&v| v as f32).collect();
    let wide: Vec<f64> = narrow.iter().map(|&v| v.into()).collect();
    let lambda = normalized(&[0.3, 0.3, 0.4]);
    let case = certify("narrow", &wide, 10, Items::Points, &[1, 7, 100], &lambda, false);
    let points = Points::new(&narrow, 10).unwrap();
    assert_eq!(case.solution.check(&points).unwrap(), case.check().unwrap());
    let mut small = case.solution.clone();
    small.answer.radius = small.answer.radius.next_down();
    let Err(CheckError::Rejected(of_narrow)) = small.check(&points) else { panic!() };
    assert_eq!(of_narrow, Case { solution: small, ..case }.violation());
}
