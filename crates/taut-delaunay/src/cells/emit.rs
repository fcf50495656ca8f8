//! From cells to one mesh: each hands over the simplices whose smallest site it owns, and facets between cells are
//! joined.
//!
//! Idea: the slots of all cells one after another are the slots of the whole; what a cell does not own is dead there,
//! so a simplex keeps its number but for an offset, and no table of numbers is needed. For a facet whose two sides
//! belong to two cells, the cell that owns the facet's smallest site, which knows both, notes them by their vertices; a
//! table of the simplices along the borders turns the notes into numbers.
//! Guarantee: every facet is joined exactly once.
//! Trap: all this happens in place. Fresh memory costs a page fault every 4 KiB, and copying the parts into one array
//! took a third of the time that two threads had saved.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};
use std::ops::Range;

use rayon::prelude::*;

use super::cell::Cell;
use crate::Error;
use crate::simplex::{DEAD_MARK, GHOST, Simplex, Slots, code, decode};

/// Hashes site numbers: they are no choice of anybody's, and the standard hash took longer than all else at the border.
#[derive(Clone, Copy, Default)]
struct SiteHasher(u64);

impl Hasher for SiteHasher {
    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(4) {
            let number = chunk.iter().rev().fold(0, |n, &byte| n << 8 | u64::from(byte));
            self.0 = (self.0.rotate_left(29) ^ number).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        }
    }

    fn finish(&self) -> u64 {
        self.0 ^ self.0 >> 32
    }
}

/// Numbers of simplices by their sites in ascending order.
type Names<const V: usize> = HashMap<[u32; V], u32, BuildHasherDefault<SiteHasher>>;

/// One side of a facet: the vertices of its simplex in ascending order, and the vertex opposite.
#[derive(Clone, Copy)]
struct Side<const V: usize> {
    key: [u32; V],
    opposite: u32,
}

/// The facets that a cell leaves for others.
struct Border<const V: usize> {
    /// Facets to join.
    joints: Vec<[Side<V>; 2]>,
    /// Simplices that other cells may name, by their vertices in ascending order.
    names: Names<V>,
}

fn sorted<const V: usize>(mut vertices: [u32; V]) -> [u32; V] {
    vertices.sort_unstable();
    vertices
}

/// The smallest vertex but the one at `except`.
fn smallest_without<const V: usize>(vertices: [u32; V], except: usize) -> u32 {
    (0..V).filter(|&i| i != except).map(|i| vertices[i]).min().unwrap_or(GHOST)
}

impl<const V: usize> Cell<V> {
    /// Returns true if a vertex is one of the own sites.
    #[inline(always)]
    fn is_own(&self, v: u32) -> bool {
        v.wrapping_sub(self.own_local.start) < self.own.end - self.own.start
    }

    /// The site of a vertex.
    #[inline(always)]
    fn global(&self, v: u32) -> u32 {
        // Own sites are numbered in a row; the rest is looked up.
        if self.is_own(v) {
            self.own.start + (v - self.own_local.start)
        } else if v == GHOST {
            GHOST
        } else {
            self.sites[v as usize]
        }
    }

    /// Slot `t` with its sites, if it is live.
    #[inline(always)]
    fn sites_of(&self, t: u32) -> Option<[u32; V]> {
        let simplex = &self.simplices[t as usize];
        let mut sites = simplex.vertices;
        for site in &mut sites {
            *site = if *site == DEAD_MARK { DEAD_MARK } else { self.global(*site) };
        }
        simplex.is_live().then_some(sites)
    }

    /// Tests whether this cell hands over a simplex with these sites.
    #[inline(always)]
    fn owns(&self, sites: &[u32; V]) -> bool {
        self.own.contains(&sites.iter().copied().fold(GHOST, u32::min))
    }

