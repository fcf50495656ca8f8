//! The cells of a Delaunay triangulation, the ghosts outside its hull among them, numbered by the point set alone.
//!
//! *Idea.* Every facet has a cell on both sides, so whatever turns around an edge or a vertex never meets an end. The slots of a
//! triangulation are numbered as it was built; here cells are in the order of their sites. Sites are numbered along a curve that fills
//! space, so cells that are near each other in space mostly are in memory, too: without this order, a million points spend
//! most of their time waiting for memory.
//! *Guarantee.* A function of the triangulation as a set of tetrahedra: what is decided by the numbers of cells and facets is decided by
//! the points. O(m) for m cells, as few share their lowest site.

use rayon::prelude::*;
use taut_delaunay::{GHOST, Simplex, decode};

/// Cells or sites of one task.
const TASK: usize = 1 << 12;

/// Cells that are renumbered at a time.
const BLOCK: usize = 16;

/// The cells by number. Of each the sites are in positive order: the lowest two first, then the third, then the highest, which of
/// a ghost is the vertex at infinity.
pub(super) struct Cells {
    all: Vec<Simplex<4>>,
}

/// A cell on its way into order: all sites in ascending order but the first, which those have in common among which it is sorted, and
/// the slot. One number, as that is compared at once.
#[derive(Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Entry(u128);

impl Entry {
    fn of([_, b, c, d]: [u32; 4], slot: u32) -> Self {
        Self(u128::from(b) << 96 | u128::from(c) << 64 | u128::from(d) << 32 | u128::from(slot))
    }

    fn slot(self) -> usize {
        self.0 as u32 as usize
    }
}

impl Cells {
    pub(super) fn of(slots: Vec<Simplex<4>>, sites: usize) -> Self {
        let order = ordered(&slots, sites);
        let mut numbers = vec![0u32; slots.len()];
        for (cell, entry) in (0u32..).zip(&order) {
            numbers[entry.slot()] = cell;
        }
        let all = slots.par_iter().with_min_len(TASK);
        let places: Vec<Places> = all.map(|simplex| Places::of(simplex.vertices)).collect();
        let blank = Simplex { vertices: [0; 4], neighbors: [0; 4] };
        let mut all = vec![blank; order.len()];
        all.par_chunks_mut(TASK).zip(order.par_chunks(TASK)).for_each(|(cells, entries)| {
            let mut olds = [(blank, Places(0)); BLOCK];
            // Some at a time, so that what is far off in memory is under way for all of them.
            for (cells, entries) in cells.chunks_mut(BLOCK).zip(entries.chunks(BLOCK)) {
                for (old, entry) in olds.iter_mut().zip(entries) {
                    *old = (slots[entry.slot()], places[entry.slot()]);
                }
                for (old, _) in &mut olds[..entries.len()] {
                    old.neighbors = old.neighbors.map(|code| {
                        let (slot, k) = decode(code);
                        numbers[slot as usize] << 2 | u32::from(places[slot as usize].get(k))
                    });
                }
                for (cell, (old, places)) in cells.iter_mut().zip(&olds) {
                    // What comes to each place, rather than where each goes: what was just written at a place that varies is slow to read.
                    let from = places.inverse().map(usize::from);
                    cell.vertices = from.map(|i| old.vertices[i]);
                    cell.neighbors = from.map(|i| old.neighbors[i]);
                }
            }
        });
        Self { all }
    }

    /// How many cells there are.
    pub(super) fn len(&self) -> usize {
        self.all.len()
    }

    pub(super) fn is_ghost(&self, cell: u32) -> bool {
        self.all[cell as usize].vertices[3] == GHOST
    }

    /// The numbers of all cells that are no ghosts.
    pub(super) fn finite(&self) -> impl Iterator<Item = u32> {
        (0..self.len() as u32).filter(|&cell| !self.is_ghost(cell))
    }

