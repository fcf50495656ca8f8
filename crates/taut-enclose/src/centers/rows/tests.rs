//! Centers among the rows, against brute force and another exact method, with proofs replayed.

mod judge;
mod other;

use taut_certify::{Centers, Items, LowerBound, Placement, Solution, Stop};
use taut_points::{Distribution, InputError, Monitor, Points, generate};

use self::judge::{Problem, judge};
use crate::Error;
use crate::centers::{CentersMethod, CentersOptions, solve};

fn ask(problem: &Problem<'_>, options: &CentersOptions<'_>) -> Result<Solution<Centers>, Error> {
    let points = Points::new(problem.values, problem.columns).unwrap();
    options.check(problem.k)?;
    solve(&points, problem.items, problem.k, options, &Monitor::silent())
}

fn exact(problem: &Problem<'_>) -> CentersOptions<'static> {
    CentersOptions {
        epsilon: 0.0,
        weights: problem.weights,
        outliers: problem.outliers as u64,
        placement: Placement::Rows,
        ..CentersOptions::default()
    }
}

/// Solves to ε = 0, judges, and returns the radius.
fn solved(problem: &Problem<'_>) -> Solution<Centers> {
    let found = ask(problem, &exact(problem)).unwrap();
    judge(problem, &found, 0.0);
    found
}

fn points(values: &[f64], columns: usize, k: usize, outliers: usize) -> Problem<'_> {
    Problem { values, columns, items: Items::Points, weights: false, k, outliers }
}

/// Equal but for the little that radii are rounded up by.
#[track_caller]
fn assert_same(found: f64, wanted: f64) {
    assert!(found >= wanted * (1.0 - 1e-14) && found <= wanted * (1.0 + 1e-14), "{found} {wanted}");
}

/// Random rows; small integers bring ties and duplicates. The last column can serve as weights or radii.
fn rows(n: usize, columns: usize, seed: u64) -> Vec<f64> {
    let mut values: Vec<f64> = generate(Distribution::Uniform, n, columns, seed).unwrap();
    if seed.is_multiple_of(2) {
        values.iter_mut().for_each(|v| *v = (*v * 7.0).floor());
    }
    values.chunks_exact_mut(columns).for_each(|row| row[columns - 1] = row[columns - 1].abs());
    values
}

#[test]
fn every_choice_of_rows_is_worse_or_equal() {
    for seed in 0..600 {
        let (n, dim) = (2 + seed as usize % 11, 1 + seed as usize % 3);
        let (k, outliers) = (1 + seed as usize / 7 % 4, (seed as usize / 3 % 4).min(n - 1));
        let values = rows(n, dim, seed);
        let plain = points(&values, dim, k, outliers);
        assert_same(solved(&plain).answer.radius, plain.brute_force());

        let mut values = rows(n, dim + 1, seed);
        values.chunks_exact_mut(dim + 1).for_each(|row| row[dim] += 0.5);
        let weighted = Problem { weights: true, ..points(&values, dim + 1, k, outliers) };
        assert_same(solved(&weighted).answer.radius, weighted.brute_force());
        let balls = Problem { items: Items::Balls, ..points(&values, dim + 1, k, outliers) };
        assert_same(solved(&balls).answer.radius, balls.brute_force());
    }
}

#[test]
fn another_exact_method_agrees() {
    for seed in 0..200 {
        let (dim, k) = (1 + seed as usize % 4, 1 + seed as usize % 6);
        let n = 56 + seed as usize % 9;
        let outliers = if seed % 5 == 0 && k <= 4 { 1 + seed as usize % 2 } else { 0 };
        let values = rows(n, dim, seed);
        let problem = points(&values, dim, k, outliers);
        assert_same(solved(&problem).answer.radius, other::radius(&problem));
    }
}

