//! The order of the simplices of a tile, and the numbers of its sites.
//!
//! *Idea.* Simplices are counted by their smallest site, which puts almost all in place, as few share it; the few are
//! sorted. Beside the mesh that takes 4 bytes for each slot and each simplex, and 8 for each site; in the plane 8 more for
//! each simplex while they are sorted.
//! *Trap.* Slots are not in this order: to look at them costs a walk through memory.

use taut_oblivious::machine::prefetch;

use super::super::solve::Solved;
use crate::canonical::arrangement;
use crate::geometry::Geometry;
use crate::kernel::Kernel;
use crate::simplex::{Simplex, code};

/// Simplices that a slot is asked for ahead of its use: about the time that memory takes.
pub(super) const FETCH_AHEAD: usize = 16;

/// Not in the tile.
pub(super) const UNUSED: u32 = u32::MAX;

/// The numbers of sites and simplices in the tile of a node.
pub(in super::super) struct TileOrder {
    /// For each site of the node its number in the tile, which ascends with the site.
    pub(super) numbers: Vec<u32>,
    /// The sites of the tile.
    pub(super) sites: Vec<u32>,
    /// The numbers of those that go up.
    pub(super) copies: Vec<u32>,
    /// The slots of the simplices of the tile.
    pub(super) finite: Vec<u32>,
    /// For each slot its simplex in the tile.
    pub(super) places: Vec<u32>,
}

/// The vertices of a simplex but the smallest in ascending order, then its slot: 32 bits each.
type RunKey = u128;

/// Longest run of simplices with one smallest site that is sorted by insertion.
const INSERTION_SORT_MAX: usize = 32;

impl TileOrder {
    /// The order of what `solved` finished, where the sites marked `up` are not owned.
    pub(in super::super) fn of<const D: usize, const V: usize, G: Geometry<D, V>>(
        solved: &Solved<D, V, G>,
        up: &[bool],
    ) -> Self {
        let (simplices, states) = (solved.mesh.simplices(), &solved.states);
        // First the smallest site of each slot, in place of the number of its simplex.
        let mut places = vec![UNUSED; simplices.len()];
        // Two ahead: while simplices are put in place, entry i + 1 runs from the beginning of site i to its end.
        let mut starts = vec![0u32; up.len() + 2];
        let mut is_copied = vec![false; up.len()];
        for (t, (place, simplex)) in places.iter_mut().zip(simplices).enumerate() {
            if states.is_of_tile(t) {
                let least = simplex.vertices.iter().fold(UNUSED, |least, &v| least.min(v));
                *place = least;
                starts[least as usize + 2] += 1;
                if simplex.vertices.iter().fold(false, |any, &v| any | up[v as usize]) {
                    simplex.vertices.iter().for_each(|&v| is_copied[v as usize] |= up[v as usize]);
                }
            }
        }
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        let finite = if V == 3 {
            in_order_by_keys(simplices, &mut places, &mut starts)
        } else {
            in_order_by_runs(simplices, &mut places, &mut starts)
        };
        drop(starts);
        let (numbers, sites, copies) = number_sites(up, &is_copied);
        Self { numbers, sites, copies, finite, places }
    }

    /// The code in the tile of a facet of one of its simplices.
    pub(in super::super) fn side<const V: usize>(
        &self,
        simplices: &[Simplex<V>],
        slot: u32,
        facet: usize,
    ) -> u32 {
        let arranged = arrangement(&simplices[slot as usize].vertices);
        let place = arranged.iter().position(|&i| usize::from(i) == facet).unwrap_or(0);
        code(self.places[slot as usize], place as u32)
    }
}

