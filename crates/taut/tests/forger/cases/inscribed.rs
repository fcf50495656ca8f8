//! Ellipsoids in polytopes.

use taut::{InscribedOptions, Monitor, inscribed_ellipsoid};

use super::{Case, Input, Solved, cases, document};

use crate::random::Random;
/// Returns the cases of the maximum-volume inscribed ellipsoid.
pub fn all() -> Vec<Case> {
    let mut found = vec![];
    for dim in 1..=5 {
        found.extend(cases(polytopes(dim), solve));
    }
    found
}

/// Returns boxes, simplices and others, some of them far from 0, large, small, thin, or with rows of odd scales.
fn polytopes(dim: usize) -> Vec<Input> {
    let mut random = Random::new("polytopes", dim as u64);
    let mut cube = vec![];
    for j in 0..dim {
        for sign in [1.0, -1.0] {
            let mut row = vec![0.0; dim + 1];
            (row[j], row[dim]) = (sign, 1.0);
            cube.extend(row);
        }
    }
    let mut simplex = vec![];
    for j in 0..dim {
        let mut row = vec![0.0; dim + 1];
        row[j] = -1.0;
        simplex.extend(row);
    }
    simplex.extend(vec![1.0; dim + 1]);
    let cut: Vec<f64> = (0..dim + 3)
        .flat_map(|_| {
            let mut row: Vec<f64> = (0..dim).map(|_| random.signed()).collect();
            row.push(0.5 + random.unit());
            row
        })
        .collect();
    let cut = [cube.clone(), cut].concat();
    let by_rows = |factor: &mut dyn FnMut() -> f64| -> Vec<f64> {
        cut.chunks_exact(dim + 1)
            .flat_map(|row| {
                let factor = factor();
                row.iter().map(|x| x * factor).collect::<Vec<f64>>()
            })
            .collect()
    };
    let odd = by_rows(&mut || 10f64.powi(random.between(-300, 300) as i32));
    let sides = |factor: f64| -> Vec<f64> {
        let scale = |(i, x): (usize, &f64)| if i % (dim + 1) == dim { x * factor } else { *x };
        cut.iter().enumerate().map(scale).collect()
    };
    let thin: Vec<f64> = cube
        .chunks_exact(dim + 1)
        .enumerate()
        .flat_map(|(i, row)| {
            let side = if i < 2 { 1e-9 } else { 1.0 };
            [&row[..dim], &[row[dim] * side]].concat()
        })
        .collect();
    let far: Vec<f64> = cube
        .chunks_exact(dim + 1)
        .flat_map(|row| {
            let shift: f64 = row[..dim].iter().sum::<f64>() * 1e6;
            [&row[..dim], &[row[dim] + shift]].concat()
        })
        .collect();
    [
        ("a cube", cube.clone()),
        ("a cube twice", cube.repeat(2)),
        ("a simplex", simplex),
        ("a cube with cuts", cut.clone()),
        ("rows of odd scales", odd),
        ("a polytope of 1e-150", sides(1e-150)),
        ("a polytope of 1e150", sides(1e150)),
        ("a thin box", thin),
        ("a cube far away", far),
    ]
    .into_iter()
    .map(|(what, values)| Input::new(format!("{what}, d = {dim}"), values, dim + 1))
    .collect()
}

fn solve(input: &Input) -> Vec<Solved> {
    let base = InscribedOptions::default();
    let ways = [
        ("1e-9", base.clone()),
        ("1e-2", InscribedOptions { epsilon: 1e-2, ..base.clone() }),
        ("1e-13", InscribedOptions { epsilon: 1e-13, ..base.clone() }),
        ("one step", InscribedOptions { max_steps: 1, ..base.clone() }),
        ("four steps", InscribedOptions { max_steps: 4, ..base }),
    ];
    ways.into_iter()
        .map(|(way, options)| {
            let monitor = Monitor::silent();
            let found = input.with(|source| {
                inscribed_ellipsoid(source, &InscribedOptions { monitor, ..options.clone() })
            });
            (way.to_owned(), found.ok().map(|found| document(&found)))
        })
        .collect()
}
