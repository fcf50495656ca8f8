//! The cells of a Delaunay triangulation, the ghosts outside its hull among them, numbered by the point set alone.
//!
//! *Idea.* Every facet has a cell on both sides, so whatever turns around an edge or a vertex never meets an end. The slots of a
//! triangulation are numbered as it was built; here cells are in the order of their sites. Sites are numbered along a curve that fills
//! space, so cells that are near each other in space mostly are in memory, too: without this order, a million points spend
//! most of their time waiting for memory.
//! *Guarantee.* A function of the triangulation as a set of tetrahedra: what is decided by the numbers of cells and facets is decided by
//! the points. O(m) for m cells where few share their lowest site, and O(m log m) if all do.

use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicU8, AtomicU32};

use taut_delaunay::{GHOST, Simplex, decode};
use taut_points::OrderBy;
use taut_points::parallel::{IntoParallel, ParallelSlice};

/// Cells or sites of one task.
const TASK: usize = 1 << 12;

/// The cells of this many sites are moved at a time.
const SITES_PER_BATCH: usize = 16;

/// The cells by number. Of each the sites are in positive order: the lowest two first, then the third, then the highest, which of
/// a ghost is the vertex at infinity.
pub(super) struct Cells {
    sites: Vec<[u32; 4]>,
    /// For each place of a cell the facet opposite it, as seen from the cell beyond. Apart from the sites, as most ways through all cells
    /// ask for one of the two alone.
    beyond: Vec<[u32; 4]>,
}

impl Cells {
    /// The cells of so many sites.
    pub(super) fn of(slots: Vec<Simplex<4>>, sites: usize) -> Self {
        let Groups { order, ends } = Groups::of(&slots, sites);
        // For each slot the number of its cell, and the places of its vertices there.
        let numbers: Vec<AtomicU32> = slots.iter().map(|_| AtomicU32::new(0)).collect();
        let places: Vec<AtomicU8> = slots.iter().map(|_| AtomicU8::new(0)).collect();
        let [mut vertices, mut beyond] = [(); 2].map(|()| vec![[0u32; 4]; order.len()]);
        let (mut rest, mut tasks, mut begin) = ((&mut vertices[..], &mut beyond[..]), vec![], 0);
        for ends in ends.chunks(TASK) {
            let end = ends[ends.len() - 1];
            let count = (end - begin) as usize;
            let (own, others) = rest.0.split_at_mut(count);
            let (own_beyond, others_beyond) = rest.1.split_at_mut(count);
            tasks.push((begin, ends, own, own_beyond));
            (rest, begin) = ((others, others_beyond), end);
        }
        tasks.into_par_iter().for_each_init(Vec::new, |moving, (first, ends, vertices, beyond)| {
            let mut begin = first;
            for ends in ends.chunks(SITES_PER_BATCH) {
                // Some at a time, so that what is far off in memory is under way for all of them.
                let order = &order[begin as usize..ends[ends.len() - 1] as usize];
                moving.clear();
                moving.extend(order.iter().map(|&slot| Moving::of(&slots[slot as usize], slot)));
                let mut rest = &mut moving[..];
                for &end in ends {
                    let (alike, others) = rest.split_at_mut((end - begin) as usize);
                    let first = (begin - first) as usize;
                    in_order(alike, |rank, moving| {
                        vertices[first + rank] = moving.vertices;
                        beyond[first + rank] = moving.beyond;
                        numbers[moving.slot as usize].store(begin + rank as u32, Relaxed);
                        places[moving.slot as usize].store(moving.places, Relaxed);
                    });
                    (rest, begin) = (others, end);
                }
            }
        });
        beyond.par_chunks_mut(TASK).for_each(|beyond| {
            for code in beyond.iter_mut().flatten() {
                let (slot, k) = decode(*code);
                let place = places[slot as usize].load(Relaxed) >> (2 * k) & 3;
                *code = numbers[slot as usize].load(Relaxed) << 2 | u32::from(place);
            }
        });
        Self { sites: vertices, beyond }
    }

