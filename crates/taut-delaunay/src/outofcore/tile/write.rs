//! Writes what a node finished, in canonical order, straight from its mesh.
//!
//! *Idea.* Simplices are counted by their smallest site, which puts almost all in place, as few share it; the few are
//! sorted. Beside the mesh that takes 4 bytes for each slot and each simplex, and 8 for each site.
//! *Trap.* Slots are not in this order, so each pass over the simplices is a walk through memory. There is one pass to sort
//! and one to write, vertices and neighbors together, and either asks for slots ahead of their use; three passes to write
//! took as long as the triangulation (2·10⁶ uniform points of space: 1240 of 3860 ns a point).

use std::io::{self, Write};

use taut_certify::{Fingerprint, SiteHash};
use taut_oblivious::machine::prefetch;

use super::super::bytes::WordSum;
use super::super::front::{Front, Link};
use super::super::solve::Solved;
use super::{MAGIC, NO_NEIGHBOR, OTHER_TILE, TileCounts, TileLink, VERSION};
use crate::canonical::arrangement;
use crate::cells::Geometry;
use crate::kernel::Kernel;
use crate::simplex::{GHOST, Simplex, code, decode};
use crate::sites::Scale;

/// Simplices that a slot is asked for ahead of its use: about the time that memory takes.
const FETCH_AHEAD: usize = 16;

/// Not in the tile.
const UNUSED: u32 = u32::MAX;

