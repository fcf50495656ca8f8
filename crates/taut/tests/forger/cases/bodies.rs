//! Convex bodies in triangle meshes.

use taut::inscribe::{DopsOptions, inscribed_dops};

use super::{Case, Input, Solved, cases, document};

/// Returns the cases of convex bodies in meshes.
pub fn all() -> Vec<Case> {
    cases(meshes(), solve)
}

/// Returns small closed meshes, some of them far from 0, large, small, or with corners that are not on the grid.
fn meshes() -> Vec<Input> {
    let octahedron = || {
        let end = |k: usize, sign: f64| {
            let mut p = [0.0; 3];
            p[k] = sign;
            p
        };
        let mut rows = vec![];
        for x in [1.0, -1.0] {
            for y in [1.0, -1.0] {
                for z in [1.0, -1.0] {
                    rows.extend([end(0, x), end(1, y), end(2, z)].concat());
                }
            }
        }
        rows
    };
    let cuboid = |low: [f64; 3], high: [f64; 3]| {
        let at = |bits: usize| [0, 1, 2].map(|c| if bits >> c & 1 == 1 { high[c] } else { low[c] });
        let sides =
            [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
        let halves = sides.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
        halves.flatten().flat_map(at).collect::<Vec<f64>>()
    };
    let moved = |values: Vec<f64>, factor: f64, shift: f64| -> Vec<f64> {
        values.into_iter().map(|x| x * factor + shift).collect()
    };
    let corners = [[0.0, 0.0, 0.0], [4.1, 0.3, 0.0], [0.2, 3.7, 0.1], [0.9, 1.1, 2.9]];
    let tetrahedron = [[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let tetrahedron = tetrahedron.into_iter().flatten().flat_map(|k: usize| corners[k]).collect();
    let nested = [cuboid([0.0; 3], [8.0; 3]), cuboid([2.0, 2.0, 3.0], [6.0, 5.0, 6.0])].concat();
    let two = [cuboid([0.0; 3], [1.0; 3]), cuboid([3.0, 0.5, 0.5], [4.0, 2.0, 1.5])].concat();
    let found = [
        ("a tetrahedron", tetrahedron),
        ("a cube", cuboid([0.0; 3], [1.0; 3])),
        ("a flat box", cuboid([-1.0, 0.0, 0.0], [5.3, 4.1, 1e-3])),
        ("an octahedron", octahedron()),
        ("an octahedron far away", moved(octahedron(), 0.1, 1e6)),
        ("an octahedron of 1e-70", moved(octahedron(), 1e-70, 0.0)),
        ("an octahedron of 1e80", moved(octahedron(), 1e80, 0.0)),
        ("a cube with a cavity", nested),
        ("two boxes", two),
    ];
    found.into_iter().map(|(name, values)| Input::new(name, values, 9)).collect()
}

fn solve(input: &Input) -> Vec<Solved> {
    let base = DopsOptions { events: 400, ..DopsOptions::default() };
    let ways = [
        ("6", DopsOptions { directions: 6, ..base.clone() }),
        ("14", DopsOptions { directions: 14, ..base.clone() }),
        ("18, two disjoint", DopsOptions { count: 2, disjoint: true, ..base.clone() }),
        ("26, two", DopsOptions { directions: 26, count: 2, ..base }),
    ];
    ways.into_iter()
        .map(|(way, options)| {
            let found = input.with(|source| inscribed_dops(source, &options));
            (way.to_owned(), found.ok().map(|found| document(&found)))
        })
        .collect()
}
