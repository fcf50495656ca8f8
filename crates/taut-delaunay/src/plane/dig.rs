//! The cavity of the query point, edge by edge counter-clockwise around it.
//!
//! *Idea.* The triangles in conflict with q form a disc without inner vertices, so from edge to edge they are a tree
//! and no marks are needed. Look through an edge (a, b) of the disc so far, with a to b counter-clockwise around q: is
//! the triangle behind it, (d, b, a), in conflict? If so it joins the disc, and its edges (a, d) and (d, b) are next, in
//! this order. If not, (a, b) belongs to the rim.
//! *Guarantee.* The rim comes out in counter-clockwise order and closed, each triangle of the disc once; the minor [ab]
//! is positive or, if q lies on the edge, zero.
//! *Trap.* A ghost has no circle: it is in conflict iff q lies strictly outside its hull edge, or on the line of that
//! edge with the finite triangle behind the edge in conflict, which is to say between its ends. Its own sign is
//! filtered as well, or every site near the hull would be counted as an exact call.

use taut_predicates::{Exact, Sign};

use super::seen::{Seen, View, minor};
use super::walk::{Found, LAST, NEXT};
use crate::kernel::Counters;
use crate::simplex::{GHOST, Simplex, code, decode};

/// An edge (a, b) with what is behind it: the facet of the triangle (d, b, a) and whether that is in conflict.
///
/// All this is computed as soon as the edge is known, before its turn: by then nobody waits for it, above all not the
/// branch on `conflict`, which goes one way as often as the other.
#[derive(Clone, Copy)]
pub(super) struct Edge {
    behind: u32,
    conflict: bool,
    b: Seen,
    d: Seen,
    ad: f64,
    db: f64,
}

/// What becomes of the cavity.
pub(super) trait Sink {
    /// A triangle is in conflict; everything of it that will be asked for has been read.
    fn enter(&mut self, triangle: u32);

    /// An edge of the rim, the facet behind it, and where the edge ends.
    fn rim(&mut self, triangles: &mut [Simplex<3>], behind: u32, edge: [u32; 2], end: Seen);
}

#[inline(always)]
pub(super) fn dig<S: Sink>(
    view: &View<'_>,
    triangles: &mut [Simplex<3>],
    found: Found,
    pending: &mut Vec<Edge>,
    exact: &mut Exact,
    counters: &mut Counters,
    sink: &mut S,
) {
    let first = triangles[found.triangle as usize].neighbors;
    let (mut tests, mut entered) = (3, 0);
    pending.push(look(view, triangles, first[NEXT[found.facet]], [found.a, found.d], found.ad, exact));
    pending.push(look(view, triangles, first[found.facet], [found.b, found.a], found.ba, exact));
    let mut a = found.d;
    let mut edge = look(view, triangles, first[LAST[found.facet]], [found.d, found.b], found.db, exact);
    loop {
        let (triangle, facet) = decode(edge.behind);
        let t = &triangles[triangle as usize];
        if edge.conflict {
            tests += 2;
            entered += 1;
            let (left, right) = (t.neighbors[NEXT[facet]], t.neighbors[LAST[facet]]);
            pending.push(look(view, triangles, right, [edge.d, edge.b], edge.db, exact));
            edge = look(view, triangles, left, [a, edge.d], edge.ad, exact);
            sink.enter(triangle);
        } else {
            let (from, to) = (t.vertices[LAST[facet]], t.vertices[NEXT[facet]]);
            sink.rim(triangles, edge.behind, [from, to], edge.b);
            a = edge.b;
            let Some(next) = pending.pop() else { break };
            edge = next;
        }
    }
    counters.conflict_tests += tests;
    counters.replaced += entered;
}

/// Looks through the edge (a, b) of a triangle in conflict.
#[inline(always)]
fn look(
    view: &View<'_>,
    triangles: &[Simplex<3>],
    behind: u32,
    [a, b]: [Seen; 2],
    ab: f64,
    exact: &mut Exact,
) -> Edge {
    let (triangle, facet) = decode(behind);
    let d = view.see(triangles[triangle as usize].vertices[facet]);
    let (ad, db) = (minor(a, d), minor(d, b));
    let determinant = view.in_circle([a, b, d], [ab, ad, db]);
    let conflict =
        if determinant == 0.0 { conflict_exact(view, triangles, behind, exact) } else { determinant > 0.0 };
    Edge { behind, conflict, b, d, ad, db }
}

