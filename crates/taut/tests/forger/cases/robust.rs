//! Robust ellipsoids of few points.

use taut::certify::RobustScale;
use taut::{Monitor, RobustMethod, RobustOptions, robust_ellipsoid};

use super::{Case, Input, Solved, cases, clouds, document, some};

use crate::random::Random;
/// Returns the cases of robust ellipsoids.
pub fn all() -> Vec<Case> {
    let mut found = vec![];
    for dim in 1..=3 {
        let mut inputs = vec![with_outliers(dim), on_a_flat(dim)];
        inputs.extend(some(clouds::points(dim, 12), dim));
        found.extend(cases(inputs, solve));
    }
    found
}

/// Points about 0, and a few far away.
fn with_outliers(dim: usize) -> Input {
    let mut random = Random::new("outliers", dim as u64);
    let inner = (0..14 * dim).map(|_| random.signed() + random.signed()).collect::<Vec<f64>>();
    let outer = (0..3 * dim).map(|_| 20.0 + random.signed()).collect::<Vec<f64>>();
    Input::new(format!("outliers, d = {dim}"), [inner, outer].concat(), dim)
}

/// Most points in a flat, some off it.
fn on_a_flat(dim: usize) -> Input {
    let mut random = Random::new("flat", dim as u64);
    let mut values = vec![];
    for i in 0..14 {
        let mut row: Vec<f64> = (0..dim).map(|_| random.between(-9, 9) as f64).collect();
        if i > 2 {
            row[dim - 1] = 2.0;
        }
        values.extend(row);
    }
    Input::new(format!("most in a flat, d = {dim}"), values, dim)
}

fn solve(input: &Input) -> Vec<Solved> {
    let mut found = vec![];
    for method in [RobustMethod::Mcd, RobustMethod::Mve, RobustMethod::Trim] {
        for (coverage, epsilon, scale) in [
            (None, 1e-9, RobustScale::Share),
            (Some(0.75), 1e-9, RobustScale::Share),
            (Some(0.75), 1e-9, RobustScale::Level),
            (None, 0.5, RobustScale::Share),
        ] {
            let options = RobustOptions { method, coverage, epsilon, scale, ..Default::default() };
            let monitor = Monitor::silent();
            let solution = input.with(|source| {
                robust_ellipsoid(source, &RobustOptions { monitor, ..options.clone() })
            });
            let way = format!("{method:?} of {coverage:?}, {epsilon}, {scale}");
            found.push((way, solution.ok().map(|solution| document(&solution))));
        }
    }
    found
}
