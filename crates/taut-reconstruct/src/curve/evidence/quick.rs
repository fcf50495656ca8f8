//! A row of vertices along a dense part of a curve: whether circles of the size that is sought are empty, for all of them at once.
//!
//! *Idea.* The two circles of radius r that touch at v have centres c with |w − c|² − r² = |w|² − 2r|n·w| for the nearer one. If
//! the ends of edges of length g are all above g²/4, no edge meets a circle: what is left of a chord's ends is at most half of it. That is
//! a loop over the vertices near the row, in their order, without a search. Other strands are sought once for the row: where there is none
//! within reach, as nearly always, the sight is the radius.
//! *Guarantee.* What is told here is what the search would find.

use std::ops::Range;

use super::features::{SMOOTH, Touching};
use super::nearest::Segments;

/// How much more of the curve is its own than circles are wide.
const TURNING: f64 = 1.125;

/// Vertices on either side that are looked at one by one.
const BESIDE: usize = 6;

/// The neighbours that a row looks at, and the row.
pub(super) struct Row<'a> {
    edges: &'a [[[f64; 2]; 2]],
    sight: &'a [f64],
    /// The number of the first vertex of `near`, from n on.
    first: usize,
    /// Vertices along the curve, the row in the middle: coordinates apart, as several are taken at once.
    x: Vec<f64>,
    y: Vec<f64>,
    /// A quarter of the squared length of the longer edge beside each.
    quarter: Vec<f64>,
    way: Vec<f64>,
}

impl<'a> Row<'a> {
    /// None where another strand is within reach, or the curve is too short.
    pub(super) fn of(
        segments: &'a Segments,
        curve: usize,
        way: &[f64],
        sight: &'a [f64],
        row: Range<usize>,
    ) -> Option<Self> {
        let of_curve = segments.of_curve(curve);
        let edges = &segments.ends[of_curve.clone()];
        let n = edges.len();
        let reach = 2.0 * row.clone().map(|v| sight[v]).fold(0.0, f64::max);
        // A curve that turns is not quite as far off as it is long.
        let wide = TURNING * reach;
        let at = |k: usize| way[k % n] + (k / n) as f64 * way[n];
        let (mut first, mut last) = (n + row.start, n + row.end - 1);
        let (from, to) = (at(first), at(last));
        while from - at(first) < wide {
            first -= 1;
            if last - first >= n {
                return None;
            }
        }
        while at(last) - to < wide {
            last += 1;
            if last - first >= n {
                return None;
            }
        }
        let center = edges[(row.start + row.end - 1) / 2][0];
        let from_center = |[p, _]: &[[f64; 2]; 2]| (p[0] - center[0]).hypot(p[1] - center[1]);
        let radius = reach + edges[row].iter().map(from_center).fold(0.0, f64::max);
        // Edges first..last are looked at below.
        let is_own = |range: &Range<usize>| {
            of_curve.start <= range.start && range.end <= of_curve.end && {
                let on = (range.start - of_curve.start + 2 * n - first) % n;
                on + range.len() <= last - first
            }
        };
        if segments.meets(center, radius, is_own) {
            return None;
        }
        let square = |k: usize| {
            let [a, b] = edges[k % n];
            let (x, y) = (b[0] - a[0], b[1] - a[1]);
            x * x + y * y
        };
        let squares: Vec<f64> = (first + n - 1..=last + n).map(square).collect();
        let of = |coordinate: usize| (first..=last).map(|k| edges[k % n][0][coordinate]).collect();
        Some(Self {
            edges,
            sight,
            first,
            x: of(0),
            y: of(1),
            quarter: squares.windows(2).map(|two| two[0].max(two[1]) / 4.0).collect(),
            way: (first..=last).map(at).collect(),
        })
    }

    /// R, no more than the sight, and the turn at a vertex of the row.
    pub(super) fn radius_and_turn(&self, vertex: usize) -> [f64; 2] {
        let here = self.edges.len() + vertex - self.first;
        let at = |k: usize| [self.x[k], self.y[k]];
        let [a, v, b] = [here - 1, here, here + 1].map(at);
        let Some((touching, turn)) = Touching::at_vertex(a, v, b) else {
            return [0.0, 0.0];
        };
        let mut radius = self.sight[vertex];
        let from_v = |p: [f64; 2]| [p[0] - v[0], p[1] - v[1]];
        for [x, y] in [from_v(a), from_v(b)] {
            radius = radius.min(touching.radius(x, y));
        }
        let [nx, ny] = touching.normal.map(|n| 2.0 * radius * n);
        let power = |x: f64, y: f64| {
            let (x, y) = (x - v[0], y - v[1]);
            x * x + y * y - (nx * x + ny * y).abs()
        };
        // No jump out of the loop, so that several are done at once.
        let is_clear = |part: Range<usize>| {
            let (x, y, quarter) =
                (&self.x[part.clone()], &self.y[part.clone()], &self.quarter[part]);
            let bad = x.iter().zip(y).zip(quarter).map(|((&x, &y), &q)| u64::from(power(x, y) < q));
            bad.sum::<u64>() == 0
        };
        // Next to the vertex, short edges beside long ones are looked at one by one; elsewhere only where something is not clear.
        let (first, end) = (here.saturating_sub(BESIDE), self.x.len().min(here + 1 + BESIDE));
        let edges = match is_clear(0..first) && is_clear(end..self.x.len()) {
            true => first..end - 1,
            false => 0..self.x.len() - 1,
        };
        for k in edges.filter(|&k| k != here && k + 1 != here) {
            let ends = [at(k), at(k + 1)];
            if (0..2).all(|end| power(ends[end][0], ends[end][1]) >= self.quarter[k + end]) {
                continue;
            }
            let way = |k: usize| self.way[k];
            let off = if k > here { way(k) - way(here) } else { way(here) - way(k + 1) };
            radius = match off < SMOOTH * (way(k + 1) - way(k)) {
                true => {
                    let radii = ends.map(from_v).map(|[x, y]| touching.radius(x, y));
                    radius.min(radii[0]).min(radii[1])
                }
                false => radius.min(touching.along(&ends)),
            };
        }
        [radius, turn]
    }
}
