//! φ: how near the curve comes to itself and to others, beside the way it takes, and how sharply it turns.
//!
//! *Tangents.* At a vertex v, that of the circle through v and two points of the curve, the first vertices at least s before and after v.
//! Where vertices are rows, s = 0 and they are the neighbours. Else s is a few times the band: below that, the curve is known no
//! better than the noise let it be.
//! *Radius.* R(v) is the least radius of a circle that is tangent to the curve at v, on either side, and passes through another
//! point q of any curve: |q − v|²/2(|n·(q − v)| − τ), over the two points and all edges but those between them. τ, a
//! part of the band, forgives offsets that noise explains, of points up to 4s along the curve; else it is 0. On its inner side a closed curve of length L leaves no room for more than
//! L/2π, by the isoperimetric inequality.
//! *φ.* The largest function below R that changes by no more than the length of the way along a curve.

use std::f64::consts::TAU;

use rayon::prelude::*;
use taut_points::{Monitor, ReadError};

use super::edges::Edges;
use super::tree::Area;
use crate::arithmetic::U;

/// s over the band.
const SPAN: f64 = 3.0;

/// τ over the band.
const FORGIVEN: f64 = 0.25;

/// Where offsets are forgiven: as far along the curve, over s. Strands that are farther along are others, and none is forgiven its being near.
const NEAR: f64 = 4.0;

/// An edge of the same curve counts with all its points from this many of its lengths on along the curve, else with its ends: next to a
/// vertex a chord would seem to come near, however gently the curve turns.
const SMOOTH: f64 = 2.0;

/// R is told up to this much of it: on a circle all points are as near as each other, and to find the nearest would take all.
const CLOSE: f64 = 1.0 / 64.0;

/// Vertices that a thread takes at once.
const VERTICES: usize = 1 << 10;

/// What is known at the vertices of a closed curve.
pub(super) struct Features {
    /// The way along the curve to each vertex; one more entry at the end.
    pub(super) along: Vec<f64>,
    /// φ at each vertex.
    pub(super) size: Vec<f64>,
    /// The vertex where the curve turns most, and by how much, in radians.
    pub(super) corner: (usize, f64),
}

/// Of a closed curve, all in scaled units.
pub(super) fn features(
    edges: &Edges,
    curve: usize,
    band: f64,
    monitor: &Monitor<'_>,
) -> Result<Features, ReadError> {
    let points = &edges.points[edges.first_vertex[curve]..edges.first_vertex[curve + 1]];
    let count = points.len();
    let mut along = vec![0.0];
    for k in 0..count {
        let [x, y] = minus(points[(k + 1) % count], points[k]);
        along.push(along[k] + (x * x + y * y).sqrt());
    }
    let length = along[count];
    let span = SPAN * band;
    // The way to the k-th vertex, counted on around the curve.
    let way = |k: usize| along[k % count] + (k / count) as f64 * length;
    let numbers: Vec<usize> = (0..count).collect();
    let blocks: Vec<Result<Vec<(f64, f64)>, ReadError>> = numbers
        .par_chunks(VERTICES)
        .map(|block| {
            monitor.check()?;
            let of = |&v: &usize| {
                let here = count + v;
                let after = |most| first(1..count, |k| way(here + k) - way(here) >= most);
                let before = |most| first(1..count, |k| way(here) - way(here - k) >= most);
                let own = [before(span), after(span)];
                // Nothing is known of a curve that is all within the span.
                if own[0] + own[1] >= count {
                    return (0.0, 0.0);
                }
                let near = [before(NEAR * span), after(NEAR * span)];
                let length_of = |k: usize| along[k + 1] - along[k];
                // Of an edge that is long beside its distance, only the ends are points of a smooth curve.
                let is_long = |on: usize| {
                    let back = count - 1 - on;
                    let off = (way(here + on) - way(here)).min(way(here) - way(here - back));
                    off < SMOOTH * length_of((v + on) % count)
                };
                at(edges, curve, v, own, near, (band, length), is_long)
            };
            Ok(block.iter().map(of).collect())
        })
        .collect();
    let mut found = Vec::with_capacity(count);
    for block in blocks {
        found.extend(block?);
    }
    let (mut size, mut corner) = (Vec::with_capacity(count), (0, 0.0));
    for (v, (radius, turn)) in found.into_iter().enumerate() {
        size.push(radius);
        if turn > corner.1 {
            corner = (v, turn);
        }
    }
    // Twice around in either direction.
    for k in 1..=2 * count {
        let (from, to) = ((k - 1) % count, k % count);
        size[to] = size[to].min(size[from] + (along[from + 1] - along[from]));
    }
    for k in (0..2 * count).rev() {
        let (from, to) = ((k + 1) % count, k % count);
        size[to] = size[to].min(size[from] + (along[to + 1] - along[to]));
    }
    Ok(Features { along, size, corner })
}

