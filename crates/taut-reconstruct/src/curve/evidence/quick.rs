//! A row of vertices along a dense part of a curve: whether circles of the size that is sought are empty, for all of them at once.
//!
//! *Idea.* The two circles of radius r that touch at v have centres c with |w − c|² − r² = |w|² − 2r|n·w| for the nearer one. If
//! the ends of edges of length g are all above g²/4, no edge meets a circle: what is left of a chord's ends is at most half of it. That is
//! a loop over the vertices near the row, in their order, without a search. Other strands are sought once for the row: where there is none
//! within reach, as nearly always, the sight is the radius.
//! *Guarantee.* What is told here is what the search would find; where it is not clear, nothing is told.

use std::ops::Range;

use super::nearest::Segments;

/// How much more of the curve is its own than circles are wide.
const TURNING: f64 = 1.125;

/// The neighbours that a row looks at, and the row.
pub(super) struct Row<'a> {
    edges: &'a [[[f64; 2]; 2]],
    sight: &'a [f64],
    /// The number of the first vertex of `near`, from n on.
    first: usize,
    /// Vertices along the curve, the row in the middle: x, y, and a quarter of the squared length of the longer edge beside it.
    near: Vec<[f64; 3]>,
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
        let mut before = square(first + n - 1);
        let near = (first..=last).map(|k| {
            let after = square(k);
            let longer = before.max(after);
            before = after;
            let [x, y] = edges[k % n][0];
            [x, y, longer / 4.0]
        });
        Some(Self { edges, sight, first, near: near.collect() })
    }

    /// R and the turn at a vertex of the row, if R is clearly above the sight.
    pub(super) fn radius_and_turn(&self, vertex: usize) -> Option<[f64; 2]> {
        let here = self.edges.len() + vertex - self.first;
        let [a, v, b] = [here - 1, here, here + 1].map(|k| self.near[k]);
        let ([ax, ay], [bx, by]) = ([a[0] - v[0], a[1] - v[1]], [b[0] - v[0], b[1] - v[1]]);
        let (aa, bb) = (ax * ax + ay * ay, bx * bx + by * by);
        let (tx, ty) = (bx / bb - ax / aa, by / bb - ay / aa);
        let size = (tx * tx + ty * ty).sqrt();
        let twice = 2.0 * self.sight[vertex] / size;
        let (nx, ny) = (-ty * twice, tx * twice);
        let is_clear = |p: &[f64; 3]| {
            let (x, y) = (p[0] - v[0], p[1] - v[1]);
            x * x + y * y - (nx * x + ny * y).abs() >= p[2]
        };
        // No jump out of the loop, so that several are done at once. NaN is not clear.
        let all = |part: &[[f64; 3]]| part.iter().fold(true, |all, p| all & is_clear(p));
        let clear = all(&self.near[..here]) && all(&self.near[here + 1..]);
        let turn = (ay * bx - ax * by).atan2(-(ax * bx + ay * by)).abs();
        clear.then_some([self.sight[vertex], turn])
    }
}
