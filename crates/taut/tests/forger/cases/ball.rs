//! Balls around points, balls and ellipsoids.

use taut::enclose::BallMethod;
use taut::{BallOptions, Items, ball};

use super::{Case, Input, Solved, cases, clouds, document};

use crate::random::Random;
/// Returns the cases of the minimum enclosing ball.
pub fn all() -> Vec<Case> {
    let mut found = vec![];
    for (dim, count) in [(1, 6), (2, 12), (3, 10), (5, 9)] {
        found.extend(cases(clouds::points(dim, count), |input| solve(input, Items::Points)));
    }
    for dim in 1..=3 {
        found.extend(cases(balls(dim), |input| solve(input, Items::Balls)));
    }
    for dim in 2..=3 {
        let shapes = ellipsoids(dim);
        let single: Vec<Input> = shapes.iter().map(Input::single).collect();
        for inputs in [shapes, single] {
            found.extend(cases(inputs, |input| solve(input, Items::Ellipsoids)));
        }
    }
    found
}

/// Returns ellipsoids in `dim` dimensions: round, thin, flat, far apart in size. Each shape is Σ aaᵀ over a few arms, rounded.
pub fn ellipsoids(dim: usize) -> Vec<Input> {
    let mut random = Random::new("ellipsoids", dim as u64);
    let mut rows = |n: usize, arms: &[f64]| -> Vec<f64> {
        let mut values = vec![];
        for _ in 0..n {
            values.extend((0..dim).map(|_| random.signed() * 2.0));
            let arms: Vec<Vec<f64>> = arms
                .iter()
                .map(|length| (0..dim).map(|_| random.signed() * length).collect())
                .collect();
            for j in 0..dim {
                values.extend((0..=j).map(|k| arms.iter().map(|a| a[j] * a[k]).sum::<f64>()));
            }
        }
        values
    };
    let round = rows(4, &[1.0, 1.0, 1.0, 1.0]);
    let scaled = |factor: f64| -> Vec<f64> {
        // A shape has the units of a square.
        let scale = |(j, x): (usize, &f64)| if j % (dim * (dim + 3) / 2) < dim { factor } else { factor * factor } * x;
        round.iter().enumerate().map(scale).collect()
    };
    [
        ("round ellipsoids", round.clone()),
        ("thin ellipsoids", rows(5, &[1.0, 1e-3, 1e-3])),
        ("needles of ellipsoids", rows(4, &[1.0, 1e-7, 1e-9])),
        ("segments", rows(4, &[1.0])),
        ("ellipsoids of all sizes", [rows(2, &[1.0, 1.0, 1.0]), rows(2, &[1e-6, 1e-6])].concat()),
        ("one ellipsoid", rows(1, &[1.0, 0.1, 0.1])),
        ("one needle", rows(1, &[1.0, 1e-5, 1e-5])),
        ("ellipsoids of 1e-18", scaled(1e-18)),
        ("ellipsoids of 1e150", scaled(1e150)),
    ]
    .into_iter()
    .map(|(what, values)| Input::new(format!("{what}, d = {dim}"), values, dim * (dim + 3) / 2))
    .collect()
}

/// Returns balls in `dim` dimensions: apart, within each other, touching from inside, of radius 0, at the ends of the range.
pub fn balls(dim: usize) -> Vec<Input> {
    let mut random = Random::new("balls", dim as u64);
    let mut rows = |n: usize, spread: f64, radius: &dyn Fn(&mut Random) -> f64| -> Vec<f64> {
        (0..n)
            .flat_map(|_| {
                let mut row: Vec<f64> = (0..dim).map(|_| random.signed() * spread).collect();
                row.push(radius(&mut random));
                row
            })
            .collect()
    };
    let apart = rows(9, 1.0, &|random| 0.3 * random.unit());
    let within = rows(8, 0.1, &|random| random.unit());
    let some = rows(7, 1.0, &|random| f64::from(u8::from(random.chance(40))) * 0.5);
    let touching: Vec<f64> = (0..6)
        .flat_map(|i| {
            let mut row = vec![0.0; dim + 1];
            (row[i % dim], row[dim]) =
                (0.25 * (i as f64 - 2.0), 2.0 - 0.25 * (i as f64 - 2.0).abs());
            row
        })
        .collect();
    let equal = rows(5, 1.0, &|_| 1.0);
    let scaled = |values: &[f64], factor: f64| values.iter().map(|x| x * factor).collect();
    let tiny = rows(4, 1.0, &|random| 1e-200 * random.unit());
    let (low, high) = (scaled(&apart, 1e-300), scaled(&apart, 1e300));
    [
        ("balls apart", apart),
        ("balls within", within),
        ("balls and points", some),
        ("balls that touch from inside", touching),
        ("balls of one radius", equal),
        ("balls that are nearly points", tiny),
        ("balls of 1e-300", low),
        ("balls of 1e300", high),
    ]
    .into_iter()
    .map(|(what, values)| Input::new(format!("{what}, d = {dim}"), values, dim + 1))
    .collect()
}

fn solve(input: &Input, items: Items) -> Vec<Solved> {
    let ways = [
        ("exact", BallOptions { epsilon: 0.0, ..Default::default() }),
        ("1e-3", BallOptions { epsilon: 1e-3, ..Default::default() }),
        (
            "badoiu-clarkson",
            BallOptions { epsilon: 0.1, method: BallMethod::BadoiuClarkson, ..Default::default() },
        ),
    ];
    ways.into_iter()
        .map(|(way, options)| {
            let found = input
                .with(|source| ball(source, &BallOptions { inputs: items, ..options.clone() }));
            (way.to_owned(), found.ok().map(|found| document(&found)))
        })
        .collect()
}