    pub(super) fn sites(&self, cell: u32) -> [u32; 4] {
        self.all[cell as usize].vertices
    }

    /// The sites in ascending order.
    pub(super) fn ascending(&self, cell: u32) -> [u32; 4] {
        let [a, b, c, d] = self.sites(cell);
        [a.min(b), a.max(b), c, d]
    }

    /// The facet `cell << 2 | place` as seen from the cell across it.
    pub(super) fn mirror(&self, facet: u32) -> u32 {
        let (cell, i) = decode(facet);
        self.all[cell as usize].neighbors[i]
    }

    /// The cell across a facet, and the place of the facet in it.
    pub(super) fn across(&self, cell: u32, facet: usize) -> (u32, usize) {
        decode(self.all[cell as usize].neighbors[facet])
    }

    /// The sites of the facet opposite the i-th of a cell, counter-clockwise as seen from beyond it.
    pub(super) fn facet(&self, cell: u32, i: usize) -> [u32; 3] {
        let sites = self.sites(cell);
        let [a, b, c] = OUTWARD[i];
        [sites[a], sites[b], sites[c]]
    }

    /// The sites of a facet, `cell << 2 | place`, in ascending order. The vertex at infinity comes last.
    pub(super) fn name(&self, facet: u32) -> [u32; 3] {
        let (cell, i) = decode(facet);
        let mut sites = self.facet(cell, i);
        sites.sort_unstable();
        sites
    }

    /// The first ghost; none if there are no cells.
    pub(super) fn first_ghost(&self) -> Option<u32> {
        (0..self.len() as u32).find(|&cell| self.is_ghost(cell))
    }
}

/// For each vertex of a slot its place in the cell, in two bits each: they are asked for in no order, so they had better be near.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Places(u8);

impl Places {
    fn of(vertices: [u32; 4]) -> Self {
        let rank = |v: u32| vertices.iter().filter(|&&other| other < v).count() as u8;
        let mut places = vertices.map(rank);
        // Pairs in the wrong order: if they are odd in number, so is the order, and its first two change places.
        let wrong = (0..4).flat_map(|i| (i + 1..4).map(move |k| (i, k)));
        if wrong.filter(|&(i, k)| places[i] > places[k]).count() % 2 == 1 {
            places.iter_mut().filter(|place| **place < 2).for_each(|place| *place = 1 - *place);
        }
        // Slots that hold nothing have vertices that mean nothing.
        Self(places.iter().rev().fold(0, |bits, place| bits << 2 | place & 3))
    }

    #[inline]
    fn get(self, vertex: usize) -> u8 {
        self.0 >> (2 * vertex) & 3
    }

    /// For each place what comes there.
    #[inline]
    fn inverse(self) -> [u8; 4] {
        let mut from = [0; 4];
        for (place, from) in (0..).zip(&mut from) {
            let is = |i: usize| u8::from(self.get(i) == place);
            *from = is(1) + 2 * is(2) + 3 * is(3);
        }
        from
    }
}

/// The live slots in the order of their sites.
fn ordered(slots: &[Simplex<4>], sites: usize) -> Vec<Entry> {
    let lowest =
        |simplex: &Simplex<4>| simplex.vertices.iter().copied().min().unwrap_or(0) as usize;
    let live = || slots.iter().zip(0u32..).filter(|(simplex, _)| simplex.is_live());
    // Where the cells of each lowest site begin, one place late, as each comes to be where they end.
    let mut begins = vec![0u32; sites + 2];
    live().for_each(|(simplex, _)| begins[lowest(simplex) + 2] += 1);
    for site in 2..begins.len() {
        begins[site] += begins[site - 1];
    }
    let mut order = vec![Entry::default(); begins[sites + 1] as usize];
    for (simplex, slot) in live() {
        let sorted = ascending(simplex.vertices);
        let place = &mut begins[sorted[0] as usize + 1];
        order[*place as usize] = Entry::of(sorted, slot);
        *place += 1;
    }
    // Each place has moved on to the end of its cells, which is where those of the next site begin.
    let (mut rest, mut tasks) = (&mut order[..], Vec::new());
    for ends in begins[1..=sites].chunks(TASK) {
        let begin =
            tasks.last().map_or(0, |(ends, _): &(&[u32], &mut [Entry])| ends[ends.len() - 1]);
        let (own, others) = rest.split_at_mut((ends[ends.len() - 1] - begin) as usize);
        tasks.push((ends, own));
        rest = others;
    }
    tasks.into_par_iter().for_each(|(ends, mut own)| {
        let mut begin = ends[ends.len() - 1] - own.len() as u32;
        for &end in ends {
            let (alike, others) = own.split_at_mut((end - begin) as usize);
            sort(alike);
            (own, begin) = (others, end);
        }
    });
    order
}

