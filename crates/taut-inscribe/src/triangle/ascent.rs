//! A local optimum, by linear programs in a region of trust.
//!
//! *Idea.* The triangle is mapped to one with legs of length 1. Each edge near it is kept apart from it by a line: a side of the triangle, to
//! the right of which the edge stays, or the line of the edge, on one side of which the corners stay. The line with the most room is
//! taken, and its conditions are linear in the changes of the corners but for their products. The best step of
//! [`program`](super::program) is scaled from its centroid until no edge enters; a step that does not hold what it promises shrinks
//! the region.

use super::gauge::{Gauge, Triangle, doubled_area, minus, scaled, turn};
use super::program::{self, Column, ROWS};
use super::rows::side_gradient;
use crate::groups::Groups;
use crate::polygon::Segment;

/// Steps of one climb among the same edges.
const STEPS_MAX: usize = 50;

/// Climbs, each with the edges near the result of the one before.
const ROUNDS_MAX: usize = 6;

/// Half the change of a coordinate, in legs of the mapped triangle, in the first step and at most.
const TRUST: (f64, f64) = (0.1, 0.3);

/// Relative gain of the area, and region of trust, below which a climb ends.
const GAIN_MIN: f64 = 1e-12;

/// The scale up to which a triangle reaches edges that are looked at.
const NEAR_SCALE_MAX: f64 = 3.0;

/// How many regions of trust an edge may be away to have a condition.
const TRUSTS_AWAY: f64 = 4.0;

/// A triangle in the frame, scaled so that no edge enters but for rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) corners: Triangle,
    /// Twice the area.
    pub(super) doubled: f64,
}

impl Candidate {
    /// The largest image of a triangle from its centroid, up to a scale, that no edge enters; `None` without an area.
    pub(super) fn of(triangle: &Triangle, edges: &Groups, most: f64) -> Option<Self> {
        let has_area = doubled_area(triangle) > 0.0;
        has_area.then(|| {
            let scale = edges.least_scale(&Gauge::of(triangle), most);
            let corners = scaled(triangle, scale);
            Candidate { corners, doubled: doubled_area(&corners) }
        })
    }

    /// Returns a local optimum, or a triangle near one.
    pub(super) fn climbed(self, edges: &Groups) -> Self {
        // Where it touches no edge, those that stop it may be out of reach.
        let Some(mut best) = Candidate::of(&self.corners, edges, f64::INFINITY) else {
            return self;
        };
        for _ in 0..ROUNDS_MAX {
            if best.doubled.is_nan() || best.doubled <= 0.0 {
                break;
            }
            let found = best.climbed_among(edges);
            let next = Candidate::of(&found, edges, f64::INFINITY);
            let Some(next) = next.filter(|next| next.doubled > best.doubled) else { break };
            let has_gained = next.doubled > best.doubled * (1.0 + GAIN_MIN);
            best = next;
            if !has_gained {
                break;
            }
        }
        best
    }

    /// Climbs among the edges that are near now.
    fn climbed_among(&self, edges: &Groups) -> Triangle {
        let gauge = Gauge::of(&self.corners);
        let [origin, one, other] = self.corners;
        let (u, v) = (minus(one, origin), minus(other, origin));
        let map = |w: [f64; 2]| {
            let d = minus(w, origin);
            [(d[0] * v[1] - d[1] * v[0]) / self.doubled, (u[0] * d[1] - u[1] * d[0]) / self.doubled]
        };
        let near = edges.reached(&gauge, NEAR_SCALE_MAX).into_iter();
        let near: Vec<Segment> = near.map(|edge| edges.edge(edge).map(map)).collect();
        let near = Groups::of(&near);
        let found = climb([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], &near);
        found.map(|p| [0, 1].map(|k| origin[k] + p[0] * u[k] + p[1] * v[k]))
    }
}

