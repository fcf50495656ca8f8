//! Canonical order: the same arrays for any way of building.
//!
//! Idea: the vertices of a simplex begin with its smallest site and ascend as far as its orientation allows; simplices
//! ascend by their vertices in ascending order. Counting by the smallest site puts almost all in place, as few share it.
//! Guarantee: a function of the set of simplices. O(simplices) for bounded stars.

use std::cmp::Ordering;

use rayon::prelude::*;

use crate::simplex::{GHOST, Simplex, Slots, code, decode};

/// Simplices one task arranges.
const TASK: usize = 1 << 14;

/// The places of the vertices in canonical arrangement: ascending, the last two exchanged if the orientation demands.
///
/// Sorts without a branch: which vertex is the smallest is nothing a processor could foresee.
#[inline(always)]
pub(crate) fn arrangement<const V: usize>(vertices: &[u32; V]) -> [u8; V] {
    let mut keys = [0u64; V];
    for (i, (key, &v)) in keys.iter_mut().zip(vertices).enumerate() {
        *key = u64::from(v) << 8 | i as u64;
    }
    let mut odd = false;
    // Written out: the loops of an insertion sort are not unrolled by every compiler.
    let mut exchange = |j: usize| {
        let (a, b) = (keys[j - 1], keys[j]);
        odd ^= a > b;
        (keys[j - 1], keys[j]) = (a.min(b), a.max(b));
    };
    const { assert!(V <= 4) }
    if V > 1 {
        exchange(1);
    }
    if V > 2 {
        exchange(2);
        exchange(1);
    }
    if V > 3 {
        exchange(3);
        exchange(2);
        exchange(1);
    }
    let (a, b) = (keys[V - 2], keys[V - 1]);
    (keys[V - 2], keys[V - 1]) = if odd { (b, a) } else { (a, b) };
    let mut places = [0; V];
    for (place, key) in places.iter_mut().zip(keys) {
        *place = key as u8;
    }
    places
}

/// Compares simplices by their vertices in ascending order.
#[inline(always)]
fn compare<const V: usize>(a: &Simplex<V>, b: &Simplex<V>) -> Ordering {
    let ascending = |s: &Simplex<V>| {
        let mut v = s.vertices;
        v.sort_unstable();
        v
    };
    ascending(a).cmp(&ascending(b))
}

/// The finite simplices in canonical order.
pub(crate) struct CanonicalOrder {
    /// Slots of the finite simplices.
    pub(crate) finite: Vec<u32>,
    /// For each slot its place in `finite`; `u32::MAX` for the others.
    pub(crate) places: Vec<u32>,
}

impl CanonicalOrder {
    /// The order of simplices over `sites` sites.
    pub(crate) fn of<const V: usize>(simplices: &Slots<V>, sites: usize) -> Self {
        let smallest = |s: &Simplex<V>| s.vertices.iter().copied().min().unwrap_or(GHOST) as usize;
        let mut starts = vec![0u32; sites + 1];
        for s in simplices.iter().filter(|s| s.is_live() && !s.is_ghost()) {
            starts[smallest(s) + 1] += 1;
        }
        for i in 0..sites {
            starts[i + 1] += starts[i];
        }
        let mut finite = vec![0u32; starts[sites] as usize];
        let mut next = starts.clone();
        for (t, s) in simplices.iter().enumerate().filter(|(_, s)| s.is_live() && !s.is_ghost()) {
            let place = &mut next[smallest(s)];
            finite[*place as usize] = t as u32;
            *place += 1;
        }
        drop(next);
        let by_vertices =
            |&a: &u32, &b: &u32| compare(&simplices[a as usize], &simplices[b as usize]);
        let mut rest = finite.as_mut_slice();
        let mut tasks = Vec::new();
        for begin in (0..sites).step_by(TASK) {
            let end = sites.min(begin + TASK);
            let (run, after) = rest.split_at_mut((starts[end] - starts[begin]) as usize);
            tasks.push((begin..end, run));
            rest = after;
        }
        tasks.into_par_iter().for_each(|(run_of_sites, run)| {
            let base = starts[run_of_sites.start];
            for site in run_of_sites {
                let (begin, end) = (starts[site] - base, starts[site + 1] - base);
                run[begin as usize..end as usize].sort_unstable_by(by_vertices);
            }
        });
        let mut places = vec![u32::MAX; simplices.len()];
        for (place, &slot) in finite.iter().enumerate() {
            places[slot as usize] = place as u32;
        }
        Self { finite, places }
    }
}

/// The simplices in canonical order and arrangement, then the ghosts by their facets; no dead slots.
pub(crate) fn renumbered<const V: usize>(slots: &Slots<V>, sites: usize) -> Vec<Simplex<V>> {
    let CanonicalOrder { finite: mut order, mut places } = CanonicalOrder::of(slots, sites);
    let first_ghost = order.len();
    let is_ghost = |slot: &u32| slots[*slot as usize].is_live() && slots[*slot as usize].is_ghost();
    order.extend((0..slots.len() as u32).filter(is_ghost));
    order[first_ghost..]
        .par_sort_unstable_by(|&a, &b| compare(&slots[a as usize], &slots[b as usize]));
    for (place, &slot) in order.iter().enumerate().skip(first_ghost) {
        places[slot as usize] = place as u32;
    }
    let renumber = |old: u32| {
        let (slot, facet) = decode(old);
        let arranged = arrangement(&slots[slot as usize].vertices);
        // An arrangement has each place.
        let mut place = 0;
        for k in 1..V {
            place = if usize::from(arranged[k]) == facet { k as u32 } else { place };
        }
        code(places[slot as usize], place)
    };
    let simplex = |&slot: &u32| {
        let Simplex { vertices, neighbors } = slots[slot as usize];
        let arranged = arrangement(&vertices);
        let mut simplex = Simplex { vertices, neighbors };
        for place in 0..V {
            let from = usize::from(arranged[place]);
            simplex.vertices[place] = vertices[from];
            simplex.neighbors[place] = renumber(neighbors[from]);
        }
        simplex
    };
    order.par_iter().with_min_len(TASK).map(simplex).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrangements_keep_the_orientation() {
        for (vertices, expected) in
            [([1, 2, 3], [1, 2, 3]), ([3, 1, 2], [1, 2, 3]), ([2, 1, 3], [1, 3, 2])]
        {
            assert_eq!(arrangement(&vertices).map(|i| vertices[usize::from(i)]), expected);
        }
        for (vertices, expected) in [
            ([4, 3, 2, 1], [1, 2, 3, 4]),
            ([1, 2, 4, 3], [1, 2, 4, 3]),
            ([2, 1, 3, 4], [1, 2, 4, 3]),
        ] {
            assert_eq!(arrangement(&vertices).map(|i| vertices[usize::from(i)]), expected);
        }
    }
}