/// The conflict of the triangle that a code names, with exact arithmetic where filters do not do; it is looked at from
/// a triangle in conflict.
#[cold]
#[inline(never)]
fn conflict_exact(
    view: &View<'_>,
    triangles: &[Simplex<3>],
    behind: u32,
    exact: &mut Exact,
) -> bool {
    let (triangle, facet) = decode(behind);
    let t = &triangles[triangle as usize];
    let Some(place) = t.vertices.iter().position(|&v| v == GHOST) else {
        return view.conflict_exact(t.vertices, exact);
    };
    let (from, to) = (t.vertices[NEXT[place]], t.vertices[LAST[place]]);
    match view.side_exact(from, to, exact) {
        Sign::Positive => true,
        Sign::Negative => false,
        // Seen through its hull edge, the triangle it is seen from is the finite one behind that edge.
        Sign::Zero => {
            place == facet || {
                let inner = decode(t.neighbors[place]).0;
                view.conflict_exact(triangles[inner as usize].vertices, exact)
            }
        }
    }
}

/// Replaces the cavity by the star of a site: vertex 0 of each triangle is the site, facet 0 the edge of the rim.
pub(super) struct Star<'a> {
    site: u32,
    free: &'a mut Vec<u32>,
    first: u32,
    last: u32,
    /// The way to the site that comes next, and on which side of it the rim is.
    onward: Seen,
    side: f64,
    /// The triangle of the star that has this way.
    start: u32,
}

impl<'a> Star<'a> {
    /// The star of `site`, whose cavity begins with the triangle `found`; `next` as seen from the site.
    #[inline(always)]
    pub(super) fn new(site: u32, free: &'a mut Vec<u32>, found: &Found, next: Seen) -> Star<'a> {
        free.push(found.triangle);
        // Before the first triangle there is none to link to; a slot that is free bears what is written into it.
        Star {
            site,
            free,
            first: GHOST,
            last: found.triangle,
            onward: next,
            side: minor(next, found.d),
            start: GHOST,
        }
    }

    /// Links the last triangle with the first; returns the triangle of the star where the way to the next site begins.
    /// Rounding may name a wrong one; the walk does not mind.
    #[inline(always)]
    pub(super) fn close(self, triangles: &mut [Simplex<3>]) -> u32 {
        debug_assert!(self.free.is_empty(), "the star takes all slots");
        triangles[self.first as usize].neighbors[2] = code(self.last, 1);
        triangles[self.last as usize].neighbors[1] = code(self.first, 2);
        if self.start == GHOST { self.last } else { self.start }
    }
}

impl Sink for Star<'_> {
    #[inline(always)]
    fn enter(&mut self, triangle: u32) {
        self.free.push(triangle);
    }

    #[inline(always)]
    fn rim(&mut self, triangles: &mut [Simplex<3>], behind: u32, [from, to]: [u32; 2], end: Seen) {
        let slot = self.free.pop().expect("a cavity of k triangles has k + 2 edges");
        let (outer, facet) = decode(behind);
        triangles[outer as usize].neighbors[facet] = code(slot, 0);
        triangles[slot as usize] =
            Simplex { vertices: [self.site, from, to], neighbors: [behind, 0, code(self.last, 1)] };
        triangles[self.last as usize].neighbors[1] = code(slot, 2);
        self.first = if self.first == GHOST { slot } else { self.first };
        self.last = slot;
        let side = minor(self.onward, end);
        self.start = if self.side <= 0.0 && side >= 0.0 { slot } else { self.start };
        self.side = side;
    }
}

/// Lists the cavity and leaves the mesh as it is.
pub(super) struct Collect<'a> {
    pub(super) out: &'a mut Vec<u32>,
}

impl Sink for Collect<'_> {
    #[inline(always)]
    fn enter(&mut self, triangle: u32) {
        self.out.push(triangle);
    }

    #[inline(always)]
    fn rim(&mut self, _: &mut [Simplex<3>], _: u32, _: [u32; 2], _: Seen) {}
}
