//! The oracle of inscribed ellipsoids: closed forms, answers of the solver, doctored answers.

use std::f64::consts::PI;

use taut::certify::{InscribedCertificate, InscribedEllipsoid, InscribedVerdict, Trace};
use taut::points::{Distribution, generate};
use taut::points::{Monitor, hash_points};
use taut::{InscribedOptions, Points, Solution, inscribed_ellipsoid};

use super::super::Truth;
use super::InscribedOracle;

type Solved = (Solution<InscribedEllipsoid>, InscribedVerdict);

fn solved(rows: &[f64], dim: usize) -> Solved {
    let rows = Points::new(rows, dim + 1).unwrap();
    let solution = inscribed_ellipsoid(&rows, &InscribedOptions::default()).unwrap();
    let verdict = solution.check(&rows).unwrap();
    (solution, verdict)
}

/// The verdict with a lower end that is rounded down.
fn rounded_down(verdict: InscribedVerdict) -> InscribedVerdict {
    InscribedVerdict { lower: verdict.lower - 2e-14 * (1.0 + verdict.lower.abs()), ..verdict }
}

fn sides_of_box(center: &[f64], widths: &[f64]) -> Vec<f64> {
    let dim = widths.len();
    let row = |j: usize, sign: f64| {
        let normal = (0..dim).map(move |k| if k == j { sign } else { 0.0 });
        normal.chain([sign * center[j] + widths[j]]).collect::<Vec<_>>()
    };
    (0..dim).flat_map(|j| [row(j, 1.0), row(j, -1.0)].concat()).collect()
}

fn simplex(dim: usize) -> Vec<f64> {
    let corner = |j: usize| (0..=dim).map(move |k| if k == j { -1.0 } else { 0.0 });
    (0..dim).flat_map(corner).chain(vec![1.0; dim + 1]).collect()
}

/// Random tangent planes of the unit ball, each moved out a little.
fn random(n: usize, dim: usize, seed: u64) -> Vec<f64> {
    let normals: Vec<f64> = generate(Distribution::Sphere, n, dim, seed).unwrap();
    let rows = normals.chunks(dim).enumerate();
    let row = |(i, a): (usize, &[f64])| [a, &[1.0 + (i % 5) as f64 * 0.1]].concat();
    rows.flat_map(row).collect()
}

fn kappa(dim: usize) -> f64 {
    [1.0, 2.0, PI, 4.0 * PI / 3.0, PI * PI / 2.0, 8.0 * PI * PI / 15.0][dim]
}

#[test]
fn brackets_are_those_of_closed_forms() {
    for dim in 1..=5 {
        let d = dim as f64;
        let of_box: Vec<f64> = (0..dim).map(|j| 10f64.powi(j as i32 - 2)).collect();
        let logs: f64 = of_box.iter().map(|w| w.ln()).sum();
        let center: Vec<f64> = (0..dim).map(|j| j as f64).collect();
        let of_simplex = -0.5 * d * (d * (d + 1.0)).ln() - 0.5 * (d + 1.0).ln();
        for (rows, wanted) in [(sides_of_box(&center, &of_box), logs), (simplex(dim), of_simplex)] {
            let (solution, verdict) = solved(&rows, dim);
            let oracle = InscribedOracle::new(&rows, dim + 1);
            let truth = oracle.judge(&solution, &rounded_down(verdict));
            assert_eq!(truth, Truth::True, "{dim}: {truth:?}");
            let (lower, width) = oracle.bracket_for_tests().unwrap();
            assert!(
                (lower - wanted - kappa(dim).ln()).abs() < 1e-13 && (0.0..1e-25).contains(&width),
                "{dim}: {lower} {width:e}"
            );
        }
    }
}

