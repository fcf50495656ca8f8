//! Triangles that close the holes of a mesh.
//!
//! *Idea.* The edges that belong to an odd number of triangles form closed loops: at each vertex their number is even. A loop is
//! a polygon of space, and of all its triangulations one has the least area (Barequet and Sharir, Filling gaps in the boundary of
//! a polyhedron, CAGD 12, 1995), found in O(m³) for m edges. Ears are cut from longer loops first.
//! *Guarantee.* The mesh with its caps is closed, and a loop of m edges has m − 2 caps.
//! *Trap.* A cap closes a hole, but says nothing about what the hole was: [`solid_angle`] tells how much of the view from a
//! point caps fill.

use std::collections::{BTreeMap, BTreeSet};

use taut_points::Monitor;

use super::vectors::{cross, dot, minus};
use crate::Error;

/// Edges of a loop that is triangulated with the least area, at most: the time grows with the cube, and is about 0.1 s for these.
const LEAST_AREA_EDGES_MAX: usize = 300;

/// Returns triangles of the vertices of edges such that each edge, and no other, belongs to an odd number of the triangles.
pub(super) fn caps(
    edges: &[[u32; 2]],
    place: &dyn Fn(u32) -> [f64; 3],
    monitor: &Monitor<'_>,
) -> Result<Vec<[u32; 3]>, Error> {
    let mut caps = vec![];
    for mut hole in loops(edges) {
        monitor.check()?;
        cut_ears(&mut hole, place, &mut caps);
        triangulate(&hole, place, &mut caps);
    }
    Ok(caps)
}

/// The edges as closed walks without repeated vertices. At each vertex the number of edges is even.
fn loops(edges: &[[u32; 2]]) -> Vec<Vec<u32>> {
    let mut next: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for &[a, b] in edges {
        next.entry(a).or_default().insert(b);
        next.entry(b).or_default().insert(a);
    }
    let mut found = vec![];
    let mut path: Vec<u32> = vec![];
    let mut position: BTreeMap<u32, usize> = BTreeMap::new();
    while let Some((&start, _)) = next.first_key_value() {
        let at = path.last().copied().unwrap_or(start);
        if path.is_empty() {
            path.push(at);
            position.insert(at, 0);
        }
        let Some(to) = next.get(&at).and_then(|ends| ends.first().copied()) else {
            // The walk is back at its start, from which no edge is left.
            path.clear();
            position.clear();
            continue;
        };
        for [from, to] in [[at, to], [to, at]] {
            if let Some(ends) = next.get_mut(&from) {
                ends.remove(&to);
                if ends.is_empty() {
                    next.remove(&from);
                }
            }
        }
        match position.get(&to) {
            Some(&first) => {
                found.push(path[first..].to_vec());
                for vertex in path.drain(first + 1..) {
                    position.remove(&vertex);
                }
            }
            None => {
                position.insert(to, path.len());
                path.push(to);
            }
        }
    }
    found
}

/// Cuts ears from a long loop, always the one with the shortest diagonal.
fn cut_ears(hole: &mut Vec<u32>, place: &dyn Fn(u32) -> [f64; 3], caps: &mut Vec<[u32; 3]>) {
    while hole.len() > LEAST_AREA_EDGES_MAX {
        let m = hole.len();
        let diagonal = |k: usize| {
            let across = minus(place(hole[(k + 1) % m]), place(hole[(k + m - 1) % m]));
            dot(across, across)
        };
        let ear = (0..m).map(|k| (diagonal(k), k)).min_by(|a, b| a.0.total_cmp(&b.0));
        let ear = ear.map_or(0, |(_, k)| k);
        caps.push([hole[(ear + m - 1) % m], hole[ear], hole[(ear + 1) % m]]);
        hole.remove(ear);
    }
}

/// Appends the triangulation of a loop with the least area.
fn triangulate(hole: &[u32], place: &dyn Fn(u32) -> [f64; 3], caps: &mut Vec<[u32; 3]>) {
    let m = hole.len();
    let places: Vec<[f64; 3]> = hole.iter().map(|&vertex| place(vertex)).collect();
    // For i < k < j the least area of the polygon i, …, j, and the third corner of the triangle at its side from i to j.
    let mut least = vec![0.0; m * m];
    let mut third = vec![0usize; m * m];
    for length in 2..m {
        for i in 0..m - length {
            let j = i + length;
            let (mut best, mut corner) = (f64::INFINITY, i + 1);
            for k in i + 1..j {
                let across = cross(minus(places[k], places[i]), minus(places[j], places[i]));
                let area = least[i * m + k] + least[k * m + j] + dot(across, across).sqrt();
                if area < best {
                    (best, corner) = (area, k);
                }
            }
            (least[i * m + j], third[i * m + j]) = (best, corner);
        }
    }
    let mut parts = vec![(0, m - 1)];
    while let Some((i, j)) = parts.pop() {
        if j >= i + 2 {
            let k = third[i * m + j];
            caps.push([hole[i], hole[k], hole[j]]);
            parts.extend([(i, k), (k, j)]);
        }
    }
}

