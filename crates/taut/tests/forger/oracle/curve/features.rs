//! φ at the vertices of closed curves whose vertices are rows, from its definition over all edges.
//!
//! *Tangent* at v: that of the circle through v and its two neighbors.
//! *Radius* R(v): the least r ≤ σ(v) such that a circle of radius r, tangent at v on either side, meets another vertex or
//! edge. Such disks of growing radius are nested, so r is found by bisection. An edge of the same curve nearer along the
//! curve than twice its length counts with its ends only.
//! *Sight* σ(v): the largest, over all gaps, of nine times the gap (at most L/2π) less the way to it.
//! *φ*: the least, over all vertices u of the curve, of R(u) plus the way from u.

use std::f64::consts::TAU;

use super::Edge;
use super::planar::Point;

const SIGHT_RATIO: f64 = 9.0;
const SMOOTH_WAY_RATIO: f64 = 2.0;

/// An interval is halved this often: to a relative 2⁻⁵⁰.
const HALVINGS_MAX: usize = 50;

pub(super) fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// A closed curve with the way to each of its vertices and back to the first.
pub(super) struct Course {
    curve: usize,
    pub(super) points: Vec<Point>,
    pub(super) along: Vec<f64>,
}

impl Course {
    pub(super) fn of(curve: usize, points: Vec<Point>) -> Self {
        let mut along = vec![0.0];
        for k in 0..points.len() {
            let e = minus(points[(k + 1) % points.len()], points[k]);
            along.push(along[k] + dot(e, e).sqrt());
        }
        Course { curve, points, along }
    }

    pub(super) fn gap(&self, k: usize) -> f64 {
        let k = k % self.points.len();
        self.along[k + 1] - self.along[k]
    }

    fn length(&self) -> f64 {
        self.along[self.points.len()]
    }

    /// The way from one vertex on to another.
    fn way(&self, from: usize, to: usize) -> f64 {
        let way = self.along[to] - self.along[from];
        if to < from { way + self.length() } else { way }
    }

    /// The shorter way between two vertices.
    fn between(&self, u: usize, v: usize) -> f64 {
        if u == v { 0.0 } else { self.way(u, v).min(self.way(v, u)) }
    }

    fn neighbors(&self, v: usize) -> [Point; 2] {
        let count = self.points.len();
        [self.points[(v + count - 1) % count], self.points[(v + 1) % count]]
    }

    /// By how much the curve turns at a vertex, in radians.
    pub(super) fn turn(&self, v: usize) -> f64 {
        let [a, b] = self.neighbors(v);
        let (to, from) = (minus(self.points[v], a), minus(b, self.points[v]));
        (to[0] * from[1] - to[1] * from[0]).atan2(dot(to, from)).abs()
    }

    fn sight(&self, v: usize) -> f64 {
        let most = self.length() / TAU;
        let count = self.points.len();
        let seen = (0..count).map(|k| {
            let way = self.between(v, k).min(self.between(v, (k + 1) % count));
            (SIGHT_RATIO * self.gap(k)).min(most) - way
        });
        seen.fold(0.0, f64::max)
    }

    /// φ at each vertex, where offsets of so many units in the last place of a vertex are forgiven.
    pub(super) fn features(&self, edges: &[Edge], forgiven: f64) -> Vec<f64> {
        let count = self.points.len();
        let radii: Vec<f64> = (0..count).map(|v| self.radius(v, edges, forgiven)).collect();
        let size = |v: usize| {
            let bounds = (0..count).map(|u| radii[u] + self.between(u, v));
            bounds.fold(f64::INFINITY, f64::min)
        };
        (0..count).map(size).collect()
    }

    fn radius(&self, v: usize, edges: &[Edge], forgiven: f64) -> f64 {
        let (at, count) = (self.points[v], self.points.len());
        let [a, b] = self.neighbors(v);
        let (to, from) = (minus(at, a), minus(b, at));
        let tangent = [0, 1].map(|k| to[k] / dot(to, to) + from[k] / dot(from, from));
        let size = dot(tangent, tangent).sqrt();
        let normal = [-tangent[1] / size, tangent[0] / size];
        let forgiven = forgiven * f64::EPSILON * (at[0].abs() + at[1].abs());
        let circles = Circles { at, normal, forgiven };
        let mut radius = self.sight(v);
        for end in [a, b] {
            radius = radius.min(circles.through(end));
        }
        for edge in edges {
            let [start, end] = edge.vertices;
            if edge.curve != self.curve {
                radius = circles.first_touch(edge.ends, radius);
            } else if start != v && end != v {
                let off = self.way(v, start).min(self.way(end, v));
                radius = match off < SMOOTH_WAY_RATIO * self.gap(edge.number % count) {
                    true => {
                        edge.ends.into_iter().map(|p| circles.through(p)).fold(radius, f64::min)
                    }
                    false => circles.first_touch(edge.ends, radius),
                };
            }
        }
        radius
    }
}

/// Circles that are tangent at a point.
struct Circles {
    at: Point,
    normal: Point,
    forgiven: f64,
}

impl Circles {
    /// The radius of the one through a point.
    fn through(&self, p: Point) -> f64 {
        let w = minus(p, self.at);
        let room = dot(self.normal, w).abs() - self.forgiven;
        if room > 0.0 { dot(w, w) / (2.0 * room) } else { f64::INFINITY }
    }

    /// The least radius, at most `most`, of a disk on either side that meets an edge.
    fn first_touch(&self, [a, b]: [Point; 2], most: f64) -> f64 {
        let (p, e) = (minus(a, self.at), minus(b, a));
        let (pe, ee) = (dot(p, e), dot(e, e));
        let mut radius = most;
        for side in [1.0, -1.0] {
            let normal = self.normal.map(|x| side * x);
            // The least power of a point of the edge, |w|² − 2r(n·w − τ).
            let meets = |r: f64| {
                let u = ((r * dot(normal, e) - pe) / ee).clamp(0.0, 1.0);
                let w = [p[0] + u * e[0], p[1] + u * e[1]];
                dot(w, w) <= 2.0 * r * (dot(normal, w) - self.forgiven)
            };
            if !meets(radius) {
                continue;
            }
            let (mut low, mut high) = (0.0, radius);
            for _ in 0..HALVINGS_MAX {
                let middle = low + (high - low) / 2.0;
                if meets(middle) { high = middle } else { low = middle }
            }
            radius = high;
        }
        radius
    }
}
