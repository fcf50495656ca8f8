//! The methods of the thesis against the default one, and against what the thesis and its lemmas say.

use taut_certify::{Ball, Items, Solution, Stop};
use taut_enclose::{BallMethod, BallOptions, ball};
use taut_points::{Distribution, Points, generate};

const THESIS: [BallMethod; 3] =
    [BallMethod::ThesisPure, BallMethod::ThesisFast, BallMethod::BadoiuClarkson];
const CONIC: [BallMethod; 2] = [BallMethod::ThesisPure, BallMethod::ThesisFast];
const DISTRIBUTIONS: [Distribution; 4] = [
    Distribution::Uniform,
    Distribution::CubeVertices,
    Distribution::Normal,
    Distribution::Poisson,
];

fn options(method: BallMethod, epsilon: f64) -> BallOptions<'static> {
    BallOptions { method, epsilon, ..BallOptions::default() }
}

fn solve(
    values: &[f64],
    columns: usize,
    items: Items,
    options: &BallOptions<'_>,
) -> Solution<Ball> {
    let points = Points::new(values, columns).unwrap();
    ball(&points, &BallOptions { inputs: items, ..options.clone() }).unwrap()
}

/// Returns how far the item that reaches farthest reaches, by plain loops.
fn reach(values: &[f64], columns: usize, items: Items, ball: &Ball) -> f64 {
    let dim = items.dim(columns);
    let center = |j: usize| ball.center[j] + ball.center_tail.get(j).copied().unwrap_or(0.0);
    values
        .chunks(columns)
        .map(|row| {
            let squares = (0..dim).map(|j| (row[j] - center(j)) * (row[j] - center(j)));
            squares.sum::<f64>().sqrt() + row[dim..].iter().sum::<f64>()
        })
        .fold(0.0, f64::max)
}

/// The bound that the multipliers prove, by plain loops.
fn lower(values: &[f64], columns: usize, items: Items, found: &Solution<Ball>) -> f64 {
    let dim = items.dim(columns);
    let certificate = &found.certificate;
    let pairs: Vec<(f64, &[f64])> = certificate
        .multipliers
        .iter()
        .zip(&certificate.support)
        .map(|(&l, &id)| (l, &values[id as usize * columns..(id as usize + 1) * columns]))
        .collect();
    let radius = |row: &[f64]| row[dim..].iter().sum::<f64>();
    let mean: f64 = pairs.iter().map(|(l, row)| l * radius(row)).sum();
    let center: Vec<f64> =
        (0..dim).map(|j| pairs.iter().map(|(l, row)| l * row[j]).sum()).collect();
    let inner: f64 = pairs
        .iter()
        .map(|(l, row)| {
            let squares = (0..dim).map(|j| (row[j] - center[j]) * (row[j] - center[j]));
            l * (squares.sum::<f64>() - (radius(row) - mean) * (radius(row) - mean))
        })
        .sum();
    let largest = pairs.iter().map(|(_, row)| radius(row)).fold(0.0, f64::max);
    (mean + inner.max(0.0).sqrt()).max(largest)
}

/// Both bounds hold by plain loops, and the gap that was asked is proved.
fn judge(name: &str, values: &[f64], columns: usize, items: Items, options: &BallOptions<'_>) {
    let found = solve(values, columns, items, options);
    let name =
        format!("{name}, {}, ε = {}, seed {}", options.method, options.epsilon, options.seed);
    let radius = found.answer.radius;
    assert_eq!(found.trace.stop, Stop::Converged, "{name}");
    assert!(found.certificate.gap <= options.epsilon, "{name}: gap {}", found.certificate.gap);
    assert!(reach(values, columns, items, &found.answer) <= radius * (1.0 + 1e-12), "{name}");
    let lower = lower(values, columns, items, &found);
    assert!(radius <= lower * (1.0 + options.epsilon + 1e-12), "{name}: {lower} to {radius}");
    let verdict = found.check(&Points::new(values, columns).unwrap());
    assert!(verdict.as_ref().is_ok_and(|v| v.gap <= options.epsilon), "{name}: {verdict:?}");

    let best = solve(values, columns, items, &BallOptions::default()).answer.radius;
    assert!(radius >= best * (1.0 - 1e-9), "{name}: {radius} is less than {best}");
    assert!(radius <= best * (1.0 + options.epsilon + 1e-9), "{name}: {radius} for {best}");

    let trace = &found.trace;
    assert_eq!(trace.method, options.method.name());
    assert!(trace.core_set >= found.certificate.support.len() as u64, "{name}");
    assert!(trace.history.len() as u64 <= trace.passes, "{name}");
    assert!(trace.history.iter().all(|b| b.lower <= best * (1.0 + 1e-9)), "{name}");
    assert!(trace.history.iter().all(|b| b.upper >= best * (1.0 - 1e-9)), "{name}");
}

