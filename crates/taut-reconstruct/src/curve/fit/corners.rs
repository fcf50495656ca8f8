//! Corners: places where two smooth pieces meet at an angle, which windows that hold points of both round off.
//!
//! *Problem.* A curve through noise is known to a few widths of the band. How can it be told whether it bends there or has a corner?
//! *Idea.* Where it turns within a few widths, parabolas are fitted to what comes before and to what comes after, without what is
//! between. Of a bend they run into each other; of a corner they meet at an angle, and the points between are no farther from them
//! than noise is, nor much farther than from the curve that goes around.
//! *Guarantee.* Nothing changes on curves that turn by less than 18° within twelve deviations of the noise. Turns and scales with the
//! points; O(n). How many corners are found depends on how many points there are: of corners of 36° to 120° between sides of a hundred
//! deviations and more, nine in ten with two points for each deviation of length, two in three with one; of shorter sides fewer, and
//! none below thirty.
//! *Trap.* Lines would do for the angle but not for the corner: it lies beyond the windows, where a bend of the sides shows most.

use std::f64::consts::PI;

use super::local::{Parabola, Window};
use super::parameters::{
    CHANCE_EXCESS_MAX, CORNER_ANGLE_MIN, CORNER_FIT_MAX, HALF_SPAN_RATIO, NODES_MAX,
    SIDE_DEVIATION_RATIO_MAX, SIDE_DEVIATIONS, SIDE_GROWTH, SIDE_POINTS_MIN, TURN_RATIO_MIN,
};
use super::regress::around;
use super::spline::{Node, Spline};

type Point = [f64; 2];

/// A corner of a spline.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Length along the spline where it turns most.
    arc: f64,
    /// Half the length that it replaces.
    half: f64,
    at: Point,
    /// Unit tangents before and after.
    arrives: Point,
    leaves: Point,
}

/// The corners of a spline, in order.
pub(super) fn corners(spline: &Spline) -> Vec<Corner> {
    let turns = turns(spline);
    let sharp: Vec<usize> = (0..turns.len()).filter(|&i| is_sharpest(spline, &turns, i)).collect();
    let mut window = Window::default();
    let corner = |place: usize| {
        let room = beside(sharp.len(), place, spline.closed)
            .map(|other| other.map_or(f64::INFINITY, |k| apart(spline, sharp[place], sharp[k])));
        measure(spline, sharp[place], room, &mut window)
    };
    (0..sharp.len()).filter_map(corner).collect()
}

/// The numbers before and after one of so many in a row, or in a circle.
fn beside(count: usize, place: usize, closed: bool) -> [Option<usize>; 2] {
    let around = |k: usize| (closed && count > 1).then_some(k);
    let before = place.checked_sub(1).or_else(|| around(count - 1));
    let after = if place + 1 < count { Some(place + 1) } else { around(0) };
    [before, after]
}