#[test]
fn larger_sets_reach_the_gap_that_was_asked_for() {
    for (n, dim, k, outliers, epsilon) in [
        (3000, 2, 5, 0, 0.0),
        (3000, 2, 8, 0, 1e-2),
        (3000, 3, 4, 0, 0.0),
        (2000, 2, 3, 3, 0.0),
        (500, 20, 3, 0, 1e-3),
        (300, 2, 100, 0, 0.1),
    ] {
        let values: Vec<f64> = generate(Distribution::Normal, n, dim, 3).unwrap();
        let problem = points(&values, dim, k, outliers);
        let found = ask(&problem, &CentersOptions { epsilon, ..exact(&problem) }).unwrap();
        judge(&problem, &found, epsilon);
        assert_eq!(found.trace.stop, Stop::Converged);
    }
}

#[test]
fn all_of_it_is_the_same_for_any_number_of_threads() {
    let values: Vec<f64> = generate(Distribution::Normal, 20_000, 2, 9).unwrap();
    let problem = points(&values, 2, 5, 2);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let found = pool.install(|| ask(&problem, &exact(&problem))).unwrap();
        (serde_json::to_string(&found.answer).unwrap(), found.certificate, found.trace)
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(5));
}

#[test]
fn scaled_shifted_permuted_and_repeated_rows_have_the_same_answer() {
    let values = rows(200, 2, 1);
    let first = solved(&points(&values, 2, 4, 1)).answer.radius;
    let scaled: Vec<f64> = values.iter().map(|v| v * 2f64.powi(40)).collect();
    assert_eq!(solved(&points(&scaled, 2, 4, 1)).answer.radius, first * 2f64.powi(40));
    let reversed: Vec<f64> = values.chunks(2).rev().flatten().copied().collect();
    assert_eq!(solved(&points(&reversed, 2, 4, 1)).answer.radius, first);
    let turned: Vec<f64> = values.chunks(2).flat_map(|p| [-p[1], p[0]]).collect();
    assert_same(solved(&points(&turned, 2, 4, 1)).answer.radius, first);
    // Each row twice, and two to be left out.
    let twice: Vec<f64> = values.iter().chain(&values).copied().collect();
    assert!(solved(&points(&twice, 2, 4, 2)).answer.radius <= first);
    let without = solved(&points(&values, 2, 4, 0)).answer.radius;
    assert_eq!(solved(&points(&twice, 2, 4, 0)).answer.radius, without);
    // A weight of 2 everywhere.
    let weighted: Vec<f64> = values.chunks(2).flat_map(|p| [p[0], p[1], 2.0]).collect();
    let weighted = Problem { weights: true, ..points(&weighted, 3, 4, 1) };
    assert_same(solved(&weighted).answer.radius, 2.0 * first);
}

#[test]
fn the_radius_falls_with_more_centers_and_more_outliers() {
    let values = rows(80, 2, 7);
    let mut before = f64::INFINITY;
    for k in 1..8 {
        let radius = solved(&points(&values, 2, k, 0)).answer.radius;
        assert!(radius <= before);
        assert!(solved(&points(&values, 2, k, 1)).answer.radius <= radius);
        before = radius;
    }
}

#[test]
fn few_rows_and_equal_rows_are_centers_themselves() {
    let one = solved(&points(&[3.0, 4.0], 2, 1, 0));
    assert_eq!((one.answer.radius, one.answer.lower_bound), (0.0, 0.0));
    assert_eq!((one.answer.rows, one.certificate.gap), (vec![0], 0.0));
    let equal = solved(&points(&[1.0, 2.0].repeat(50), 2, 3, 0));
    assert_eq!((equal.answer.radius, equal.answer.rows.len()), (0.0, 1));
    let pair = [0.0, 0.0, 1.0, 1.0].repeat(20);
    assert_eq!(solved(&points(&pair, 2, 2, 0)).answer.radius, 0.0);
    assert_eq!(solved(&points(&pair, 2, usize::MAX, 0)).answer.rows.len(), 2);
    // Nineteen may be left out, but each of the two stands there twenty times.
    assert_same(solved(&points(&pair, 2, 1, 19)).answer.radius, 2f64.sqrt());
    let found = solved(&points(&pair, 2, 1, 20)).answer;
    assert_eq!((found.radius, found.outliers.len()), (0.0, 20));
    assert_eq!(solved(&points(&pair, 2, 1, 39)).answer.radius, 0.0);
    // Balls are never less than they are, even as centers.
    let balls = Problem { items: Items::Balls, ..points(&[0.0, 1.0, 5.0, 2.0], 2, 2, 0) };
    assert_eq!(solved(&balls).answer.radius, 2.0);
}