/// Normal centers; radii |normal| · spread.
fn balls(n: usize, dim: usize, seed: u64, spread: f64) -> Vec<f64> {
    let mut values: Vec<f64> = generate(Distribution::Normal, n, dim + 1, seed).unwrap();
    values.chunks_mut(dim + 1).for_each(|row| row[dim] = spread * row[dim].abs());
    values
}

#[test]
fn the_distributions_are_solved_to_epsilon() {
    for distribution in DISTRIBUTIONS.into_iter().step_by(crate::test_length::long_or(1, 2)) {
        for (n, dim) in [(60, 1), (200, 2), (200, 3), (150, 20), (40, 60)] {
            let values: Vec<f64> = generate(distribution, n, dim, 7).unwrap();
            for method in THESIS {
                let name = format!("{distribution:?} {n} × {dim}");
                judge(&name, &values, dim, Items::Points, &options(method, 0.01));
            }
            for method in CONIC {
                let name = format!("{distribution:?} {n} × {dim}");
                judge(&name, &values, dim, Items::Points, &options(method, 1e-5));
            }
        }
    }
}

/// The experiment of 2.4 in small: any accuracy of the conic solver leads to ε; the size of the core-set hardly depends on it.
#[test]
fn any_accuracy_of_the_core_sets_leads_to_epsilon() {
    let (dim, epsilon) = (50, 1e-3);
    let values: Vec<f64> = generate(Distribution::Normal, 500, dim, 11).unwrap();
    let mut sizes = vec![];
    for &delta in
        crate::test_length::long_or(&[0.9, 1e-3, 1e-6, 1e-9, 1e-300][..], &[0.9, 1e-6, 1e-300])
    {
        for method in CONIC {
            let options = BallOptions { delta: Some(delta), ..options(method, epsilon) };
            judge(&format!("δ = {delta:e}"), &values, dim, Items::Points, &options);
            sizes.push(solve(&values, dim, Items::Points, &options).trace.core_set);
        }
    }
    let (least, most) = (sizes.iter().min().unwrap(), sizes.iter().max().unwrap());
    assert!(most - least <= least / 4, "{sizes:?}");
    // It reaches the solver: a coarser one takes fewer of its steps.
    let steps = |delta| {
        let options =
            BallOptions { delta: Some(delta), ..options(BallMethod::ThesisPure, epsilon) };
        solve(&values, dim, Items::Points, &options).trace.counters["interior_point_steps"]
    };
    assert!(steps(1e-3) < steps(1e-9));
}

#[test]
fn balls_are_solved_to_epsilon() {
    for (seed, spread) in [1e-3, 0.1, 1.0, 10.0].into_iter().enumerate() {
        for dim in [1, 2, 3, 12] {
            let values = balls(120, dim, seed as u64, spread);
            for method in THESIS {
                let name = format!("balls in {dim} dimensions, radii of {spread}");
                judge(&name, &values, dim + 1, Items::Balls, &options(method, 0.01));
            }
            for method in CONIC {
                let name = format!("balls in {dim} dimensions, radii of {spread}");
                judge(&name, &values, dim + 1, Items::Balls, &options(method, 1e-5));
            }
        }
    }
}

