//! Whether a point is inside by votes of the vertices nearest to it, as in section 8.5.6.5 of the thesis.
//!
//! *Idea.* The normal of a vertex is the mean normal of its triangles, by their area. A vertex votes for inside if its normal points
//! away from the point. The nearest vertices come from a tree that splits at medians.

use std::collections::BTreeMap;

use super::super::vectors::{cross, dot, minus, plus};

/// A vertex, and the sum of the normals of its triangles, each as long as twice its area.
#[derive(Clone, Copy)]
struct Vertex {
    place: [f64; 3],
    normal: [f64; 3],
}

/// Vertices in the order of a tree: the middle of each range splits it along one axis.
pub(super) struct Votes {
    vertices: Vec<Vertex>,
    /// How many vertices vote.
    count: usize,
}

impl Votes {
    pub(super) fn of(triangles: &[[[i32; 3]; 3]], count: usize) -> Self {
        let mut normals: BTreeMap<[i32; 3], [f64; 3]> = BTreeMap::new();
        let mut volume = 0.0;
        // Rows that are points have no normal, and no vote.
        for corners in triangles.iter().filter(|[a, b, c]| a != b || b != c) {
            let [a, b, c] = corners.map(|corner| corner.map(f64::from));
            let normal = cross(minus(b, a), minus(c, a));
            volume += dot(a, normal);
            for corner in corners {
                let sum = normals.entry(*corner).or_default();
                *sum = plus(*sum, 1.0, normal);
            }
        }
        let outward = if volume < 0.0 { -1.0 } else { 1.0 };
        let vertex = |(place, normal): ([i32; 3], [f64; 3])| Vertex {
            place: place.map(f64::from),
            normal: normal.map(|x| outward * x),
        };
        let mut vertices: Vec<Vertex> = normals.into_iter().map(vertex).collect();
        split(&mut vertices, 0);
        Votes { vertices, count }
    }

    /// Whether most of the vertices nearest to a point vote for inside, and the distance of the nearest.
    pub(super) fn of_point(&self, point: [i32; 3]) -> (bool, f64) {
        let point = point.map(f64::from);
        let mut nearest: Vec<(f64, &Vertex)> = Vec::with_capacity(self.count + 1);
        self.search(&self.vertices, 0, point, &mut nearest);
        let inside = nearest.iter().filter(|(_, v)| dot(minus(v.place, point), v.normal) > 0.0);
        let is_inside = 2 * inside.count() > nearest.len();
        (is_inside, nearest.first().map_or(0.0, |(square, _)| square.sqrt()))
    }

    /// Puts the vertices of a range that are nearest into a list, by their squared distance.
    fn search<'a>(
        &self,
        range: &'a [Vertex],
        axis: usize,
        point: [f64; 3],
        nearest: &mut Vec<(f64, &'a Vertex)>,
    ) {
        let Some(middle) = range.get(range.len() / 2) else { return };
        let (lower, upper) = (&range[..range.len() / 2], &range[range.len() / 2 + 1..]);
        let off = point[axis] - middle.place[axis];
        let [near, far] = if off < 0.0 { [lower, upper] } else { [upper, lower] };
        self.search(near, (axis + 1) % 3, point, nearest);
        let apart = minus(middle.place, point);
        let square = dot(apart, apart);
        let place = nearest.partition_point(|(other, _)| *other <= square);
        nearest.insert(place, (square, middle));
        nearest.truncate(self.count);
        if nearest.len() < self.count || nearest.last().is_some_and(|last| off * off <= last.0) {
            self.search(far, (axis + 1) % 3, point, nearest);
        }
    }
}

/// Brings vertices into the order of the tree.
fn split(vertices: &mut [Vertex], axis: usize) {
    if vertices.len() > 1 {
        let middle = vertices.len() / 2;
        let order = |v: &Vertex| [0, 1, 2].map(|c| v.place[(axis + c) % 3]);
        vertices.select_nth_unstable_by(middle, |p, q| {
            order(p).partial_cmp(&order(q)).unwrap_or(std::cmp::Ordering::Equal)
        });
        split(&mut vertices[..middle], (axis + 1) % 3);
        split(&mut vertices[middle + 1..], (axis + 1) % 3);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    #[test]
    fn the_nearest_vertices_are_those_of_brute_force() {
        let mut random = Random::new(7);
        let mut corner = || [0; 3].map(|_: i32| random.below(40) as i32);
        let triangles: Vec<[[i32; 3]; 3]> =
            (0..60).map(|_| [0; 3].map(|_: i32| corner())).collect();
        let votes = Votes::of(&triangles, 4);
        for _ in 0..300 {
            let point = corner();
            let square = |q: &[i32; 3]| (0..3).map(|c| (q[c] - point[c]).pow(2)).sum::<i32>();
            let expected = triangles.as_flattened().iter().map(square).min().unwrap();
            let (_, distance) = votes.of_point(point);
            assert_eq!(distance, f64::from(expected).sqrt());
            let mut nearest = vec![];
            votes.search(&votes.vertices, 0, point.map(f64::from), &mut nearest);
            let found: Vec<f64> = nearest.iter().map(|(square, _)| *square).collect();
            let mut all: Vec<f64> = votes
                .vertices
                .iter()
                .map(|v| minus(v.place, point.map(f64::from)))
                .map(|off| dot(off, off))
                .collect();
            all.sort_by(f64::total_cmp);
            assert_eq!(found, all[..4]);
        }
    }

    #[test]
    fn votes_tell_inside_from_outside_however_all_triangles_are_turned() {
        let (x, y) = ([[9, 0, 0], [-9, 0, 0]], [[0, 9, 0], [0, -9, 0]]);
        let mut octahedron = vec![];
        for (a, sign) in [(x[0], true), (x[1], false)] {
            for (b, other) in [(y[0], true), (y[1], false)] {
                for (c, last) in [([0, 0, 9], true), ([0, 0, -9], false)] {
                    let is_even = sign ^ other ^ last;
                    octahedron.push(if is_even { [a, b, c] } else { [b, a, c] });
                }
            }
        }
        let turned: Vec<_> = octahedron.iter().map(|&[a, b, c]| [b, a, c]).collect();
        for mesh in [octahedron, turned] {
            let votes = Votes::of(&mesh, 1);
            assert!(votes.of_point([0; 3]).0 && votes.of_point([2, 1, 0]).0);
            assert!(!votes.of_point([12, 0, 1]).0 && !votes.of_point([0, -20, 3]).0);
            // Pointed shapes mislead votes, as the thesis says: this point is outside.
            assert!(votes.of_point([-7, -7, -7]).0);
        }
    }
}
