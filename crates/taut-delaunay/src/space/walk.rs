//! The walk to a point: from simplex to simplex across a facet that has the point beyond it.
//!
//! *Guarantee.* It ends: with exact signs, the simplices that are crossed lie one behind the other as seen from the
//! point, and a Delaunay triangulation has no cycles in that order (Edelsbrunner, Combinatorica 10(3), 1990). What it
//! returns is in conflict with the point: the simplex that holds it, or a ghost whose facet it lies beyond.
//! *Trap.* The facet by which a simplex was entered is not asked again. All other facets are asked at once, as the way
//! out is a branch that nobody can foresee: one per simplex is enough.

use crate::kernel::Counters;
use crate::simplex::{Simplex, decode};

use super::Site;
use super::cavity::{FACETS, ghost_place};
use super::signs::{Judge, Signs, rows};

/// A simplex in conflict with q, reached from any live one.
#[inline(always)]
pub(super) fn walk<S: Signs>(
    signs: S,
    sites: &[Site],
    simplices: &[Simplex<4>],
    judge: &mut Judge,
    counters: &mut Counters,
    q: &Site,
    hint: u32,
) -> u32 {
    let mut t = hint;
    // Facets that are not known to have q on their inner side.
    let mut unknown = 0b1111;
    if let Some(infinity) = ghost_place(&simplices[t as usize]) {
        t = simplices[t as usize].neighbors[infinity] >> 2;
    }
    loop {
        let simplex = &simplices[t as usize];
        counters.walk_steps += 1;
        if ghost_place(simplex).is_some() {
            return t;
        }
        counters.orientations += u64::from(u32::count_ones(unknown));
        let corners = rows(sites, simplex);
        let (beyond, open) = signs.beyond(corners, q);
        let mut beyond = beyond & unknown;
        if beyond == 0 {
            let mut open = open & unknown;
            while open != 0 && beyond == 0 {
                let i = open.trailing_zeros();
                open &= open - 1;
                let [a, b, c] = FACETS[i as usize].map(|j| corners[j]);
                beyond = u32::from(judge.orient([q, a, b, c]).is_negative()) << i;
            }
            if beyond == 0 {
                return t;
            }
        }
        let (next, entry) = decode(simplex.neighbors[beyond.trailing_zeros() as usize]);
        t = next;
        unknown = 0b1111 & !(1 << entry);
    }
}
