//! φ at the vertices of a closed curve: the least radius of a circle that touches the curve there and meets it, or another, elsewhere,
//! made to change no faster than the way along the curve.
//!
//! The definition is that of the certificate: see `CurveCertificate`. The tangent at a vertex is that of the circle through
//! two vertices at least three bands away along the curve on either side; offsets are forgiven by a quarter of the band.
//! Where vertices are points, φ is sought up to what `sight` says, a few times the gaps: most circles of that size have nothing in
//! them but the vertices beside theirs, which `quick` finds for a row of vertices at once.

use std::f64::consts::TAU;

use rayon::prelude::*;
use taut_points::{Cancelled, Monitor};

use super::nearest::Segments;
use super::quick::Row;
use super::sight::sight;

/// The vertices that give a tangent are at least this far, over the band.
const SPAN_RATIO: f64 = 3.0;
/// Offsets are forgiven by this part of the band.
const FORGIVEN_OFFSET_RATIO: f64 = 0.25;
/// Offsets are forgiven this far along the curve, over the span.
const FORGIVEN_WAY_RATIO: f64 = 4.0;
/// An edge of the same curve counts with its ends alone up to this many of its lengths along the curve.
pub(super) const SMOOTH_WAY_RATIO: f64 = 2.0;
/// R may exceed the least radius by this part of it: on a circle every point gives the same.
const RADIUS_TOLERANCE: f64 = 1.0 / 64.0;
/// Vertices of one task.
const TASK: usize = 1 << 10;
/// This many vertices are looked at together.
const VERTICES_PER_BATCH: usize = 1 << 5;

pub(super) struct Features {
    /// The way to each vertex, and around.
    pub(super) way: Vec<f64>,
    /// φ.
    pub(super) phi: Vec<f64>,
    /// The largest turn, in radians.
    pub(super) turn: f64,
}

