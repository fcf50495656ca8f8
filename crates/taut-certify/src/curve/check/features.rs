//! φ: how near the curve comes to itself and to others, beside the way it takes, and how sharply it turns.
//!
//! *Tangents.* At a vertex v, that of the circle through v and two points of the curve, the first vertices at least s before and after v.
//! Where vertices are rows, s = 0 and they are the neighbors. Else s is a few times the band: below that, the curve is known no
//! better than the noise let it be.
//! *Radius.* R(v) is the least radius of a circle that is tangent to the curve at v, on either side, and passes through another
//! point q of any curve: |q − v|²/2(|n·(q − v)| − τ), over the two points and all edges but those between them. τ, a part of the
//! band, forgives offsets that noise explains, of points up to 4s along the curve; else it is 0. On its inner side a closed curve
//! of length L leaves no room for more than L/2π, by the isoperimetric inequality.
//! *Sight.* Where vertices are rows, R(v) is looked for up to σ(v) only, and counts as that much where it is larger: the largest,
//! over all gaps between rows of the curve, of nine times the gap less the way to it. No ε below 1/16 is told then.
//! *Speed.* Runs of vertices that are dense beside what else is near need no search: [`super::run`].
//! *φ.* The largest function below R that changes by no more than the length of the way along a curve.

use std::f64::consts::TAU;

use taut_points::parallel::IntoParallel;
use taut_points::{Cancelled, Monitor};

use super::edges::Edges;
use super::run;
use super::tangent::{Tangent, dot, minus};
use crate::arithmetic::U;

/// s over the band.
const SPAN_RATIO: f64 = 3.0;

/// τ over the band.
const FORGIVEN_OFFSET_RATIO: f64 = 0.25;

/// Offsets are forgiven as far along the curve, over s. Strands that are farther along are others, and none is forgiven
/// its being near.
const FORGIVEN_WAY_RATIO: f64 = 4.0;

/// An edge of the same curve counts with all its points from this many of its lengths on along the curve, else with its ends: next to a
/// vertex a chord would seem to come near, however gently the curve turns.
const SMOOTH_WAY_RATIO: f64 = 2.0;

/// σ over a gap at v.
const SIGHT_RATIO: f64 = 9.0;

/// Vertices of one task.
const VERTICES_PER_TASK: usize = 1 << 10;

/// Vertices of one run, of which it is asked together whether anything else is near.
const VERTICES_PER_RUN: usize = 1 << 5;

/// What is known at the vertices of a closed curve.
pub(super) struct Features {
    /// The way along the curve to each vertex; one more entry at the end.
    pub(super) along: Vec<f64>,
    /// φ at each vertex.
    pub(super) size: Vec<f64>,
    /// The vertex where the curve turns most, and by how much, in radians.
    pub(super) corner: (usize, f64),
}

/// Of a closed curve, all in scaled units. `is_exact` says that its vertices are rows.
pub(super) fn features(
    edges: &Edges,
    curve: usize,
    band: f64,
    is_exact: bool,
    monitor: &Monitor<'_>,
) -> Result<Features, Cancelled> {
    found(edges, curve, band, [is_exact; 2], monitor)
}