/// The slots of the simplices in order, where `places` has the smallest site of each and gets its number.
///
/// One key of 64 bits for each simplex, and no look at slots out of order. Few simplices share a smallest site, two of the
/// plane on average, but how many is nothing that a processor could foresee: up to four are sorted without a branch. (10⁷
/// uniform points of the plane, ns a point: 30 by runs, 20 by keys in a sort with branches, 17 without.)
fn in_order_by_keys<const V: usize>(
    simplices: &[Simplex<V>],
    places: &mut [u32],
    starts: &mut [u32],
) -> Vec<u32> {
    let form = KeyForm::of(starts.len() - 2, simplices.len());
    let count = starts[starts.len() - 1] as usize;
    let mut keys = vec![0u64; count + NETWORK];
    for (t, (&least, simplex)) in places.iter().zip(simplices).enumerate() {
        if least != UNUSED {
            let next = &mut starts[least as usize + 1];
            keys[*next as usize] = form.key(simplex, t);
            *next += 1;
        }
    }
    for i in 0..starts.len() - 1 {
        let (begin, end) = (starts[i] as usize, starts[i + 1] as usize);
        if end - begin > NETWORK {
            keys[begin..end].sort_unstable();
        } else if let Some(run) = keys[begin..].first_chunk_mut::<NETWORK>() {
            sort_few(run, end - begin);
        }
        if form.cut > 0 {
            form.settle(&mut keys[begin..end], simplices);
        }
    }
    let mut finite = vec![0u32; count];
    for ((place, slot), &key) in (0u32..).zip(&mut finite).zip(&keys) {
        *slot = form.slot(key);
        places[*slot as usize] = place;
    }
    finite
}

/// Simplices with one smallest site that are sorted without a branch, at most.
const NETWORK: usize = 4;

/// For each number of keys all bits of the places behind them; from a table, as compilers make branches of comparisons.
const BEHIND: [[u64; NETWORK]; NETWORK + 1] = {
    let mut behind = [[0; NETWORK]; NETWORK + 1];
    let mut count = 0;
    while count < NETWORK {
        let mut i = count;
        while i < NETWORK {
            behind[count][i] = u64::MAX;
            i += 1;
        }
        count += 1;
    }
    behind
};

/// Sorts the first `count` keys and leaves the others.
#[inline(always)]
fn sort_few(keys: &mut [u64; NETWORK], count: usize) {
    let behind = &BEHIND[count];
    let mut sorted: [u64; NETWORK] = std::array::from_fn(|i| keys[i] | behind[i]);
    for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
        let (a, b) = (sorted[i], sorted[j]);
        (sorted[i], sorted[j]) = (a.min(b), a.max(b));
    }
    *keys = std::array::from_fn(|i| sorted[i] & !behind[i] | keys[i] & behind[i]);
}

/// How a triangle with a known smallest site is put in 64 bits: its other two, ascending, then its slot. Of the last site
/// low bits are cut off where all do not fit, with 2²¹ sites or more.
struct KeyForm {
    slot_bits: u32,
    site_bits: u32,
    cut: u32,
}

impl KeyForm {
    fn of(sites: usize, slots: usize) -> Self {
        let bits = |count: usize| usize::BITS - count.leading_zeros();
        let (site_bits, slot_bits) = (bits(sites), bits(slots));
        Self { slot_bits, site_bits, cut: (2 * site_bits + slot_bits).saturating_sub(u64::BITS) }
    }

    #[inline(always)]
    fn key<const V: usize>(&self, simplex: &Simplex<V>, slot: usize) -> u64 {
        let [middle, last] = upper_two(simplex).map(u64::from);
        ((middle << (self.site_bits - self.cut) | last >> self.cut) << self.slot_bits) | slot as u64
    }

    #[inline(always)]
    fn slot(&self, key: u64) -> u32 {
        (key & ((1 << self.slot_bits) - 1)) as u32
    }

    /// Orders sorted keys by the bits that were cut off too.
    fn settle<const V: usize>(&self, keys: &mut [u64], simplices: &[Simplex<V>]) {
        let is_close = |pair: &[u64]| (pair[0] ^ pair[1]) >> self.slot_bits == 0;
        if keys.windows(2).any(is_close) {
            keys.sort_unstable_by_key(|&key| upper_two(&simplices[self.slot(key) as usize]));
        }
    }
}