#[test]
fn a_line_of_equal_steps_is_cut_evenly() {
    let line: Vec<f64> = (0..90).map(f64::from).collect();
    for (k, radius) in [(1, 45.0), (2, 22.0), (3, 15.0), (6, 7.0), (30, 1.0), (45, 1.0), (90, 0.0)]
    {
        assert_eq!(solved(&points(&line, 1, k, 0)).answer.radius, radius, "k = {k}");
    }
}

#[test]
fn sizes_at_the_ends_of_the_range_are_solved_or_refused() {
    let values = rows(30, 2, 3);
    let first = solved(&points(&values, 2, 3, 0)).answer.radius;
    for scale in [2f64.powi(-600), 2f64.powi(-400), 2f64.powi(400), 2f64.powi(1000)] {
        let scaled: Vec<f64> = values.iter().map(|v| v * scale).collect();
        assert_same(solved(&points(&scaled, 2, 3, 0)).answer.radius, first * scale);
    }
    let ends = [f64::MAX, -f64::MAX];
    let problem = points(&ends, 1, 1, 0);
    let refused = ask(&problem, &exact(&problem));
    assert!(matches!(refused, Err(Error::Overflow)));
}

#[test]
fn wrong_input_is_refused_by_name() {
    let ask = |values: &[f64], columns, items, k, weights| {
        let problem = Problem { values, columns, items, weights, k, outliers: 0 };
        ask(&problem, &exact(&problem)).map(|_| ()).unwrap_err()
    };
    let is = Items::Points;
    assert!(matches!(ask(&[], 2, is, 1, false), Error::Empty));
    assert!(matches!(
        ask(&[1.0], 1, is, 0, false),
        Error::Input(InputError::Option { name: "k", .. })
    ));
    let nan = ask(&[1.0, 2.0, f64::NAN, 3.0], 2, is, 1, false);
    assert!(matches!(nan, Error::Input(InputError::NonFinite { row: 1, column: 0, .. })));
    let weight = ask(&[1.0, 2.0, 1.0, 0.0], 2, is, 1, true);
    assert!(matches!(weight, Error::NonPositiveWeight { row: 1, .. }));
    assert!(matches!(ask(&[1.0], 1, is, 1, true), Error::NoWeight { columns: 1 }));
    let radius = ask(&[1.0, -2.0], 2, Items::Balls, 1, false);
    assert!(matches!(radius, Error::NegativeRadius { row: 0, .. }));
    assert!(matches!(ask(&[1.0], 1, Items::Balls, 1, false), Error::NoRadius { .. }));
    let shapes = ask(&[1.0, 1.0], 2, Items::Ellipsoids, 1, false);
    assert!(matches!(shapes, Error::Input(InputError::Option { name: "inputs", .. })));
    let problem = points(&[1.0, 2.0, 3.0], 1, 1, 3);
    let refused = self::ask(&problem, &exact(&problem));
    assert!(matches!(refused, Err(Error::Input(InputError::Option { name: "outliers", .. }))));
    let both = ask(&[1.0, 1.0], 2, Items::Balls, 1, true);
    assert!(matches!(both, Error::Input(InputError::Option { name: "weights", .. })));
}

#[test]
fn a_search_cut_short_still_gives_bounds_that_hold() {
    let values: Vec<f64> = generate(Distribution::Uniform, 1000, 2, 4).unwrap();
    let problem = points(&values, 2, 7, 0);
    let best = solved(&problem).answer.radius;
    let mut before = f64::INFINITY;
    for max_nodes in [0, 1, 30, 300, 3000] {
        let options = CentersOptions { max_nodes, ..exact(&problem) };
        let found = ask(&problem, &options).unwrap();
        judge(&problem, &found, 1.0);
        assert!(found.answer.lower_bound <= best && found.answer.radius >= best);
        assert!(found.trace.iterations <= max_nodes);
        assert!(found.certificate.gap <= before, "more nodes, a wider gap");
        before = found.certificate.gap;
        if max_nodes < 30 {
            assert_eq!(found.trace.stop, Stop::NodeBudget);
            assert!(matches!(found.certificate.proof, LowerBound::Separated));
        }
    }
}

