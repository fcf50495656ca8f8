//! Any bytes as rings or as a mesh, with one of the shapes looked for inside, and each answer judged by the checker.

use std::collections::BTreeSet;

use taut_certify::{Answer, Solution};
use taut_inscribe::{
    BodiesOptions, BodyShape, CircleOptions, ConvexOptions, EllipseOptions, Error,
    OrientedRectangleOptions, RectangleOptions, Scene, TriangleOptions, inscribed_bodies,
    inscribed_circle, inscribed_ellipse, inscribed_oriented_rectangle, inscribed_polygon,
    inscribed_rectangle, inscribed_triangle,
};
use taut_points::Points;

/// Most vertices of a ring, and most triangles: small inputs are the degenerate ones, and fast.
const VERTICES_MAX: usize = 24;
const TRIANGLES_MAX: usize = 48;

/// Cells of a search, at most: an answer with a large gap is judged as one with a small one.
const CELLS_MAX: u64 = 300;

/// Returns what a byte means as a coordinate: mostly small whole numbers, so that edges touch and lie on common lines; and the ends of
/// what a double holds.
fn coordinate(byte: u8, style: u8) -> f64 {
    let small = f64::from(byte % 8);
    match style % 16 {
        0..=7 => small,
        // A finer grid.
        8..=11 => f64::from(byte),
        // Ties that are no whole numbers, and almost ties.
        12 => small * 0.1,
        13 => small + f64::from(byte / 64) * f64::EPSILON,
        14 => 2f64.powi(i32::from(byte) * 8 - 1024),
        _ => [0.0, -0.0, 5e-324, 1e-300, 1.0, 1e150, -1e300, f64::MAX][usize::from(byte % 8)],
    }
}

/// Returns the byte that says how large all coordinates are: mostly as they are.
fn scale(byte: u8) -> f64 {
    let exponent = if byte < 192 { 0 } else { (i32::from(byte) - 224) * 32 };
    2f64.powi(exponent)
}

/// Looks for the shape that the bytes choose in the rings that they mean, and has it checked. Returns whether there was an answer.
///
/// # Panics
/// If the checker rejects an answer.
pub(crate) fn rings(bytes: &[u8]) -> bool {
    let [style, order, size, shape, rest @ ..] = bytes else { return false };
    let scale = scale(*size);
    let coordinate = |byte: u8| coordinate(byte, *style) * scale;
    let mut ring: Vec<[f64; 2]> = rest
        .as_chunks::<2>()
        .0
        .iter()
        .take(VERTICES_MAX)
        .map(|pair| pair.map(coordinate))
        .collect();
    match order % 4 {
        0 => {}
        1 => around_middle(&mut ring),
        _ => uncrossed(&mut ring),
    }
    let (mut values, mut dim) = (ring.as_flattened().to_vec(), 2);
    if order & 8 != 0 {
        // The second half of the vertices is a ring of its own.
        let of = |k: usize| f64::from(u8::from(k >= ring.len() / 2));
        let numbered = ring.iter().enumerate().flat_map(|(k, p)| [p[0], p[1], of(k)]);
        (values, dim) = (numbered.collect(), 3);
    }
    let Ok(points) = Points::new(&values, dim) else { return false };
    let epsilon = if order & 16 == 0 { 0.1 } else { 1e-9 };
    let max_cells = CELLS_MAX;
    match shape % 6 {
        0 => {
            let options = CircleOptions { epsilon, max_cells, ..Default::default() };
            judge(inscribed_circle(&points, &options), &points)
        }
        1 => {
            let options = TriangleOptions { epsilon, max_cells, ..Default::default() };
            judge(inscribed_triangle(&points, &options), &points)
        }
        2 => {
            let options = EllipseOptions { epsilon, max_cells, ..Default::default() };
            judge(inscribed_ellipse(&points, &options), &points)
        }
        3 => {
            let options = RectangleOptions { epsilon, max_cells, ..Default::default() };
            judge(inscribed_rectangle(&points, &options), &points)
        }
        4 => {
            let options = OrientedRectangleOptions { epsilon, max_cells, ..Default::default() };
            judge(inscribed_oriented_rectangle(&points, &options), &points)
        }
        _ => {
            let options = ConvexOptions { rounds: 2, starts: 2, ..Default::default() };
            judge(inscribed_polygon(&points, &options), &points)
        }
    }
}