/// The two largest vertices, ascending.
#[inline(always)]
fn upper_two<const V: usize>(simplex: &Simplex<V>) -> [u32; 2] {
    let (mut middle, mut last) = (0, 0);
    for &v in &simplex.vertices {
        middle = v.min(last).max(middle);
        last = v.max(last);
    }
    [middle, last]
}

/// As [`in_order_by_keys`], for simplices whose keys are too long to be kept: each run is gathered, then sorted.
fn in_order_by_runs<const V: usize>(
    simplices: &[Simplex<V>],
    places: &mut [u32],
    starts: &mut [u32],
) -> Vec<u32> {
    let mut finite = vec![0u32; starts[starts.len() - 1] as usize];
    for (t, &least) in places.iter().enumerate() {
        if least != UNUSED {
            let next = &mut starts[least as usize + 1];
            finite[*next as usize] = t as u32;
            *next += 1;
        }
    }
    let mut run: Vec<RunKey> = Vec::new();
    for i in 0..starts.len() - 1 {
        let (begin, end) = (starts[i] as usize, starts[i + 1] as usize);
        for ahead in begin + FETCH_AHEAD..end + FETCH_AHEAD {
            fetch(simplices, finite.get(ahead));
        }
        match &mut finite[begin..end] {
            [] | [_] => {}
            [a, b] => {
                if run_key(simplices, *a) > run_key(simplices, *b) {
                    std::mem::swap(a, b);
                }
            }
            slots => sort_run(slots, simplices, &mut run),
        }
        for (place, &t) in (begin as u32..).zip(&finite[begin..end]) {
            places[t as usize] = place;
        }
    }
    finite
}

/// Asks for a slot that will be read soon.
#[inline(always)]
pub(super) fn fetch<const V: usize>(simplices: &[Simplex<V>], slot: Option<&u32>) {
    if let Some(&t) = slot {
        // A slot may lie across the end of a line.
        prefetch(simplices, t as usize);
        prefetch(simplices, t as usize + 1);
    }
}

/// The key of a simplex among those with the same smallest site.
#[inline(always)]
fn run_key<const V: usize>(simplices: &[Simplex<V>], slot: u32) -> RunKey {
    let mut sorted = simplices[slot as usize].vertices;
    for i in 1..V {
        for j in (1..=i).rev() {
            let (a, b) = (sorted[j - 1], sorted[j]);
            (sorted[j - 1], sorted[j]) = (a.min(b), a.max(b));
        }
    }
    let key = sorted[1..].iter().fold(0, |key: u128, &v| key << 32 | u128::from(v));
    key << 32 | u128::from(slot)
}

/// Sorts simplices with the same smallest site.
fn sort_run<const V: usize>(slots: &mut [u32], simplices: &[Simplex<V>], run: &mut Vec<RunKey>) {
    run.clear();
    run.extend(slots.iter().map(|&t| run_key(simplices, t)));
    if run.len() > INSERTION_SORT_MAX {
        run.sort_unstable();
    }
    for i in 1..run.len().min(INSERTION_SORT_MAX + 1) {
        let key = run[i];
        let mut at = i;
        while at > 0 && run[at - 1] > key {
            run[at] = run[at - 1];
            at -= 1;
        }
        run[at] = key;
    }
    slots.iter_mut().zip(run).for_each(|(slot, &mut key)| *slot = key as u32);
}

/// Numbers the owned sites and those others that simplices of the tile have; lists the sites and the numbers of the others.
fn number_sites(up: &[bool], is_copied: &[bool]) -> (Vec<u32>, Vec<u32>, Vec<u32>) {
    let mut numbers = vec![UNUSED; up.len()];
    let (mut sites, mut copies) = (Vec::with_capacity(up.len()), Vec::new());
    for v in 0..up.len() {
        if !up[v] || is_copied[v] {
            let number = sites.len() as u32;
            numbers[v] = number;
            sites.push(v as u32);
            if up[v] {
                copies.push(number);
            }
        }
    }
    (numbers, sites, copies)
}