    /// Turns the slots into those of the whole, where they begin at `offset`. Neighbors of other cells are still to be
    /// joined.
    fn hand_over(mut self, offset: u32) -> Vec<Simplex<V>> {
        for t in 0..self.simplices.len() {
            let handed = match self.sites_of(t as u32).filter(|sites| self.owns(sites)) {
                Some(vertices) => {
                    let codes = self.simplices[t].neighbors;
                    Simplex {
                        vertices,
                        neighbors: codes.map(|code| code.wrapping_add(offset << 2)),
                    }
                }
                None => Simplex { vertices: [DEAD_MARK; V], neighbors: [0; V] },
            };
            self.simplices[t] = handed;
        }
        self.simplices
    }

    /// The border of this cell. `owner` tells which cell a site is of.
    fn border(&self, offset: u32, owner: impl Fn(u32) -> usize) -> Border<V> {
        let mut border = Border { joints: Vec::new(), names: Names::default() };
        let mut name = |t: u32, sites: &[u32; V]| {
            border.names.insert(sorted(*sites), offset + t);
        };
        for &t in &self.mixed {
            // A facet between two cells has a side with sites of both; the other side may be all ours.
            let vertices = &self.simplices[t as usize].vertices;
            let own = vertices.iter().filter(|&&v| self.is_own(v)).count();
            if own == 0 || own == V {
                continue;
            }
            let Some(sites) = self.sites_of(t) else { continue };
            let ours = self.owns(&sites);
            for i in 0..V {
                let (other, facet) = decode(self.simplices[t as usize].neighbors[i]);
                let there = self.sites_of(other).expect("a live simplex has live neighbors");
                match (ours, self.owns(&there)) {
                    // A cell that owns both sides has joined them itself.
                    (true, true) => continue,
                    (true, false) => name(t, &sites),
                    (false, true) => name(other, &there),
                    (false, false) => {}
                }
                // Both sides of a facet at an own site are right here. Note it once.
                let once = t < other || there.iter().all(|site| self.own.contains(site));
                if once && self.own.contains(&smallest_without(sites, i)) {
                    let sides = [
                        Side { key: sorted(sites), opposite: sites[i] },
                        Side { key: sorted(there), opposite: there[facet] },
                    ];
                    if owner(sides[0].key[0]) != owner(sides[1].key[0]) {
                        border.joints.push(sides);
                    }
                }
            }
        }
        border
    }
}

/// One mesh from all cells, in the order of the cells.
pub(super) fn join<const V: usize>(cells: Vec<Cell<V>>) -> Result<Slots<V>, Error> {
    let mut offsets = vec![0];
    for cell in &cells {
        offsets.push(offsets[offsets.len() - 1] + cell.simplices.len());
    }
    if offsets[cells.len()] >= 1 << 30 {
        return Err(Error::TooManySimplices);
    }
    let owned: Vec<Range<u32>> = cells.iter().map(|cell| cell.own.clone()).collect();
    let owner = |site: u32| owned.partition_point(|own| own.end <= site);
    let handed: Vec<(Border<V>, Vec<Simplex<V>>)> = cells
        .into_par_iter()
        .zip(&offsets)
        .with_max_len(1)
        .map(|(cell, &offset)| (cell.border(offset as u32, owner), cell.hand_over(offset as u32)))
        .collect();
    let (borders, parts): (Vec<_>, Vec<_>) = handed.into_iter().unzip();
    let mut mesh = Slots::of(parts);
    let side = |side: &Side<V>| {
        let names = &borders[owner(side.key[0])].names;
        let number =
            *names.get(&side.key).expect("the owner of the smallest site hands over the simplex");
        let vertices = mesh[number as usize].vertices;
        let facet = vertices.iter().position(|&v| v == side.opposite);
        code(number, facet.expect("the vertex opposite the facet") as u32)
    };
    let joints: Vec<[u32; 2]> = borders
        .par_iter()
        .flat_map_iter(|border| &border.joints)
        .map(|sides| [side(&sides[0]), side(&sides[1])])
        .collect();
    for [a, b] in joints {
        for (here, there) in [(a, b), (b, a)] {
            let (number, facet) = decode(here);
            mesh[number as usize].neighbors[facet] = there;
        }
    }
    Ok(mesh)
}