/// Radii ten thousand times the spread of the centers, all but equal: what counts is what is left of them.
#[test]
fn large_balls_close_together_are_solved() {
    let mut values = balls(80, 3, 21, 0.3);
    values.chunks_mut(4).for_each(|row| row[3] += 1e4);
    for method in CONIC {
        judge("large balls", &values, 4, Items::Balls, &options(method, 1e-12));
    }
}

#[test]
fn a_ball_that_covers_the_others_is_the_answer() {
    let mut covering = balls(100, 4, 3, 1.0);
    covering[5 * 17 + 4] = 50.0;
    // Concentric balls, and all balls of one center.
    let concentric: Vec<f64> = [1.0, 2.0, 3.0, 2.0].iter().flat_map(|&r| [0.5, 0.5, r]).collect();
    for method in THESIS {
        for seed in [0, 17, 2] {
            let options = BallOptions { seed, ..options(method, 0.01) };
            let found = solve(&covering, 5, Items::Balls, &options);
            assert_eq!((found.answer.radius, found.certificate.gap), (50.0, 0.0), "{method}");
            assert_eq!(found.certificate.support, [17]);
            let found = solve(&concentric, 3, Items::Balls, &options);
            assert_eq!((found.answer.radius, found.certificate.gap), (3.0, 0.0), "{method}");
        }
    }
}

#[test]
fn degenerate_sets_are_solved() {
    let grid: Vec<f64> = (0..81).flat_map(|i| [i % 9, i / 9]).map(f64::from).collect();
    let cube: Vec<f64> = (0..64).flat_map(|i| (0..6).map(move |j| f64::from(i >> j & 1))).collect();
    let polygon: Vec<f64> = generate(Distribution::Polygon { vertices: 37 }, 37, 2, 0).unwrap();
    let line: Vec<f64> = (0..20).flat_map(|i| [f64::from(i), 3.0 * f64::from(i), 1.0]).collect();
    let far: Vec<f64> = grid.iter().map(|v| v + 1e9).collect();
    let huge: Vec<f64> = grid.iter().map(|v| v * 1e150).collect();
    let tiny: Vec<f64> = grid.iter().map(|v| v * 1e-150).collect();
    let doubled = grid.repeat(3);
    let simplex: Vec<f64> = generate(Distribution::Simplex, 21, 20, 0).unwrap();
    let cases: [(&str, &[f64], usize); 11] = [
        ("grid", &grid, 2),
        ("cube", &cube, 6),
        ("polygon", &polygon, 2),
        ("line", &line, 3),
        ("far from the origin", &far, 2),
        ("huge", &huge, 2),
        ("tiny", &tiny, 2),
        ("every point thrice", &doubled, 2),
        ("simplex", &simplex, 20),
        ("two points", &[0.0, 0.0, 3.0, 4.0], 2),
        ("two points, one twice", &[0.0, 0.0, 3.0, 4.0, 0.0, 0.0], 2),
    ];
    for (name, values, dim) in cases {
        for method in THESIS {
            for seed in 0..3 {
                let options = BallOptions { seed, ..options(method, 0.01) };
                judge(name, values, dim, Items::Points, &options);
            }
        }
        for method in CONIC {
            judge(name, values, dim, Items::Points, &options(method, 1e-5));
        }
    }
}

#[test]
fn one_point_is_its_own_ball() {
    for method in THESIS {
        for values in [vec![1.5, -2.5], [0.1, 0.7].repeat(100)] {
            let found = solve(&values, 2, Items::Points, &options(method, 0.01));
            assert_eq!((found.answer.radius, found.certificate.gap), (0.0, 0.0), "{method}");
            assert_eq!(found.answer.center, values[..2]);
            assert_eq!(found.trace.stop, Stop::Converged);
        }
    }
}

