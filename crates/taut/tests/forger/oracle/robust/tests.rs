//! The oracle of robust ellipsoids: answers of the solver, doctored answers, and a circle that is no local optimum.

use std::f64::consts::PI;

use taut::certify::{
    Ellipsoid, EllipsoidCertificate, EllipsoidVerdict, RobustCertificate, RobustEllipsoid,
    RobustScale, RobustVerdict, Trace,
};
use taut::certify::{Enclosure, Unweighted};
use taut::points::{Distribution, generate};
use taut::points::{Monitor, hash_points};
use taut::{Items, Points, RobustMethod, RobustOptions, Solution, robust_ellipsoid};

use super::super::Truth;
use super::RobustOracle;

struct Case {
    values: Vec<f64>,
    dim: usize,
    solution: Solution<RobustEllipsoid>,
    verdict: RobustVerdict,
}

fn solved(values: Vec<f64>, dim: usize, method: RobustMethod) -> Case {
    let points = Points::new(&values, dim).unwrap();
    let options = RobustOptions { method, ..Default::default() };
    let solution = robust_ellipsoid(&points, &options).unwrap();
    let verdict = solution.check(&points).unwrap();
    Case { values, dim, solution, verdict }
}

/// Normal points, every fifth of them far away.
fn with_outliers(n: usize, dim: usize, seed: u64) -> Vec<f64> {
    let values: Vec<f64> = generate(Distribution::Normal, n, dim, seed).unwrap();
    let rows = values.chunks(dim).enumerate();
    rows.flat_map(|(i, row)| row.iter().map(move |v| if i % 5 == 4 { v + 20.0 } else { *v }))
        .collect()
}

fn cases() -> Vec<Case> {
    let mut cases = vec![];
    for method in RobustMethod::ALL {
        for (n, dim, seed) in [(16, 2, 1), (30, 2, 2), (24, 3, 3), (30, 4, 4)] {
            cases.push(solved(with_outliers(n, dim, seed), dim, method));
        }
        // Most points on a line.
        let line = (0..20).flat_map(|i| {
            let x = f64::from(i * i % 23);
            [x, if i % 5 == 4 { 3.0 + x * x } else { 2.0 * x }]
        });
        cases.push(solved(line.collect(), 2, method));
        // Far from the origin.
        let far = with_outliers(20, 2, 5).iter().map(|v| v + 1e6).collect();
        cases.push(solved(far, 2, method));
    }
    cases
}

#[test]
fn answers_of_the_solver_are_true_and_doctored_ones_are_false() {
    let (mut decided, mut undecided) = (0, vec![]);
    for case in cases() {
        let oracle = RobustOracle::new(&case.values, case.dim);
        let words =
            format!("{} {}: {:?}", case.solution.certificate.method, case.dim, case.verdict);
        match oracle.judge(&case.solution, &case.verdict) {
            Truth::True => decided += 1,
            Truth::False(why) => panic!("{words}: {why}"),
            Truth::Undecided(why) => undecided.push(format!("{words}: {why}")),
        }
        let is_false = |what: &str,
                        change: &dyn Fn(
            &mut RobustEllipsoid,
            &mut RobustCertificate,
            &mut RobustVerdict,
        )| {
            let (mut solution, mut verdict) = (case.solution.clone(), case.verdict);
            change(&mut solution.answer, &mut solution.certificate, &mut verdict);
            let truth = oracle.judge(&solution, &verdict);
            assert!(matches!(truth, Truth::False(_)), "{words}: {what} is {truth:?}");
        };
        let slack = 10.0 * case.verdict.slack;
        is_false("another objective", &|_, _, v| {
            v.objective += 10.0 * slack * (1.0 + v.objective.abs())
        });
        is_false("more kept", &|_, _, v| v.kept += 1);
        is_false("more wanted", &|_, _, v| v.wanted += 1);
        is_false("fewer on the hull", &|_, _, v| v.on_hull = 3);
        is_false("another rank", &|_, _, v| v.rank -= 1);
        is_false("weights", &|_, _, v| v.reweighted = !v.reweighted);
        is_false("one outlier more", &|a, _, _| {
            let inner = (0..case.values.len() as u64).find(|row| !a.outliers.contains(row));
            a.outliers.extend(inner);
            a.outliers.sort_unstable();
        });
        is_false("one outlier less", &|a, _, _| a.outliers.truncate(a.outliers.len() - 1));
        is_false("another log-volume", &|a, _, _| {
            a.log_volume += 1e-10 * (1.0 + a.log_volume.abs())
        });
        is_false("another log-determinant", &|a, _, _| {
            a.log_det += 10.0 * slack * (1.0 + a.log_det.abs())
        });
        is_false("another center", &|a, _, _| a.center[0] += 1e-2);
        is_false("a larger scatter", &|a, _, _| {
            a.scatter.iter_mut().flatten().for_each(|s| *s *= 1.0 + slack)
        });
        is_false("more slack", &|_, _, v| v.slack *= 1.5);
        is_false("a lower end above the optimum", &|_, _, v| match &mut v.enclosure {
            Some(enclosure) => enclosure.lower = enclosure.upper + 1e-9,
            None => v.objective = f64::NAN,
        });
        is_false("another factor of the points kept", &|_, c, _| c.raw_scale *= 1.0 + 1e-8);
        is_false("another level", &|_, c, _| c.level *= 1.0 - 1e-8);
        // The first row kept for the last one left out.
        is_false("others kept", &|_, c, _| {
            let first = (0..u64::MAX).find(|row| !c.left_out.contains(row)).unwrap();
            c.left_out.pop();
            c.left_out.push(first);
            c.left_out.sort_unstable();
        });
    }
    println!("true {decided}, undecided {}: {undecided:#?}", undecided.len());
    assert!(undecided.is_empty(), "{undecided:#?}");
}