impl Features {
    pub(super) fn of(
        segments: &Segments,
        curve: usize,
        band: f64,
        are_points: bool,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Cancelled> {
        Self::found(segments, curve, band, [are_points; 2], monitor)
    }

    /// Of points, without rows.
    #[cfg(test)]
    pub(super) fn searched(
        segments: &Segments,
        curve: usize,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Cancelled> {
        Self::found(segments, curve, 0.0, [true, false], monitor)
    }

    fn found(
        segments: &Segments,
        curve: usize,
        band: f64,
        [are_points, by_rows]: [bool; 2],
        monitor: &Monitor<'_>,
    ) -> Result<Self, Cancelled> {
        let edges = &segments.ends[segments.of_curve(curve)];
        let n = edges.len();
        let mut way = Vec::with_capacity(n + 1);
        way.push(0.0);
        for [a, b] in edges {
            let (x, y) = (b[0] - a[0], b[1] - a[1]);
            way.push(way[way.len() - 1] + (x * x + y * y).sqrt());
        }
        let tangents = Tangents { segments, curve, edges, way: &way, band };
        let sight = if are_points { sight(&way) } else { vec![way[n] / TAU; n] };
        let of_task = |task: usize| -> Result<Vec<[f64; 2]>, Cancelled> {
            monitor.check()?;
            let end = n.min((task + 1) * TASK);
            let mut found = Vec::with_capacity(TASK);
            for first in (task * TASK..end).step_by(VERTICES_PER_BATCH) {
                let row = first..end.min(first + VERTICES_PER_BATCH);
                let quick = if by_rows {
                    Row::of(segments, curve, &way, &sight, row.clone())
                } else {
                    None
                };
                found.extend(row.map(|vertex| match &quick {
                    Some(quick) => quick.radius_and_turn(vertex),
                    None => tangents.radius_and_turn(vertex, sight[vertex]),
                }));
            }
            Ok(found)
        };
        let found: Vec<Vec<[f64; 2]>> =
            (0..n.div_ceil(TASK)).into_par_iter().map(of_task).collect::<Result<_, _>>()?;
        let mut phi: Vec<f64> = found.iter().flatten().map(|of| of[0]).collect();
        let turn = found.iter().flatten().fold(0.0f64, |turn, of| turn.max(of[1]));
        around(&way, |from, to, gap| {
            let is_less = phi[from] + gap < phi[to];
            if is_less {
                phi[to] = phi[from] + gap;
            }
            is_less
        });
        Ok(Self { way, phi, turn })
    }

    /// The length of the curve.
    pub(super) fn length(&self) -> f64 {
        self.way[self.phi.len()]
    }
}

struct Tangents<'a> {
    segments: &'a Segments,
    curve: usize,
    edges: &'a [[[f64; 2]; 2]],
    way: &'a [f64],
    band: f64,
}

impl Tangents<'_> {
    /// R, if it is below `most`, and the turn at a vertex; 0 and 0 where the curve is too short for its band.
    fn radius_and_turn(&self, vertex: usize, most: f64) -> [f64; 2] {
        let (n, span) = (self.edges.len(), SPAN_RATIO * self.band);
        let length = self.way[n];
        let way = |k: usize| self.way[k % n] + (k / n) as f64 * length;
        let here = n + vertex;
        let after_by = |least: f64| steps(n, |k| way(here + k) - way(here) >= least);
        let before_by = |least: f64| steps(n, |k| way(here) - way(here - k) >= least);
        let (before, after) = (before_by(span), after_by(span));
        if before + after >= n {
            return [0.0, 0.0];
        }
        let point = |k: usize| self.edges[k % n][0];
        let (v, ends) = (point(here), [point(here - before), point(here + after)]);
        let Some((far, turn)) = Touching::at_vertex(ends[0], v, ends[1]) else {
            return [0.0, 0.0];
        };
        let near =
            Touching { forgiven: far.forgiven.max(FORGIVEN_OFFSET_RATIO * self.band), ..far };
        let mut radius = most;
        for [x, y] in ends {
            radius = radius.min(near.radius(x - v[0], y - v[1]));
        }
        // Edges between the two vertices are left out. `low` is the first that is near, counted on around the curve.
        let (near_before, near_after) =
            (before_by(FORGIVEN_WAY_RATIO * span), after_by(FORGIVEN_WAY_RATIO * span));
        let (low, reach) = ((here - near_before) % n, near_before + near_after);
        let own = near_before - before..near_before + after;
        let of_curve = self.segments.of_curve(self.curve);
        self.segments.search(
            &mut radius,
            |area, edges| {
                // What forgives more bounds more of what is near, and what is left out needs no look.
                if edges.start < of_curve.start || edges.end > of_curve.end {
                    return far.least(area);
                }
                let on = (edges.start - of_curve.start + n - vertex) % n;
                let is_within = |before: usize, after: usize| {
                    on + edges.len() <= after || on + edges.len() <= n && on + before >= n
                };
                match () {
                    () if is_within(before, after) => f64::INFINITY,
                    () if is_within(near_before, near_after) => near.least(area),
                    () => far.least(area),
                }
            },
            |edge, radius| {
                let mut touching = &far;
                if of_curve.contains(&edge) {
                    // Where `near` goes around more than once, an edge has two numbers.
                    let number = (edge - of_curve.start + n - low) % n;
                    if own.contains(&number) || own.contains(&(number + n)) {
                        return;
                    }
                    touching = if number < reach { &near } else { &far };
                    let on = (edge - of_curve.start + n - vertex) % n;
                    let off = (way(here + on) - way(here)).min(way(here) - way(here + on + 1 - n));
                    if off < SMOOTH_WAY_RATIO * (way(here + on + 1) - way(here + on)) {
                        for [x, y] in self.segments.ends[edge] {
                            *radius = radius.min(touching.radius(x - v[0], y - v[1]));
                        }
                        return;
                    }
                }
                *radius = radius.min(touching.along(&self.segments.ends[edge]));
            },
        );
        [radius, turn]
    }
}

/// Calls `pass` for all pairs of neighbours along a closed curve with their gap, around it in either direction, and on for as long as it
/// says that something changed.
pub(super) fn around(way: &[f64], mut pass: impl FnMut(usize, usize, f64) -> bool) {
    let n = way.len() - 1;
    let next = |k: usize| if k + 1 == n { 0 } else { k + 1 };
    let gap = |k: usize| way[k + 1] - way[k];
    (0..n).for_each(|k| _ = pass(k, next(k), gap(k)));
    (0..n).all(|k| pass(k, next(k), gap(k)));
    (0..n).rev().for_each(|k| _ = pass(next(k), k, gap(k)));
    (0..n).rev().all(|k| pass(next(k), k, gap(k)));
}