/// Four sites in ascending order, without a branch, as none could be guessed.
fn ascending([a, b, c, d]: [u32; 4]) -> [u32; 4] {
    let (a, b, c, d) = (a.min(b), a.max(b), c.min(d), c.max(d));
    let (first, b, c, last) = (a.min(c), a.max(c), b.min(d), b.max(d));
    [first, b.min(c), b.max(c), last]
}

/// Sorts entries, no two of which are equal.
fn sort(entries: &mut [Entry]) {
    /// Up to so many, it costs less to compare all with all than to guess which is the lower one.
    const FEW: usize = 20;
    if entries.len() > FEW {
        entries.sort_unstable();
        return;
    }
    let mut copies = [Entry::default(); FEW];
    let copies = &mut copies[..entries.len()];
    copies.copy_from_slice(entries);
    for &entry in &*copies {
        let lower: usize = copies.iter().map(|&other| usize::from(other < entry)).sum();
        entries[lower] = entry;
    }
}

/// For a cell a, b, c, d with det(b − a, c − a, d − a) > 0, the corners of the facet opposite each, counter-clockwise from outside.
pub(super) const OUTWARD: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::spheres::{cross, dot, minus};

    #[test]
    fn facets_look_outward() {
        let p = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(dot(minus(p[1], p[0]), cross(minus(p[2], p[0]), minus(p[3], p[0]))) > 0.0);
        for (i, facet) in OUTWARD.into_iter().enumerate() {
            let [a, b, c] = facet.map(|k| p[k]);
            let normal = cross(minus(b, a), minus(c, a));
            assert!(dot(normal, minus(p[i], a)) < 0.0, "{i}");
        }
    }

    #[test]
    fn four_sites_are_sorted() {
        for k in 0..256u32 {
            let sites = [k & 3, k >> 2 & 3, k >> 4 & 3, k >> 6];
            let mut sorted = sites;
            sorted.sort();
            assert_eq!(ascending(sites), sorted);
        }
    }

    #[test]
    fn few_and_many_entries_are_sorted() {
        for count in [0, 1, 2, 7, 20, 21, 60] {
            let mut entries: Vec<Entry> =
                (0..count).map(|k| Entry::of([0, k * 37 % 5, k * 11 % 3, 1], k)).collect();
            let mut sorted = entries.clone();
            sorted.sort();
            sort(&mut entries);
            assert!(entries == sorted, "{count}");
        }
    }

    #[test]
    fn places_keep_the_orientation() {
        for (vertices, there) in [
            ([1, 2, 3, 4], [0, 1, 2, 3]),
            ([2, 1, 3, 4], [0, 1, 2, 3]),
            ([2, 1, 4, 3], [1, 0, 3, 2]),
            ([GHOST, 7, 5, 9], [3, 1, 0, 2]),
        ] {
            let places = Places::of(vertices);
            assert_eq!([0, 1, 2, 3].map(|i| places.get(i)), there, "{vertices:?}");
            let from = places.inverse();
            assert!((0..4).all(|i| from[usize::from(there[i])] == i as u8));
        }
    }
}