#[test]
fn the_limit_of_the_conic_solver_is_reported_and_ends_the_method() {
    let normal: Vec<f64> = generate(Distribution::Normal, 300, 12, 4).unwrap();
    let sphere: Vec<f64> = generate(Distribution::Sphere, 300, 5, 4).unwrap();
    let cube: Vec<f64> = generate(Distribution::CubeVertices, 300, 12, 4).unwrap();
    for (values, dim) in [(&normal, 12), (&sphere, 5), (&cube, 12)] {
        for method in CONIC {
            for epsilon in [1e-12, 0.0] {
                let found = solve(values, dim, Items::Points, &options(method, epsilon));
                let gap = found.certificate.gap;
                assert!(gap < 1e-10, "{method}: {gap}");
                assert_eq!(found.trace.stop == Stop::Converged, gap <= epsilon.max(1e-12));
                assert!(found.trace.passes < 60, "{method}: {} passes", found.trace.passes);
                assert!(
                    reach(values, dim, Items::Points, &found.answer)
                        <= found.answer.radius * (1.0 + 1e-14)
                );
            }
        }
    }
}

/// Inputs on which the conic solver once gave up, or left multipliers that missed its own center.
#[test]
fn nearly_cospherical_sets_and_lattices_are_solved() {
    let normal = |n, seed| generate::<f64>(Distribution::Normal, n, 5, seed).unwrap();
    let near_cube: Vec<f64> =
        normal(40, 75).iter().map(|x| x.signum() * (1.0 + 1e-8 * x)).collect();
    let many: Vec<f64> = normal(90, 237).iter().map(|x| x.signum() * (1.0 + 1e-8 * x)).collect();
    let lattice: Vec<f64> = normal(90, 307).iter().map(|x| (2.0 * x).round()).collect();
    for (values, seed) in [(&near_cube, 75), (&many, 237), (&lattice, 307)] {
        for method in CONIC {
            let exact = BallOptions { seed, ..options(method, 0.0) };
            let found = solve(values, 5, Items::Points, &exact);
            let gap = found.certificate.gap;
            assert!(gap < 1e-8, "{method}, seed {seed}: {gap}");
            assert!(found.check(&Points::new(values, 5).unwrap()).is_ok());
        }
    }
}

/// The dual value after a step to distance D is (1 − β)(r² + βD²): the history of Algorithm 10 must obey it.
#[test]
fn the_lower_bound_of_a_step_follows_its_formula() {
    let three = [Distribution::Uniform, Distribution::Normal, Distribution::Sphere];
    for (seed, distribution) in three.into_iter().enumerate() {
        let values: Vec<f64> = generate(distribution, 150, 8, seed as u64).unwrap();
        let found = solve(&values, 8, Items::Points, &options(BallMethod::BadoiuClarkson, 0.01));
        let history = &found.trace.history;
        assert!(history.len() > 5, "{distribution:?}");
        for (i, step) in (3u32..).zip(history.windows(2)) {
            let beta = 1.0 / f64::from(i + 2);
            let (r2, far2) = (step[0].lower.powi(2), step[0].upper.powi(2));
            let expected = ((1.0 - beta) * (r2 + beta * far2)).sqrt();
            assert!((step[1].lower / expected - 1.0).abs() < 1e-12, "{distribution:?}, step {i}");
        }
        // 1/ε² steps are what the method is known to need at most.
        assert!(found.trace.iterations <= 10_000);
    }
}

/// An item at distance D from a ball of radius r raises it to (D² + r²)/(2D) at least, which implies Lemma 2.3.2.
#[test]
fn every_added_point_raises_the_radius_as_the_lemma_says() {
    for (seed, distribution) in DISTRIBUTIONS.into_iter().enumerate() {
        let values: Vec<f64> = generate(distribution, 400, 25, seed as u64).unwrap();
        let found = solve(&values, 25, Items::Points, &options(BallMethod::ThesisPure, 1e-4));
        let history = &found.trace.history;
        assert!(history.len() > 5, "{distribution:?}");
        for step in history.windows(2) {
            let (r, far) = (step[0].lower, step[0].upper);
            assert_eq!(step[1].working_set, step[0].working_set + 1);
            let grown = (far * far + r * r) / (2.0 * far);
            // The solver leaves δ = ε² of the radius open, twice.
            assert!(step[1].lower >= grown * (1.0 - 4e-8), "{distribution:?}: {step:?}");
            let excess = (3.0 * (far / r - 1.0)).min(1.0);
            assert!(step[1].lower >= r * (1.0 + excess * excess / 33.0) * (1.0 - 4e-8));
        }
    }
}