/// The solid angle that a triangle fills, seen from a point (Van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30, 1983).
pub(super) fn solid_angle(triangle: &[[i32; 3]; 3], p: [i32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|q| [0, 1, 2].map(|k| f64::from(q[k]) - f64::from(p[k])));
    let [x, y, z] = [a, b, c].map(|q| dot(q, q).sqrt());
    let below = x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y;
    2.0 * dot(a, cross(b, c)).abs().atan2(below)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn odd(caps: &[[u32; 3]]) -> BTreeSet<[u32; 2]> {
        let mut odd = BTreeSet::new();
        for &[a, b, c] in caps {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                let edge = [from.min(to), from.max(to)];
                if !odd.remove(&edge) {
                    odd.insert(edge);
                }
            }
        }
        odd
    }

    #[test]
    fn loops_that_touch_are_closed_each() {
        // Two triangles and a square that share vertex 0, and a triangle apart.
        let walks: [&[u32]; 4] = [&[0, 1, 2], &[0, 3, 4], &[0, 5, 6, 7], &[8, 9, 10]];
        let edges: Vec<[u32; 2]> = walks
            .iter()
            .flat_map(|walk| (0..walk.len()).map(|k| [walk[k], walk[(k + 1) % walk.len()]]))
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        let place = |k: u32| [f64::from(k), f64::from(k * k % 7), f64::from(k * k % 5)];
        let found = caps(&edges, &place, &Monitor::silent()).unwrap();
        assert_eq!(odd(&found), edges.iter().copied().collect());
        assert_eq!(found.len(), 1 + 1 + 2 + 1);
    }

    #[test]
    fn a_plane_star_is_triangulated_without_overlap() {
        // A star of many points in the plane: the least area is that of the star itself.
        for m in [10u32, 24, 500] {
            let place = |k: u32| {
                let turn = std::f64::consts::TAU * f64::from(k) / f64::from(m);
                let radius = if k.is_multiple_of(2) { 1.0 } else { 0.4 };
                [radius * turn.cos(), radius * turn.sin(), 0.25]
            };
            let edges: Vec<[u32; 2]> =
                (0..m).map(|k| [k.min((k + 1) % m), k.max((k + 1) % m)]).collect();
            let found = caps(&edges, &place, &Monitor::silent()).unwrap();
            assert_eq!(odd(&found), edges.into_iter().collect());
            assert_eq!(found.len(), m as usize - 2);
            let area = |[a, b, c]: [u32; 3]| {
                let across = cross(minus(place(b), place(a)), minus(place(c), place(a)));
                dot(across, across).sqrt() / 2.0
            };
            let sum: f64 = found.into_iter().map(area).sum();
            let expected = f64::from(m) / 2.0 * 0.4 * (std::f64::consts::TAU / f64::from(m)).sin();
            // Ears of the shortest diagonals may lie outside of a long star.
            let is_least = m as usize <= LEAST_AREA_EDGES_MAX;
            assert!(!is_least || (sum - expected).abs() < 1e-9, "{m}: {sum}, not {expected}");
        }
    }

    #[test]
    fn the_sides_of_a_tetrahedron_fill_the_view_from_inside() {
        let corners = [[0, 0, 0], [90, 0, 0], [0, 80, 0], [0, 0, 70]];
        let faces = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]];
        let sum = |p: [i32; 3]| -> f64 {
            faces.iter().map(|face| solid_angle(&face.map(|k: usize| corners[k]), p)).sum()
        };
        assert!((sum([10, 20, 9]) - 4.0 * std::f64::consts::PI).abs() < 1e-9);
        assert!(sum([300, 200, 100]) < 0.5);
        // In the plane of a face this face fills half of the view, or nothing.
        assert!(
            (solid_angle(&faces[0].map(|k: usize| corners[k]), [10, 10, 0])
                - 2.0 * std::f64::consts::PI)
                .abs()
                < 1e-9
        );
    }
}
