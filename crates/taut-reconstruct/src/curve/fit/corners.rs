//! Corners: places where two smooth pieces meet at an angle, which windows that hold points of both round off.
//!
//! *Problem.* A curve through noise is known to a few widths of the band. How can it be told whether it bends there or has a corner?
//! *Idea.* Where it turns within a few widths, parabolas are fitted to what comes before and to what comes after, without what is
//! between. Of a bend they run into each other; of a corner they meet at an angle, and the points between are no farther from them
//! than noise is, nor much farther than from the curve that goes around.
//! *Guarantee.* Nothing changes on curves that turn by less than 30° within twelve deviations of the noise. Turns and scales with the
//! points; O(n).
//! *Trap.* Lines would do for the angle but not for the corner: it lies beyond the windows, where a bend of the sides shows most.

use std::f64::consts::{FRAC_PI_6, PI};

use super::local::{Parabola, Window};
use super::regress::around;
use super::strand::{Node, Strand};

type Point = [f64; 2];

/// Half the length that a corner spoils, in deviations of the noise.
const SPAN: f64 = 6.0;
/// The least angle of a corner.
const TURN: f64 = FRAC_PI_6;
/// The share of it by which the strand turns at least, as windows round corners off.
const SEEN: f64 = 0.6;
/// The shortest and the longest side, in deviations.
const SIDE: [f64; 2] = [12.0, 60.0];
/// Nodes are two deviations and more apart, so there are about ten within that and what corners spoil; more than this are not looked at.
const MOST: usize = 50;
/// Growth of sides, and the deviation from its parabola, in those of the noise, at which a side is too long.
const GROWTH: f64 = 1.3;
const SPREAD: f64 = 1.3;
/// Fewest points of a side, and between.
const FEWEST: u32 = 8;
/// The mean square distance of the points between from the corner, in that of the noise.
const FITS: f64 = 1.4;
/// By how much of itself it may exceed that from the curve that goes around, times the root of the number of points: by chance. Of 200
/// smooth curves with bends of two to ten widths of the band some passed for corners with twice this; at the corners of polygons
/// it is 0.5 to 0.9 of that from the curve, where points are many.
const AS_NEAR: f64 = 1.5;

/// A corner of a strand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Length along the strand where it turns most.
    arc: f64,
    /// Half the length that it replaces.
    half: f64,
    at: Point,
    /// Unit tangents before and after.
    arrives: Point,
    leaves: Point,
}

/// The corners of a strand, in order.
pub(super) fn corners(strand: &Strand) -> Vec<Corner> {
    let turns = turns(strand);
    let sharp: Vec<usize> = (0..turns.len()).filter(|&i| is_sharpest(strand, &turns, i)).collect();
    let mut window = Window::default();
    let corner = |(place, &i): (usize, &usize)| {
        let gap = |other: Option<&usize>| other.map_or(f64::INFINITY, |&j| apart(strand, i, j));
        let wrapped = |k: Option<usize>| match k {
            Some(k) if k < sharp.len() => Some(&sharp[k]),
            None if strand.closed && sharp.len() > 1 => sharp.last(),
            Some(_) if strand.closed && sharp.len() > 1 => sharp.first(),
            _ => None,
        };
        let room = [gap(wrapped(place.checked_sub(1))), gap(wrapped(Some(place + 1)))];
        measure(strand, i, room, &mut window)
    };
    sharp.iter().enumerate().filter_map(corner).collect()
}

/// Puts corners in the place of the nodes around them; nodes are those of the strand, moved perhaps.
pub(super) fn insert(nodes: &mut Vec<Node>, strand: &Strand, corners: &[Corner]) {
    if corners.is_empty() {
        return;
    }
    let mut put = vec![false; corners.len()];
    let mut kept = Vec::with_capacity(nodes.len());
    for (&node, &arc) in nodes.iter().zip(&strand.arc) {
        // Corners come in order: the nearest is the one before or after, or across the seam.
        let after = corners.partition_point(|corner| corner.arc < arc);
        let near = [after.checked_sub(1).unwrap_or(corners.len() - 1), after % corners.len()]
            .map(|c| (along(strand, arc, corners[c].arc), c));
        let (away, c) = if near[0].0 < near[1].0 { near[0] } else { near[1] };
        if away >= corners[c].half {
            kept.push(node);
        } else if !std::mem::replace(&mut put[c], true) {
            let Corner { at, arrives, leaves, .. } = corners[c];
            kept.push(Node { at, tangent: arrives, leaving: leaves, ..node });
        }
    }
    *nodes = kept;
}

/// The distance of two places along a strand.
fn along(strand: &Strand, a: f64, b: f64) -> f64 {
    let apart = (a - b).abs();
    if strand.closed { apart.min(strand.length() - apart) } else { apart }
}

fn apart(strand: &Strand, i: usize, j: usize) -> f64 {
    along(strand, strand.arc[i], strand.arc[j])
}

/// At each node the angle between the tangents [`SPAN`] before and after it; 0 near the ends of an open strand.
fn turns(strand: &Strand) -> Vec<f64> {
    let tangent = |arc: f64| {
        let whole = strand.length();
        let arc = if strand.closed { arc.rem_euclid(whole) } else { arc };
        (0.0..=whole).contains(&arc).then(|| strand.place(arc).1)
    };
    strand
        .nodes
        .iter()
        .zip(&strand.arc)
        .map(|(node, &arc)| {
            let span = SPAN * node.deviation;
            match (tangent(arc - span), tangent(arc + span)) {
                (Some(a), Some(b)) if 2.0 * span < 0.5 * strand.length() => angle(a, b),
                _ => 0.0,
            }
        })
        .collect()
}