#[test]
fn core_sets_are_as_small_as_the_thesis_says() {
    for dim in [2, 3] {
        let values: Vec<f64> = generate(Distribution::Normal, 5000, dim, 11).unwrap();
        for method in CONIC {
            for epsilon in [1e-3, 1e-6] {
                let found = solve(&values, dim, Items::Points, &options(method, epsilon));
                assert!(found.trace.core_set < 10, "{method}: {}", found.trace.core_set);
            }
        }
    }
    let values: Vec<f64> = generate(Distribution::Normal, 1000, 100, 1).unwrap();
    let [pure, fast] =
        CONIC.map(|method| solve(&values, 100, Items::Points, &options(method, 1e-3)).trace);
    assert!((20..=60).contains(&pure.core_set), "{}", pure.core_set);
    assert!(fast.core_set.abs_diff(pure.core_set) <= 6, "{} {}", fast.core_set, pure.core_set);
    // One pass to look, two for the pair, one for each ball.
    assert_eq!(pure.passes, 3 + pure.counters["conic_solves"]);
    assert_eq!(pure.core_set, 1 + pure.counters["conic_solves"]);
    assert_eq!(fast.counters["steps"], 33);
    assert_eq!(fast.passes, 3 + 33 + fast.counters["conic_solves"]);
    assert_eq!(fast.iterations, 33 + fast.counters["conic_solves"]);
    assert!(fast.counters["conic_solves"] < pure.counters["conic_solves"] / 2);
}

#[test]
fn the_seed_changes_the_start_and_not_the_answer() {
    let values: Vec<f64> = generate(Distribution::Uniform, 500, 6, 5).unwrap();
    for method in THESIS {
        let found: Vec<Solution<Ball>> = (0..8)
            .map(|seed| {
                let options = BallOptions { seed, ..options(method, 1e-2) };
                judge("uniform", &values, 6, Items::Points, &options);
                solve(&values, 6, Items::Points, &options)
            })
            .collect();
        assert!(found.iter().any(|f| f.trace.history[0] != found[0].trace.history[0]), "{method}");
    }
}

#[test]
fn the_answer_does_not_depend_on_threads() {
    let points: Vec<f64> = generate(Distribution::Normal, 20_000, 40, 2).unwrap();
    let balls = balls(20_000, 40, 2, 1.0);
    for method in THESIS {
        for (values, columns, items) in [(&points, 40, Items::Points), (&balls, 41, Items::Balls)] {
            let [one, two, eight] = [1, 2, 8].map(|threads| {
                let options = BallOptions { threads: Some(threads), ..options(method, 0.02) };
                solve(values, columns, items, &options)
            });
            assert_eq!(one, two, "{method}");
            assert_eq!(one, eight, "{method}");
        }
    }
}

#[test]
fn the_budget_of_passes_is_kept_and_the_gap_reached_is_reported() {
    let values: Vec<f64> = generate(Distribution::Normal, 400, 30, 9).unwrap();
    for method in THESIS {
        for max_passes in [4, 5, 9] {
            let options = BallOptions { max_passes, ..options(method, 1e-6) };
            let found = solve(&values, 30, Items::Points, &options);
            assert_eq!((found.trace.stop, found.trace.passes), (Stop::PassBudget, max_passes));
            let gap = found.certificate.gap;
            assert!(gap > 1e-6 && gap < 2.0, "{method}: {gap}");
            let radius = found.answer.radius;
            assert!(reach(&values, 30, Items::Points, &found.answer) <= radius * (1.0 + 1e-14));
            assert!(radius <= lower(&values, 30, Items::Points, &found) * (1.0 + gap + 1e-12));
        }
        let points = Points::new(&values, 30).unwrap();
        let options = BallOptions { max_passes: 3, ..options(method, 1e-6) };
        let refused = taut_enclose::ball(&points, &options).unwrap_err();
        assert!(refused.to_string().contains("max_passes"), "{refused}");
    }
}