/// The numbers of sites and simplices in the tile of a node.
pub(in super::super) struct TileOrder {
    /// For each site of the node its number in the tile, which ascends with the site.
    numbers: Vec<u32>,
    /// The sites of the tile.
    sites: Vec<u32>,
    /// The numbers of those that go up.
    copies: Vec<u32>,
    /// The slots of the simplices of the tile.
    finite: Vec<u32>,
    /// For each slot its simplex in the tile.
    places: Vec<u32>,
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
        for (t, (place, simplex)) in places.iter_mut().zip(simplices).enumerate() {
            if states.is_of_tile(t) {
                let least = simplex.vertices.iter().fold(UNUSED, |least, &v| least.min(v));
                *place = least;
                starts[least as usize + 2] += 1;
            }
        }
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
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
        drop(starts);
        let (numbers, sites, copies) = number_sites(simplices, up, |t| states.is_of_tile(t));
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

/// Asks for a slot that will be read soon.
#[inline(always)]
fn fetch<const V: usize>(simplices: &[Simplex<V>], slot: Option<&u32>) {
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
fn number_sites<const V: usize>(
    simplices: &[Simplex<V>],
    up: &[bool],
    is_of_tile: impl Fn(usize) -> bool,
) -> (Vec<u32>, Vec<u32>, Vec<u32>) {
    let mut is_copied = vec![false; up.len()];
    if up.contains(&true) {
        for (t, simplex) in simplices.iter().enumerate() {
            if is_of_tile(t) {
                for v in simplex.vertices {
                    is_copied[v as usize] |= up[v as usize];
                }
            }
        }
    }
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

/// Words on their way to the output, with their sum.
struct Words<'a, W> {
    out: &'a mut W,
    sum: WordSum,
    buffer: Vec<u8>,
}

impl<'a, W: Write> Words<'a, W> {
    /// Bytes that are written at once.
    const BLOCK: usize = 1 << 16;

    fn new(out: &'a mut W) -> Self {
        Self { out, sum: WordSum::default(), buffer: Vec::with_capacity(Self::BLOCK + 64) }
    }

    #[inline(always)]
    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.buffer.extend_from_slice(bytes);
        if self.buffer.len() >= Self::BLOCK { self.flush() } else { Ok(()) }
    }

    #[inline(always)]
    fn all<const N: usize>(&mut self, words: [u32; N]) -> io::Result<()> {
        let mut bytes = [[0; 4]; N];
        for (bytes, word) in bytes.iter_mut().zip(words) {
            *bytes = word.to_le_bytes();
        }
        self.put(bytes.as_flattened())
    }

    fn row(&mut self, row: u64, bytes: u32) -> io::Result<()> {
        // The caller chose the width by the number of rows.
        self.put(&row.to_le_bytes()[..bytes as usize])
    }

    #[cold]
    fn flush(&mut self) -> io::Result<()> {
        self.sum.add(&self.buffer);
        self.out.write_all(&self.buffer)?;
        self.buffer.clear();
        Ok(())
    }

    fn head(&mut self, dimension: usize) -> io::Result<()> {
        self.put(MAGIC)?;
        self.all([VERSION, dimension as u32])
    }

    fn finish(mut self, counts: &TileCounts, dimension: usize) -> io::Result<()> {
        self.put(MAGIC)?;
        let TileCounts { vertices_per_simplex, row_bytes, tile, .. } = *counts;
        self.all([VERSION, dimension as u32, vertices_per_simplex, row_bytes, tile, 0])?;
        let TileCounts { copies, sites, duplicates, simplices, links, hull, .. } = *counts;
        for count in [copies, sites, duplicates, simplices, links, hull] {
            self.put(&count.to_le_bytes())?;
        }
        self.put(&counts.fingerprint.0.to_le_bytes())?;
        self.flush()?;
        self.out.write_all(&self.sum.finish().to_le_bytes())
    }
}

/// Writes the tile of a node whose sites span all dimensions; returns its counts.
pub(in super::super) fn write_solved<const D: usize, const V: usize, G: Geometry<D, V>>(
    solved: &Solved<D, V, G>,
    order: &TileOrder,
    (tile, row_bytes): (u32, u32),
    unscale: Scale,
    out: &mut impl Write,
) -> io::Result<TileCounts> {
    let simplices = solved.mesh.simplices();
    let at = |v: u32| solved.mesh.site(v).map(|x| unscale.apply(x));
    let mut counts = TileCounts {
        vertices_per_simplex: V as u32,
        row_bytes,
        tile,
        copies: order.copies.len() as u64,
        sites: order.sites.len() as u64,
        duplicates: solved.duplicates.len() as u64,
        simplices: order.finite.len() as u64,
        ..TileCounts::default()
    };
    let mut words = Words::new(out);
    words.head(D)?;
    for &v in &order.sites {
        for x in at(v) {
            words.put(&x.to_le_bytes())?;
        }
    }
    for &v in &order.sites {
        words.row(solved.rows[v as usize], row_bytes)?;
    }
    write_duplicates(&mut words, &solved.duplicates, row_bytes)?;
    let mut links: Vec<TileLink> = Vec::new();
    for (place, &t) in order.finite.iter().enumerate() {
        fetch(simplices, order.finite.get(place + 2 * FETCH_AHEAD));
        if let Some(&soon) = order.finite.get(place + FETCH_AHEAD) {
            for i in 0..V {
                let Simplex { vertices, neighbors } = &simplices[soon as usize];
                prefetch(&order.places, decode(neighbors[i]).0 as usize);
                prefetch(&order.numbers, vertices[i] as usize);
                solved.mesh.fetch(vertices[i]);
            }
        }
        let simplex = &simplices[t as usize];
        let (mut hashes, mut numbers) = ([SiteHash::default(); V], [0; V]);
        for (i, &v) in simplex.vertices.iter().enumerate() {
            // To hash again takes less time than to look up what was hashed.
            hashes[i] = SiteHash::of(&at(v));
            numbers[i] = order.numbers[v as usize];
        }
        counts.fingerprint.add(hashes);
        let (mut vertices, mut neighbors) = ([0; V], [0; V]);
        for (k, &i) in arrangement(&simplex.vertices).iter().enumerate() {
            let i = usize::from(i);
            vertices[k] = numbers[i];
            neighbors[k] = neighbor(solved, order, t, i);
            if neighbors[k] >= OTHER_TILE {
                if neighbors[k] == NO_NEIGHBOR {
                    counts.hull += 1;
                } else if solved.states.is_frozen(t, i) {
                    let link = solved.links.get(t, i);
                    links.push(TileLink { code: code(place as u32, k as u32), link });
                }
            }
        }
        words.all(vertices)?;
        words.all(neighbors)?;
    }
    let outside = links_to_hull(solved);
    counts.hull += outside.len() as u64;
    links.extend(outside.into_iter().map(|link| TileLink { code: Link::OUTSIDE, link }));
    counts.links = links.len() as u64;
    for &copy in &order.copies {
        words.all([copy])?;
    }
    for TileLink { code, link } in links {
        words.all([code, link.tile, link.code])?;
    }
    words.finish(&counts, D)?;
    Ok(counts)
}

/// The facets of earlier tiles that this node found to lie on the hull, in order.
fn links_to_hull<const D: usize, const V: usize, G: Geometry<D, V>>(
    solved: &Solved<D, V, G>,
) -> Vec<Link> {
    let is_hull = |&(side, link): &(u32, Link)| {
        let (t, facet) = decode(side);
        let simplex = &solved.mesh.simplices()[t as usize];
        solved.states.is_final(t) && simplex.vertices[facet] == GHOST && !link.is_outside()
    };
    let mut links: Vec<Link> = solved.links.iter().filter(is_hull).map(|(_, link)| link).collect();
    links.sort_unstable_by_key(|link| (link.tile, link.code));
    links
}

fn write_duplicates<W: Write>(
    words: &mut Words<'_, W>,
    duplicates: &[[u64; 2]],
    row_bytes: u32,
) -> io::Result<()> {
    duplicates.as_flattened().iter().try_for_each(|&row| words.row(row, row_bytes))
}

/// Returns what the tile says of the neighbor of slot `t` across facet `i`.
#[inline(always)]
fn neighbor<const D: usize, const V: usize, G: Geometry<D, V>>(
    solved: &Solved<D, V, G>,
    order: &TileOrder,
    t: u32,
    i: usize,
) -> u32 {
    if solved.states.is_frozen(t, i) {
        return if solved.links.get(t, i).is_outside() { NO_NEIGHBOR } else { OTHER_TILE };
    }
    let (other, _) = decode(solved.mesh.simplices()[t as usize].neighbors[i]);
    let place = order.places[other as usize];
    match place {
        UNUSED if solved.states.is_open(other) => OTHER_TILE,
        UNUSED => NO_NEIGHBOR,
        _ => place,
    }
}

/// The tile of simplices that are listed: those of points that do not span all dimensions.
pub(in super::super) struct LowerTile<'a> {
    pub(in super::super) vertices_per_simplex: usize,
    /// Numbers of sites, in the order of the tile.
    pub(in super::super) simplices: &'a [u32],
    pub(in super::super) neighbors: &'a [u32],
}