/// The same; runs of vertices are taken together `by_runs` only.
fn found(
    edges: &Edges,
    curve: usize,
    band: f64,
    [is_exact, by_runs]: [bool; 2],
    monitor: &Monitor<'_>,
) -> Result<Features, Cancelled> {
    let points = &edges.points[edges.first_vertex[curve]..edges.first_vertex[curve + 1]];
    let count = points.len();
    let mut along = vec![0.0];
    for k in 0..count {
        let [x, y] = minus(points[(k + 1) % count], points[k]);
        along.push(along[k] + (x * x + y * y).sqrt());
    }
    let most = match is_exact {
        true => sight(&along),
        false => vec![along[count] / TAU; count],
    };
    let course = Course { edges, base: edges.first_edge[curve], points, along: &along, band };
    let of_task = |task: usize| -> Result<Vec<(f64, f64)>, Cancelled> {
        monitor.check()?;
        let end = count.min((task + 1) * VERTICES_PER_TASK);
        let mut found = Vec::with_capacity(VERTICES_PER_TASK);
        for first in (task * VERTICES_PER_TASK..end).step_by(VERTICES_PER_RUN) {
            let vertices = first..end.min(first + VERTICES_PER_RUN);
            let clear =
                if by_runs { run::clear_way(&course, &most, vertices.clone()) } else { None };
            found.extend(vertices.map(|v| course.radius_and_turn(v, most[v], clear)));
        }
        Ok(found)
    };
    let tasks = (0..count.div_ceil(VERTICES_PER_TASK)).into_par_iter();
    let found: Vec<Vec<(f64, f64)>> = tasks.map(of_task).collect::<Result<_, _>>()?;
    let (mut size, mut corner) = (Vec::with_capacity(count), (0, 0.0));
    for (v, (radius, turn)) in found.into_iter().flatten().enumerate() {
        size.push(radius);
        if turn > corner.1 {
            corner = (v, turn);
        }
    }
    around(&along, |from, to, gap| size[to] = size[to].min(size[from] + gap));
    Ok(Features { along, size, corner })
}

/// Calls `pass` for all pairs of neighbors and their gap, twice around in either direction.
fn around(along: &[f64], mut pass: impl FnMut(usize, usize, f64)) {
    let count = along.len() - 1;
    for k in (0..2 * count).map(|k| k % count) {
        pass(k, (k + 1) % count, along[k + 1] - along[k]);
    }
    for k in (0..2 * count).rev().map(|k| k % count) {
        pass((k + 1) % count, k, along[k + 1] - along[k]);
    }
}

/// σ at each vertex; no more than the radius of a circle as long as the curve.
fn sight(along: &[f64]) -> Vec<f64> {
    let most = along[along.len() - 1] / TAU;
    let mut sight = vec![0.0f64; along.len() - 1];
    around(along, |from, to, gap| {
        let here = (SIGHT_RATIO * gap).min(most);
        sight[from] = sight[from].max(here);
        sight[to] = sight[to].max(here).max(sight[from] - gap);
    });
    sight
}

/// The first number of a range for which something holds that holds for all after it too; the end if there is none.
fn first(range: std::ops::Range<usize>, holds: impl Fn(usize) -> bool) -> usize {
    // Where vertices are rows it is the first.
    if holds(range.start) {
        return range.start;
    }
    let (mut least, mut end) = (range.start, range.end);
    while least < end {
        let middle = least + (end - least) / 2;
        if holds(middle) { end = middle } else { least = middle + 1 }
    }
    least
}

/// A closed curve and the way along it.
pub(super) struct Course<'a> {
    pub(super) edges: &'a Edges,
    /// Its first edge.
    pub(super) base: usize,
    pub(super) points: &'a [[f64; 2]],
    along: &'a [f64],
    band: f64,
}

