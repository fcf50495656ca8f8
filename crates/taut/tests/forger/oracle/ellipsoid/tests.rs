//! The oracle of enclosing ellipsoids: closed forms, answers of the solver, doctored answers.

use std::f64::consts::PI;

use taut::certify::{Ellipsoid, EllipsoidCertificate, EllipsoidVerdict, Trace};
use taut::points::{Distribution, generate};
use taut::points::{Monitor, hash_points};
use taut::{EllipsoidOptions, Items, Points, Solution, ellipsoid};

use super::super::Truth;
use super::{EllipsoidOracle, U};
use crate::test_length::long_or;

/// An input with the answer that the solver gives and the verdict of the checker.
struct Case {
    values: Vec<f64>,
    columns: usize,
    items: Items,
    solution: Solution<Ellipsoid>,
    verdict: EllipsoidVerdict,
}

impl Case {
    fn solved(values: Vec<f64>, columns: usize, items: Items) -> Self {
        let points = Points::new(&values, columns).unwrap();
        let options = EllipsoidOptions::default();
        let solution =
            ellipsoid(&points, &EllipsoidOptions { inputs: items, ..options.clone() }).unwrap();
        let verdict = solution.check(&points).unwrap();
        Case { values, columns, items, solution, verdict }
    }

    fn oracle(&self) -> EllipsoidOracle {
        EllipsoidOracle::new(&self.values, self.columns, self.items)
    }
}

fn cube(dim: usize) -> Vec<f64> {
    let corner = |i: usize| (0..dim).map(move |j| if i >> j & 1 == 1 { 1.0 } else { -1.0 });
    (0..1 << dim).flat_map(corner).collect()
}

fn random(n: usize, columns: usize, seed: u64) -> Vec<f64> {
    generate(Distribution::Normal, n, columns, seed).unwrap()
}

/// Balls, or ellipsoids with S = LLᵀ, from normal numbers.
fn bodies(items: Items, n: usize, dim: usize, seed: u64) -> Vec<f64> {
    let numbers = random(n, dim + dim * dim, seed);
    let row = |row: &[f64]| -> Vec<f64> {
        let (center, l) = row.split_at(dim);
        let mut values = center.to_vec();
        match items {
            Items::Points => {}
            Items::Balls => values.push(0.25 * l[0].abs()),
            Items::Ellipsoids => {
                for j in 0..dim {
                    for k in 0..=j {
                        let entry: f64 = (0..dim).map(|a| l[j * dim + a] * l[k * dim + a]).sum();
                        values.push(0.0625 * entry);
                    }
                }
            }
        }
        values
    };
    numbers.chunks(dim + dim * dim).flat_map(row).collect()
}

fn kappa(dim: usize) -> f64 {
    [1.0, 2.0, PI, 4.0 * PI / 3.0, PI * PI / 2.0, 8.0 * PI * PI / 15.0][dim]
}

