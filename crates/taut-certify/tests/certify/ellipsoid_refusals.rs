//! In which order faults are named, what a monitor stops, and that threads change nothing.

use std::sync::atomic::AtomicBool;

use common::ellipsoids::{Case, cube, hash, solve, uniform};
use common::numbers;
use taut_certify::{
    Answer, CheckError, Ellipsoid, EllipsoidCertificate, Hull, Items, Solution, Trace, Violation,
};
use taut_points::{Monitor, Points, ReadError};

use crate::common;

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

/// The corners (±r, 0, …) and (0, ±1, …) of a flat rhombus, with the ellipse through them; rows of its factor may lean out of
/// the flat by `tilt`.
fn rhombus(r: f64, dim: usize, tilt: f64) -> Case {
    let unit = |axis: usize, length: f64| {
        (0..dim).map(|j| if j == axis { length } else { 0.0 }).collect::<Vec<f64>>()
    };
    let values = [unit(0, r), unit(0, -r), unit(1, 1.0), unit(1, -1.0)].concat();
    let shrink = 1.0 - 1e-15;
    let mut factor = vec![unit(0, shrink / r), unit(1, shrink)];
    factor[1][2] = tilt;
    let entry = |j: usize, k: usize| factor.iter().map(|row| row[j] * row[k]).sum::<f64>();
    let answer = Ellipsoid {
        center: vec![0.0; dim],
        center_tail: vec![],
        matrix: (0..dim).map(|j| (0..dim).map(|k| entry(j, k)).collect()).collect(),
        hull: Some(Hull { basis: vec![unit(0, 1.0), unit(1, 1.0)], distance: 0.0 }),
        log_volume: (std::f64::consts::PI * r).ln() - 2.0 * shrink.ln(),
        factor,
    };
    let certificate = EllipsoidCertificate {
        items: Items::Points,
        support: vec![0, 1, 2, 3],
        multipliers: vec![0.25; 4],
        directions: vec![],
        left_out: vec![],
        gap: 1e-14,
        points_hash: hash(&values, dim),
    };
    let solution = Solution { answer, certificate, trace: Trace::default() };
    Case { name: format!("rhombus {r:e}"), values, columns: dim, solution }
}

#[test]
fn flat_sets_of_any_aspect_are_accepted() {
    for r in [1.0, 1e5, 1e6, 1e9, 1e12] {
        for dim in [3, 5, 10] {
            let verdict = rhombus(r, dim, 0.0).verdict();
            assert!(verdict.gap < 2e-14 && verdict.rank == 2, "{r:e}, {dim}: {verdict:?}");
            // Rounding of plain arithmetic is told with the distance.
            assert!(verdict.off_hull > 0.0 && verdict.off_hull < 1e-11 * r, "{verdict:?}");
        }
    }
}

/// Points lie 1 off a flat that is 1e10 long and 1e-3 wide; a row of the factor that leans out of it by rounding moves their images.
#[test]
fn a_factor_that_leans_out_of_the_hull_is_charged_for_it() {
    let values = vec![1e10, 0.0, 0.0, -1e10, 0.0, 0.0, 0.0, 1e-3, 1.0, 0.0, -1e-3, -1.0];
    for tilt in [4e-11, -4e-11] {
        let f = 1e3 * (1.0 - tilt) * (1.0 - 1e-15);
        let mut case = rhombus(1.0, 3, 0.0);
        case.values = values.clone();
        let answer = &mut case.solution.answer;
        answer.factor = vec![vec![1e-10 * (1.0 - 1e-15), 0.0, 0.0], vec![0.0, f, tilt]];
        let factor = answer.factor.clone();
        let entry = |j: usize, k: usize| factor.iter().map(|row| row[j] * row[k]).sum::<f64>();
        answer.matrix = (0..3).map(|j| (0..3).map(|k| entry(j, k)).collect()).collect();
        answer.hull.as_mut().unwrap().distance = 1.0;
        answer.log_volume = std::f64::consts::PI.ln() - (1e-10 * f).ln();
        case.solution.certificate.gap = 1e-9;
        case.solution.certificate.points_hash = hash(&values, 3);
        let optimum = std::f64::consts::PI.ln() + 1e7f64.ln();
        match case.check() {
            Ok(verdict) => assert!(verdict.lower <= optimum && optimum <= verdict.upper),
            Err(CheckError::Rejected(violation)) => {
                assert!(matches!(violation, Violation::OutsideEllipsoid { .. }), "{violation}");
            }
            Err(error) => panic!("{error}"),
        }
    }
}

/// A claim that all points are one, or lie on a line, for sets whose differences overflow.
#[test]
fn no_set_is_flat_because_its_differences_overflow() {
    let certificate = |values: &[f64], dim, support: &[u64]| EllipsoidCertificate {
        items: Items::Points,
        support: support.to_vec(),
        multipliers: vec![1.0 / support.len() as f64; support.len()],
        directions: vec![],
        left_out: vec![],
        gap: 0.0,
        points_hash: hash(values, dim),
    };
    let names_reason = |violation: &Violation| {
        matches!(
            violation,
            Violation::OffHull { .. }
                | Violation::NotFlat { .. }
                | Violation::OutsideEllipsoid { .. }
        )
    };
    let refused = |name: &str, values: Vec<f64>, columns, answer: Ellipsoid, support: &[u64]| {
        let certificate = certificate(&values, columns, support);
        let solution = Solution { answer, certificate, trace: Trace::default() };
        Case { name: name.into(), values, columns, solution }.violation()
    };
    for distance in [0.0, 1.0, f64::MAX] {
        for center in [-1.7e308, 0.0, 1.7e308] {
            let answer = Ellipsoid {
                center: vec![center],
                center_tail: vec![],
                matrix: vec![vec![0.0]],
                factor: vec![],
                hull: Some(Hull { basis: vec![], distance }),
                log_volume: 0.0,
            };
            let violation = refused("two points", vec![-1.7e308, 1.7e308], 1, answer, &[0]);
            assert!(names_reason(&violation), "{center:e}, {distance:e}: {violation}");
        }
        // A rectangle 1e210 wide and 1e-100 high as the segment of its height.
        let values = vec![-1e210, 0.0, 1e210, 0.0, -1e210, 1e-100, 1e210, 1e-100];
        let answer = Ellipsoid {
            center: vec![0.0, 0.5e-100],
            center_tail: vec![],
            matrix: vec![vec![0.0, 0.0], vec![0.0, 4e200]],
            factor: vec![vec![0.0, 2e100]],
            hull: Some(Hull { basis: vec![vec![0.0, 1.0]], distance }),
            log_volume: 1e-100f64.ln(),
        };
        let violation = refused("rectangle", values, 2, answer, &[0, 2]);
        assert!(names_reason(&violation), "{distance:e}: {violation}");
    }
}
