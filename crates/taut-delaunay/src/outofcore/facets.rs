//! Finds frozen facets in the triangulation of a node, and the part of it that they leave unfinished.
//!
//! *Problem.* The sites that came up from below are triangulated again. Part of the new triangulation is that of all
//! points, the rest lies where the triangulation is finished below. The frozen facets are the border between the two.
//! *Idea.* Each is listed at its smallest vertex and looked for among the facets of all simplices; as it is turned as the
//! unfinished side sees it, one of its two sides is the unfinished one. From there flood, never across a frozen facet.
//! *Guarantee.* Each frozen facet is found exactly once and the flood never comes to a finished side, or the fronts are
//! damaged and that is an error. O(simplices + facets).
//! *Trap.* Facets may have the vertex at infinity. In space a facet is rotated, never sorted: orientation tells the sides
//! apart.

use taut_points::OrderBy;

use super::front::{FrozenFacet, Link};
use crate::Error;
use crate::simplex::{GHOST, Simplex, code, decode};

/// Bits of [`States`]; the low bits say which facets are frozen.
const UNFINISHED: u8 = 1 << 4;
/// The simplex lies where the triangulation was finished below.
const BEHIND: u8 = 1 << 5;
/// A point of another node may conflict with it.
const OPEN: u8 = 1 << 6;
/// One of its vertices is at infinity.
const IS_GHOST: u8 = 1 << 7;

/// What is known of each slot of a mesh.
pub(super) struct States(Vec<u8>);

impl States {
    /// Tests whether the simplex was not finished below.
    #[inline(always)]
    pub(super) fn is_unfinished(&self, t: u32) -> bool {
        self.0[t as usize] & UNFINISHED != 0
    }

    /// Tests whether the simplex was not finished below and has a vertex at infinity.
    #[inline(always)]
    pub(super) fn is_unfinished_ghost(&self, t: u32) -> bool {
        self.0[t as usize] & (UNFINISHED | IS_GHOST) == UNFINISHED | IS_GHOST
    }

    /// Tests whether the simplex belongs to the tile of this node: it is final and finite.
    #[inline(always)]
    pub(super) fn is_of_tile(&self, t: usize) -> bool {
        self.0[t] & (UNFINISHED | OPEN | IS_GHOST) == UNFINISHED
    }

    /// Tests whether the simplex is finished by this node: points of other nodes do not conflict.
    #[inline(always)]
    pub(super) fn is_final(&self, t: u32) -> bool {
        self.0[t as usize] & (UNFINISHED | OPEN) == UNFINISHED
    }

    /// Tests whether a point of another node may conflict.
    #[inline(always)]
    pub(super) fn is_open(&self, t: u32) -> bool {
        self.0[t as usize] & OPEN != 0
    }

    pub(super) fn set_open(&mut self, t: u32) {
        self.0[t as usize] |= OPEN;
    }

    /// Tests whether the simplex across the facet was finished below.
    #[inline(always)]
    pub(super) fn is_frozen(&self, t: u32, facet: usize) -> bool {
        self.0[t as usize] >> facet & 1 != 0
    }
}

/// The vertices of the facet opposite vertex `i` in positive order as the simplex sees it, in space from the smallest on.
pub(super) fn facet_of<const D: usize, const V: usize>(vertices: &[u32; V], i: usize) -> [u32; D] {
    let mut facet: [u32; D] = std::array::from_fn(|k| vertices[(i + 1 + k) % V]);
    if D == 3 {
        // (i, facet) is the simplex turned by i places, an odd permutation of four if i is odd.
        if i % 2 == 1 {
            facet.swap(0, 1);
        }
        let least = (0..D).min_by_key(|&k| facet[k]).unwrap_or(0);
        facet.rotate_left(least);
    }
    facet
}

/// The vertices of a facet under other numbers, in the order of [`facet_of`].
pub(super) fn renumbered<const D: usize>(facet: [u32; D], number: impl Fn(u32) -> u32) -> [u32; D] {
    let mut facet = facet.map(|v| if v == GHOST { GHOST } else { number(v) });
    if D == 3 {
        let least = (0..D).min_by_key(|&k| facet[k]).unwrap_or(0);
        facet.rotate_left(least);
    }
    facet
}

/// The frozen facets of a mesh, by the codes of their unfinished sides in ascending order.
pub(super) struct FrozenLinks(Vec<(u32, Link)>);

impl FrozenLinks {
    /// All of them: the codes of the unfinished sides with the finished ones.
    pub(super) fn iter(&self) -> impl Iterator<Item = (u32, Link)> {
        self.0.iter().copied()
    }