/// The corners of a cube, a regular polygon, the corners of a simplex and of a cross-polytope lie on the least ellipsoid.
#[test]
fn brackets_are_those_of_closed_forms() {
    let near = |values: &[f64], columns: usize, items: Items, wanted: f64| {
        let (lower, width) =
            EllipsoidOracle::new(values, columns, items).bracket_for_tests().unwrap();
        assert!((lower - wanted).abs() < 1e-13, "{lower} in place of {wanted}");
        assert!((0.0..1e-17).contains(&width), "{width:e}");
    };
    for dim in 1..=long_or(4, 2) {
        let d = dim as f64;
        near(&cube(dim), dim, Items::Points, kappa(dim).ln() + 0.5 * d * d.ln());
        let cross: Vec<f64> = (0..2 * dim * dim)
            .map(|at| match (at / dim / 2, at / dim % 2) {
                (j, side) if j == at % dim => 1.0 - 2.0 * side as f64,
                _ => 0.0,
            })
            .collect();
        near(&cross, dim, Items::Points, kappa(dim).ln());
        // One ball, and one ellipsoid with the squares of 1, 2, … on its diagonal.
        let ball: Vec<f64> = (0..dim).map(|_| 3.0).chain([0.5]).collect();
        near(&ball, dim + 1, Items::Balls, kappa(dim).ln() - d * 2f64.ln());
        let mut one: Vec<f64> = vec![1e6; dim];
        (0..dim).for_each(|j| {
            one.extend((0..=j).map(|k| if j == k { ((j + 1) * (j + 1)) as f64 } else { 0.0 }))
        });
        let logs: f64 = (1..=dim).map(|j| (j as f64).ln()).sum();
        near(&one, dim * (dim + 3) / 2, Items::Ellipsoids, kappa(dim).ln() + logs);
        // The simplex of 0 and the units has volume 1/d!; a regular one with radius 1 has (d + 1)^((d + 1)/2)/(d!·d^(d/2)).
        let simplex: Vec<f64> =
            (0..=dim).flat_map(|i| (1..=dim).map(move |j| f64::from(i == j))).collect();
        let wanted = kappa(dim).ln() - 0.5 * (d + 1.0) * (d + 1.0).ln() + 0.5 * d * d.ln();
        near(&simplex, dim, Items::Points, wanted);
    }
    // Two balls of radius 1 at ±2: x²/a² + y²/b² ≤ 1 with the least ab holds the right one where
    // b² = 1 + 4/(a²/b² − 1)… so the bracket is compared with that of many tangent points.
    let balls = [-2.0, 0.0, 1.0, 2.0, 0.0, 1.0];
    let around = |center: f64| {
        (0..720).flat_map(move |k| {
            let angle = f64::from(k) * PI / 360.0;
            [center + angle.cos(), angle.sin()]
        })
    };
    let points: Vec<f64> = around(-2.0).chain(around(2.0)).collect();
    let of_points = EllipsoidOracle::new(&points, 2, Items::Points).bracket_for_tests().unwrap();
    let of_balls = EllipsoidOracle::new(&balls, 3, Items::Balls).bracket_for_tests().unwrap();
    let more = of_balls.0 - of_points.0;
    assert!(of_balls.1 < 1e-17 && (0.0..2e-4).contains(&more), "{of_balls:?} {of_points:?}");
}

fn cases() -> Vec<Case> {
    let mut cases = vec![];
    for dim in 2..=long_or(5, 3) {
        cases.push(Case::solved(cube(dim), dim, Items::Points));
        for (n, seed) in [(dim + 1, 1), (12, 2), (30, 3)] {
            cases.push(Case::solved(random(n, dim, seed), dim, Items::Points));
        }
        // Far from the origin, and thin.
        let far = random(15, dim, 4).iter().map(|v| v + 1e9).collect();
        cases.push(Case::solved(far, dim, Items::Points));
        let thin = random(15, dim, 5).into_iter().enumerate();
        let thin = thin.map(|(i, v)| if i % dim == 0 { v * 1e-6 } else { v * 1e3 }).collect();
        cases.push(Case::solved(thin, dim, Items::Points));
        // In a hyperplane, through integers and turned.
        let numbers = random(12, dim, 6);
        let flat = numbers.chunks(dim).flat_map(|row| {
            let sum: f64 = row[1..].iter().map(|v| (v * 8.0).round()).sum();
            [sum].into_iter().chain(row[1..].iter().map(|v| (v * 8.0).round())).collect::<Vec<_>>()
        });
        cases.push(Case::solved(flat.collect(), dim, Items::Points));
    }
    for dim in 2..=3 {
        for items in [Items::Balls, Items::Ellipsoids] {
            for n in [1, 3, 5] {
                cases.push(Case::solved(bodies(items, n, dim, 7), items.columns(dim), items));
            }
        }
    }
    // One point three times.
    cases.push(Case::solved([0.1, 0.7].repeat(3), 2, Items::Points));
    cases
}

