//! Distances to edges: fast for the search, accurate for what is claimed.

use taut_points::two_to;

use crate::pair::{Pair, cross, minus};
use crate::polygon::Segment;
use crate::runs::Runs;
use crate::units::factors_of;

/// Bound of the errors of cross products in double-double, relative to the differences of coordinates.
const PRODUCT_ERROR: f64 = two_to(-93);

/// Unit roundoff.
const U: f64 = f64::EPSILON / 2.0;

/// The edges of a polygon, with coordinates scaled by a power of two.
pub(super) struct Edges<'a> {
    /// The edges as given.
    pub(super) exact: &'a [Segment],
    /// Boxes around runs of the edges as given.
    pub(super) runs: &'a Runs,
    /// Boxes around runs of the scaled edges.
    pub(super) scaled_runs: Runs,
    /// The first edge of each ring.
    pub(super) ring_starts: Vec<u32>,
    scaled: Vec<Segment>,
    /// Of each edge its vector over its squared length, so that a projection takes no division; 0 where that overflows.
    inverse: Vec<[f64; 2]>,
    /// The product of both is the power of two that brings the largest coordinate to [1, 2).
    factors: [f64; 2],
}

impl<'a> Edges<'a> {
    pub(super) fn of(exact: &'a [Segment], runs: &'a Runs) -> Self {
        let coordinates = exact.iter().flatten().flatten();
        let largest = coordinates.fold(0.0f64, |most, x| most.max(x.abs()));
        let factors = factors_of(largest);
        let scale = |p: [f64; 2]| p.map(|x| x * factors[0] * factors[1]);
        let scaled: Vec<Segment> = exact.iter().map(|edge| edge.map(scale)).collect();
        let inverse = scaled.iter().map(|[a, b]| {
            let e = [b[0] - a[0], b[1] - a[1]];
            let inverse = e.map(|x| x / (e[0] * e[0] + e[1] * e[1]));
            if inverse.iter().all(|x| x.is_finite()) { inverse } else { [0.0; 2] }
        });
        let inverse = inverse.collect();
        // Rings do not touch, so that another one starts where an edge does not start at the end of the one before.
        let is_start = |&edge: &usize| edge == 0 || exact[edge - 1][1] != exact[edge][0];
        let ring_starts = (0..exact.len()).filter(is_start).map(|edge| edge as u32).collect();
        Edges {
            exact,
            runs,
            scaled_runs: runs.mapped(scale),
            ring_starts,
            inverse,
            scaled,
            factors,
        }
    }

    pub(super) fn len(&self) -> u32 {
        self.exact.len() as u32
    }

    /// A point in scaled coordinates.
    pub(super) fn scaled(&self, p: [f64; 2]) -> [f64; 2] {
        p.map(|x| x * self.factors[0] * self.factors[1])
    }

    /// A point in coordinates of the input.
    pub(super) fn unscaled(&self, p: [f64; 2]) -> [f64; 2] {
        p.map(|x| x / self.factors[0] / self.factors[1])
    }

    /// A scaled length in units of the input, not rounded up.
    pub(super) fn unscaled_down(&self, length: f64) -> f64 {
        let unscaled = length / self.factors[0] / self.factors[1];
        let is_above = unscaled * self.factors[0] * self.factors[1] > length;
        if is_above { unscaled.next_down() } else { unscaled }
    }

    /// The distance of p from an edge, off by some units of the last place of p and of the ends.
    #[inline(always)]
    pub(super) fn distance(&self, p: [f64; 2], edge: u32) -> f64 {
        self.square_distance(p, edge).sqrt()
    }

    /// The square of [`distance`](Self::distance).
    #[inline(always)]
    pub(super) fn square_distance(&self, p: [f64; 2], edge: u32) -> f64 {
        let [a, b] = self.scaled[edge as usize];
        let (d, inverse) = ([p[0] - a[0], p[1] - a[1]], self.inverse[edge as usize]);
        let share = (d[0] * inverse[0] + d[1] * inverse[1]).clamp(0.0, 1.0);
        let (x, y) = (d[0] - share * (b[0] - a[0]), d[1] - share * (b[1] - a[1]));
        x * x + y * y
    }

