//! Which share of the inside of a mesh bodies cover: judged without the library, by points that no search has seen.

use rand::rngs::StdRng;
use rand::{RngExt as _, SeedableRng as _};
use taut_certify::InscribedBodies;

use super::*;

/// Points inside, about.
pub(super) const POINTS: usize = 1 << 20;
/// Lines along z, in as many cells along x and along y.
const CELLS: usize = 256;

/// Points on random lines along z, at equal distances, where the winding number is not 0.
pub(super) fn points(mesh: &Mesh) -> Vec<[f64; 3]> {
    let corners = mesh.as_flattened();
    let bound = |c: usize, pick: fn(f64, f64) -> f64, from: f64| {
        corners.iter().map(|p| p[c]).fold(from, pick)
    };
    let low = [0, 1].map(|c| bound(c, f64::min, f64::INFINITY));
    let side = [0, 1].map(|c| (bound(c, f64::max, f64::NEG_INFINITY) - low[c]) / CELLS as f64);
    let mut cells: Vec<Vec<u32>> = vec![vec![]; CELLS * CELLS];
    for (t, triangle) in (0..).zip(mesh) {
        let range = |c: usize| {
            let at = triangle.map(|p| ((p[c] - low[c]) / side[c]).clamp(0.0, (CELLS - 1) as f64));
            let ends = [f64::min, f64::max].map(|pick| at.into_iter().fold(at[0], pick) as usize);
            ends[0]..=ends[1]
        };
        for i in range(0) {
            range(1).for_each(|j| cells[i * CELLS + j].push(t));
        }
    }
    let mut random = StdRng::seed_from_u64(SEED);
    let mut inside: Vec<([f64; 2], [f64; 2])> = vec![];
    for (cell, triangles) in cells.iter().enumerate() {
        let at = [cell / CELLS, cell % CELLS];
        let line = [0, 1].map(|c| low[c] + side[c] * (at[c] as f64 + random.random::<f64>()));
        let crossings = triangles.iter().filter_map(|&t| crossing(&mesh[t as usize], line));
        let mut crossings: Vec<(f64, i32)> = crossings.collect();
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut winding = 0;
        for pair in crossings.windows(2) {
            winding += pair[0].1;
            if winding != 0 {
                inside.push((line, [pair[0].0, pair[1].0]));
            }
        }
    }
    let length: f64 = inside.iter().map(|(_, [from, to])| to - from).sum();
    let distance = length / POINTS as f64;
    let mut points = vec![];
    for ([x, y], [from, to]) in inside {
        // A start of its own for each part, so that short ones have their share, and no two are in step.
        let mut z = from + distance * random.random::<f64>();
        while z < to {
            points.push([x, y, z]);
            z += distance;
        }
    }
    points
}

/// Where a line along z meets a triangle, and the sign of the turn of its corners there.
fn crossing(triangle: &[[f64; 3]; 3], [x, y]: [f64; 2]) -> Option<(f64, i32)> {
    let area = |k: usize| {
        let [p, q] = [triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
        (p[0] - x) * (q[1] - y) - (p[1] - y) * (q[0] - x)
    };
    let parts = [0, 1, 2].map(area);
    let whole: f64 = parts.iter().sum();
    let is_met = parts.iter().all(|&part| part > 0.0) || parts.iter().all(|&part| part < 0.0);
    let z = || (0..3).map(|k| parts[k] / whole * triangle[k][2]).sum();
    is_met.then(|| (z(), if whole > 0.0 { 1 } else { -1 }))
}

/// The share of points in at least one body.
pub(super) fn share(points: &[[f64; 3]], answer: &InscribedBodies) -> f64 {
    let bodies: Vec<_> = answer.bodies.iter().map(|body| answer.half_spaces(body)).collect();
    let is_in = |p: &[f64; 3], body: &[([f64; 3], f64)]| {
        body.iter().all(|(a, b)| (0..3).map(|c| a[c] * p[c]).sum::<f64>() <= *b)
    };
    let covered = points.iter().filter(|p| bodies.iter().any(|body| is_in(p, body)));
    covered.count() as f64 / points.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The triangles of a box.
    fn cuboid([x, y, z]: [f64; 3]) -> Mesh {
        let corner = |i: usize| [(i & 1) as f64 * x, (i >> 1 & 1) as f64 * y, (i >> 2) as f64 * z];
        let faces =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
        triangles.map(|ids| ids.map(corner)).collect()
    }

    #[test]
    fn a_box_is_covered_whole_and_in_part() {
        let mesh = cuboid([1.0, 0.5, 0.25]);
        let points = points(&mesh);
        assert!(points.len().abs_diff(POINTS) < POINTS / 100, "{}", points.len());
        let answer = |normals: Vec<[i64; 3]>, offsets: Vec<i64>| InscribedBodies {
            exponent: -2,
            origin: [0; 3],
            disjoint: false,
            caps: vec![],
            at: vec![],
            ends: vec![],
            bodies: vec![taut_certify::ConvexBody { normals, offsets, volume: 0.0 }],
        };
        assert_eq!(share(&points, &answer(vec![[1, 0, 0]], vec![4])), 1.0);
        // Between two of the cells, across all lines, and along them.
        for (normal, offset, part) in
            [([17, 0, 0], 23, 23.0 / 68.0), ([0, 1, 0], 1, 0.5), ([0, 0, 10], 3, 0.3)]
        {
            let found = share(&points, &answer(vec![normal], vec![offset]));
            assert!((found - part).abs() < 2e-3, "{found} {part}");
        }
    }
}