/// Every answer of the solver is true, and doctored verdicts and answers are false.
#[test]
fn answers_of_the_solver_are_true_and_doctored_ones_are_false() {
    let (mut decided, mut undecided) = (0, vec![]);
    for case in cases() {
        let oracle = case.oracle();
        let words = format!("{:?}, {} columns: {:?}", case.items, case.columns, case.verdict);
        match oracle.judge(&case.solution, &case.verdict) {
            Truth::True => decided += 1,
            Truth::False(why) => panic!("{words}: {why}"),
            Truth::Undecided(why) => undecided.push(format!("{words}: {why}")),
        }
        let is_false = |what: &str, answer: &Ellipsoid, verdict: EllipsoidVerdict| {
            let solution = Solution { answer: answer.clone(), ..case.solution.clone() };
            let truth = oracle.judge(&solution, &verdict);
            assert!(matches!(truth, Truth::False(_)), "{words}: {what} is {truth:?}");
        };
        let (answer, verdict) = (&case.solution.answer, case.verdict);
        let rank = verdict.rank;
        if rank == 0 {
            is_false("a lower end above 0", answer, EllipsoidVerdict { lower: 1e-300, ..verdict });
            continue;
        }
        let (optimum, _) = oracle.bracket_for_tests().unwrap_or((verdict.upper, 0.0));
        let digit = 1e-12 + 8.0 * optimum.abs() * f64::EPSILON;
        is_false(
            "a lower end above the optimum",
            answer,
            EllipsoidVerdict { lower: optimum + digit, ..verdict },
        );
        is_false(
            "an upper end below",
            answer,
            EllipsoidVerdict { upper: optimum - digit, ..verdict },
        );
        is_false(
            "no gap",
            answer,
            EllipsoidVerdict { gap: verdict.gap - 2.0 * verdict.gap - digit, ..verdict },
        );
        is_false(
            "a negative excess",
            answer,
            EllipsoidVerdict { excess: verdict.excess - digit, ..verdict },
        );
        is_false("another rank", answer, EllipsoidVerdict { rank: rank - 1, ..verdict });
        is_false("NaN", answer, EllipsoidVerdict { upper: f64::NAN, ..verdict });
        let other = Ellipsoid {
            log_volume: answer.log_volume + 1e-12 + 1e3 * U * optimum.abs(),
            ..answer.clone()
        };
        is_false("another log-volume", &other, verdict);
        let shrunk: Vec<Vec<f64>> = answer
            .factor
            .iter()
            .map(|row| row.iter().map(|f| f * (1.0 + 1e-11)).collect())
            .collect();
        is_false("a smaller ellipsoid", &Ellipsoid { factor: shrunk, ..answer.clone() }, verdict);
        let mut matrix = answer.matrix.clone();
        matrix.iter_mut().flatten().for_each(|q| *q *= 1.0 + 1e-3);
        is_false(
            "a larger matrix",
            &Ellipsoid { matrix, ..answer.clone() },
            EllipsoidVerdict { matrix_excess: verdict.matrix_excess.min(1e-9), ..verdict },
        );
    }
    println!("true {decided}, undecided {}: {undecided:#?}", undecided.len());
    assert!(undecided.is_empty(), "{undecided:#?}");
}

fn certificate(values: &[f64], columns: usize) -> EllipsoidCertificate {
    let points = Points::new(values, columns).unwrap();
    EllipsoidCertificate {
        items: Items::Points,
        support: vec![0],
        multipliers: vec![1.0],
        directions: vec![],
        left_out: vec![],
        gap: 0.0,
        points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
    }
}