    /// The distance of p from an edge, off by at most 8u of it and 2⁻⁹⁸ times the distance of p from the ends.
    pub(super) fn accurate(&self, p: [f64; 2], edge: u32) -> f64 {
        self.feature(p, edge).1
    }

    /// The unit vector to p from the nearest point of an edge, and the distance, both accurate; no vector for a p on the edge.
    pub(super) fn feature(&self, p: [f64; 2], edge: u32) -> ([f64; 2], f64) {
        let [a, b] = self.scaled[edge as usize];
        let between = |p: [f64; 2], q: [f64; 2]| [minus(p[0], q[0]), minus(p[1], q[1])];
        let (d, e, f) = (between(p, a), between(b, a), between(p, b));
        let length = |v: [Pair; 2]| (v[0].0 * v[0].0 + v[1].0 * v[1].0).sqrt();
        let dot = |v: [Pair; 2]| v[0].0 * e[0].0 + v[1].0 * e[1].0;
        let to_end = |v: [Pair; 2]| ([v[0].0 / length(v), v[1].0 / length(v)], length(v));
        // Where rounding takes an end for the nearest point, the distance changes by the square of a rounding error.
        if dot(d) <= 0.0 || length(e) == 0.0 {
            to_end(d)
        } else if dot(f) >= 0.0 {
            to_end(f)
        } else {
            let distance = cross(d, e) / length(e);
            let along = length(e) * distance.signum();
            ([e[1].0 / along, -e[0].0 / along], distance.abs())
        }
    }

    /// An upper bound of the distance that a checker confirms.
    pub(super) fn rounded_up(&self, p: [f64; 2], edge: u32) -> f64 {
        (self.accurate(p, edge) + self.error(p, edge)) * (1.0 + 16.0 * U)
    }

    /// A lower bound of the distance that a checker confirms.
    pub(super) fn rounded_down(&self, p: [f64; 2], edge: u32) -> f64 {
        (self.accurate(p, edge) - self.error(p, edge)) * (1.0 - 32.0 * U)
    }

    /// Tests whether the polygon is so thin that no radius can be claimed: wherever a point is inside, some edge is nearer to it than
    /// the error of its distance from that edge.
    ///
    /// The width is measured across the line from a vertex to the farthest one, and each part of that line has to lie beside an edge
    /// that is long enough for such an error. A polygon that is thin but has no straight direction is not recognized.
    pub(super) fn are_too_near(&self) -> bool {
        /// Leaves room for the rounding of the width.
        const MARGIN: f64 = 2.0;
        let Some(&[first, _]) = self.scaled.first() else { return false };
        let square = |p: [f64; 2]| (p[0] - first[0]).powi(2) + (p[1] - first[1]).powi(2);
        let vertices = || self.scaled.iter().map(|edge| edge[0]);
        let far = vertices().max_by(|&p, &q| square(p).total_cmp(&square(q))).unwrap_or(first);
        let length = square(far).sqrt();
        let from_first = |p: [f64; 2]| [minus(p[0], first[0]), minus(p[1], first[1])];
        let heights = vertices().map(|p| cross(from_first(p), from_first(far)) / length);
        let (least, most) = heights.fold((0.0, 0.0), |(a, b), h| (h.min(a), h.max(b)));
        let long = MARGIN * (most - least) / PRODUCT_ERROR;
        // Nearly every polygon ends here, far from too thin.
        if long.is_nan() || long > length {
            return false;
        }
        let along = |p: [f64; 2]| {
            ((p[0] - first[0]) * (far[0] - first[0]) + (p[1] - first[1]) * (far[1] - first[1]))
                / length
        };
        let long_edges =
            self.scaled.iter().filter(|[a, b]| (b[0] - a[0]).hypot(b[1] - a[1]) > long);
        let mut shadows: Vec<[f64; 2]> =
            long_edges.map(|&[a, b]| [along(a).min(along(b)), along(a).max(along(b))]).collect();
        shadows.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
        let ends = vertices().map(along).fold([0.0, 0.0], |[a, b], x| [x.min(a), x.max(b)]);
        let reached = shadows.iter().try_fold(ends[0], |reached, &[from, to]| {
            if from > reached { Err(reached) } else { Ok(to.max(reached)) }
        });
        reached.is_ok_and(|reached| reached >= ends[1])
    }

