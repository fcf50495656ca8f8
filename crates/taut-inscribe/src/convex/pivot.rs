//! The best single side: the half-plane that keeps some points out of a region and leaves most of it.
//!
//! *Idea.* The border of a best half-plane touches the convex hull of the points, at a corner q of it. Turned about q, the area left
//! changes by ½(v² − u²) per radian, u and v being the lengths of the chord ahead of q and behind it: it is largest where q is the middle
//! of the chord, or where the line lies along a side of the hull.
//! *Guarantee.* A local optimum on each interval of directions that are tried, and the best of all intervals.
//! *Reference.* Goodman, On the largest convex polygon contained in a non-convex n-gon, Geometriae Dedicata 11, 1981: the middle of
//! the chord.

use std::f64::consts::{PI, TAU};

use taut_points::OrderBy;

use super::region::{Region, Side, cross, dot, minus};

/// Directions tried at a corner, besides the ends of its range.
const DIRECTIONS: usize = 4;

/// Halvings of an interval of directions.
const HALVINGS: usize = 40;

/// Corners of hulls that are nearer to each other than this are one, and sides may have them this far inside.
const SAME: f64 = 1e-13;

/// The half-plane that leaves most of a region, has one point inside and none of some others, and the area left.
pub(super) fn best_side(
    region: &Region,
    points: &mut [[f64; 2]],
    inside: [f64; 2],
) -> Option<(f64, Side)> {
    let hull = hull(points);
    let mut best: Option<(f64, Side)> = None;
    let mut consider = |side: Side| {
        // Behind the points there may be no inside of the polygon. At a corner of a nearly straight hull rounding can make the range
        // a whole turn.
        let lets_in = |&p: &[f64; 2]| side.excess(p) < -SAME;
        if side.excess(inside) >= 0.0 || hull.iter().any(lets_in) {
            return;
        }
        let area = region.clipped(&side).area();
        if best.is_none_or(|(most, _)| area > most) {
            best = Some((area, side));
        }
    };
    for (i, &q) in hull.iter().enumerate() {
        let last = hull[if i == 0 { hull.len() - 1 } else { i - 1 }];
        let next = hull[if i + 1 == hull.len() { 0 } else { i + 1 }];
        // Normals point from the body into the hull: the inner normals of its two sides at q bound their range.
        let inner = |from: [f64; 2], to: [f64; 2]| {
            let d = minus(to, from);
            d[0].atan2(-d[1])
        };
        let begin = inner(last, q);
        let turn = match hull.len() {
            1 => TAU,
            2 => PI,
            _ => (inner(q, next) - begin).rem_euclid(TAU),
        };
        let at = |angle: f64| Side::through(q, [angle.cos(), angle.sin()]);
        let shuts_out = |angle: f64| at(angle).is_none_or(|side| side.excess(inside) >= 0.0);
        // Then all directions between do as well: q is on the far side of the hull.
        if turn < PI && shuts_out(begin) && shuts_out(begin + turn) {
            continue;
        }
        let parts = DIRECTIONS + 1;
        let angle = |part: usize| begin + turn * part as f64 / parts as f64;
        for part in 0..parts {
            let (from, to) = (angle(part), angle(part + 1));
            [from, to].into_iter().filter_map(at).for_each(&mut consider);
            if let Some(middle) = balanced(region, q, from, to) {
                at(middle).into_iter().for_each(&mut consider);
            }
        }
    }
    best
}

/// A direction between two at which q is the middle of its chord and the area is largest.
fn balanced(region: &Region, q: [f64; 2], mut from: f64, mut to: f64) -> Option<f64> {
    let slope = |angle: f64| {
        let [sine, cosine] = [angle.sin(), angle.cos()];
        let [u, v] = chord(region, q, [-sine, cosine]);
        u * u - v * v
    };
    // Turned counterclockwise, the area falls where the part ahead is the longer one.
    if !(slope(from) < 0.0 && slope(to) > 0.0) {
        return None;
    }
    for _ in 0..HALVINGS {
        let middle = 0.5 * (from + to);
        if slope(middle) < 0.0 { from = middle } else { to = middle }
    }
    Some(0.5 * (from + to))
}

/// How far the line through a point of the region stays in it, along a direction and against it.
fn chord(region: &Region, q: [f64; 2], direction: [f64; 2]) -> [f64; 2] {
    let corners = &region.corners;
    let (mut ahead, mut behind) = (0.0f64, 0.0f64);
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[if i + 1 == corners.len() { 0 } else { i + 1 }];
        let (here, there) = (cross(direction, minus(a, q)), cross(direction, minus(b, q)));
        if (here <= 0.0) == (there <= 0.0) {
            continue;
        }
        let share = here / (here - there);
        let at = dot(direction, minus([0, 1].map(|k| a[k] + share * (b[k] - a[k])), q));
        (ahead, behind) = (ahead.max(at), behind.max(-at));
    }
    [ahead, behind]
}

/// The corners of the convex hull, counterclockwise (Andrew's chain).
pub(super) fn hull(points: &mut [[f64; 2]]) -> Vec<[f64; 2]> {
    points.order_by(&|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    let is_near = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]) <= SAME;
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut kept: Vec<[f64; 2]> = vec![];
        for p in points {
            if kept.last().is_some_and(|&last| is_near(last, p)) {
                continue;
            }
            while let [.., o, q] = kept[..] {
                if cross(minus(q, o), minus(p, o)) > 0.0 {
                    break;
                }
                kept.pop();
            }
            kept.push(p);
        }
        kept
    };
    let mut lower = chain(&mut points.iter().copied());
    let mut upper = chain(&mut points.iter().rev().copied());
    if lower.len() > 1 {
        lower.pop();
        upper.pop();
        lower.extend(upper);
    }
    lower
}