impl LowerTile<'_> {
    /// The facets of the hull.
    pub(in super::super) fn hull(&self) -> u64 {
        // A single point has no facets.
        let is_open = |&&n: &&u32| n == NO_NEIGHBOR && self.vertices_per_simplex > 1;
        self.neighbors.iter().filter(is_open).count() as u64
    }
}

/// The fingerprint of simplices that are listed.
pub(in super::super) fn fingerprint_lower<const D: usize>(
    sites: &Front<D>,
    lower: &LowerTile<'_>,
) -> Fingerprint {
    let hash = |v: u32| SiteHash::of(&sites.coordinates[v as usize]);
    let mut fingerprint = Fingerprint::default();
    for simplex in lower.simplices.chunks_exact(lower.vertices_per_simplex.max(1)) {
        match *simplex {
            [a] => fingerprint.add([a].map(hash)),
            [a, b] => fingerprint.add([a, b].map(hash)),
            [a, b, c] => fingerprint.add([a, b, c].map(hash)),
            _ => {}
        }
    }
    fingerprint
}

/// Writes the tile of a node with sites that are all its own and simplices that are listed.
pub(in super::super) fn write_lower<const D: usize>(
    sites: &Front<D>,
    lower: &LowerTile<'_>,
    duplicates: &[[u64; 2]],
    (tile, row_bytes): (u32, u32),
    out: &mut impl Write,
) -> io::Result<TileCounts> {
    let vertices = lower.vertices_per_simplex;
    let counts = TileCounts {
        vertices_per_simplex: vertices as u32,
        row_bytes,
        tile,
        copies: 0,
        sites: sites.len() as u64,
        duplicates: duplicates.len() as u64,
        simplices: (lower.simplices.len() / vertices.max(1)) as u64,
        links: 0,
        hull: lower.hull(),
        fingerprint: fingerprint_lower(sites, lower),
    };
    let mut words = Words::new(out);
    words.head(D)?;
    for x in sites.coordinates.as_flattened() {
        words.put(&x.to_le_bytes())?;
    }
    for &row in &sites.rows {
        words.row(row, row_bytes)?;
    }
    write_duplicates(&mut words, duplicates, row_bytes)?;
    let width = vertices.max(1);
    for (simplex, neighbors) in
        lower.simplices.chunks_exact(width).zip(lower.neighbors.chunks_exact(width))
    {
        for &word in simplex.iter().chain(neighbors) {
            words.all([word])?;
        }
    }
    words.finish(&counts, D)?;
    Ok(counts)
}
