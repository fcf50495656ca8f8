//! A row of vertices along a dense part of a curve: whether circles of the size that is sought are empty, for all of them at once.
//!
//! *Idea.* Where all edges around the row run in directions within α of one, so do tangents and chords between their points: for a point
//! of them w away from a vertex, |n·w| ≤ |w| sin 2α, and |w| is at least cos α times the way along the curve. A circle of radius r that
//! touches at the vertex has |w|² ≤ 2r|n·w| for what is in it: no end of an edge is from the way 4r sin α on. An edge g long that is at
//! least 2g off loses g²/4 against its ends, a fifteenth of |w|² for α ≤ 0.3. So edges off by more than 4.3r sin α need no look: on dense
//! samples nearly all of them. Other strands are sought once for the row.
//! *Guarantee.* What is told here is what the search would find.

use std::ops::Range;

use super::features::{SMOOTH_WAY_RATIO, Touching};
use super::nearest::Segments;

/// How much more of the curve is its own than circles are wide: a curve that turns is not quite as far off as it is long.
const WIDTH_FACTOR: f64 = 1.125;
/// The largest sine of α.
const SINE_MOST: f64 = 0.29;
/// Edges need no look from this way on, over r sin α.
const CLEAR_WAY_RATIO: f64 = 4.3;

/// A row with nothing near but its own curve, which is nearly straight there.
pub(super) struct Row<'a> {
    edges: &'a [[[f64; 2]; 2]],
    way: &'a [f64],
    sight: &'a [f64],
    /// Sine of α.
    sine: f64,
}

impl<'a> Row<'a> {
    /// None where another strand is within reach, or the curve turns too much, or is too short.
    pub(super) fn of(
        segments: &'a Segments,
        curve: usize,
        way: &'a [f64],
        sight: &'a [f64],
        row: Range<usize>,
    ) -> Option<Self> {
        let of_curve = segments.of_curve(curve);
        let edges = &segments.ends[of_curve.clone()];
        let n = edges.len();
        let reach = 2.0 * row.clone().map(|v| sight[v]).fold(0.0, f64::max);
        let at = |k: usize| way[k % n] + (k / n) as f64 * way[n];
        // The row is at n and on, and has edges first..last around it.
        let (mut first, mut last) = (n + row.start, n + row.end - 1);
        let (from, to) = (at(first), at(last));
        while last - first < n && from - at(first) < WIDTH_FACTOR * reach {
            first -= 1;
        }
        while last - first < n && at(last) - to < WIDTH_FACTOR * reach {
            last += 1;
        }
        if last - first >= n {
            return None;
        }
        let sine = spread(edges, first..last)?;
        let center = edges[(row.start + row.end - 1) / 2][0];
        let from_center = |[p, _]: &[[f64; 2]; 2]| (p[0] - center[0]).hypot(p[1] - center[1]);
        let radius = reach + edges[row].iter().map(from_center).fold(0.0, f64::max);
        let is_own = |range: &Range<usize>| {
            of_curve.start <= range.start && range.end <= of_curve.end && {
                let on = (range.start - of_curve.start + 2 * n - first) % n;
                on + range.len() <= last - first
            }
        };
        match segments.meets(center, radius, is_own) {
            true => None,
            false => Some(Self { edges, way, sight, sine }),
        }
    }

    /// R, no more than the sight, and the turn at a vertex of the row.
    pub(super) fn radius_and_turn(&self, vertex: usize) -> [f64; 2] {
        let n = self.edges.len();
        let [before, after] = [(vertex + n - 1) % n, vertex].map(|edge| self.edges[edge]);
        let v = after[0];
        let Some((touching, turn)) = Touching::at_vertex(before[0], v, after[1]) else {
            return [0.0, 0.0];
        };
        let through = |p: [f64; 2]| touching.radius(p[0] - v[0], p[1] - v[1]);
        let mut radius = self.sight[vertex].min(through(before[0])).min(through(after[1]));
        let clear = CLEAR_WAY_RATIO * self.sine * radius;
        let mut see = |edge: usize, off: f64| {
            let ends = &self.edges[edge];
            radius = match off < SMOOTH_WAY_RATIO * (self.way[edge + 1] - self.way[edge]) {
                true => radius.min(through(ends[0])).min(through(ends[1])),
                false => radius.min(touching.along(ends)),
            };
        };
        let gap = |edge: usize| self.way[edge + 1] - self.way[edge];
        let (mut edge, mut off) = (vertex, gap(vertex));
        while off < clear {
            edge = (edge + 1) % n;
            see(edge, off);
            off += gap(edge);
        }
        let mut edge = (vertex + n - 1) % n;
        let mut off = gap(edge);
        while off < clear {
            edge = (edge + n - 1) % n;
            see(edge, off);
            off += gap(edge);
        }
        [radius, turn]
    }
}

/// The sine of α, the most that the direction of an edge, counted on around the curve, is off that of the chord of all of them.
fn spread(edges: &[[[f64; 2]; 2]], around: Range<usize>) -> Option<f64> {
    let edge = |k: usize| edges[k % edges.len()];
    let [from, to] = [edge(around.start)[0], edge(around.end - 1)[1]];
    let (ux, uy) = (to[0] - from[0], to[1] - from[1]);
    let mut square = 0.0f64;
    for [a, b] in around.map(edge) {
        let (x, y) = (b[0] - a[0], b[1] - a[1]);
        let (along, across) = (x * ux + y * uy, x * uy - y * ux);
        // tan²; NaN of an edge that is too short to have a direction is not small.
        let slope = (across / along) * (across / along);
        if !(along > 0.0 && slope <= SINE_MOST * SINE_MOST) {
            return None;
        }
        square = square.max(slope);
    }
    Some(square.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::evidence::features::Features;
    use taut_certify::CurveComponent;
    use taut_points::Monitor;

    /// Radii by rows are those by search: uneven gaps on a circle, an ellipse with another strand near it, corners.
    #[test]
    fn rows_find_what_the_search_finds() {
        let ring = |n: usize, wide: f64, high: f64| -> CurveComponent {
            let uneven = |k: usize| k as f64 + 0.45 * (k as f64 * 2.4).sin();
            let at = |k: usize| (uneven(k) * std::f64::consts::TAU / n as f64).sin_cos();
            let vertices: Vec<[f64; 2]> =
                (0..n).map(|k| [wide * at(k).1, high * at(k).0]).collect();
            CurveComponent { rows: (0..n as u64).collect(), vertices, closed: true }
        };
        let sets = [
            vec![ring(20_000, 1.0, 1.0)],
            vec![ring(20_000, 1.0, 0.01), ring(5000, 1.01, 0.0105)],
            vec![ring(300, 1.0, 0.3)],
            vec![ring(24, 1.0, 1.0)],
        ];
        for (set, curves) in sets.iter().enumerate() {
            let segments = Segments::of(curves);
            for curve in 0..curves.len() {
                let by_rows = Features::of(&segments, curve, 0.0, true, &Monitor::silent());
                let by_search = Features::searched(&segments, curve, &Monitor::silent());
                let (rows, search) = (by_rows.unwrap(), by_search.unwrap());
                assert_eq!(rows.turn, search.turn, "set {set}, curve {curve}");
                for (k, (a, b)) in rows.phi.iter().zip(&search.phi).enumerate() {
                    assert!(
                        (a / b - 1.0).abs() <= 1.0 / 32.0,
                        "set {set}, curve {curve}, {k}: {a} {b}"
                    );
                }
            }
        }
    }
}