/// Eight points on an ellipse with axes 5 and 1, and one far away. Around the eight, by hand: an ellipse centered at 0 with
/// these half axes, which is at best within the gap stated.
fn trimmed(axes: [f64; 2], gap: f64) -> (Vec<f64>, Solution<RobustEllipsoid>, RobustVerdict) {
    let mut values: Vec<f64> = (0..8)
        .flat_map(|k| {
            let angle = f64::from(k) * PI / 4.0 + 0.1;
            [5.0 * angle.cos(), angle.sin()]
        })
        .collect();
    values.extend([100.0, 100.0]);
    let points = Points::new(&values, 2).unwrap();
    let points_hash = hash_points(&points, &Monitor::silent()).unwrap();
    let f = axes.map(|axis| 1.0 / (axis * (1.0 + 1e-14)));
    let diagonal = |entries: [f64; 2]| vec![vec![entries[0], 0.0], vec![0.0, entries[1]]];
    let log_volume = PI.ln() - f[0].ln() - f[1].ln();
    let ellipsoid = Ellipsoid {
        center: vec![0.0; 2],
        center_tail: vec![],
        matrix: diagonal(f.map(|f| f * f)),
        factor: diagonal(f),
        hull: None,
        log_volume,
    };
    let certificate = EllipsoidCertificate {
        items: Items::Points,
        support: (0..8).collect(),
        multipliers: vec![0.125; 8],
        directions: vec![],
        left_out: vec![8],
        gap,
        points_hash,
    };
    let enclosure = EllipsoidVerdict {
        lower: (5.0 * PI).ln() - 1e-12,
        upper: log_volume + 1e-12,
        gap,
        excess: 0.0,
        matrix_excess: 1e-12,
        off_hull: 0.0,
        rank: 2,
    };
    // (1 + 15/(9 − 2))² over the quantile −2·ln(1 − 8/10) in the plane.
    let raw_scale = (22.0f64 / 7.0).powi(2) / (-2.0 * 0.2f64.ln());
    let answer = RobustEllipsoid {
        center: vec![0.0; 2],
        center_tail: vec![],
        matrix: ellipsoid.matrix.clone(),
        factor: ellipsoid.factor.clone(),
        hull: None,
        log_volume,
        scatter: diagonal(f.map(|f| raw_scale / (f * f))),
        log_det: -2.0 * (f[0].ln() + f[1].ln()) + 2.0 * raw_scale.ln(),
        outliers: vec![8],
    };
    let certificate = RobustCertificate {
        method: RobustMethod::Trim,
        kept: 8,
        left_out: vec![8],
        objective: log_volume,
        level: 1.0,
        cutoff: 0.0,
        raw_scale,
        scale: 0.0,
        scaled_by: RobustScale::Share,
        weighed_out: vec![],
        unweighted: Some(Unweighted::Trimmed),
        enclosure: Some(Enclosure { ellipsoid, certificate }),
        points_hash,
    };
    let verdict = RobustVerdict {
        objective: log_volume,
        enclosure: Some(enclosure),
        wanted: 8,
        kept: 8,
        on_hull: 9,
        flag_excess: 0.0,
        slack: 1e-9,
        reweighted: false,
        rank: 2,
    };
    let solution = Solution { answer, certificate, trace: Trace::default() };
    (values, solution, verdict)
}

/// A circle in place of the smallest ellipsoid is no local optimum, whatever gap a line below states.
#[test]
fn a_circle_around_a_thin_set_is_no_local_optimum() {
    let (values, solution, verdict) = trimmed([5.0, 1.0], 1e-12);
    assert_eq!(RobustOracle::new(&values, 2).judge(&solution, &verdict), Truth::True);
    let (values, solution, verdict) = trimmed([5.0, 5.0], 1.7);
    let truth = RobustOracle::new(&values, 2).judge(&solution, &verdict);
    assert!(matches!(&truth, Truth::False(why) if why.contains("local optimum")), "{truth:?}");
}