/// Climbs from a triangle with legs of about 1.
fn climb(start: Triangle, near: &Groups) -> Triangle {
    let (mut best, mut area, mut trust) = (start, doubled_area(&start), TRUST.0);
    let gauge = Gauge::of(&start);
    for _ in 0..STEPS_MAX {
        let half = [[trust; 2]; 3];
        let columns = columns(&best, near, trust);
        let mut target = [0.0; ROWS];
        for corner in 0..3 {
            let side = minus(best[(corner + 2) % 3], best[(corner + 1) % 3]);
            target[2 * corner] = -side[1] * half[corner][0];
            target[2 * corner + 1] = side[0] * half[corner][1];
        }
        let found = program::best(&columns, &target, f64::NEG_INFINITY);
        let promised = found.value;
        if promised.is_nan() || promised <= area * GAIN_MIN {
            break;
        }
        let step = found.step;
        let mut next = best;
        for (k, p) in next.as_flattened_mut().iter_mut().enumerate() {
            *p += trust * step[k];
        }
        let next = Candidate::of(&next, near, NEAR_SCALE_MAX);
        // Beyond the reach there may be other edges.
        if next.is_some_and(|next| {
            next.corners.iter().any(|&p| gauge.scale([p, p], NEAR_SCALE_MAX) >= NEAR_SCALE_MAX)
        }) {
            break;
        }
        let held = next.map_or(f64::NEG_INFINITY, |next| next.doubled - area);
        if held > 0.7 * promised {
            trust = (2.0 * trust).min(TRUST.1);
        } else if held < 0.3 * promised {
            trust *= 0.35;
        }
        if let Some(next) = next.filter(|_| held > 0.0) {
            (best, area) = (next.corners, next.doubled);
        }
        if trust < GAIN_MIN {
            break;
        }
    }
    best
}

/// The conditions of the edges near a triangle for small changes of its corners.
fn columns(triangle: &Triangle, near: &Groups, trust: f64) -> Vec<Column> {
    let half = [[trust; 2]; 3];
    let away = TRUSTS_AWAY * trust;
    let length = |[a, b]: Segment| (b[0] - a[0]).hypot(b[1] - a[1]);
    let sides = [0, 1, 2].map(|k: usize| [triangle[k], triangle[(k + 1) % 3]]);
    let lengths = sides.map(length);
    let mut found = vec![];
    let gauge = Gauge::of(triangle);
    for edge in near.reached(&gauge, 1.0 + away * gauge.slope()) {
        let edge = near.edge(edge);
        // The room between the edge and each side, and between the line of the edge and the corners on both of its sides.
        let of_side = |k: usize| {
            let [p, q] = sides[k];
            edge.map(|w| -turn(p, q, w) / lengths[k])
        };
        let rooms = [of_side(0), of_side(1), of_side(2)];
        let heights = triangle.map(|p| turn(edge[0], edge[1], p) / length(edge));
        let least = |x: &[f64]| x.iter().copied().fold(f64::INFINITY, f64::min);
        let (left, right) = (least(&heights), least(&heights.map(|x| -x)));
        let (mut side, mut room) = (0, f64::NEG_INFINITY);
        for (k, rooms) in rooms.iter().enumerate() {
            if least(rooms) > room {
                (side, room) = (k, least(rooms));
            }
        }
        if room.max(left).max(right) > away {
            continue;
        }
        if room >= left.max(right) {
            for (w, room) in edge.into_iter().zip(rooms[side]) {
                if room <= away {
                    let value = turn(sides[side][0], sides[side][1], w);
                    found.push(Column::new(value, side_gradient(triangle, side, w, half)));
                }
            }
            continue;
        }
        let sign = if left >= right { -1.0 } else { 1.0 };
        let normal = [edge[0][1] - edge[1][1], edge[1][0] - edge[0][0]];
        for (corner, height) in heights.iter().enumerate() {
            if height.abs() <= away {
                let mut gradient = [0.0; ROWS];
                for k in 0..2 {
                    gradient[2 * corner + k] = sign * normal[k] * trust;
                }
                found.push(Column::new(sign * height * length(edge), gradient));
            }
        }
    }
    found.retain(Column::can_bind);
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Loops;

    #[test]
    fn a_small_triangle_climbs_to_half_of_a_square() {
        let mut loops = Loops::default();
        loops.push(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        let start = [[0.3, 0.4], [0.5, 0.3], [0.4, 0.6]];
        let edges = Groups::of(&loops.segments);
        let found = Candidate::of(&start, &edges, 1.0).unwrap();
        assert!((found.doubled - doubled_area(&start)).abs() < 1e-15);
        let found = found.climbed(&edges);
        assert!((found.doubled - 1.0).abs() < 1e-9, "{found:?}");
    }
}