/// The first number of a range for which something holds that holds for all after it too; the end if there is none.
fn first(range: std::ops::Range<usize>, holds: impl Fn(usize) -> bool) -> usize {
    let (mut least, mut end) = (range.start, range.end);
    while least < end {
        let middle = least + (end - least) / 2;
        if holds(middle) { end = middle } else { least = middle + 1 }
    }
    least
}

/// R and the turn at a vertex, given how many steps before and after it the curve is its `own`, and is `near`.
fn at(
    edges: &Edges,
    curve: usize,
    vertex: usize,
    own: [usize; 2],
    near: [usize; 2],
    (band, length): (f64, f64),
    is_long: impl Fn(usize) -> bool,
) -> (f64, f64) {
    let (first, base) = (edges.first_vertex[curve], edges.first_edge[curve]);
    let count = edges.first_edge[curve + 1] - base;
    let steps = [count - own[0], 0, own[1]];
    let [a, v, b] = steps.map(|steps| edges.points[first + (vertex + steps) % count]);
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
    let close = Tangent { forgiven: (FORGIVEN * band).max(rounding), ..far };
    let mut radius = length / TAU;
    for end in [a, b] {
        radius = radius.min(close.through(minus(end, v)));
    }
    edges.tree.least(
        &mut radius,
        |area, [start, last]| {
            if start < base || last >= base + count {
                return far.least(area);
            }
            // All of the box in the part before the vertex, or in that after it.
            let steps = |edge: usize| (edge - base + count - vertex) % count;
            let (on, end) = (steps(start), steps(last));
            let is_in = |part: [usize; 2]| on <= end && (end < part[1] || count - 1 - on < part[0]);
            match (is_in(own), is_in(near)) {
                (true, _) => f64::INFINITY,
                (_, true) => close.least(area),
                _ => far.least(area),
            }
        },
        |edge, radius| {
            let mut tangent = &far;
            if base <= edge && edge < base + count {
                // The steps that lead on to the edge, and those that lead back to its end.
                let on = (edge - base + count - vertex) % count;
                let back = count - 1 - on;
                if on < own[1] || back < own[0] {
                    return;
                }
                if on < near[1] || back < near[0] {
                    tangent = &close;
                }
                if is_long(on) {
                    for end in edges.segment(edge) {
                        *radius = radius.min(tangent.through(minus(end, v)));
                    }
                    return;
                }
            }
            *radius = radius.min(tangent.through_edge(edges.segment(edge)));
        },
    );
    (radius, turn)
}

/// Circles that are tangent at a point.
#[derive(Clone, Copy)]
struct Tangent {
    v: [f64; 2],
    normal: [f64; 2],
    forgiven: f64,
}

impl Tangent {
    /// The radius of the circle through v + w.
    fn through(&self, w: [f64; 2]) -> f64 {
        let room = dot(self.normal, w).abs() - self.forgiven;
        if room > 0.0 { dot(w, w) / (2.0 * room) } else { f64::INFINITY }
    }

    /// No circle through a point of a box has a smaller radius, by more than a little.
    fn least(&self, area: &Area) -> f64 {
        let near = area.distance_squared(self.v);
        let center = [0, 1].map(|k| (area.least[k] + area.most[k]) / 2.0 - self.v[k]);
        let reach: f64 =
            (0..2).map(|k| (area.most[k] - area.least[k]) / 2.0 * self.normal[k].abs()).sum();
        let room = dot(self.normal, center).abs() + reach - self.forgiven;
        // An empty box gives NaN, and is as good as none.
        if room > 0.0 { near / (2.0 * room) * (1.0 + CLOSE) } else { f64::INFINITY }
    }

    /// The least radius of a circle through a point of an edge.
    ///
    /// With w = p + u·e and room r₀ + r₁u on one side, |w|²/(r₀ + r₁u) is least at an end or where
    /// e²r₁u² + 2e²r₀u + 2(p·e)r₀ − p²r₁ = 0.
    fn through_edge(&self, [a, b]: [[f64; 2]; 2]) -> f64 {
        let (p, e) = (minus(a, self.v), minus(b, a));
        let (pp, pe, ee) = (dot(p, p), dot(p, e), dot(e, e));
        let mut radius = self.through(p).min(self.through([p[0] + e[0], p[1] + e[1]]));
        for side in [1.0, -1.0] {
            let r0 = side * dot(self.normal, p) - self.forgiven;
            let r1 = side * dot(self.normal, e);
            if r0.max(r0 + r1) <= 0.0 {
                continue;
            }
            let (q0, q1, q2) = (2.0 * pe * r0 - pp * r1, ee * r0, ee * r1);
            let root = (q1 * q1 - q2 * q0).max(0.0).sqrt();
            // The roots of q2·u² + 2·q1·u + q0, without cancellation.
            let sum = -(q1 + root.copysign(q1));
            for u in [sum / q2, q0 / sum] {
                if u > 0.0 && u < 1.0 {
                    radius = radius.min(self.through([p[0] + u * e[0], p[1] + u * e[1]]));
                }
            }
        }
        radius
    }
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}
