//! Circles in polygons.

use taut::{CircleOptions, inscribed_circle};

use super::{Case, Input, Solved, cases, document};

use crate::random::Random;

/// Returns the cases of the largest circle in a polygon.
pub fn all() -> Vec<Case> {
    cases(polygons(), solve)
}

/// Returns small polygons, some of them with holes, far from 0, large, small, thin, or with repeated vertices.
pub fn polygons() -> Vec<Input> {
    let square = vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
    let corner = vec![0.0, 0.0, 3.0, 0.0, 3.0, 2.0, 2.0, 2.0, 2.0, 3.0, 0.0, 3.0];
    let scaled = |factor: f64| corner.iter().map(|x| x * factor).collect::<Vec<_>>();
    let mut found = vec![
        ("a triangle", vec![0.0, 0.0, 4.0, 0.0, 4.0, 3.0]),
        ("a square", square.clone()),
        ("a square, closed", [&square[..], &square[..2]].concat()),
        ("a square with repeated vertices", {
            square.chunks_exact(2).flat_map(|p| [p, p].concat()).collect()
        }),
        ("a corridor", vec![0.0, 0.0, 9.0, 0.0, 9.0, 1.0, 0.0, 1.0]),
        ("an L", corner.clone()),
        ("an L of 1e-150", scaled(1e-150)),
        ("an L of 1e150", scaled(1e150)),
        ("an L far away", corner.iter().map(|x| x + 1e6).collect()),
        ("a thin triangle", vec![0.0, 0.0, 1.0, 0.0, 0.5, 1e-6]),
        (
            "a comb",
            vec![
                0.0, 0.0, 5.0, 0.0, 5.0, 2.0, 4.0, 2.0, 4.0, 1.0, 3.0, 1.0, 3.0, 2.0, 2.0, 2.0,
                2.0, 1.0, 0.0, 1.0,
            ],
        ),
    ];
    for (name, size) in [("a star of 7", 7), ("a star of 10", 10), ("a star of 16", 16)] {
        let mut random = Random::new("rings", size);
        let ring = (0..size).flat_map(|i| {
            let turn = (i as f64 + 0.9 * random.unit()) / size as f64;
            let (sine, cosine) = (std::f64::consts::TAU * turn).sin_cos();
            let radius = 0.2 + random.unit();
            [radius * cosine, radius * sine]
        });
        found.push((name, ring.collect()));
    }
    let rings = |rings: &[&[f64]]| -> Vec<f64> {
        let numbered = |(number, ring): (usize, &&[f64])| {
            ring.chunks_exact(2).flat_map(|p| [p[0], p[1], number as f64]).collect::<Vec<_>>()
        };
        rings.iter().enumerate().flat_map(numbered).collect()
    };
    let large: Vec<f64> = square.iter().map(|x| 4.0 * x).collect();
    let at = |x: f64| square.iter().map(|y| x + y).collect::<Vec<_>>();
    let hole: Vec<f64> = square.iter().map(|x| 0.5 + 3.0 * x).collect();
    let with_holes = [
        ("a square with a hole", rings(&[&large, &at(1.25)])),
        ("two squares", rings(&[&square, &at(2.0)])),
        ("an island", rings(&[&large, &hole, &at(1.5)])),
        ("one ring with its number", rings(&[&corner])),
    ];
    let plain = found.into_iter().map(|(name, values)| Input::new(name, values, 2));
    plain.chain(with_holes.map(|(name, values)| Input::new(name, values, 3))).collect()
}

fn solve(input: &Input) -> Vec<Solved> {
    let base = CircleOptions::default();
    let ways = [
        ("1e-9", base.clone()),
        ("1e-2", CircleOptions { epsilon: 1e-2, ..base.clone() }),
        ("1e-13", CircleOptions { epsilon: 1e-13, max_cells: 5000, ..base.clone() }),
        ("one cell", CircleOptions { max_cells: 1, ..base }),
    ];
    ways.into_iter()
        .map(|(way, options)| {
            let found = input.with(|source| inscribed_circle(source, &options));
            (way.to_owned(), found.ok().map(|found| document(&found)))
        })
        .collect()
}
