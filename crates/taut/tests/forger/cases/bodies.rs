//! Convex bodies in triangle meshes.

use taut::inscribe::{BodiesOptions, BodyShape, Scene, inscribed_bodies, point_rows};

use super::{Case, Input, Solved, cases, document};
use crate::test_length::long_or;

/// Returns the cases of convex bodies in meshes.
pub fn all() -> Vec<Case> {
    cases(meshes(), solve)
}

/// Three directions that are no axes.
const SKEW: [[i64; 3]; 3] = [[1, 2, 0], [-2, 1, 0], [1, 0, 5]];

/// Returns small meshes, one among points, two of them with a hole, some of them far from 0, large, small, or with corners that are not on the grid.
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
    let points = [[0.5, 0.25, 0.75], [0.1, 0.8, 0.2], [2.0, 3.0, -1.0]];
    let among_points = [cuboid([0.0; 3], [1.0; 3]), point_rows(&points)].concat();
    // Without its last triangle, and without two that share an edge.
    let open_octahedron = octahedron()[..63].to_vec();
    let open_cube = cuboid([0.0; 3], [1.0; 3])[18..].to_vec();
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
        ("an octahedron with a hole", open_octahedron),
        ("a cube with a hole", open_cube),
        ("a cube with points in it and beside it", among_points),
    ];
    let mut among = Scene::around(&cuboid([0.0; 3], [4.0; 3])).expect("rows of triangles");
    among.add_points(&[[3.5, 1.0, 2.0]]);
    // A solid in the mesh, one that leaves it, and a wall.
    let leaving = cuboid([3.0; 3], [6.0; 3]);
    for surface in [&cuboid([1.0; 3], [2.0; 3])[..], &leaving[..], &octahedron()[..9]] {
        among.add_surface(surface).expect("rows of triangles");
    }
    let scene = Input::new("a cube with obstacles", among.into_rows(), 10);
    found.into_iter().map(|(name, values)| Input::new(name, values, 9)).chain([scene]).collect()
}

fn solve(input: &Input) -> Vec<Solved> {
    let base = BodiesOptions { events: 400, close_holes: true, ..BodiesOptions::default() };
    let dop = |directions| BodiesOptions { shape: BodyShape::Dop(directions), ..base.clone() };
    // A point in a third of the way from the first corner of the mesh to the mean of all corners.
    let rows = input.values.chunks_exact(input.columns);
    let corners: Vec<[f64; 3]> = rows.flat_map(|row| row.as_chunks::<3>().0).copied().collect();
    let mean = |c: usize| corners.iter().map(|p| p[c] / corners.len() as f64).sum::<f64>();
    let at = [[0, 1, 2].map(|c| corners[0][c] + (mean(c) - corners[0][c]) / 3.0)];
    let ends = [[0, 1, 2].map(|c| at[0][c] + (mean(c) - at[0][c]) / 5.0)];
    let ways = [
        ("6", dop(6)),
        ("14", dop(14)),
        ("18, two disjoint", BodiesOptions { count: 2, disjoint: true, ..dop(18) }),
        ("26, two", BodiesOptions { count: 2, ..dop(26) }),
        ("free, two disjoint", BodiesOptions { count: 2, disjoint: true, ..base.clone() }),
        ("free, around a point", BodiesOptions { count: 2, at: &at, ..base.clone() }),
        ("free, around a segment", BodiesOptions { at: &at, ends: &ends, ..base.clone() }),
        ("6 facets askew", BodiesOptions { shape: BodyShape::Directions(&SKEW), ..base.clone() }),
        ("9 facets", BodiesOptions { shape: BodyShape::Free(9), ..base.clone() }),
        (
            "12 facets, around a point",
            BodiesOptions { shape: BodyShape::Free(12), at: &at, ..base },
        ),
    ];
    ways.into_iter()
        .step_by(long_or(1, 2))
        .map(|(way, options)| {
            let found = input.with(|source| inscribed_bodies(source, &options));
            (way.to_owned(), found.ok().map(|found| document(&found)))
        })
        .collect()
}