/// Puts corners in the place of the nodes around them; nodes are those of the spline, moved perhaps.
pub(super) fn insert(nodes: &mut Vec<Node>, spline: &Spline, corners: &[Corner]) {
    if corners.is_empty() {
        return;
    }
    let mut put = vec![false; corners.len()];
    let mut kept = Vec::with_capacity(nodes.len());
    for (&node, &arc) in nodes.iter().zip(&spline.arc) {
        // Corners come in order: the nearest is the one before or after, or across the seam.
        let after = corners.partition_point(|corner| corner.arc < arc);
        let near = [after.checked_sub(1).unwrap_or(corners.len() - 1), after % corners.len()]
            .map(|c| (along(spline, arc, corners[c].arc), c));
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

/// The distance of two places along a spline.
fn along(spline: &Spline, a: f64, b: f64) -> f64 {
    let apart = (a - b).abs();
    if spline.closed { apart.min(spline.length() - apart) } else { apart }
}

fn apart(spline: &Spline, i: usize, j: usize) -> f64 {
    along(spline, spline.arc[i], spline.arc[j])
}

/// At each node the angle between the tangents [`HALF_SPAN_RATIO`] before and after it; 0 near the ends of an open spline.
fn turns(spline: &Spline) -> Vec<f64> {
    let tangent = |arc: f64| {
        let whole = spline.length();
        let arc = if spline.closed { arc.rem_euclid(whole) } else { arc };
        (0.0..=whole).contains(&arc).then(|| spline.place(arc).1)
    };
    spline
        .nodes
        .iter()
        .zip(&spline.arc)
        .map(|(node, &arc)| {
            let span = HALF_SPAN_RATIO * node.deviation;
            match (tangent(arc - span), tangent(arc + span)) {
                (Some(a), Some(b)) if 2.0 * span < 0.5 * spline.length() => angle(a, b),
                _ => 0.0,
            }
        })
        .collect()
}

/// The angle from one direction to another, in (−π, π].
fn angle(a: Point, b: Point) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
}

/// Whether the spline turns by [`TURN_RATIO_MIN`]·[`CORNER_ANGLE_MIN`] at a node, and by more nowhere so near to it that it could be another corner.
fn is_sharpest(spline: &Spline, turns: &[f64], i: usize) -> bool {
    let count = turns.len();
    let own = turns[i].abs();
    if own < TURN_RATIO_MIN * CORNER_ANGLE_MIN {
        return false;
    }
    // Between corners that are nearer to each other no side would be long enough.
    let span = (SIDE_DEVIATIONS[0] + 2.0 * HALF_SPAN_RATIO) * spline.nodes[i].deviation;
    let sharper = |forward: bool| {
        (1..count)
            .map_while(|k| match (forward, spline.closed) {
                (true, true) => Some((i + k) % count),
                (false, true) => Some((i + count - k) % count),
                (true, false) => (i + k < count).then_some(i + k),
                (false, false) => i.checked_sub(k),
            })
            .take(NODES_MAX)
            .take_while(|&j| apart(spline, i, j) <= span)
            .any(|j| turns[j].abs() > own || (turns[j].abs() == own && j < i))
    };
    !sharper(true) && !sharper(false)
}

/// The corner at a node, if it is one; `room` is how far the next ones are.
fn measure(spline: &Spline, i: usize, room: [f64; 2], window: &mut Window) -> Option<Corner> {
    let (node, arc) = (&spline.nodes[i], spline.arc[i]);
    let half = HALF_SPAN_RATIO * node.deviation;
    let before = side(spline, arc - half, -1.0, room[0] - 2.0 * half, node, window)?;
    let after = side(spline, arc + half, 1.0, room[1] - 2.0 * half, node, window)?;
    let (u, v) = meet(&before, &after, half)?;
    let (at, arrives, leaves) = (before.place(u), before.direction_at(u), after.direction_at(v));
    let turn = angle(arrives, leaves).abs();
    if !(CORNER_ANGLE_MIN..PI - CORNER_ANGLE_MIN).contains(&turn) {
        return None;
    }
    let ends = [before.place(u.min(0.0) - half), after.place(v.max(0.0) + half)];
    let (mut count, mut corner, mut curve) = (0u32, 0.0, 0.0);
    for member in around(spline, arc, half).into_iter().flatten() {
        let distance = to_segment(member.at, ends[0], at).min(to_segment(member.at, at, ends[1]));
        count += 1;
        corner += distance * distance;
        curve += (member.share * node.deviation).powi(2);
    }
    let count = f64::from(count);
    let noise = count * node.deviation * node.deviation;
    let chance = 1.0 + CHANCE_EXCESS_MAX / count.sqrt();
    let fits = count >= f64::from(SIDE_POINTS_MIN)
        && corner <= CORNER_FIT_MAX * noise
        && corner <= chance * curve;
    fits.then_some(Corner { arc, half, at, arrives, leaves })
}

/// The parabola of the longest side from a place on, in a direction along the spline, in which residuals are as small as noise is. Its
/// tangent runs along the spline.
fn side(
    spline: &Spline,
    from: f64,
    sign: f64,
    room: f64,
    node: &Node,
    window: &mut Window,
) -> Option<Parabola> {
    let whole = spline.length();
    let [mut length, longest] = SIDE_DEVIATIONS.map(|side| side * node.deviation);
    let left = match (spline.closed, sign > 0.0) {
        (true, _) => 0.25 * whole,
        (false, true) => whole - from,
        (false, false) => from,
    };
    let longest = longest.min(room).min(left);
    let mut best = None;
    while length <= longest {
        let middle = from + 0.5 * sign * length;
        let middle = if spline.closed { middle.rem_euclid(whole) } else { middle };
        let members = around(spline, middle, 0.5 * length);
        let points = members.into_iter().flatten().map(|m| m.at);
        if points.clone().count() >= SIDE_POINTS_MIN as usize {
            // The frame's origin is the spline's place next to the corner.
            let origin = spline.place(if spline.closed { from.rem_euclid(whole) } else { from });
            let found = window.fit(origin.0, points)?;
            if found.variance.sqrt() > SIDE_DEVIATION_RATIO_MAX * node.deviation {
                break;
            }
            best = Some(if angle(found.tangent, origin.1).abs() > 0.5 * PI {
                found.reversed()
            } else {
                found
            });
        }
        length *= SIDE_GROWTH;
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

#[cfg(test)]
mod tests {
    use taut_points::generate::{Distribution, generate};

    use super::super::spline::assign;
    use super::*;

    const NOISE: f64 = 0.01;

    /// A spline through points around sides of a length, each turned by so many degrees against the one before, from a node on.
    /// Nodes cut corners as windows do, by the way six deviations before to six after.
    fn around_sides(
        turns: &[f64],
        length: f64,
        closed: bool,
        first: usize,
    ) -> (Spline, Vec<Point>) {
        let (mut ends, mut angle) = (vec![[0.0, 0.0]], 0.0f64);
        for turn in turns {
            let [x, y] = ends[ends.len() - 1];
            ends.push([x + length * angle.cos(), y + length * angle.sin()]);
            angle += turn.to_radians();
        }
        let sides = turns.len() as f64;
        let place = |arc: f64| {
            let side = (arc / length).clamp(0.0, sides - 1.0).floor() as usize;
            let t = (arc - side as f64 * length) / length;
            [0, 1].map(|c| ends[side][c] + t * (ends[side + 1][c] - ends[side][c]))
        };
        let whole = sides * length;
        let wrapped = |arc: f64| if closed { arc.rem_euclid(whole) } else { arc };
        let node = |k: usize| {
            let arc = 2.0 * NOISE * k as f64;
            let [p, q] = [-6.0, 6.0].map(|off| place(wrapped(arc + off * NOISE)));
            let (x, y) = (q[0] - p[0], q[1] - p[1]);
            let tangent = [x / x.hypot(y), y / x.hypot(y)];
            let at = [0, 1].map(|c| 0.25 * (p[c] + q[c]) + 0.5 * place(arc)[c]);
            Node { at, tangent, leaving: tangent, reach: 0.1, deviation: NOISE, error: NOISE }
        };
        let count = (whole / (2.0 * NOISE)) as usize;
        let mut nodes: Vec<Node> = (0..count).map(node).collect();
        nodes.rotate_left(first);
        let spline = Spline::new(nodes, closed, 1);
        // Six points for each deviation, off by up to √3 of it.
        let lots = generate(Distribution::Uniform, 6 * (whole / NOISE) as usize, 2, 1).unwrap();
        let point = |lots: &[f64]| {
            let side = ((sides * lots[0]) as usize).min(ends.len() - 2);
            let [p, q] = [ends[side], ends[side + 1]];
            let off = 3f64.sqrt() * NOISE * (2.0 * lots[1] - 1.0) / length;
            let [x, y] = place(whole * lots[0]);
            [x - off * (q[1] - p[1]), y + off * (q[0] - p[0])]
        };
        let points: Vec<Point> = lots.chunks_exact(2).map(point).collect();
        let mut splines = [spline];
        assign(&mut splines, &points, 5.0);
        let [spline] = splines;
        (spline, ends)
    }

    fn found_at(spline: &Spline) -> Vec<Point> {
        corners(spline).iter().map(|corner| corner.at).collect()
    }

    fn is_near(found: &[Point], wanted: Point) -> bool {
        found.iter().any(|at| (at[0] - wanted[0]).hypot(at[1] - wanted[1]) < NOISE)
    }

    #[test]
    fn the_corners_of_a_square_are_found_wherever_it_begins() {
        for first in [0, 1, 7, 30, 99] {
            let (spline, ends) = around_sides(&[90.0; 4], 1.0, true, first);
            let found = found_at(&spline);
            assert_eq!(found.len(), 4, "{first}: {found:?}");
            assert!(ends.iter().all(|&end| is_near(&found, end)), "{first}: {found:?}");
        }
    }

    #[test]
    fn turns_from_30_degrees_on_are_corners() {
        for (turn, wanted) in [(15.0, 0), (25.0, 0), (40.0, 1), (120.0, 1)] {
            let (spline, ends) = around_sides(&[turn, 0.0], 1.0, false, 0);
            let found = found_at(&spline);
            assert_eq!(found.len(), wanted, "{turn}: {found:?}");
            assert!(wanted == 0 || is_near(&found, ends[1]), "{turn}: {found:?}");
        }
    }

    #[test]
    fn a_corner_next_to_an_end_has_no_side() {
        let (mut spline, _) = around_sides(&[90.0, 0.0], 1.0, false, 0);
        let skipped = 45;
        let cut = spline.arc[skipped];
        spline.nodes.drain(..skipped);
        spline.arc.drain(..skipped);
        spline.arc.iter_mut().for_each(|arc| *arc -= cut);
        spline.members.iter_mut().for_each(|member| member.arc -= cut);
        spline.members.retain(|member| member.arc > 0.0);
        assert!(corners(&spline).is_empty());
    }

    #[test]
    fn corners_take_the_place_of_the_nodes_they_spoil() {
        let (spline, ends) = around_sides(&[90.0; 4], 1.0, true, 1);
        let found = corners(&spline);
        let mut nodes = spline.nodes.clone();
        insert(&mut nodes, &spline, &found);
        let sharp: Vec<Point> =
            nodes.iter().filter(|node| node.tangent != node.leaving).map(|node| node.at).collect();
        assert_eq!(sharp.len(), 4);
        assert!(ends.iter().all(|&end| is_near(&sharp, end)));
        // Six deviations on either side, at two of them from node to node.
        assert!((200 - 4 * 7 + 4..=200 - 4 * 5 + 4).contains(&nodes.len()), "{}", nodes.len());
        insert(&mut nodes, &spline, &[]);
        assert_eq!(nodes.iter().filter(|node| node.tangent != node.leaving).count(), 4);
    }

    #[test]
    fn parabolas_meet_where_they_do() {
        let line = |origin: Point, degrees: f64, bend: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let coefficients = [0.0, 0.0, bend];
            Parabola { origin, tangent: [cos, sin], coefficients, variance: 1.0, kept: 10 }
        };
        let (u, v) = meet(&line([0.0, 0.0], 0.0, 0.0), &line([1.0, 1.0], 90.0, 0.0), 1.0).unwrap();
        assert!((u - 1.0).abs() < 1e-12 && (v + 1.0).abs() < 1e-12);
        // y = x²/2 and the line x = 1.
        let (u, v) = meet(&line([0.0, 0.0], 0.0, 0.5), &line([1.0, 1.0], 90.0, 0.0), 1.0).unwrap();
        assert!((u - 1.0).abs() < 1e-12 && (v + 0.5).abs() < 1e-12);
        assert!(meet(&line([0.0, 0.0], 0.0, 0.0), &line([1.0, 1.0], 0.0, 0.0), 1.0).is_none());
        assert!(meet(&line([0.0, 0.0], 0.0, 0.0), &line([9.0, 1.0], 90.0, 0.0), 1.0).is_none());
    }

    #[test]
    fn neighbors_are_in_a_row_or_around() {
        assert_eq!(beside(3, 0, false), [None, Some(1)]);
        assert_eq!(beside(3, 0, true), [Some(2), Some(1)]);
        assert_eq!(beside(3, 2, true), [Some(1), Some(0)]);
        assert_eq!(beside(1, 0, true), [None, None]);
    }
}
