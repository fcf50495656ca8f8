//! The cavity of the query point, edge by edge counter-clockwise around it.
//!
//! *Idea.* The triangles in conflict with q form a disc without inner vertices, so from edge to edge they are a tree
//! and no marks are needed. Look through an edge (a, b) of the disc so far, with a to b counter-clockwise around q: is
//! the triangle behind it, (d, b, a), in conflict? If so it joins the disc, and its edges (a, d) and (d, b) are next, in
//! this order. If not, (a, b) belongs to the rim.
//! *Guarantee.* The rim comes out in counter-clockwise order and closed, each triangle of the disc once; the minor [ab]
//! is positive or, if q lies on the edge, zero.
//! *Trap.* A ghost has no circle: it is in conflict iff q lies strictly outside its hull edge, or on that edge between
//! the ends. Its own sign is filtered as well, or every site near the hull would be counted as an exact call.

use taut_predicates::{Exact, MulAdd, Sign};

use super::seen::{PointOffset, View, minor};
use super::walk::{LAST_FACET, LocatedTriangle, NEXT_FACET};
use crate::kernel::Counters;
use crate::simplex::{GHOST, decode};
use crate::threads::{Hold, Slot};

/// An edge (a, b) with what is behind it: the facet of the triangle (d, b, a) and whether that is in conflict.
///
/// All this is computed as soon as the edge is known, before its turn: by then nobody waits for it, above all not the
/// branch on `conflict`, which goes one way as often as the other. To look through an edge in its turn instead makes
/// an entry half as long and a build two per cent slower.
#[derive(Clone, Copy)]
pub(super) struct Edge {
    behind: u32,
    conflict: bool,
    b: PointOffset,
    d: PointOffset,
    ad: f64,
    db: f64,
}

/// The receiver of the cavity.
pub(super) trait Sink {
    /// A triangle is in conflict; everything of it that will be asked for has been read.
    fn enter(&mut self, triangle: u32);

    /// An edge of the rim, the facet behind it, and where the edge ends.
    fn rim(&mut self, behind: u32, edge: [u32; 2], end: PointOffset);
}

/// Digs from a triangle that is held, and holds the others. Returns false, having told a part, if another thread holds one.
#[inline(always)]
pub(super) fn dig<M: MulAdd, S: Sink, H: Hold>(
    view: &View<'_>,
    triangles: &[H::Slot<3>],
    hold: &mut H,
    found: LocatedTriangle,
    pending: &mut Vec<Edge>,
    exact: &mut Exact,
    counters: &mut Counters,
    sink: &mut S,
) -> bool {
    let first = triangles[found.triangle as usize].neighbors();
    let mut entered = 0;
    pending.push(look::<M>(
        view,
        triangles,
        first[NEXT_FACET[found.facet]],
        [found.a, found.d],
        found.ad,
        exact,
    ));
    pending.push(look::<M>(
        view,
        triangles,
        first[found.facet],
        [found.b, found.a],
        found.ba,
        exact,
    ));
    let mut a = found.d;
    let mut edge = look::<M>(
        view,
        triangles,
        first[LAST_FACET[found.facet]],
        [found.d, found.b],
        found.db,
        exact,
    );
    loop {
        let (triangle, facet) = decode(edge.behind);
        let t = &triangles[triangle as usize];
        // Before the branch, as nobody can foresee which way it goes: what comes after it waits. Written in both branches, these took
        // 3 % of an insertion.
        let (next, last) = (NEXT_FACET[facet], LAST_FACET[facet]);
        if edge.conflict {
            if H::SHARED && !hold.hold([t.vertex(facet)]) {
                pending.clear();
                return false;
            }
            entered += 1;
            let (left, right) = (t.neighbor(next), t.neighbor(last));
            pending.push(look::<M>(view, triangles, right, [edge.d, edge.b], edge.db, exact));
            edge = look::<M>(view, triangles, left, [a, edge.d], edge.ad, exact);
            sink.enter(triangle);
        } else {
            let (from, to) = (t.vertex(last), t.vertex(next));
            sink.rim(edge.behind, [from, to], edge.b);
            a = edge.b;
            let Some(nearest) = pending.pop() else { break };
            edge = nearest;
        }
    }
    // Three edges of the first triangle, and two more of each that was entered.
    counters.conflict_tests += 3 + 2 * entered;
    counters.replaced += entered;
    true
}

/// Looks through the edge (a, b) of a triangle in conflict.
#[inline(always)]
fn look<M: MulAdd>(
    view: &View<'_>,
    triangles: &[impl Slot<3>],
    behind: u32,
    [a, b]: [PointOffset; 2],
    ab: f64,
    exact: &mut Exact,
) -> Edge {
    let (triangle, facet) = decode(behind);
    let d = view.see::<M>(triangles[triangle as usize].vertex(facet));
    let (ad, db) = (minor::<M>(a, d), minor::<M>(d, b));
    let determinant = view.in_circle::<M>([a, b, d], [ab, ad, db]);
    let conflict = if determinant == 0.0 {
        conflict_exact(view, triangles, behind, exact)
    } else {
        determinant > 0.0
    };
    Edge { behind, conflict, b, d, ad, db }
}

/// The conflict of the triangle that a code names, with exact arithmetic where filters do not do; it is looked at from
/// a triangle in conflict.
///
/// The three vertices stay in registers. If they are stored one by one as an array and loaded together, the load waits for the stores,
/// which took 9 % of the time of a grid.
#[cold]
#[inline(never)]
fn conflict_exact(
    view: &View<'_>,
    triangles: &[impl Slot<3>],
    behind: u32,
    exact: &mut Exact,
) -> bool {
    let (triangle, facet) = decode(behind);
    let [a, b, c] = triangles[triangle as usize].vertices();
    let (place, from, to) = if a == GHOST {
        (0, b, c)
    } else if b == GHOST {
        (1, c, a)
    } else if c == GHOST {
        (2, a, b)
    } else {
        return view.conflict_exact(a, b, c, exact);
    };
    match view.side_exact(from, to, exact) {
        Sign::Positive => true,
        Sign::Negative => false,
        // Between the ends q is in the hull, and no ghost but this one is near: it is seen through its hull edge, from a
        // triangle whose circle meets the line of the edge between the ends alone. Beyond them it is seen from a ghost.
        Sign::Zero => place == facet,
    }
}