    pub(super) fn len(&self) -> usize {
        self.sites.len()
    }

    pub(super) fn is_ghost(&self, cell: u32) -> bool {
        self.sites[cell as usize][3] == GHOST
    }

    /// The numbers of all cells that are no ghosts.
    pub(super) fn finite(&self) -> impl Iterator<Item = u32> {
        (0..self.len() as u32).filter(|&cell| !self.is_ghost(cell))
    }

    pub(super) fn sites(&self, cell: u32) -> [u32; 4] {
        self.sites[cell as usize]
    }

    /// The sites in ascending order.
    pub(super) fn ascending(&self, cell: u32) -> [u32; 4] {
        let [a, b, c, d] = self.sites(cell);
        [a.min(b), a.max(b), c, d]
    }

    /// The facet `cell << 2 | place` as seen from the cell across it.
    pub(super) fn mirror(&self, facet: u32) -> u32 {
        let (cell, i) = decode(facet);
        self.beyond[cell as usize][i]
    }

    /// The cell across a facet, and the place of the facet in it.
    #[inline(always)]
    pub(super) fn across(&self, cell: u32, facet: usize) -> (u32, usize) {
        decode(self.beyond[cell as usize][facet])
    }

    /// The sites of the facet opposite the i-th of a cell, counter-clockwise as seen from beyond it.
    #[inline(always)]
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

/// A cell on its way from its slot into order.
struct Moving {
    /// All sites but the lowest in ascending order, as one number, which is compared at once.
    name: u128,
    vertices: [u32; 4],
    /// As slots know it.
    beyond: [u32; 4],
    /// For each vertex of the slot its place in the cell, in two bits each.
    places: u8,
    slot: u32,
}

impl Moving {
    #[inline]
    fn of(from: &Simplex<4>, slot: u32) -> Self {
        // Where each comes from goes along with it.
        let [a, b, c, d] = from.vertices.map(u64::from);
        let sorted = ascending([a << 2, b << 2 | 1, c << 2 | 2, d << 2 | 3]);
        let sources = (0..4).fold(0, |all, k| all | (sorted[k] as usize & 3) << (2 * k));
        let [_, b, c, d] = sorted.map(|from| u128::from(from >> 2));
        let [sources, places] = POSITIVE[sources];
        // Iterates over the places and finds their cells, not the reverse: data just written at varying places are slow to read.
        let source = [0, 2, 4, 6].map(|shift| usize::from(sources >> shift & 3));
        Self {
            name: b << 64 | c << 32 | d,
            vertices: source.map(|k| from.vertices[k]),
            beyond: source.map(|k| from.neighbors[k]),
            places,
            slot,
        }
    }
}

/// Has each visited with its rank among all, in some order.
fn in_order(all: &mut [Moving], mut visit: impl FnMut(usize, &Moving)) {
    /// Up to this many, it costs less to compare all with all than to guess which is the lower one.
    const COMPARE_ALL_MAX: usize = 20;
    if all.len() > COMPARE_ALL_MAX {
        all.order_by_key(|moving| moving.name);
        all.iter().enumerate().for_each(|(rank, moving)| visit(rank, moving));
        return;
    }
    for moving in &*all {
        let lower = all.iter().map(|other| usize::from(other.name < moving.name)).sum();
        visit(lower, moving);
    }
}

/// For the places that four vertices in ascending order come from, in two bits each: these again, the first two exchanged if that was an
/// odd permutation, and for each vertex the place that it goes to.
const POSITIVE: [[u8; 2]; 256] = {
    let mut all = [[0; 2]; 256];
    let mut code = 0;
    while code < 256 {
        let (mut from, mut wrong, mut k) = ([0; 4], 0, 0);
        while k < 4 {
            from[k] = code >> (2 * k) & 3;
            let mut former = 0;
            while former < k {
                wrong += (from[former] > from[k]) as usize;
                former += 1;
            }
            k += 1;
        }
        if wrong % 2 == 1 {
            (from[0], from[1]) = (from[1], from[0]);
        }
        let mut k = 0;
        while k < 4 {
            all[code][0] |= (from[k] << (2 * k)) as u8;
            all[code][1] |= (k << (2 * from[k])) as u8;
            k += 1;
        }
        code += 1;
    }
    all
};

/// The live slots by the lowest of their sites.
struct Groups {
    order: Vec<u32>,
    /// Where those of each site end.
    ends: Vec<u32>,
}

impl Groups {
    fn of(slots: &[Simplex<4>], sites: usize) -> Self {
        let lowest = |simplex: &Simplex<4>| {
            let [a, b, c, d] = simplex.vertices;
            a.min(b).min(c.min(d)) as usize
        };
        let live = || slots.iter().zip(0u32..).filter(|(simplex, _)| simplex.is_live());
        // Where those of each site begin, two places late; then, one place late, each moves on to where they end.
        let mut ends = vec![0u32; sites + 2];
        live().for_each(|(simplex, _)| ends[lowest(simplex) + 2] += 1);
        for site in 2..ends.len() {
            ends[site] += ends[site - 1];
        }
        let mut order = vec![0u32; ends[sites + 1] as usize];
        for (simplex, slot) in live() {
            let place = &mut ends[lowest(simplex) + 1];
            order[*place as usize] = slot;
            *place += 1;
        }
        ends.truncate(sites + 1);
        ends.remove(0);
        Self { order, ends }
    }
}

/// Four numbers in ascending order, without a branch, as none could be guessed.
fn ascending<T: Ord + Copy>([a, b, c, d]: [T; 4]) -> [T; 4] {
    let (a, b, c, d) = (a.min(b), a.max(b), c.min(d), c.max(d));
    let (first, b, c, last) = (a.min(c), a.max(c), b.min(d), b.max(d));
    [first, b.min(c), b.max(c), last]
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
    fn four_numbers_are_sorted() {
        for k in 0..256u32 {
            let sites = [k & 3, k >> 2 & 3, k >> 4 & 3, k >> 6];
            let mut sorted = sites;
            sorted.sort();
            assert_eq!(ascending(sites), sorted);
        }
    }

    #[test]
    fn few_and_many_are_put_in_order() {
        for count in [0u32, 1, 2, 7, 20, 21, 60] {
            let slot =
                |k| Simplex { vertices: [0, k * 37 % 61, k % 3 + 70, 80], neighbors: [0; 4] };
            let mut all: Vec<Moving> = (0..count).map(|k| Moving::of(&slot(k), k)).collect();
            let mut sorted: Vec<(u128, u32)> = all.iter().map(|m| (m.name, m.slot)).collect();
            sorted.sort_unstable();
            let mut visited = 0;
            in_order(&mut all, |rank, moving| {
                assert_eq!(sorted[rank], (moving.name, moving.slot));
                visited += 1;
            });
            assert_eq!(visited, count);
        }
    }

    #[test]
    fn moving_keeps_the_orientation() {
        for (vertices, there) in [
            ([1, 2, 3, 4], [0, 1, 2, 3]),
            ([2, 1, 3, 4], [0, 1, 2, 3]),
            ([2, 1, 4, 3], [1, 0, 3, 2]),
            ([GHOST, 7, 5, 9], [3, 1, 0, 2]),
        ] {
            let moving = Moving::of(&Simplex { vertices, neighbors: [10, 11, 12, 13] }, 5);
            assert_eq!([0, 2, 4, 6].map(|shift| usize::from(moving.places >> shift & 3)), there);
            for (k, place) in there.into_iter().enumerate() {
                assert_eq!(moving.vertices[place], vertices[k]);
                assert_eq!(moving.beyond[place], 10 + k as u32);
            }
            let [_, b, c, d] = ascending(vertices).map(u128::from);
            assert_eq!(moving.name, b << 64 | c << 32 | d);
        }
    }
}
