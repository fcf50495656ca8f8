//! In which order faults are named, what a monitor stops, and that threads change nothing.

mod common;

use std::sync::atomic::AtomicBool;

use common::ellipsoids::{Case, cube, hash, solve, uniform};
use common::numbers;
use taut_certify::{Answer, CheckError, Violation};
use taut_points::{Monitor, Points, ReadError};

#[test]
fn bad_rows_are_named_before_the_hash_and_before_rows_outside() {
    let mut case = uniform("square", &cube(2), 2);
    case.values[2] = 7.0;
    assert!(matches!(case.violation(), Violation::Hash { .. }));
    case.values[5] = f64::NEG_INFINITY;
    let infinite = Violation::NonFinite { row: 2, column: 1, value: f64::NEG_INFINITY };
    assert_eq!(case.violation(), infinite);
    case.values[7] = f64::NAN;
    assert_eq!(case.violation(), infinite);
}

#[test]
fn rows_far_beyond_every_scale_are_outside() {
    for far in [1e9, 1e160, 1e308, -1e308] {
        let mut case = uniform("square", &cube(2), 2);
        case.values.extend([0.0, far]);
        case.solution.certificate.points_hash = hash(&case.values, 2);
        assert!(matches!(case.violation(), Violation::OutsideEllipsoid { row: 4, .. }), "{far}");
    }
}

#[test]
fn a_monitor_stops_the_check() {
    let case = uniform("square", &cube(2), 2);
    let stop = AtomicBool::new(true);
    let monitor = Monitor { cancel: Some(&stop), ..Monitor::silent() };
    let points = Points::new(&case.values, 2).unwrap();
    let outcome = case.solution.answer.check(&case.solution.certificate, &points, &monitor);
    assert!(matches!(outcome, Err(CheckError::Read(ReadError::Cancelled(_)))), "{outcome:?}");
}

fn said(case: &Case, threads: usize) -> String {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    format!("{:?}", pool.install(|| case.check()))
}

#[test]
fn the_verdict_is_the_same_for_every_number_of_threads() {
    let dim = 4;
    let mut values = numbers(60_000 * dim, 21);
    // The best ellipsoid of twelve far rows, which then encloses all others.
    let far: Vec<f64> = numbers(12 * dim, 22).iter().map(|v| v.signum() * 3.0 + v).collect();
    values[..12 * dim].copy_from_slice(&far);
    let (support, u) = solve(&far, dim);
    let sound = common::ellipsoids::certify("threads", &values, dim, &support, &u);
    let mut outside = sound.clone();
    for row in [50_001, 33_000, 20_000] {
        outside.values[row * dim] = 40.0;
    }
    outside.solution.certificate.points_hash = hash(&outside.values, dim);
    let mut infinite = sound.clone();
    infinite.values[59_000 * dim + 1] = f64::NAN;
    infinite.values[40_000 * dim] = f64::INFINITY;
    let words =
        ["EllipsoidVerdict", "OutsideEllipsoid { row: 20000,", "NonFinite { row: 40000, column: 0"];
    for (case, word) in [sound, outside, infinite].iter().zip(words) {
        let one = said(case, 1);
        assert!(one.contains(word), "{one}");
        for threads in [2, 3, 8] {
            assert_eq!(one, said(case, threads));
        }
    }
}
