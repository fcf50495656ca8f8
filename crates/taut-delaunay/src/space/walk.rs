//! The walk to a point: from simplex to simplex across a facet that has the point beyond it.
//!
//! *Guarantee.* It ends: with exact signs, the simplices that are crossed lie one behind the other as seen from the
//! point, and a Delaunay triangulation has no cycles in that order (Edelsbrunner, Combinatorica 10(3), 1990). What it
//! returns is in conflict with the point: the simplex that holds it, or a ghost whose facet it lies beyond. Beside other
//! threads that change the mesh there is no such promise: it may end at a dead slot or go on and on, and then says where it stands.
//! *Trap.* The facet by which a simplex was entered is not asked again. All other facets are asked at once, as the way
//! out is a branch that nobody can foresee: one per simplex is enough.

use crate::kernel::Counters;
use crate::simplex::{DEAD_MARK, decode};
use crate::threads::{Hold, Slot};

use super::Site;
use super::cavity::{FACETS, ghost_place};
use super::signs::{Judge, Signs, rows};

/// Steps beside other threads, at most: along a line of sites a walk may have as many as there are sites, but it could go in a
/// circle while simplices change.
const STEPS_MAX: u64 = 1 << 20;

/// A simplex in conflict with q, reached from any live one, and its vertices; or where a walk beside other threads stands that came
/// to a slot without a simplex, or was long.
#[inline(always)]
pub(super) fn walk<S: Signs, H: Hold>(
    signs: S,
    sites: &[Site],
    simplices: &[H::Slot<4>],
    judge: &mut Judge,
    counters: &mut Counters,
    q: &Site,
    hint: u32,
) -> Result<(u32, [u32; 4]), u32> {
    let mut t = hint;
    // Facets that are not known to have q on their inner side.
    let mut unknown = 0b1111;
    if let Some(infinity) = ghost_place(simplices[t as usize].vertices()) {
        t = simplices[t as usize].neighbor(infinity) >> 2;
    }
    let mut steps = 0;
    loop {
        let simplex = &simplices[t as usize];
        let vertices = simplex.vertices();
        steps += 1;
        if H::SHARED && (!is_simplex(vertices) || steps > STEPS_MAX) {
            counters.walk_steps += steps;
            return Err(t);
        }
        if ghost_place(vertices).is_some() {
            counters.walk_steps += steps;
            return Ok((t, vertices));
        }
        // One facet at most is known. To count bits takes ten instructions where no instruction does it.
        counters.orientations += if unknown == 0b1111 { 4 } else { 3 };
        let corners = rows(sites, vertices);
        let (beyond, open) = signs.beyond(corners, q);
        let mut beyond = beyond & unknown;
        if beyond == 0 {
            let mut open = open & unknown;
            while open != 0 && beyond == 0 {
                let i = open.trailing_zeros();
                open &= open - 1;
                let [a, b, c] = {
                    let [a, b, c] = FACETS[i as usize];
                    [corners[a], corners[b], corners[c]]
                };
                beyond = u32::from(judge.orient([q, a, b, c]).is_negative()) << i;
            }
            if beyond == 0 {
                counters.walk_steps += steps;
                return Ok((t, vertices));
            }
        }
        let (next, entry) = decode(simplex.neighbor(beyond.trailing_zeros() as usize));
        t = next;
        // Beside other threads it may be another facet than the one that was crossed: then all four are asked, for these vertices.
        unknown = if H::SHARED { 0b1111 } else { 0b1111 & !(1 << entry) };
    }
}

/// Tests whether these are the vertices of a simplex, and not those of a dead slot, or of one that was never written.
#[inline(always)]
pub(super) fn is_simplex([first, second, ..]: [u32; 4]) -> bool {
    first != DEAD_MARK && first != second
}