/// The angle from one direction to another, in (−π, π].
fn angle(a: Point, b: Point) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
}

/// Whether the strand turns by [`TURN`] at a node, and by more nowhere so near to it that it could be another corner.
fn is_sharpest(strand: &Strand, turns: &[f64], i: usize) -> bool {
    let count = turns.len();
    let own = turns[i].abs();
    if own < SEEN * TURN {
        return false;
    }
    // Between corners that are nearer to each other no side would be long enough.
    let span = (SIDE[0] + 2.0 * SPAN) * strand.nodes[i].deviation;
    let sharper = |forward: bool| {
        (1..count)
            .map_while(|k| match (forward, strand.closed) {
                (true, true) => Some((i + k) % count),
                (false, true) => Some((i + count - k) % count),
                (true, false) => (i + k < count).then_some(i + k),
                (false, false) => i.checked_sub(k),
            })
            .take(MOST)
            .take_while(|&j| apart(strand, i, j) <= span)
            .any(|j| turns[j].abs() > own || (turns[j].abs() == own && j < i))
    };
    !sharper(true) && !sharper(false)
}

/// The corner at a node, if it is one; `room` is how far the next ones are.
fn measure(strand: &Strand, i: usize, room: [f64; 2], window: &mut Window) -> Option<Corner> {
    let (node, arc) = (&strand.nodes[i], strand.arc[i]);
    let half = SPAN * node.deviation;
    let before = side(strand, arc - half, -1.0, room[0] - 2.0 * half, node, window)?;
    let after = side(strand, arc + half, 1.0, room[1] - 2.0 * half, node, window)?;
    let (u, v) = meet(&before, &after, half)?;
    let (at, arrives, leaves) = (before.place(u), before.direction_at(u), after.direction_at(v));
    let turn = angle(arrives, leaves).abs();
    if !(TURN..PI - TURN).contains(&turn) {
        return None;
    }
    let ends = [before.place(u.min(0.0) - half), after.place(v.max(0.0) + half)];
    let (mut count, mut corner, mut curve) = (0u32, 0.0, 0.0);
    for member in around(strand, arc, half).into_iter().flatten() {
        let distance = to_segment(member.at, ends[0], at).min(to_segment(member.at, at, ends[1]));
        count += 1;
        corner += distance * distance;
        curve += (member.share * node.deviation).powi(2);
    }
    let count = f64::from(count);
    let noise = count * node.deviation * node.deviation;
    let chance = 1.0 + AS_NEAR / count.sqrt();
    let fits = count >= f64::from(FEWEST) && corner <= FITS * noise && corner <= chance * curve;
    fits.then_some(Corner { arc, half, at, arrives, leaves })
}

/// The parabola of the longest side from a place on, in a direction along the strand, in which residuals are as small as noise is. Its
/// tangent runs along the strand.
fn side(
    strand: &Strand,
    from: f64,
    sign: f64,
    room: f64,
    node: &Node,
    window: &mut Window,
) -> Option<Parabola> {
    let whole = strand.length();
    let [mut length, longest] = SIDE.map(|side| side * node.deviation);
    let left = match (strand.closed, sign > 0.0) {
        (true, _) => 0.25 * whole,
        (false, true) => whole - from,
        (false, false) => from,
    };
    let longest = longest.min(room).min(left);
    let mut best = None;
    while length <= longest {
        let middle = from + 0.5 * sign * length;
        let middle = if strand.closed { middle.rem_euclid(whole) } else { middle };
        let members = around(strand, middle, 0.5 * length);
        let points = members.into_iter().flatten().map(|m| m.at);
        if points.clone().count() >= FEWEST as usize {
            // The frame's origin is the strand's place next to the corner.
            let origin = strand.place(if strand.closed { from.rem_euclid(whole) } else { from });
            let found = window.fit(origin.0, points)?;
            if found.variance.sqrt() > SPREAD * node.deviation {
                break;
            }
            best = Some(if angle(found.tangent, origin.1).abs() > 0.5 * PI {
                found.reversed()
            } else {
                found
            });
        }
        length *= GROWTH;
    }
    best
}

/// Where two parabolas meet, as places along both: beyond the first, and before the second.
fn meet(before: &Parabola, after: &Parabola, half: f64) -> Option<(f64, f64)> {
    let (mut u, mut v) = (half, -half);
    for _ in 0..20 {
        let (p, q) = (before.place(u), after.place(v));
        let (a, b) = (before.derivative(u), after.derivative(v));
        let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
        let turn = a[0] * b[1] - a[1] * b[0];
        // p + s·a = q + t·b.
        let (s, t) = ((dx * b[1] - dy * b[0]) / turn, (dx * a[1] - dy * a[0]) / turn);
        (u, v) = (u + s, v + t);
        // What is not a number is not within, either.
        if !((-half..=3.0 * half).contains(&u) && (-3.0 * half..=half).contains(&v)) {
            return None;
        }
        if s.abs() + t.abs() <= 1e-12 * half {
            return Some((u, v));
        }
    }
    None
}

/// The distance of a point from a segment.
fn to_segment(p: Point, a: Point, b: Point) -> f64 {
    let (ex, ey) = (b[0] - a[0], b[1] - a[1]);
    let share =
        ((p[0] - a[0]) * ex + (p[1] - a[1]) * ey) / (ex * ex + ey * ey).max(f64::MIN_POSITIVE);
    let t = share.clamp(0.0, 1.0);
    (p[0] - a[0] - t * ex).hypot(p[1] - a[1] - t * ey)
}
