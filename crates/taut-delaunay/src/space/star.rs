//! The star of a new site: one simplex for each facet of the boundary of its cavity, and who is beside whom.
//!
//! *Problem.* Two new simplices share a facet where their facets of the boundary share an edge. Pair 3F/2 edges.
//! *Idea.* The boundary is a sphere, so each of its edges is run once in either direction. Vertices get numbers of their
//! own, 0 to R − 1, and a table of R × R codes is written at the directed edges and read at the reversed ones. Every
//! entry that is read was written in this insertion, so nothing is cleared and nothing is searched.
//! *Guarantee.* Linear time in the boundary. The table is used up to R = 512 (1 MB); beyond, a hash table of edges.
//! *Trap.* Local numbers are kept in 16 bits per site and are never cleared: a number counts only if the vertex with
//! that number names the site back. A version without that branch was slower: its stores feed the next loads.

use crate::simplex::{Simplex, code, decode};

use super::cavity::Facet;
use super::row;

/// Largest number of vertices on a boundary for which the table of edges is used.
const TABLE_MAX: usize = 512;

/// No edge: an empty slot of the hash table.
const EMPTY: u32 = u32::MAX;

/// What it takes to number and to pair, kept between insertions.
#[derive(Default)]
pub(super) struct Star {
    /// For each site, after the vertex at infinity: its local number in the last boundary it was on.
    local: Vec<u16>,
    /// The vertices of this boundary by local number.
    ring: Vec<u32>,
    /// Local numbers of the vertices of each facet.
    corners: Vec<[u16; 3]>,
    /// Codes of the facets of new simplices, at row · stride + column of the directed edge.
    table: Vec<u32>,
    /// Or by a hash of the edge, when the table would be too large: `3 · facet + edge`.
    edges: Vec<u32>,
}

impl Star {
    /// For so many sites.
    pub(super) fn new(sites: usize) -> Self {
        Self { local: vec![0; sites + 1], ..Self::default() }
    }

    /// Room for one site more.
    pub(super) fn push(&mut self) {
        self.local.push(0);
    }

    /// Writes one simplex (q, a, b, c) for each facet into the slot of the same place, with all neighbours on both sides.
    #[inline(always)]
    pub(super) fn fill(&mut self, simplices: &mut [Simplex<4>], facets: &[Facet], slots: &[u32], q: u32) {
        // Euler: F = 2R − 4 on a sphere of triangles.
        let vertices = facets.len() / 2 + 2;
        if vertices <= TABLE_MAX {
            self.fill_by_table(simplices, facets, slots, q, vertices);
        } else {
            self.fill_by_hash(simplices, facets, slots, q);
        }
    }

    #[inline(always)]
    fn fill_by_table(
        &mut self,
        simplices: &mut [Simplex<4>],
        facets: &[Facet],
        slots: &[u32],
        q: u32,
        vertices: usize,
    ) {
        let shift = vertices.next_power_of_two().max(64).trailing_zeros();
        let size = 1 << (2 * shift);
        if self.table.len() < size {
            self.table.resize(size, 0);
        }
        let table = &mut self.table[..size];
        let at = |from: u16, to: u16| (usize::from(from) << shift) + usize::from(to);
        self.ring.clear();
        self.corners.clear();
        for (facet, &slot) in facets.iter().zip(slots) {
            let [a, b, c] = facet.vertices;
            let a = number(&mut self.local, &mut self.ring, a);
            let b = number(&mut self.local, &mut self.ring, b);
            let c = number(&mut self.local, &mut self.ring, c);
            table[at(a, b)] = code(slot, 3);
            table[at(b, c)] = code(slot, 1);
            table[at(c, a)] = code(slot, 2);
            self.corners.push([a, b, c]);
        }
        debug_assert_eq!(self.ring.len(), vertices, "the boundary of a cavity is a sphere");
        for ((facet, &slot), &[a, b, c]) in facets.iter().zip(slots).zip(&self.corners) {
            let neighbors = [facet.outside, table[at(c, b)], table[at(a, c)], table[at(b, a)]];
            place(simplices, facet, slot, q, neighbors);
        }
    }

    /// Pairs the edges in an open hash table of at least twice their number. A boundary gets here where a site has
    /// hundreds of neighbours: an apex over a plane full of sites, the centre of a sphere.
    #[cold]
    fn fill_by_hash(&mut self, simplices: &mut [Simplex<4>], facets: &[Facet], slots: &[u32], q: u32) {
        let edge = |name: u32| {
            let (facet, i) = (&facets[name as usize / 3], name as usize % 3);
            (facet.vertices[(i + 1) % 3], facet.vertices[(i + 2) % 3])
        };
        for (facet, &slot) in facets.iter().zip(slots) {
            place(simplices, facet, slot, q, [facet.outside, 0, 0, 0]);
        }
        let size = (3 * facets.len()).next_power_of_two();
        self.edges.clear();
        self.edges.resize(size, EMPTY);
        for name in 0..3 * facets.len() as u32 {
            let (from, to) = edge(name);
            let key = u64::from(from.min(to)) << 32 | u64::from(from.max(to));
            // Multiplicative hashing with the golden ratio of 2⁶⁴; the high bits are the mixed ones.
            let mut at = (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> (64 - size.trailing_zeros())) as usize;
            loop {
                let other = self.edges[at];
                if other == EMPTY {
                    self.edges[at] = name;
                    break;
                }
                if edge(other) == (to, from) {
                    // Edge i lies in the facet opposite corner i, which is vertex i + 1 of the simplex.
                    let (mine, its) = (slots[name as usize / 3], slots[other as usize / 3]);
                    simplices[mine as usize].neighbors[name as usize % 3 + 1] = code(its, other % 3 + 1);
                    simplices[its as usize].neighbors[other as usize % 3 + 1] = code(mine, name % 3 + 1);
                    break;
                }
                at = (at + 1) & (size - 1);
            }
        }
    }
}

/// The local number of a vertex, a new one if need be.
#[inline(always)]
fn number(local: &mut [u16], ring: &mut Vec<u32>, vertex: u32) -> u16 {
    let known = &mut local[row(vertex)];
    if ring.get(usize::from(*known)) != Some(&vertex) {
        *known = ring.len() as u16;
        ring.push(vertex);
    }
    *known
}

/// Writes a simplex and tells the one outside.
#[inline(always)]
fn place(simplices: &mut [Simplex<4>], facet: &Facet, slot: u32, q: u32, neighbors: [u32; 4]) {
    let [a, b, c] = facet.vertices;
    simplices[slot as usize] = Simplex { vertices: [q, a, b, c], neighbors };
    let (outside, side) = decode(facet.outside);
    simplices[outside as usize].neighbors[side] = code(slot, 0);
}
