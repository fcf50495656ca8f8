//! Decides whether two triangles of space share more than their common vertices, exactly.
//!
//! *Idea.* Triangles without a common vertex meet if an edge of one meets the other. Those with one common vertex are convex sets that
//! share it: if they share another point, they share the segment to it, which can be prolonged until it leaves one of them, through
//! the edge opposite the common vertex; so that edge of one meets the other. Those with a common edge share more if they lie in one
//! plane on the same side of the edge, and only then.

use std::cmp::Ordering;

use super::places::{axes, side};
use super::separated::are_separated;
use super::tree::Area;
use crate::triangulation::{Signs, turn};

type Point = [f64; 3];

/// A triangle that is not flat: its rows, and where they are.
#[derive(Clone, Copy)]
pub(super) struct Face {
    pub(super) rows: [u32; 3],
    pub(super) corners: [Point; 3],
}

impl Face {
    /// Vertices and corners from one of them on.
    fn turned(&self, first: usize) -> Face {
        let at = |k: usize| (first + k) % 3;
        Face {
            rows: [0, 1, 2].map(|k| self.rows[at(k)]),
            corners: [0, 1, 2].map(|k| self.corners[at(k)]),
        }
    }

    fn place(&self, row: u32) -> Option<usize> {
        self.rows.iter().position(|&own| own == row)
    }
}

/// Tests whether two triangles, not flat and not of the same vertices, share a point that is not on a common vertex or edge.
pub(super) fn meet(signs: &Signs, one: &Face, other: &Face) -> bool {
    if are_separated(signs, one, other) {
        return false;
    }
    let common = |k: usize| other.place(one.rows[k]).map(|place| (k, place));
    let (first, second) = match [0, 1, 2].map(common) {
        [None, None, None] => return meet_apart(signs, &one.corners, &other.corners),
        [Some(first), second, None] => (first, second),
        [Some(first), None, third] => (first, third),
        [None, Some(first), third] => (first, third),
        [None, None, Some(first)] => (first, None),
        // All vertices in common, which was refused: whatever is said, a triangle does meet itself.
        [Some(_), Some(_), Some(_)] => return true,
    };
    let Some(second) = second else {
        let (one, other) = (one.turned(first.0).corners, other.turned(first.1).corners);
        return meets(signs, [one[1], one[2]], &other) || meets(signs, [other[1], other[2]], &one);
    };
    let [u, v, a] = [first.0, second.0, 3 - first.0 - second.0].map(|k| one.corners[k]);
    let b = other.corners[3 - first.1 - second.1];
    if side(signs, &[u, v, a], &b).is_ne() {
        return false;
    }
    // In a plane where one triangle has an area, so has the other, unless it is flat.
    let Some(axes) = axes(signs, &[u, v, a]) else { return true };
    turn(signs, &u, &v, &a, axes) == turn(signs, &u, &v, &b, axes)
}

/// Tests whether two triangles have a point in common.
fn meet_apart(signs: &Signs, one: &[Point; 3], other: &[Point; 3]) -> bool {
    if is_beside(signs, one, other) || is_beside(signs, other, one) {
        return false;
    }
    let sides = |[a, b, c]: [Point; 3]| [[a, b], [b, c], [c, a]];
    sides(*one).into_iter().any(|edge| meets(signs, edge, other))
        || sides(*other).into_iter().any(|edge| meets(signs, edge, one))
}

/// Tests whether all corners of the other triangle are on one side of the plane of this one.
fn is_beside(signs: &Signs, one: &[Point; 3], other: &[Point; 3]) -> bool {
    let first = side(signs, one, &other[0]);
    first.is_ne() && other[1..].iter().all(|p| side(signs, one, p) == first)
}

/// Tests whether a segment has a point in common with a triangle that is not flat.
fn meets(signs: &Signs, [p, q]: [Point; 2], triangle: &[Point; 3]) -> bool {
    let [a, b, c] = *triangle;
    let (at_p, at_q) = (side(signs, triangle, &p), side(signs, triangle, &q));
    if at_p == at_q {
        return at_p.is_eq() && meets_in_plane(signs, [p, q], triangle);
    }
    // The line cuts the plane in one point, which is inside if it sees no two edges turn different ways.
    let turns = [[a, b], [b, c], [c, a]].map(|[s, t]| side(signs, &[p, q, s], &t));
    !(turns.contains(&Ordering::Less) && turns.contains(&Ordering::Greater))
}

/// The same in one plane.
fn meets_in_plane(signs: &Signs, [p, q]: [Point; 2], triangle: &[Point; 3]) -> bool {
    // A flat triangle is never asked about.
    let Some(axes) = axes(signs, triangle) else { return true };
    let [a, b, c] = *triangle;
    let mut edges = [[a, b], [b, c], [c, a]].into_iter();
    contains_in_plane(signs, triangle, &p, axes)
        || edges.any(|edge| segments_meet(signs, [p, q], edge, axes))
}

/// Tests whether a point of the plane of a triangle is on it; of a flat one, whether it is in the box around it.
pub(super) fn contains(signs: &Signs, triangle: &[Point; 3], p: &Point) -> bool {
    match axes(signs, triangle) {
        Some(axes) => contains_in_plane(signs, triangle, p, axes),
        None => Area::of(triangle).meets(&Area::of(&[*p])),
    }
}

fn contains_in_plane(signs: &Signs, [a, b, c]: &[Point; 3], p: &Point, axes: [usize; 2]) -> bool {
    let turns = [[a, b], [b, c], [c, a]].map(|[s, t]| turn(signs, s, t, p, axes));
    !(turns.contains(&Ordering::Less) && turns.contains(&Ordering::Greater))
}

/// Tests whether two segments of a plane meet, as seen along the third axis.
fn segments_meet(signs: &Signs, [a, b]: [Point; 2], [c, d]: [Point; 2], axes: [usize; 2]) -> bool {
    let of = |s: &Point, t: &Point, p: &Point| turn(signs, s, t, p, axes);
    let [abc, abd, cda, cdb] = [of(&a, &b, &c), of(&a, &b, &d), of(&c, &d, &a), of(&c, &d, &b)];
    if [abc, abd, cda, cdb].iter().all(|turn| turn.is_ne()) {
        return abc != abd && cda != cdb;
    }
    let is_between = |s: &Point, t: &Point, p: &Point| {
        axes.iter().all(|&k| s[k].min(t[k]) <= p[k] && p[k] <= s[k].max(t[k]))
    };
    abc.is_eq() && is_between(&a, &b, &c)
        || abd.is_eq() && is_between(&a, &b, &d)
        || cda.is_eq() && is_between(&c, &d, &a)
        || cdb.is_eq() && is_between(&c, &d, &b)
}