/// Points that span more than the largest number are no single point, and points 1e210 apart no segment along y.
#[test]
fn sets_that_are_flat_by_overflow_alone_are_refused() {
    let nothing = EllipsoidVerdict {
        lower: 0.0,
        upper: 0.0,
        gap: 0.0,
        excess: 0.0,
        matrix_excess: 0.0,
        off_hull: f64::MAX,
        rank: 0,
    };
    let values = [-1.7e308, 1.7e308];
    let hull = |basis: Vec<Vec<f64>>, distance: f64| Some(taut::certify::Hull { basis, distance });
    let answer = Ellipsoid {
        center: vec![0.0],
        center_tail: vec![],
        matrix: vec![vec![0.0]],
        factor: vec![],
        hull: hull(vec![], f64::MAX),
        log_volume: 0.0,
    };
    let solution =
        Solution { answer, certificate: certificate(&values, 1), trace: Trace::default() };
    let truth = EllipsoidOracle::new(&values, 1, Items::Points).judge(&solution, &nothing);
    assert!(matches!(truth, Truth::False(_)), "{truth:?}");

    let values = [1e210, 0.0, -1e210, 0.0, 1e210, 1e-100, -1e210, 1e-100];
    let answer = Ellipsoid {
        center: vec![0.0, 5e-101],
        center_tail: vec![],
        matrix: vec![vec![0.0, 0.0], vec![0.0, 4e200]],
        factor: vec![vec![0.0, 2e100]],
        hull: hull(vec![vec![0.0, 1.0]], 1e210),
        log_volume: -230.258_509_299_404_57,
    };
    let verdict = EllipsoidVerdict {
        lower: -230.3,
        upper: -230.2,
        gap: 1e-9,
        excess: 1e-12,
        matrix_excess: 1e-9,
        off_hull: f64::MAX,
        rank: 1,
    };
    let solution =
        Solution { answer, certificate: certificate(&values, 2), trace: Trace::default() };
    let truth = EllipsoidOracle::new(&values, 2, Items::Points).judge(&solution, &verdict);
    assert!(matches!(&truth, Truth::False(why) if why.contains("flat")), "{truth:?}");
}

/// Of a shape that rounding made indefinite, the item is that of S + 2τD, and an ellipsoid around S alone does not hold it.
#[test]
fn an_ellipsoid_around_an_indefinite_shape_holds_what_the_lower_bound_is_about() {
    // Correlation 1 + τ with τ near 1e-14: S + 2τD has the axes √2 and √τ.
    let tau: f64 = (1.0 + 1e-14) - 1.0;
    let values = [0.0, 0.0, 1.0, 1.0 + tau, 1.0];
    let oracle = EllipsoidOracle::new(&values, 5, Items::Ellipsoids);
    // x ≈ y: the short axis is off by the root of τ, so that an ellipsoid with one of √τ/2 is too thin.
    let judge = |short: f64, below: f64| {
        let (a, b) =
            (0.5f64.sqrt() / (2.0 + 10.0 * tau).sqrt() / (1.0 + 1e-15), 0.5f64.sqrt() / short);
        let factor = vec![vec![a, a], vec![b, -b]];
        let matrix = vec![vec![a * a + b * b, a * a - b * b], vec![a * a - b * b, a * a + b * b]];
        let log_volume = PI.ln() - (2.0 * a * b).ln();
        let answer = Ellipsoid {
            center: vec![0.0; 2],
            center_tail: vec![],
            matrix,
            factor,
            hull: None,
            log_volume,
        };
        let points = Points::new(&values, 5).unwrap();
        let certificate = EllipsoidCertificate {
            items: Items::Ellipsoids,
            support: vec![0, 0, 0, 0],
            multipliers: vec![0.25; 4],
            directions: vec![vec![1.0, 1.0], vec![-1.0, -1.0], vec![1.0, -1.0], vec![-1.0, 1.0]],
            left_out: vec![],
            gap: 3.0,
            points_hash: hash_points(&points, &Monitor::silent()).unwrap(),
        };
        let verdict = EllipsoidVerdict {
            lower: log_volume - below,
            upper: log_volume + 1e-10,
            gap: below,
            excess: 1e-12,
            matrix_excess: 1e-2,
            off_hull: 0.0,
            rank: 2,
        };
        oracle.judge(&Solution { answer, certificate, trace: Trace::default() }, &verdict)
    };
    let thin = judge(0.5 * tau.sqrt(), 3.0);
    assert!(matches!(thin, Truth::False(_)), "{thin:?}");
    let wide = judge(4.0 * tau.sqrt(), 3.0);
    assert_eq!(wide, Truth::True, "{wide:?}");
    // The first power that helps is 128u. The least log-volume around S + 256uD is a true lower end, and a number above it
    // is not.
    let short = (256.0 * U - tau).sqrt() * (1.0 + 1e-9);
    assert_eq!(judge(short, 1e-8), Truth::True);
    let above = judge(short, -1e-8);
    assert!(matches!(above, Truth::False(_)), "{above:?}");
}
