//! Meshes to test with, and what every answer has to satisfy.

use taut_certify::{BodiesVerdict, InscribedBodies, Solution};
use taut_inscribe::{BodiesOptions, BodyShape, Error, inscribed_bodies, triangle_rows};
use taut_points::Points;

/// Triangles by their corners.
pub(crate) type Mesh = Vec<[[f64; 3]; 3]>;

pub(crate) fn points(mesh: &[[[f64; 3]; 3]]) -> Points<'_, f64> {
    Points::new(mesh.as_flattened().as_flattened(), 9).unwrap()
}

pub(crate) fn solve(
    mesh: &[[[f64; 3]; 3]],
    options: &BodiesOptions<'_>,
) -> Result<Solution<InscribedBodies>, Error> {
    inscribed_bodies(&points(mesh), options)
}

/// Bodies that the checker accepts.
pub(crate) fn proved(
    mesh: &[[[f64; 3]; 3]],
    options: &BodiesOptions<'_>,
) -> (Solution<InscribedBodies>, BodiesVerdict) {
    let found = solve(mesh, options).unwrap();
    let verdict = found.check(&points(mesh));
    let verdict = verdict.unwrap_or_else(|error| panic!("{error}: {:?}", found.answer));
    assert_eq!(verdict.bodies, found.answer.bodies.len() as u64);
    (found, verdict)
}

pub(crate) fn options(directions: usize) -> BodiesOptions<'static> {
    BodiesOptions { shape: BodyShape::Dop(directions), events: 3000, ..BodiesOptions::default() }
}

pub(crate) fn free(facets: usize) -> BodiesOptions<'static> {
    BodiesOptions { shape: BodyShape::Free(facets), events: 3000, ..BodiesOptions::default() }
}

/// The faces of the convex hull in some directions as fans of triangles.
pub(crate) fn hull(vertices: &[[f64; 3]], directions: &[[f64; 3]]) -> Mesh {
    let dot = |p: [f64; 3], q: [f64; 3]| p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
    let cross = |p: [f64; 3], q: [f64; 3]| {
        [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
    };
    let mut mesh = vec![];
    for &u in directions {
        let most = vertices.iter().map(|&v| dot(u, v)).fold(f64::NEG_INFINITY, f64::max);
        let mut face: Vec<_> =
            vertices.iter().copied().filter(|&v| dot(u, v) > most - 1e-9).collect();
        let axis = if u[0] == 0.0 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.3] };
        let along = cross(u, axis);
        let across = cross(u, along).map(|x| x / dot(u, u).sqrt());
        let mean = [0, 1, 2].map(|c| face.iter().map(|v| v[c]).sum::<f64>() / face.len() as f64);
        let angle = |v: &[f64; 3]| {
            let off = [v[0] - mean[0], v[1] - mean[1], v[2] - mean[2]];
            dot(off, across).atan2(dot(off, along))
        };
        face.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        mesh.extend((2..face.len()).map(|k| [face[0], face[k - 1], face[k]]));
    }
    mesh
}

/// All vectors with entries −1, 0 and 1 whose squared length is one of these.
pub(crate) fn directions(squares: &[i32]) -> Vec<[f64; 3]> {
    let ends = [-1, 0, 1];
    let all = ends.into_iter().flat_map(|x| ends.map(|y| ends.map(|z| [x, y, z]))).flatten();
    let kept = all.filter(|[x, y, z]| squares.contains(&(x * x + y * y + z * z)));
    kept.map(|u: [i32; 3]| u.map(f64::from)).collect()
}

/// All permutations of (±a, ±b, ±c).
pub(crate) fn permutations([a, b, c]: [f64; 3]) -> Vec<[f64; 3]> {
    let orders = [[a, b, c], [a, c, b], [b, a, c], [b, c, a], [c, a, b], [c, b, a]];
    let signs = (0..8).map(|bits| [0, 1, 2].map(|c| if bits >> c & 1 == 1 { -1.0 } else { 1.0 }));
    let mut all: Vec<[f64; 3]> =
        signs.flat_map(|s| orders.map(|p| [0, 1, 2].map(|c| s[c] * p[c] + 0.0))).collect();
    all.sort_by(|p, q| p.partial_cmp(q).unwrap());
    all.dedup();
    all
}

pub(crate) fn cuboid(low: [f64; 3], high: [f64; 3]) -> Mesh {
    let corner = |bits: usize| [0, 1, 2].map(|c| if bits >> c & 1 == 1 { high[c] } else { low[c] });
    hull(&(0..8).map(corner).collect::<Vec<_>>(), &directions(&[1]))
}

pub(crate) fn octahedron() -> Mesh {
    hull(&permutations([1.0, 0.0, 0.0]), &directions(&[3]))
}

/// The prism over an L of two unit squares and their corner, of height 1: 12 sides, with all corners.
pub(crate) fn l_shape() -> Mesh {
    let ring = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let at = |k: usize, z: f64| [ring[k % 6][0], ring[k % 6][1], z];
    let sides = (0..6).flat_map(|k| {
        [[at(k, 0.0), at(k + 1, 0.0), at(k + 1, 1.0)], [at(k, 0.0), at(k + 1, 1.0), at(k, 1.0)]]
    });
    // The corner (1, 1) sees all others.
    let fan = [4, 5, 0, 1].map(|k| [3, k, k + 1]);
    let caps = [0.0, 1.0].into_iter().flat_map(|z| fan.map(|t| t.map(|k| at(k, z))));
    sides.chain(caps).collect()
}

/// A torus with waves, of 2·m² triangles, with corners rounded to multiples of `grid` where it is given.
pub(crate) fn wavy(m: usize, grid: Option<f64>) -> Mesh {
    let (vertices, triangles) = wavy_parts(m, grid);
    let rows = triangle_rows(&vertices, &triangles).unwrap();
    let corners = rows.as_chunks::<3>().0.as_chunks::<3>().0;
    corners.to_vec()
}

/// Its vertices and triangles.
fn wavy_parts(m: usize, grid: Option<f64>) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let turn = |k: usize| std::f64::consts::TAU * k as f64 / m as f64;
    let place = |i: usize, j: usize| {
        let (s, t) = (turn(i), turn(j));
        let tube = 0.8 + 0.2 * (3.0 * s).sin() * (2.0 * t).cos();
        let radius = 2.0 + tube * t.cos();
        let p = [radius * s.cos(), radius * s.sin(), tube * t.sin()];
        p.map(|x| grid.map_or(x, |unit| (x / unit).round() * unit + 0.0))
    };
    let vertices = (0..m * m).map(|k| place(k / m, k % m)).collect();
    let id = |i: usize, j: usize| ((i % m) * m + j % m) as u32;
    let pair = |k: usize| {
        let (i, j) = (k / m, k % m);
        let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    (vertices, (0..m * m).flat_map(pair).collect())
}
