//! The way to the triangle that holds the query point.
//!
//! *Idea.* From a triangle step across any edge that has q strictly on its other side, never back across the edge just
//! crossed, until there is none.
//! *Guarantee.* In a Delaunay triangulation no order of such steps comes back to a triangle, so the walk ends: in a
//! triangle that holds q, on its border perhaps, or in a ghost whose hull edge has q strictly outside. Either is in
//! conflict with q.

use taut_predicates::{Exact, MulAdd};

use super::seen::{PointOffset, View, minor};
use crate::kernel::Counters;
use crate::simplex::{DEAD_MARK, GHOST, decode};
use crate::threads::{Hold, Slot};

/// Steps beside other threads, at most: along a line of sites a walk may have as many as there are sites, but it could go in a
/// circle while triangles change.
const STEPS_MAX: u64 = 1 << 20;

/// The triangle (d, b, a) that was found, d being at place `facet`, and its minors.
#[derive(Clone, Copy)]
pub(super) struct LocatedTriangle {
    pub(super) triangle: u32,
    pub(super) facet: usize,
    /// d, b and a.
    pub(super) vertices: [u32; 3],
    pub(super) a: PointOffset,
    pub(super) b: PointOffset,
    pub(super) d: PointOffset,
    pub(super) ba: f64,
    pub(super) ad: f64,
    pub(super) db: f64,
}

impl LocatedTriangle {
    /// Tests whether the triangle is there, and has these vertices.
    pub(super) fn is_at(&self, triangles: &[impl Slot<3>]) -> bool {
        let t = &triangles[self.triangle as usize];
        let places = [self.facet, NEXT_FACET[self.facet], LAST_FACET[self.facet]];
        self.vertices == places.map(|place| t.vertex(place))
    }
}

/// Tests whether these are the vertices of a triangle, and not those of a dead slot, or of one that was never written.
pub(super) fn is_triangle([first, second, third]: [u32; 3]) -> bool {
    let is_dead = [first, second, third].contains(&DEAD_MARK);
    !is_dead && first != second && second != third && third != first
}

/// The way from a triangle to the one that holds q, or to a ghost. Beside other threads it may come to a dead slot, or not end
/// in reasonable time: then it says where it stands, and else it is one only if the triangle [`is_at`](LocatedTriangle::is_at) its
/// place once it is held.
#[inline(always)]
pub(super) fn walk<M: MulAdd, H: Hold>(
    view: &View<'_>,
    triangles: &[H::Slot<3>],
    from: u32,
    exact: &mut Exact,
    counters: &mut Counters,
) -> Result<LocatedTriangle, u32> {
    // As if the first triangle had been entered through the edge opposite its vertex 0; that edge is looked at once.
    let mut triangle = from;
    let vertices = triangles[triangle as usize].vertices();
    if let Some(place) = vertices.iter().position(|&v| v == GHOST) {
        triangle = decode(triangles[triangle as usize].neighbor(place)).0;
    }
    let mut facet = 0;
    let vertices = triangles[triangle as usize].vertices();
    if H::SHARED && (!is_triangle(vertices) || vertices.contains(&GHOST)) {
        return Err(triangle);
    }
    let [_, b, a] = vertices;
    let (mut a_id, mut b_id) = (a, b);
    let (mut a, mut b) = (view.see::<M>(a), view.see::<M>(b));
    let mut ba = minor::<M>(b, a);
    if strictly_right::<M>(view, (b_id, b), (a_id, a), ba, exact) {
        (triangle, facet) = decode(triangles[triangle as usize].neighbor(0));
        (a, b) = (b, a);
        (a_id, b_id) = (b_id, a_id);
        ba = -ba;
    }
    let mut steps = 0;
    loop {
        steps += 1;
        let t = &triangles[triangle as usize];
        let d_id = t.vertex(facet);
        if H::SHARED && (d_id == DEAD_MARK || steps > STEPS_MAX) {
            return Err(triangle);
        }
        let d = view.see::<M>(d_id);
        let (ad, db) = (minor::<M>(a, d), minor::<M>(d, b));
        if strictly_right::<M>(view, (a_id, a), (d_id, d), ad, exact) {
            (triangle, facet) = decode(t.neighbor(NEXT_FACET[facet]));
            (b, b_id, ba) = (d, d_id, -ad);
        } else if strictly_right::<M>(view, (d_id, d), (b_id, b), db, exact) {
            (triangle, facet) = decode(t.neighbor(LAST_FACET[facet]));
            (a, a_id, ba) = (d, d_id, -db);
        } else {
            counters.walk_steps += steps;
            counters.orientations += 2 * steps + 1;
            let vertices = [d_id, b_id, a_id];
            return Ok(LocatedTriangle { triangle, facet, vertices, a, b, d, ba, ad, db });
        }
    }
}

/// The place after this one, counter-clockwise.
pub(super) const NEXT_FACET: [usize; 4] = [1, 2, 0, 0];
/// The place before this one.
pub(super) const LAST_FACET: [usize; 4] = [2, 0, 1, 0];

/// Returns true if q lies strictly to the right of the directed edge from u to v. It does of no edge at the ghost vertex.
#[inline(always)]
fn strictly_right<M: MulAdd>(
    view: &View<'_>,
    u: (u32, PointOffset),
    v: (u32, PointOffset),
    uv: f64,
    exact: &mut Exact,
) -> bool {
    let side = view.side::<M>(u.1, v.1, uv);
    side < 0.0 || (side == 0.0 && strictly_right_exact(view, u.0, v.0, exact))
}

#[cold]
#[inline(never)]
fn strictly_right_exact(view: &View<'_>, u: u32, v: u32, exact: &mut Exact) -> bool {
    u != GHOST && v != GHOST && view.side_exact(u, v, exact).is_negative()
}
