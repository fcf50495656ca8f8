//! A star that can be taken back: beside other threads it turns out only while digging whether all of the cavity can be held.
//!
//! *Idea.* The star is written while the cavity is dug, as on one thread, into the slots of the cavity and two of the thread's own. Of
//! each triangle that goes the record is kept. If another thread holds a vertex, the records are written back, and with them what the
//! triangles around the cavity say of their neighbors in it; the two slots are dead again.
//! *Guarantee.* All that is written, either way, is in slots of the thread, in triangles whose vertices it holds, or the number in a
//! triangle around the cavity that names one of them. Nobody can hold what was taken back: it has the new site, which is given back
//! after the last record is.
//! *Trap.* A walk of another thread may have ended in a slot that dies here, and it would begin its next one there.
//! *Trap.* To write down the cavity first and its star once all is held needs no way back, and makes every insertion a third
//! longer for the sake of one in a thousand that fails.

use super::dig::Sink;
use super::seen::PointOffset;
use super::star::Star;
use crate::simplex::{Simplex, code, decode};
use crate::threads::Slot;

/// The triangles of a cavity as they were.
#[derive(Default)]
pub(super) struct Undo(Vec<(u32, Simplex<3>)>);

impl Undo {
    /// Keeps a triangle.
    #[inline(always)]
    pub(super) fn note(&mut self, triangles: &[impl Slot<3>], triangle: u32) {
        let record = &triangles[triangle as usize];
        let kept = Simplex { vertices: record.vertices(), neighbors: record.neighbors() };
        self.0.push((triangle, kept));
    }

    /// Forgets all of them.
    #[inline(always)]
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// Writes all of them back, and forgets them; `own` are the slots that held none.
    #[cold]
    #[inline(never)]
    pub(super) fn take_back(&mut self, triangles: &[impl Slot<3>], own: [u32; 2]) {
        for slot in own {
            triangles[slot as usize].kill();
        }
        for &(triangle, kept) in &self.0 {
            triangles[triangle as usize].set(kept);
        }
        for (triangle, kept) in self.0.drain(..) {
            for (facet, behind) in (0..).zip(kept.neighbors) {
                let (outer, back) = decode(behind);
                triangles[outer as usize].set_neighbor(back, code(triangle, facet));
            }
        }
    }
}

/// A star, and what is needed to take it back.
pub(super) struct Recorded<'a, R> {
    pub(super) star: Star<'a, R>,
    pub(super) triangles: &'a [R],
    pub(super) undo: &'a mut Undo,
}

impl<R: Slot<3>> Sink for Recorded<'_, R> {
    #[inline(always)]
    fn enter(&mut self, triangle: u32) {
        self.undo.note(self.triangles, triangle);
        self.star.enter(triangle);
    }

    #[inline(always)]
    fn rim(&mut self, behind: u32, edge: [u32; 2], end: PointOffset) {
        self.star.rim(behind, edge, end);
    }
}