/// The least number of steps from 1 on after which something holds; n if it does not before.
fn steps(n: usize, holds: impl Fn(usize) -> bool) -> usize {
    // Mostly a few steps: double, then halve.
    let mut high = 1;
    while high < n && !holds(high) {
        high *= 2;
    }
    let (mut low, mut high) = (high / 2 + 1, high.min(n));
    while low < high {
        let middle = (low + high) / 2;
        if holds(middle) { high = middle } else { low = middle + 1 }
    }
    low.min(n)
}

/// Circles that touch the curve at a vertex.
#[derive(Clone, Copy)]
pub(super) struct Touching {
    at: [f64; 2],
    pub(super) normal: [f64; 2],
    forgiven: f64,
}

impl Touching {
    /// Those that touch the circle through a, v and b at v, and the turn from a by v to b. Roundings are forgiven.
    pub(super) fn at_vertex(a: [f64; 2], v: [f64; 2], b: [f64; 2]) -> Option<(Self, f64)> {
        let [[ax, ay], [bx, by]] = [a, b].map(|end| [end[0] - v[0], end[1] - v[1]]);
        let (aa, bb) = (ax * ax + ay * ay, bx * bx + by * by);
        if aa == 0.0 || bb == 0.0 {
            return None;
        }
        let turn = (ay * bx - ax * by).atan2(-(ax * bx + ay * by)).abs();
        let (tx, ty) = (bx / bb - ax / aa, by / bb - ay / aa);
        let size = (tx * tx + ty * ty).sqrt();
        let forgiven = 8.0 * f64::EPSILON * (v[0].abs() + v[1].abs());
        Some((Self { at: v, normal: [-ty / size, tx / size], forgiven }, turn))
    }

    /// The radius of the one through `at` + (x, y).
    pub(super) fn radius(&self, x: f64, y: f64) -> f64 {
        let offset = (self.normal[0] * x + self.normal[1] * y).abs() - self.forgiven;
        if offset > 0.0 { (x * x + y * y) / (2.0 * offset) } else { f64::INFINITY }
    }

    /// A little more than the least radius that a point of a box may give, for few boxes to be opened.
    fn least(&self, area: &[f64; 4]) -> f64 {
        let from = |low: f64, high: f64, at: f64| (low - at).max(at - high).max(0.0);
        let x = from(area[0], area[2], self.at[0]);
        let y = from(area[1], area[3], self.at[1]);
        let across = |i: usize, low: f64, high: f64| {
            let (a, b) =
                (self.normal[i] * (low - self.at[i]), self.normal[i] * (high - self.at[i]));
            [a.min(b), a.max(b)]
        };
        let (u, w) = (across(0, area[0], area[2]), across(1, area[1], area[3]));
        let offset = (u[1] + w[1]).max(-(u[0] + w[0])) - self.forgiven;
        match offset > 0.0 {
            true => (x * x + y * y) / (2.0 * offset) * (1.0 + RADIUS_TOLERANCE),
            false => f64::INFINITY,
        }
    }

    /// The least radius that a point of an edge gives.
    ///
    /// On either side, (|p|² + 2u·p·e + u²|e|²)/(c + u·d) has its extremes where |e|²d·u² + 2|e|²c·u + 2(p·e)c − |p|²d = 0.
    pub(super) fn along(&self, [a, b]: &[[f64; 2]; 2]) -> f64 {
        let (px, py) = (a[0] - self.at[0], a[1] - self.at[1]);
        let (ex, ey) = (b[0] - a[0], b[1] - a[1]);
        let at = |u: f64| self.radius(px + u * ex, py + u * ey);
        let mut least = at(0.0).min(at(1.0));
        let (pp, pe, ee) = (px * px + py * py, px * ex + py * ey, ex * ex + ey * ey);
        let offset = self.normal[0] * px + self.normal[1] * py;
        let slope = self.normal[0] * ex + self.normal[1] * ey;
        for (c, d) in [(offset - self.forgiven, slope), (-offset - self.forgiven, -slope)] {
            if c <= 0.0 && c + d <= 0.0 {
                continue;
            }
            let half = ee * c;
            let rest = 2.0 * pe * c - pp * d;
            let root = (half * half - ee * d * rest).max(0.0).sqrt();
            let sum = if half < 0.0 { root - half } else { -root - half };
            for u in [sum / (ee * d), rest / sum] {
                if (0.0..1.0).contains(&u) {
                    least = least.min(at(u));
                }
            }
        }
        least
    }
}
