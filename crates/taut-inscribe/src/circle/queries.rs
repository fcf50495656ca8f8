//! Edges near a point or in a cell, and the side of a point, by the boxes around runs of edges.
//!
//! A point is moved by (δ, δ²) for an infinitely small δ > 0, so that it lies on no edge. It is inside if the line to its left
//! crosses an odd number of edges. A run to the left of the point needs only its ends for that: each vertex between two of its
//! edges is an end of both.

use taut_predicates::plane::orient;

use super::ROUNDING;
use super::distance::Edges;
use crate::runs::{Run, overlap, square_distance};
use crate::simple::meets_cell;

impl Edges<'_> {
    /// The edge nearest to a scaled point and its distance, both up to rounding; `hint` is an edge that may be near.
    pub(super) fn nearest(&self, p: [f64; 2], hint: u32) -> (u32, f64) {
        let square = |edge: u32| self.square_distance(p, edge);
        let in_box = |bounds: &_| square_distance(bounds, p);
        let (edge, square) = self.scaled_runs.least((hint, square(hint)), &in_box, &square);
        (edge, square.sqrt())
    }

    /// The edge with the least weighted sum of distances from four scaled points, and these distances.
    ///
    /// Weights are at least 0 and sum to 1. `distance` gives distances of the four points from an edge.
    pub(super) fn least_sum(
        &self,
        points: &[[f64; 2]; 4],
        weights: [f64; 4],
        hint: u32,
        distances: &impl Fn(u32) -> [f64; 4],
    ) -> (u32, [f64; 4]) {
        let sum = |edge: u32| {
            let of_edge = distances(edge);
            (0..4).map(|j| weights[j] * of_edge[j]).sum::<f64>()
        };
        let in_box = |bounds: &_| {
            let least = |j: usize| weights[j] * square_distance(bounds, points[j]).sqrt();
            (0..4).map(least).sum::<f64>() - ROUNDING
        };
        let (edge, _) = self.scaled_runs.least((hint, sum(hint)), &in_box, &sum);
        (edge, distances(edge))
    }

    /// Lists the edges up to a distance from a scaled point, ascending; returns false when there are more than `most`.
    ///
    /// Distances are computed up to rounding.
    pub(super) fn within(
        &self,
        p: [f64; 2],
        distance: f64,
        most: usize,
        list: &mut Vec<u32>,
    ) -> bool {
        list.clear();
        let square = distance * distance;
        self.scaled_runs.visit(&|bounds| square_distance(bounds, p) <= square, &mut |edges| {
            let edges = edges.map(|edge| edge as u32);
            list.extend(edges.filter(|&edge| self.square_distance(p, edge) <= square));
            list.len() <= most
        })
    }

    /// Tests whether an edge meets a closed cell.
    pub(super) fn meet(&self, low: [f64; 2], high: [f64; 2]) -> bool {
        let cell = [low, high];
        let meets = |edge: usize| meets_cell(self.exact[edge], low, high);
        !self.runs.visit(&|bounds| overlap(bounds, &cell), &mut |mut edges| !edges.any(meets))
    }

    /// Tests whether the moved p is inside.
    pub(super) fn is_inside(&self, p: [f64; 2]) -> bool {
        self.is_odd(self.runs.whole(), p)
    }

    /// Tests whether an odd number of edges of a run cross the line to the left of the moved p.
    fn is_odd(&self, run: Run, p: [f64; 2]) -> bool {
        let [low, high] = self.runs.bounds(run);
        if low[0] > p[0] || low[1] > p[1] || high[1] <= p[1] {
            return false;
        }
        let edges = self.runs.edges(run);
        if high[0] < p[0] {
            let is_low = |vertex: [f64; 2]| vertex[1] <= p[1];
            let (first, last) = (edges.start, edges.end - 1);
            // From the first vertex to the start of its ring and from the start of the last ring to the last vertex; whole
            // rings are crossed an even number of times.
            let ends = is_low(self.exact[first][0]) != is_low(self.exact[last][1]);
            let starts = is_low(self.ring_start(first)) != is_low(self.ring_start(last));
            return ends != starts;
        }
        let mut is_odd = false;
        let mut is_lowest = true;
        for child in self.runs.children(run) {
            is_lowest = false;
            is_odd ^= self.is_odd(child, p);
        }
        if is_lowest {
            is_odd = edges.filter(|&edge| is_left(self.exact[edge], p)).count() % 2 == 1;
        }
        is_odd
    }

    /// The vertex at which the ring of an edge starts.
    fn ring_start(&self, edge: usize) -> [f64; 2] {
        let ring = self.ring_starts.partition_point(|&start| start as usize <= edge);
        self.exact[self.ring_starts[ring - 1] as usize][0]
    }
}

