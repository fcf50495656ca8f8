//! The cavity of a site becomes its star.
//!
//! *Idea.* Every edge of the rim and the site are a triangle, linked to the one before it. The slots are those of the
//! cavity, as they become free, and two new ones: k edges of the rim are out when at least k − 2 triangles are in.
//! *Trap.* A walk that begins anywhere in the star takes 3.1 steps to the next site, most of them around the star. One
//! that begins in the triangle which faces the next site takes 1.3; to find it costs one minor per edge of the rim,
//! and it took a sixth off the time of a build.

use taut_predicates::Separate;

use super::dig::Sink;
use super::seen::{PointOffset, minor};
use super::walk::LocatedTriangle;
use crate::simplex::{GHOST, Simplex, code, decode};
use crate::threads::Slot;

/// Replaces the cavity by the star of a site: vertex 0 of each triangle is the site, facet 0 the edge of the rim.
pub(super) struct Star<'a, R> {
    site: u32,
    triangles: &'a [R],
    free: &'a mut Vec<u32>,
    first: u32,
    last: u32,
    /// The way to the site that comes next, and on which side of it the rim is.
    onward: PointOffset,
    side: f64,
    /// The triangle of the star that has this way.
    start: u32,
}

impl<'a, R: Slot<3>> Star<'a, R> {
    /// The star of `site`, whose cavity begins with the triangle `found`; `next` as seen from the site.
    #[inline(always)]
    pub(super) fn new(
        site: u32,
        triangles: &'a [R],
        free: &'a mut Vec<u32>,
        found: &LocatedTriangle,
        next: PointOffset,
    ) -> Self {
        free.push(found.triangle);
        // Before the first triangle there is none to link to; a slot that is free bears what is written into it.
        Star {
            site,
            triangles,
            free,
            first: GHOST,
            last: found.triangle,
            onward: next,
            side: minor::<Separate>(next, found.d),
            start: GHOST,
        }
    }

    /// Links the last triangle with the first; returns the triangle of the star where the way to the next site begins.
    /// Rounding may name a wrong one; the walk does not mind.
    #[inline(always)]
    pub(super) fn close(self) -> u32 {
        debug_assert!(self.free.is_empty(), "the star takes all slots");
        self.triangles[self.first as usize].set_neighbor(2, code(self.last, 1));
        self.triangles[self.last as usize].set_neighbor(1, code(self.first, 2));
        if self.start == GHOST { self.last } else { self.start }
    }
}

impl<R: Slot<3>> Sink for Star<'_, R> {
    #[inline(always)]
    fn enter(&mut self, triangle: u32) {
        self.free.push(triangle);
    }

    #[inline(always)]
    fn rim(&mut self, behind: u32, [from, to]: [u32; 2], end: PointOffset) {
        let slot = self.free.pop().expect("a cavity of k triangles has k + 2 edges");
        let (outer, facet) = decode(behind);
        self.triangles[outer as usize].set_neighbor(facet, code(slot, 0));
        self.triangles[slot as usize].set(Simplex {
            vertices: [self.site, from, to],
            neighbors: [behind, 0, code(self.last, 1)],
        });
        self.triangles[self.last as usize].set_neighbor(1, code(slot, 2));
        self.first = if self.first == GHOST { slot } else { self.first };
        self.last = slot;
        let side = minor::<Separate>(self.onward, end);
        self.start = if self.side <= 0.0 && side >= 0.0 { slot } else { self.start };
        self.side = side;
    }
}
