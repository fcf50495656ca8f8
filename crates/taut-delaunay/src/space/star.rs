//! The star of a new site: one simplex for each facet of the boundary of its cavity, and who is beside whom.
//!
//! *Problem.* Two new simplices share a facet where their facets of the boundary share an edge. Pair 3F/2 edges.
//! *Idea.* The boundary is a sphere, so each of its edges is run once in either direction. Vertices get local numbers,
//! and a square table of codes is written at the directed edges and read at the reversed ones. Every entry that is read
//! was written in this insertion, so nothing is cleared and nothing is searched. A local number is the place of the last
//! corner at which the vertex is seen, among the 3F corners: one pass of stores, one of loads.
//! *Guarantee.* Linear time in the boundary. The table is used up to F = 256 (2.3 MB); beyond, a hash table of edges.
//! *Trap.* Numbers without gaps, 0 to R − 1 with R = F/2 + 2, make the table 36 times smaller, but they cost a branch that
//! nobody can foresee for each corner, or a chain of stores that feed the next loads: 4 to 15 % of everything on uniform
//! points, and no gain on a torus either.

use crate::simplex::{Simplex, code, decode};
use crate::threads::Slot;

use super::cavity::Facet;
use super::row;

/// Largest number of facets for which the table of edges is used.
const TABLE_MAX: usize = 256;

/// The key of an empty slot of the hash table; an edge has two different vertices.
const EMPTY: u64 = u64::MAX;

/// The lists to number and to pair simplices, kept between insertions.
pub(super) struct Star {
    /// For each site, after the vertex at infinity: its number in the last boundary it was on.
    local: Vec<u16>,
    /// Numbers of the corners of each facet.
    corners: Vec<[u16; 3]>,
    /// Codes of the facets of new simplices, at row · stride + column of the directed edge.
    table: Vec<u32>,
    /// Keys of a hash table of edges, when the square table would be too large: both vertices, the smaller one first.
    edges: Vec<u64>,
    /// For each key the code of the facet of the new simplex that was there first. Twelve bytes a slot with the key: of n sites around one
    /// cavity some 100 n bytes.
    codes: Vec<u32>,
}

impl Star {
    pub(super) fn new(sites: usize) -> Self {
        Star {
            local: vec![0; sites + 1],
            corners: vec![[0; 3]; TABLE_MAX],
            table: Vec::new(),
            edges: Vec::new(),
            codes: Vec::new(),
        }
    }

    /// Writes one simplex (q, a, b, c) for each facet into the slot of the same place, with all neighbors on both
    /// sides.
    #[inline(always)]
    pub(super) fn fill(
        &mut self,
        simplices: &[impl Slot<4>],
        facets: &[Facet],
        slots: &[u32],
        q: u32,
    ) {
        if facets.len() <= TABLE_MAX {
            self.fill_by_table(simplices, facets, slots, q);
        } else {
            self.fill_by_hash(simplices, facets, slots, q);
        }
    }

    #[inline(always)]
    fn fill_by_table(
        &mut self,
        simplices: &[impl Slot<4>],
        facets: &[Facet],
        slots: &[u32],
        q: u32,
    ) {
        let stride = 3 * facets.len();
        if self.table.len() < stride * stride {
            self.table.resize(stride * stride, 0);
        }
        let local = &mut self.local[..];
        let corners = &mut self.corners[..facets.len()];
        let table = &mut self.table[..stride * stride];
        let slots = &slots[..facets.len()];
        let at = |from: u16, to: u16| usize::from(from) * stride + usize::from(to);
        let mut number = 0;
        for facet in facets {
            for vertex in facet.vertices {
                local[row(vertex)] = number;
                number += 1;
            }
        }
        for ((facet, &slot), corners) in facets.iter().zip(slots).zip(&mut *corners) {
            let [a, b, c] = facet.vertices;
            let (a, b, c) = (local[row(a)], local[row(b)], local[row(c)]);
            table[at(a, b)] = code(slot, 3);
            table[at(b, c)] = code(slot, 1);
            table[at(c, a)] = code(slot, 2);
            *corners = [a, b, c];
        }
        for ((facet, &slot), &[a, b, c]) in facets.iter().zip(slots).zip(&*corners) {
            let neighbors = [facet.outside, table[at(c, b)], table[at(a, c)], table[at(b, a)]];
            place(simplices, facet, slot, q, neighbors);
        }
    }

    /// Pairs the edges in an open hash table of twice their number at least. A boundary gets here where a site has
    /// hundreds of neighbors: an apex over a plane full of sites, the center of a sphere.
    #[cold]
    #[inline(never)]
    fn fill_by_hash(
        &mut self,
        simplices: &[impl Slot<4>],
        facets: &[Facet],
        slots: &[u32],
        q: u32,
    ) {
        /// Multiplicative hashing with the golden ratio of 2⁶⁴; the high bits are the mixed ones.
        const HASH_FACTOR: u64 = 0x9e37_79b9_7f4a_7c15;
        for (facet, &slot) in facets.iter().zip(slots) {
            place(simplices, facet, slot, q, [facet.outside, 0, 0, 0]);
        }
        let size = (3 * facets.len()).next_power_of_two();
        let shift = u64::BITS - size.trailing_zeros();
        self.edges.clear();
        self.edges.resize(size, EMPTY);
        self.codes.resize(size.max(self.codes.len()), 0);
        let (edges, codes) = (&mut self.edges[..size], &mut self.codes[..size]);
        for (facet, &slot) in facets.iter().zip(slots) {
            let [a, b, c] = facet.vertices;
            // Edge i lies opposite corner i, which is vertex i + 1 of the simplex.
            for (i, [u, v]) in [(1, [b, c]), (2, [c, a]), (3, [a, b])] {
                let edge = u64::from(u.min(v)) << 32 | u64::from(u.max(v));
                let mut at = (edge.wrapping_mul(HASH_FACTOR) >> shift) as usize;
                while edges[at] != edge && edges[at] != EMPTY {
                    at = (at + 1) & (size - 1);
                }
                let mine = code(slot, i);
                if edges[at] == EMPTY {
                    (edges[at], codes[at]) = (edge, mine);
                } else {
                    let its = codes[at];
                    let (other, j) = decode(its);
                    simplices[slot as usize].set_neighbor(i as usize, its);
                    simplices[other as usize].set_neighbor(j, mine);
                }
            }
        }
    }
}

/// Writes a simplex and tells the one outside.
#[inline(always)]
fn place(simplices: &[impl Slot<4>], facet: &Facet, slot: u32, q: u32, neighbors: [u32; 4]) {
    let [a, b, c] = facet.vertices;
    simplices[slot as usize].set(Simplex { vertices: [q, a, b, c], neighbors });
    let (outside, side) = decode(facet.outside);
    simplices[outside as usize].set_neighbor(side, code(slot, 0));
}