/// Tests whether an edge crosses the horizontal line through the moved p, to the left of it.
fn is_left([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> bool {
    if (a[1] <= p[1]) == (b[1] <= p[1]) {
        return false;
    }
    let (low, high) = if a[1] <= p[1] { (a, b) } else { (b, a) };
    !orient(low, high, p).is_positive()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Loops;
    use crate::random::Random;
    use crate::runs::Runs;

    #[test]
    fn points_on_edges_and_vertices_have_a_side() {
        let loops = Loops::of_ring(&[[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]);
        let runs = Runs::of(&loops.segments);
        let edges = Edges::of(&loops.segments, &runs);
        for (p, expected) in [
            ([-1.0, -1.0], false),
            ([0.0, 0.0], true),
            ([0.25, 0.5], true),
            ([0.75, 0.75], false),
            ([-0.75, -0.75], false),
            // On the ring a point is moved to the right.
            ([-0.5, -0.5], true),
            ([-0.5, 0.5], true),
            ([0.5, 0.5], false),
            ([-1.0, 0.0], true),
            ([1.0, 0.0], false),
        ] {
            assert_eq!(edges.is_inside(p), expected, "{p:?}");
        }
    }

    #[test]
    fn queries_agree_with_all_edges() {
        // Squares on a grid, so that runs have edges of several rings, and a jagged one around them.
        let mut loops = Loops::default();
        for i in 0..40 {
            let (x, y) = (f64::from(i % 8), f64::from(i / 8));
            loops.push(&[[x, y], [x + 0.5, y], [x + 0.5, y + 0.5], [x, y + 0.5]]);
        }
        let rim = |i: i32| {
            let (sine, cosine) = (std::f64::consts::TAU * f64::from(i) / 90.0).sin_cos();
            let radius = 8.0 + f64::from(i % 2);
            [4.0 + radius * cosine, 3.0 + radius * sine]
        };
        loops.push(&(0..90).map(rim).collect::<Vec<_>>());
        let runs = Runs::of(&loops.segments);
        let edges = Edges::of(&loops.segments, &runs);
        let mut random = Random::new(5);
        let (mut inside, mut list) = (0, vec![]);
        for round in 0..2000 {
            // Half of the points have coordinates of vertices.
            let grain = if round % 2 == 0 { 0.5 } else { 1e-3 };
            let place = |share: f64| ((26.0 * share - 9.0) / grain).round() * grain;
            let p = [place(random.unit()), place(random.unit())];
            let count = loops.segments.iter().filter(|&&edge| is_left(edge, p)).count();
            assert_eq!(edges.is_inside(p), count % 2 == 1, "{p:?}");
            inside += count % 2;
            let scaled = edges.scaled(p);
            let all: Vec<f64> = (0..edges.len()).map(|e| edges.distance(scaled, e)).collect();
            let least = all.iter().copied().fold(f64::INFINITY, f64::min);
            let (edge, distance) = edges.nearest(scaled, round % edges.len());
            assert!(distance == least && all[edge as usize] == least, "{p:?}");
            assert!(edges.within(scaled, 1.5 * least, usize::MAX, &mut list));
            let near = (0..edges.len()).filter(|&edge| all[edge as usize] <= 1.5 * least);
            assert_eq!(list, near.collect::<Vec<_>>(), "{p:?}");
            let high = [p[0] + 0.3, p[1] + 0.2];
            let meets = loops.segments.iter().any(|&edge| meets_cell(edge, p, high));
            assert_eq!(edges.meet(p, high), meets, "{p:?}");
        }
        assert!((200..1800).contains(&inside), "{inside}");
    }
}