/// Every answer of the solver is true but for its lower end, and doctored ones are false.
#[test]
fn answers_of_the_solver_are_true_and_doctored_ones_are_false() {
    let mut count = 0;
    for (n, dim, seed) in [
        (4, 2, 1),
        (9, 2, 2),
        (30, 2, 3),
        (8, 3, 4),
        (20, 3, 5),
        (12, 4, 6),
        (25, 5, 7),
        (30, 5, 8),
    ] {
        // Some of few sides are no polytope.
        let rows = [random(n, dim, seed), sides_of_box(&vec![0.5; dim], &vec![2.0; dim])].concat();
        let (solution, verdict) = solved(&rows, dim);
        let verdict = rounded_down(verdict);
        let oracle = InscribedOracle::new(&rows, dim + 1);
        let truth = oracle.judge(&solution, &verdict);
        assert_eq!(truth, Truth::True, "{n} {dim}: {truth:?}");
        count += 1;
        let (optimum, width) = oracle.bracket_for_tests().unwrap();
        assert!(width < 1e-25, "{width:e}");
        let is_false = |what: &str, answer: &InscribedEllipsoid, verdict: InscribedVerdict| {
            let solution = Solution { answer: answer.clone(), ..solution.clone() };
            let truth = oracle.judge(&solution, &verdict);
            assert!(matches!(truth, Truth::False(_)), "{n} {dim}: {what} is {truth:?}");
        };
        let answer = &solution.answer;
        is_false(
            "a lower end above the optimum",
            answer,
            InscribedVerdict { lower: optimum + 1e-12, ..verdict },
        );
        is_false(
            "an upper end below",
            answer,
            InscribedVerdict { upper: optimum - 1e-12, ..verdict },
        );
        is_false("no gap", answer, InscribedVerdict { gap: -1e-12, ..verdict });
        let other = InscribedEllipsoid { log_volume: answer.log_volume + 1e-12, ..answer.clone() };
        is_false("another log-volume", &other, verdict);
        let mut moved = answer.clone();
        moved.center[0] += 1e-3;
        is_false("a moved ellipsoid", &moved, verdict);
        let mut larger = answer.clone();
        larger.axes.iter_mut().flatten().for_each(|g| *g *= 1.0 + 1e-9);
        is_false("a larger ellipsoid", &larger, verdict);
    }
    println!("true {count}, undecided 0");
}

/// With multipliers that underflow, an ellipsoid of half the axes passed for the largest in the cube of ten dimensions.
#[test]
fn half_the_largest_ellipsoid_is_not_the_largest() {
    let dim = 10;
    let rows = sides_of_box(&vec![0.0; dim], &vec![1.0; dim]);
    let points = Points::new(&rows, dim + 1).unwrap();
    let judge = |axis: f64| {
        let unit = |j: usize| (0..dim).map(|k| if k == j { axis } else { 0.0 }).collect::<Vec<_>>();
        // π⁵/120.
        let log_volume = (PI.powi(5) / 120.0).ln() + 10.0 * axis.ln();
        let answer = InscribedEllipsoid {
            center: vec![0.0; dim],
            axes: (0..dim).map(unit).collect(),
            log_volume,
        };
        let certificate = InscribedCertificate {
            support: (0..20).collect(),
            multipliers: vec![5e-324; 20],
            gap: 0.0,
            points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
        };
        let verdict =
            InscribedVerdict { lower: log_volume - 3e-14, upper: log_volume + 1e-12, gap: 0.0 };
        let solution = Solution { answer, certificate, trace: Trace::default() };
        InscribedOracle::new(&rows, dim + 1).judge(&solution, &verdict)
    };
    let half = judge(0.51);
    assert!(matches!(&half, Truth::False(why) if why.contains("upper end")), "{half:?}");
    assert_eq!(judge(1.0), Truth::True);
}

/// The lower end of a bracket is rounded down: that of an ellipsoid that touches all sides of its box is not above the optimum.
#[test]
fn a_lower_end_above_the_optimum_is_false() {
    let rows = sides_of_box(&[0.0; 3], &[0.3, 0.7, 1.1]);
    let (solution, verdict) = solved(&rows, 3);
    let oracle = InscribedOracle::new(&rows, 4);
    assert_eq!(oracle.judge(&solution, &rounded_down(verdict)), Truth::True);
    let (optimum, _) = oracle.bracket_for_tests().unwrap();
    let above = InscribedVerdict { lower: optimum + 2e-14, upper: optimum + 1e-9, gap: 1e-9 };
    let truth = oracle.judge(&solution, &above);
    assert!(matches!(&truth, Truth::False(why) if why.contains("lower end")), "{truth:?}");
}