    /// Returns what products of differences may be off by in the checker as well, relative to the length of an edge.
    pub(super) fn error(&self, p: [f64; 2], edge: u32) -> f64 {
        let [a, b] = self.scaled[edge as usize];
        let size = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).abs() + (p[1] - q[1]).abs();
        PRODUCT_ERROR * (size(p, a) + size(b, a))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Loops;

    #[test]
    fn a_needle_keeps_its_width() {
        let width = 2f64.powi(-60);
        let loops = Loops::of_ring(&[[-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]);
        let runs = Runs::of(&loops.segments);
        let edges = Edges::of(&loops.segments, &runs);
        let expected = width * std::f64::consts::SQRT_2;
        assert!((edges.accurate([width, -width], 0) - expected).abs() <= 1e-15 * expected);
    }

    #[test]
    fn a_strip_is_too_thin_beside_long_edges_alone() {
        let of_ring = |ring: &[[f64; 2]]| {
            let loops = Loops::of_ring(ring);
            let runs = Runs::of(&loops.segments);
            Edges::of(&loops.segments, &runs).are_too_near()
        };
        let strip = |from: f64, to: f64, height: f64| {
            [[from, 0.0], [to, 0.0], [to, height], [from, height]]
        };
        assert!(of_ring(&strip(0.0, 1.0, 1e-300)) && of_ring(&strip(0.0, 1.0, 1e-29)));
        assert!(!of_ring(&strip(0.0, 1.0, 1e-27)) && !of_ring(&strip(0.0, 1.0, 1.0)));
        // Far from the origin, errors are those of the differences.
        let end = 1.0 + 2f64.powi(-40);
        assert!(!of_ring(&strip(1.0, end, 2f64.powi(-100))));
        assert!(of_ring(&strip(1.0, end, 2f64.powi(-136))));
        // Along a diagonal, where plain doubles would see no width.
        let rhombus = |w: f64| [[-1.0, -1.0], [w, -w], [1.0, 1.0], [-w, w]];
        assert!(!of_ring(&rhombus(2f64.powi(-60))) && of_ring(&rhombus(2f64.powi(-97))));
        // Between short edges distances have small errors.
        let mut ring = strip(0.0, 1.0, 1e-30).to_vec();
        ring.insert(1, [0.5, 0.0]);
        ring.insert(4, [0.5, 1e-30]);
        assert!(of_ring(&ring));
        ring.splice(1..2, [[0.5, 0.0], [0.5 + 1e-9, 0.0]]);
        ring.splice(5..6, [[0.5 + 1e-9, 1e-30], [0.5, 1e-30]]);
        assert!(!of_ring(&ring));
    }

    #[test]
    fn both_arithmetics_agree() {
        let loops = Loops::of_ring(&[[0.3, 0.1], [1.7, 0.9], [0.2, 1.9]]);
        let runs = Runs::of(&loops.segments);
        let edges = Edges::of(&loops.segments, &runs);
        for i in 0..20 {
            for j in 0..20 {
                let p = [f64::from(i) / 10.0, f64::from(j) / 10.0];
                for edge in 0..3 {
                    let (fast, accurate) = (edges.distance(p, edge), edges.accurate(p, edge));
                    assert!((fast - accurate).abs() <= 1e-14, "{p:?}, edge {edge}");
                }
            }
        }
    }
}
