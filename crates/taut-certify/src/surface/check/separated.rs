//! Decides whether two triangles are separated by an edge of one of them, seen along an axis: a test in plain arithmetic that never errs where
//! it says yes.
//!
//! *Idea.* Let all common vertices be ends of an edge of one triangle, its third vertex on one side of the line of that edge as seen
//! along the axis, and the other vertices of the other triangle strictly on the other side. What the triangles share is then seen
//! on the line, where the other triangle has nothing but the hull of the common vertices.
//! *Why.* Neighbors in one plane, which leave the sign of a determinant in space to whole numbers, are separated by their edges in
//! that plane: two coordinates tell them apart, with bits to spare.

use super::meet::Face;
use crate::arithmetic::U;
use crate::triangulation::{Signs, UNDERFLOW};

/// Pairs of coordinates that are seen along the third axis.
const VIEWS: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];

/// The error of a turn, over the sum of its two products: two differences, a product and a difference, and once more for the bound
/// itself. All sizes are below 1.
const ROUNDING: f64 = 5.0 * U;

/// Returns true if two triangles surely share no more than the hull of their common vertices.
pub(super) fn are_separated(signs: &Signs, one: &Face, other: &Face) -> bool {
    signs.is_filtered
        && VIEWS
            .into_iter()
            .any(|axes| is_cut_off(one, other, axes) || is_cut_off(other, one, axes))
}

/// Tests whether an edge of `one` separates the two.
fn is_cut_off(one: &Face, other: &Face, axes: [usize; 2]) -> bool {
    (0..3).any(|k| {
        let [s, t] = [(k + 1) % 3, (k + 2) % 3].map(|end| &one.corners[end]);
        let side = sure_turn(s, t, &one.corners[k], axes);
        side != 0.0
            && !other.rows.contains(&one.rows[k])
            && (0..3).all(|at| {
                one.rows.contains(&other.rows[at])
                    || sure_turn(s, t, &other.corners[at], axes) * side < 0.0
            })
    })
}

/// 1 or −1 for the sign of the turn of three points as seen along an axis, 0 where rounding leaves it open.
#[inline(always)]
fn sure_turn(s: &[f64; 3], t: &[f64; 3], p: &[f64; 3], [i, j]: [usize; 2]) -> f64 {
    let rising = (t[i] - s[i]) * (p[j] - s[j]);
    let falling = (t[j] - s[j]) * (p[i] - s[i]);
    let bound = ROUNDING * (rising.abs() + falling.abs()) + UNDERFLOW;
    match rising - falling {
        turn if turn > bound => 1.0,
        turn if turn < -bound => -1.0,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIGNS: Signs = Signs { is_filtered: true, quantum: 0.0 };

    fn face(rows: [u32; 3], corners: [[f64; 3]; 3]) -> Face {
        Face { rows, corners }
    }

    /// Four points of a plane that is level with no axis, and two triangles of the quadrilateral.
    #[test]
    fn neighbors_in_one_plane_are_separated() {
        let [a, b, c, d] =
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[u, v]: [f64; 2]| {
                [0.1 * u + 0.3 * v + 0.3, 0.2 * u - 0.1 * v + 0.3, 0.7 * u + 0.1 * v]
            });
        let [abc, acd] = [face([0, 1, 2], [a, b, c]), face([0, 2, 3], [a, c, d])];
        assert!(are_separated(&SIGNS, &abc, &acd) && are_separated(&SIGNS, &acd, &abc));
        // The other diagonal, on the same side of the common edge.
        let abd = face([0, 1, 3], [a, b, d]);
        assert!(!are_separated(&SIGNS, &abc, &abd) && !are_separated(&SIGNS, &abd, &abc));
        // One common vertex, and none.
        let beyond = [c, d].map(|p| p.map(|x| x - 0.5));
        let at_vertex =
            face([0, 4, 5], [a, beyond[0].map(|x| x - 0.5), beyond[1].map(|x| x - 0.5)]);
        assert!(are_separated(&SIGNS, &abc, &at_vertex));
        let far = face([6, 7, 8], [a, b, c].map(|p| p.map(|x| x - 0.5)));
        assert!(are_separated(&SIGNS, &abc, &far));
    }

    /// A vertex of one on the line of an edge of the other by less than rounding tells.
    #[test]
    fn what_rounding_leaves_open_is_not_separated() {
        let abc = face([0, 1, 2], [[0.0; 3], [0.5, 0.5, 0.0], [0.5, 0.0, 0.0]]);
        let with = |off: f64| {
            let on = [0.25, 0.25 + off, 0.0];
            face([3, 4, 5], [on, [0.0, 0.5, 0.0], [0.0, 0.75, 0.1]])
        };
        assert!(!are_separated(&SIGNS, &abc, &with(0.0)));
        assert!(are_separated(&SIGNS, &abc, &with(1e-12)));
        let unfiltered = Signs { is_filtered: false, quantum: 0.0 };
        assert!(!are_separated(&unfiltered, &abc, &with(0.1)));
    }
}