impl Course<'_> {
    /// The way to the k-th vertex, counted on around the curve.
    pub(super) fn way(&self, k: usize) -> f64 {
        let count = self.points.len();
        self.along[k % count] + (k / count) as f64 * self.along[count]
    }

    /// R, or `most` if that is less, and the turn at a vertex. Only edges up to the way `clear` along the curve, over R, can meet circles if
    /// that is told.
    fn radius_and_turn(&self, vertex: usize, most: f64, clear: Option<f64>) -> (f64, f64) {
        let (count, base, span) = (self.points.len(), self.base, SPAN_RATIO * self.band);
        let here = count + vertex;
        let way = |k: usize| self.way(k);
        let after = |least| first(1..count, |k| way(here + k) - way(here) >= least);
        let before = |least| first(1..count, |k| way(here) - way(here - k) >= least);
        let own = [before(span), after(span)];
        // Nothing is known of a curve that is all within the span.
        if own[0] + own[1] >= count {
            return (0.0, 0.0);
        }
        let near = [before(FORGIVEN_WAY_RATIO * span), after(FORGIVEN_WAY_RATIO * span)];
        let [a, v, b] = [here - own[0], here, here + own[1]].map(|k| self.points[k % count]);
        let (to, from) = (minus(v, a), minus(b, v));
        let turn = (to[0] * from[1] - to[1] * from[0]).atan2(dot(to, from)).abs();
        let (long, short) = (dot(to, to), dot(from, from));
        if long == 0.0 || short == 0.0 {
            return (0.0, 0.0);
        }
        let tangent = [0, 1].map(|k| to[k] / long + from[k] / short);
        let size = dot(tangent, tangent).sqrt();
        let normal = [-tangent[1] / size, tangent[0] / size];
        let rounding = 16.0 * U * (v[0].abs() + v[1].abs());
        let far = Tangent { v, normal, forgiven: rounding };
        let close = Tangent { forgiven: (FORGIVEN_OFFSET_RATIO * self.band).max(rounding), ..far };
        let mut radius = most;
        for end in [a, b] {
            radius = radius.min(close.through(minus(end, v)));
        }
        // Of the edge so many steps on, as many as lead back to its end.
        let back = |on: usize| count - 1 - on;
        let look = |on: usize, radius: f64| {
            let tangent = if on < near[1] || back(on) < near[0] { &close } else { &far };
            let segment = [here + on, here + on + 1].map(|k| self.points[k % count]);
            if tangent.misses(segment, radius) {
                return radius;
            }
            // Of an edge that is long beside its distance, only the ends are points of a smooth curve.
            let off = (way(here + on) - way(here)).min(way(here) - way(here - back(on)));
            match off < SMOOTH_WAY_RATIO * (way(here + on + 1) - way(here + on)) {
                true => segment
                    .map(|end| tangent.through(minus(end, v)))
                    .into_iter()
                    .fold(radius, f64::min),
                false => radius.min(tangent.through_edge(segment)),
            }
        };
        if let Some(clear) = clear {
            for on in own[1]..count {
                if way(here + on) - way(here) >= clear * radius {
                    break;
                }
                radius = look(on, radius);
            }
            for off in own[0]..count {
                if way(here) - way(here - off) >= clear * radius {
                    break;
                }
                radius = look(back(off), radius);
            }
            return (radius, turn);
        }
        self.edges.tree.least(
            &mut radius,
            |area, [start, last]| {
                if start < base || last >= base + count {
                    return far.least(area);
                }
                // All of the box in the part before the vertex, or in that after it.
                let steps = |edge: usize| (edge - base + count - vertex) % count;
                let (on, end) = (steps(start), steps(last));
                let is_in = |part: [usize; 2]| on <= end && (end < part[1] || back(on) < part[0]);
                match (is_in(own), is_in(near)) {
                    (true, _) => f64::INFINITY,
                    (_, true) => close.least(area),
                    _ => far.least(area),
                }
            },
            |edge, radius| {
                if edge < base || base + count <= edge {
                    *radius = radius.min(far.through_edge(self.edges.segment(edge)));
                    return;
                }
                let on = (edge - base + count - vertex) % count;
                if on >= own[1] && back(on) >= own[0] {
                    *radius = look(on, *radius);
                }
            },
        );
        (radius, turn)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::CurveComponent;

    /// Radii by runs are those by search: uneven gaps on a circle, an ellipse with another strand near it, few vertices.
    #[test]
    fn runs_find_what_the_search_finds() {
        let ring = |n: usize, wide: f64, high: f64| -> CurveComponent {
            let uneven = |k: usize| k as f64 + 0.45 * (k as f64 * 2.4).sin();
            let at = |k: usize| (uneven(k) * TAU / n as f64).sin_cos();
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
            let edges = Edges::of(curves, &[]);
            for curve in 0..curves.len() {
                let of = |by_runs| {
                    found(&edges, curve, 0.0, [true, by_runs], &Monitor::silent()).unwrap()
                };
                let (runs, search) = (of(true), of(false));
                assert_eq!(runs.corner, search.corner, "set {set}, curve {curve}");
                for (k, (a, b)) in runs.size.iter().zip(&search.size).enumerate() {
                    let is_same = (a / b - 1.0).abs() <= 1.0 / 32.0;
                    assert!(is_same, "set {set}, curve {curve}, {k}: {a} {b}");
                }
            }
        }
    }
}
