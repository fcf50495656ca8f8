//! Decides whether two triangles share more than their common vertices.
//!
//! *Problem.* Triangles A and B with area, s of whose vertices are common: is there a point in both that is not in the hull of
//! these?
//! *Idea.* s = 3: always. s = 2: if they lie in one plane on the same side of the edge. s = 1: both are convex, so a common point
//! brings the way to the common vertex p with it, and the first of the sides opposite p on this way is in the other triangle;
//! so it is asked whether such a side meets the other triangle. s = 0: as convex sets they meet if and only if a side of one
//! meets the other. A side that is not in the plane of a triangle meets it if its ends are not on one side of the plane and
//! its line runs around no two sides of the triangle in different directions; one in the plane is seen in a projection along
//! an axis that keeps the triangle's area.
//! *Guarantee.* Exact, as all is said by signs of orientations.
//! *Trap.* For s = 1 touching the plane of the other triangle in p means nothing; the two other corners count alone.
//! *Reference.* Guigue, Devillers, Journal of Graphics Tools 8(1), 2003, for the signs that decide the case s = 0.

use taut_predicates::{Sign, plane, space};

use crate::crossing;

/// A triangle with area, and the names of its vertices.
#[derive(Clone, Copy)]
pub(super) struct Face {
    pub(super) names: [u32; 3],
    pub(super) corners: [[f64; 3]; 3],
}

impl Face {
    fn swap(&mut self, i: usize, j: usize) {
        self.names.swap(i, j);
        self.corners.swap(i, j);
    }
}

/// Returns true if two triangles with area share a point that is not in the hull of their common vertices.
pub(super) fn meet(mut a: Face, mut b: Face) -> bool {
    // Common vertices come first, in the same order.
    let mut common = 0;
    for i in 0..3 {
        if let Some(j) = (common..3).find(|&j| b.names[j] == a.names[i]) {
            a.swap(common, i);
            b.swap(common, j);
            common += 1;
        }
    }
    let (p, q) = (&a.corners, &b.corners);
    match common {
        3 => true,
        2 => space::orient(p[0], p[1], p[2], q[2]).is_zero() && overlap_at_edge(p, q),
        _ => {
            let of_q = sides(p, q, common);
            if apart(&of_q[common..]) {
                return false;
            }
            let of_p = sides(q, p, common);
            if apart(&of_p[common..]) {
                return false;
            }
            // Of triangles with a common vertex the sides opposite alone.
            let asked: &[[usize; 2]] =
                if common == 1 { &[[1, 2]] } else { &[[0, 1], [1, 2], [2, 0]] };
            asked.iter().any(|&[i, j]| {
                pierces(p, [q[i], q[j]], [of_q[i], of_q[j]])
                    || pierces(q, [p[i], p[j]], [of_p[i], of_p[j]])
            })
        }
    }
}

/// Tests whether the corners of a triangle are not on one line.
pub(super) fn has_area(corners: &[[f64; 3]; 3]) -> bool {
    (0..3).any(|axis| !turn(corners, axis).is_zero())
}

/// On which side of a triangle the corners of the other are; the common ones, which come first, are in its plane.
fn sides([a, b, c]: &[[f64; 3]; 3], other: &[[f64; 3]; 3], common: usize) -> [Sign; 3] {
    std::array::from_fn(
        |k| {
            if k < common { Sign::Zero } else { space::orient(*a, *b, *c, other[k]) }
        },
    )
}

/// Returns true if all are on the same side, and none in the plane.
fn apart(sides: &[Sign]) -> bool {
    !sides[0].is_zero() && sides.iter().all(|&side| side == sides[0])
}

/// Tests whether not two of these are opposite.
fn agree(signs: [Sign; 3]) -> bool {
    !(signs.contains(&Sign::Positive) && signs.contains(&Sign::Negative))
}

/// Tests whether a segment, its ends on these sides of the triangle's plane, meets the triangle.
fn pierces(triangle: &[[f64; 3]; 3], [p, q]: [[f64; 3]; 2], ends: [Sign; 2]) -> bool {
    let [a, b, c] = *triangle;
    match ends {
        [Sign::Zero, Sign::Zero] => meets_in_plane(triangle, [p, q]),
        [one, other] if one == other => false,
        _ => agree([[a, b], [b, c], [c, a]].map(|[from, to]| space::orient(p, q, from, to))),
    }
}

/// Tests whether a segment of the triangle's plane meets the triangle.
fn meets_in_plane(triangle: &[[f64; 3]; 3], segment: [[f64; 3]; 2]) -> bool {
    let axis = axis_with_area(triangle);
    let [a, b, c] = triangle.map(|p| project(p, axis));
    let [p, q] = segment.map(|p| project(p, axis));
    let around = [[a, b], [b, c], [c, a]];
    agree(around.map(|[from, to]| plane::orient(from, to, p)))
        || around.iter().any(|&[from, to]| crossing::meet((p, q), (from, to)))
}

/// Tests whether two triangles of one plane, whose first two corners are common, lie on the same side of that edge.
fn overlap_at_edge(p: &[[f64; 3]; 3], q: &[[f64; 3]; 3]) -> bool {
    let axis = axis_with_area(p);
    turn(p, axis) == turn(q, axis)
}

/// Along this axis the triangle is not seen as a line.
fn axis_with_area(triangle: &[[f64; 3]; 3]) -> usize {
    (0..2).find(|&axis| !turn(triangle, axis).is_zero()).unwrap_or(2)
}

/// Which way round the triangle is seen along an axis.
fn turn(triangle: &[[f64; 3]; 3], axis: usize) -> Sign {
    let [a, b, c] = triangle.map(|p| project(p, axis));
    plane::orient(a, b, c)
}

/// The two coordinates that are not along the axis.
fn project(p: [f64; 3], axis: usize) -> [f64; 2] {
    [p[(axis + 1) % 3], p[(axis + 2) % 3]]
}