    /// The finished side of a frozen facet.
    pub(super) fn get(&self, simplex: u32, facet: usize) -> Link {
        let wanted = code(simplex, facet as u32);
        match self.0.binary_search_by_key(&wanted, |&(code, _)| code) {
            Ok(place) => self.0[place].1,
            // Asked of frozen facets alone.
            Err(_) => Link::HULL,
        }
    }
}

/// Tells what is unfinished in a mesh over `sites` sites: everything if no facet is frozen.
pub(super) fn unfinished<const D: usize, const V: usize>(
    simplices: &[Simplex<V>],
    sites: usize,
    frozen: Vec<FrozenFacet<D>>,
) -> Result<(States, FrozenLinks), Error> {
    let damaged = |what| Error::DamagedFront { what };
    let mut states = vec![0u8; simplices.len()];
    let all = if frozen.is_empty() { UNFINISHED } else { 0 };
    for (state, simplex) in states.iter_mut().zip(simplices) {
        let kind = if simplex.is_ghost() { all | IS_GHOST } else { all };
        *state = if simplex.is_live() { kind } else { 0 };
    }
    if frozen.is_empty() {
        return Ok((States(states), FrozenLinks(vec![])));
    }
    let (starts, frozen) = by_smallest(sites, frozen);
    let mut found = Vec::with_capacity(frozen.len());
    for (t, simplex) in (0u32..).zip(simplices) {
        for i in 0..if simplex.is_live() { V } else { 0 } {
            let facet = facet_of::<D, V>(&simplex.vertices, i);
            let least = facet.iter().copied().min().unwrap_or(GHOST) as usize;
            let listed = starts[least] as usize..starts[least + 1] as usize;
            let Some(hit) = frozen[listed].iter().find(|f| f.vertices == facet) else { continue };
            states[t as usize] |= 1 << i;
            states[decode(simplex.neighbors[i]).0 as usize] |= BEHIND;
            found.push((code(t, i as u32), hit.link));
        }
    }
    if found.len() != frozen.len() {
        return Err(damaged("a frozen facet is not in the triangulation above"));
    }
    let mut open: Vec<u32> = Vec::new();
    let reach = |t: u32, states: &mut Vec<u8>, open: &mut Vec<u32>| {
        if states[t as usize] & UNFINISHED == 0 {
            states[t as usize] |= UNFINISHED;
            open.push(t);
        }
    };
    found.iter().for_each(|&(side, _)| reach(decode(side).0, &mut states, &mut open));
    while let Some(t) = open.pop() {
        let state = states[t as usize];
        if state & BEHIND != 0 {
            return Err(damaged("frozen facets do not close"));
        }
        for (i, &neighbor) in simplices[t as usize].neighbors.iter().enumerate() {
            if state >> i & 1 == 0 {
                reach(decode(neighbor).0, &mut states, &mut open);
            }
        }
    }
    found.order_by_key(|&(side, _)| side);
    Ok((States(states), FrozenLinks(found)))
}

/// The facets in the order of their smallest vertices, and where those of each vertex begin.
fn by_smallest<const D: usize>(
    sites: usize,
    mut frozen: Vec<FrozenFacet<D>>,
) -> (Vec<u32>, Vec<FrozenFacet<D>>) {
    let least = |f: &FrozenFacet<D>| f.vertices.iter().copied().min().unwrap_or(GHOST);
    frozen.sort_unstable_by_key(|f| (least(f), f.vertices));
    let mut starts = vec![0u32; sites + 1];
    for facet in &frozen {
        starts[least(facet) as usize + 1] += 1;
    }
    for i in 0..sites {
        starts[i + 1] += starts[i];
    }
    (starts, frozen)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facets_of_two_sides_have_opposite_orientations() {
        // Two tetrahedra with the facet 1, 2, 3 in common, both positive: (0, 1, 2, 3) and (4, 1, 3, 2).
        let ours = facet_of::<3, 4>(&[0, 1, 2, 3], 0);
        for (vertices, i) in [([4, 1, 3, 2], 0), ([1, 4, 2, 3], 1), ([1, 3, 4, 2], 2)] {
            let its = facet_of::<3, 4>(&vertices, i);
            assert_eq!((its[0], its[1], its[2]), (ours[0], ours[2], ours[1]), "{vertices:?}");
        }
        assert_eq!(facet_of::<2, 3>(&[5, 7, 6], 1), [6, 5]);
        assert_eq!(renumbered([GHOST, 4, 5], |v| 9 - v), [4, GHOST, 5]);
    }
}