/// Looks for bodies in the mesh that the bytes mean, and has them checked. Returns whether there was an answer.
///
/// # Panics
/// If the checker rejects an answer.
pub(crate) fn mesh(bytes: &[u8]) -> bool {
    let [style, build, size, shape, seed, rest @ ..] = bytes else { return false };
    let scale = scale(*size);
    let corners: Vec<[f64; 3]> = rest
        .as_chunks::<3>()
        .0
        .iter()
        .map(|place| place.map(|byte| coordinate(byte, *style) * scale))
        .collect();
    let mut triangles: Vec<[[f64; 3]; 3]> = match build % 4 {
        0 => corners.as_chunks::<3>().0.to_vec(),
        _ => tetrahedra(&corners),
    };
    triangles.truncate(TRIANGLES_MAX);
    if build & 4 != 0 {
        // A hole.
        triangles.pop();
    }
    if shape & 8 != 0 {
        // Points among the triangles, one of them a corner.
        triangles.extend(corners.iter().rev().take(5).map(|&point| [point; 3]));
    }
    let rows = triangles.as_flattened().as_flattened();
    let (values, dim) = if shape & 64 != 0 {
        // The triangles of a half of the corners as a mesh, and those of the others as an obstacle.
        let (mesh, obstacle) = rows.split_at(rows.len() / 18 * 9);
        let Ok(mut scene) = Scene::around(mesh) else { return false };
        let is_added = scene.add_surface(obstacle);
        is_added.expect("rows of nine numbers");
        scene.add_points(&corners[..corners.len().min(2)]);
        (scene.into_rows(), 10)
    } else {
        (rows.to_vec(), 9)
    };
    let Ok(points) = Points::new(&values, dim) else { return false };
    let directions: Vec<[i64; 3]> = rest
        .as_chunks::<3>()
        .0
        .iter()
        .take(3 + usize::from(*seed % 11))
        .map(|place| place.map(|byte| i64::from(byte % 32) - 11))
        .collect();
    let ends = corners.last().copied();
    let is_segment = shape & 16 != 0;
    let shape = match shape % 8 {
        _ if shape & 32 != 0 => BodyShape::Directions(&directions),
        0..=1 => BodyShape::Dop(6),
        2..=3 => BodyShape::Dop(14),
        4 => BodyShape::Dop(18),
        5 => BodyShape::Dop(26),
        6 => BodyShape::Free(12),
        _ => BodyShape::Free(40),
    };
    let middle = corners
        .iter()
        .take(4)
        .fold([0.0; 3], |sum: [f64; 3], p| [0, 1, 2].map(|c| sum[c] + 0.25 * p[c]));
    let at = [middle];
    // Most of the way to a corner.
    let ends = ends.map(|end| [0, 1, 2].map(|c| 0.3 * middle[c] + 0.7 * end[c]));
    let options = BodiesOptions {
        shape,
        count: 1 + usize::from(*seed % 3),
        events: 40 + u64::from(*seed),
        disjoint: build & 8 != 0,
        close_holes: build & 16 != 0,
        at: if build & 32 != 0 { &at } else { &[] },
        ends: if build & 32 != 0 && is_segment { ends.as_slice() } else { &[] },
        seed: u64::from(*seed),
        ..Default::default()
    };
    judge(inscribed_bodies(&points, &options), &points)
}

fn judge<A: Answer>(found: Result<Solution<A>, Error>, points: &Points<'_, f64>) -> bool {
    let Ok(found) = found else { return false };
    if let Err(violation) = found.check(points) {
        panic!("{violation}: {points:?}");
    }
    true
}

/// Sorts vertices around their mean: a ring that is mostly simple.
fn around_middle(ring: &mut [[f64; 2]]) {
    let count = ring.len() as f64;
    let mean = [0, 1].map(|c| ring.iter().map(|p| p[c] / count).sum::<f64>());
    let turn = |p: &[f64; 2]| (p[1] - mean[1]).atan2(p[0] - mean[0]);
    ring.sort_by(|p, q| turn(p).total_cmp(&turn(q)));
}

/// Turns runs of the ring around as long as two edges cross; coinciding and touching edges stay.
fn uncrossed(ring: &mut [[f64; 2]]) {
    let count = ring.len();
    let side = |a: [f64; 2], b: [f64; 2], p: [f64; 2]| {
        ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])).signum()
    };
    for _ in 0..4 * count {
        let crossing =
            (0..count).flat_map(|i| (i + 2..count).map(move |j| (i, j))).find(|&(i, j)| {
                let [a, b, p, q] = [ring[i], ring[i + 1], ring[j], ring[(j + 1) % count]];
                side(a, b, p) * side(a, b, q) < 0.0 && side(p, q, a) * side(p, q, b) < 0.0
            });
        let Some((i, j)) = crossing else { break };
        ring[i + 1..=j].reverse();
    }
}

/// The triangles that an odd number of tetrahedra of four corners each have: closed, whatever the corners.
fn tetrahedra(corners: &[[f64; 3]]) -> Vec<[[f64; 3]; 3]> {
    let mut odd: BTreeSet<[[u64; 3]; 3]> = BTreeSet::new();
    for four in corners.as_chunks::<4>().0.iter().take(TRIANGLES_MAX / 4) {
        for left_out in 0..4 {
            let face = [1, 2, 3].map(|step| four[(left_out + step) % 4]);
            let mut face = face.map(|corner| corner.map(f64::to_bits));
            face.sort_unstable();
            if !odd.remove(&face) {
                odd.insert(face);
            }
        }
    }
    odd.into_iter().map(|face| face.map(|corner| corner.map(f64::from_bits))).collect()
}