#[test]
fn the_traversal_alone_proves_a_factor_of_two() {
    let values: Vec<f64> = generate(Distribution::Uniform, 1000, 2, 8).unwrap();
    let problem = points(&values, 2, 9, 0);
    let method = CentersMethod::FarthestFirst;
    let found = ask(&problem, &CentersOptions { method, ..exact(&problem) }).unwrap();
    judge(&problem, &found, 1.0);
    assert_eq!((found.trace.stop, found.trace.iterations), (Stop::Converged, 0));
    let best = solved(&problem).answer.radius;
    assert!(found.answer.lower_bound <= best && best < found.answer.radius);
    let thesis = CentersOptions { method: CentersMethod::Thesis, ..exact(&problem) };
    assert!(matches!(
        ask(&problem, &thesis),
        Err(Error::Input(InputError::Option { name: "placement", .. }))
    ));
}

#[test]
fn each_row_is_told_its_center_on_request() {
    let values = rows(50, 2, 11);
    let problem = points(&values, 2, 4, 0);
    let options = CentersOptions { assignment: true, ..exact(&problem) };
    let answer = ask(&problem, &options).unwrap().answer;
    assert_eq!(answer.assignment.len(), 50);
    for (row, &j) in values.chunks(2).zip(&answer.assignment) {
        let distance = |c: &Vec<f64>| (row[0] - c[0]).hypot(row[1] - c[1]);
        let nearest = answer.centers.iter().map(distance).fold(f64::INFINITY, f64::min);
        assert!(distance(&answer.centers[j as usize]) <= nearest * (1.0 + 1e-15));
    }
}

#[test]
fn the_judge_rejects_what_is_not_proved() {
    let values: Vec<f64> = generate(Distribution::Uniform, 800, 2, 6).unwrap();
    let problem = points(&values, 2, 8, 0);
    let found = solved(&problem);
    let LowerBound::Branches { items } = &found.certificate.proof else { panic!("a short proof") };
    let rejects = |problem: &Problem<'_>, edit: &dyn Fn(&mut Solution<Centers>)| {
        let mut doctored = found.clone();
        edit(&mut doctored);
        std::panic::catch_unwind(|| judge(problem, &doctored, 0.0)).is_err()
    };
    assert!(!rejects(&problem, &|_| ()));
    assert!(rejects(&problem, &|found| {
        found.answer.radius *= 1.0 + 1e-6;
        found.answer.lower_bound = found.answer.radius;
    }));
    assert!(rejects(&problem, &|found| found.answer.radius *= 1.0 - 1e-6));
    let log = |items: Vec<u32>| {
        move |found: &mut Solution<Centers>| {
            found.certificate.proof = LowerBound::Branches { items: items.clone() };
        }
    };
    assert!(rejects(&problem, &log(items[1..].to_vec())));
    assert!(rejects(&problem, &log(items[..items.len() - 1].to_vec())));
    assert!(rejects(&problem, &log([&items[..], &[0]].concat())));
    let more = Problem { k: 9, ..problem };
    assert!(rejects(&more, &|found| found.certificate.k = 9));
    let fewer = Problem { outliers: 1, ..problem };
    assert!(rejects(&fewer, &|found| found.certificate.outliers = 1));
}

#[test]
fn cancelling_stops_the_search() {
    let values = rows(50, 2, 5);
    let points = Points::new(&values, 2).unwrap();
    let cancel = std::sync::atomic::AtomicBool::new(true);
    let monitor = Monitor { cancel: Some(&cancel), ..Monitor::silent() };
    let options = CentersOptions { placement: Placement::Rows, ..CentersOptions::default() };
    let refused = solve(&points, Items::Points, 3, &options, &monitor);
    assert!(matches!(refused, Err(Error::Input(InputError::Read(_)))));
}
