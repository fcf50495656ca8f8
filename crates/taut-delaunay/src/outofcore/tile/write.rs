//! Writes what a node finished, in canonical order, straight from its mesh.
//!
//! *Idea.* Simplices are counted by their smallest site, which puts almost all in place, as few share it; the few are
//! sorted. Beside the mesh that takes 4 bytes for each slot and each simplex, and 8 for each site.

use std::io::{self, Write};

use taut_certify::{Fingerprint, SiteHash};

use super::super::bytes::WordSum;
use super::super::front::{Front, Link};
use super::super::solve::Solved;
use super::{HEADER, MAGIC, NO_NEIGHBOR, OTHER_TILE, TileHeader, TileLink, VERSION};
use crate::canonical::arrangement;
use crate::cells::Geometry;
use crate::kernel::Kernel;
use crate::simplex::{GHOST, Simplex, code, decode};
use crate::sites::Scale;

/// Not in the tile.
const UNUSED: u32 = u32::MAX;

/// The numbers of sites and simplices in the tile of a node.
pub(in super::super) struct TileOrder {
    /// For each site of the node its number in the tile.
    numbers: Vec<u32>,
    /// The sites of the tile.
    sites: Vec<u32>,
    owned: usize,
    /// The slots of the simplices of the tile.
    finite: Vec<u32>,
    /// For each slot its simplex in the tile.
    places: Vec<u32>,
}

/// A simplex by its vertices in ascending order, and its slot.
type SortedSimplex<const V: usize> = ([u32; V], u32);

impl TileOrder {
    /// The order of what `solved` finished, where the sites marked `up` are not owned.
    pub(in super::super) fn of<const D: usize, const V: usize, G: Geometry<D, V>>(
        solved: &Solved<D, V, G>,
        up: &[bool],
    ) -> Self {
        let simplices = solved.mesh.simplices();
        let is_ours = |t: u32, s: &Simplex<V>| solved.states.is_final(t) && !s.is_ghost();
        let (mut numbers, sites, owned) = number_sites(simplices, up, is_ours);
        let least = |s: &Simplex<V>| {
            s.vertices.iter().map(|&v| numbers[v as usize]).min().unwrap_or(0) as usize
        };
        // Two ahead: while simplices are put in place, entry i + 1 runs from the beginning of site i to its end.
        let mut starts = vec![0u32; sites.len() + 2];
        let ours = || (0u32..).zip(simplices).filter(|&(t, s)| is_ours(t, s));
        ours().for_each(|(_, s)| starts[least(s) + 2] += 1);
        for i in 2..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut finite = vec![0u32; starts[starts.len() - 1] as usize];
        for (t, s) in ours() {
            let next = &mut starts[least(s) + 1];
            finite[*next as usize] = t;
            *next += 1;
        }
        let mut run: Vec<SortedSimplex<V>> = Vec::new();
        for ends in starts.windows(2) {
            let slots = &mut finite[ends[0] as usize..ends[1] as usize];
            if slots.len() < 2 {
                continue;
            }
            run.clear();
            run.extend(slots.iter().map(|&t| {
                let mut vertices = simplices[t as usize].vertices.map(|v| numbers[v as usize]);
                vertices.sort_unstable();
                (vertices, t)
            }));
            run.sort_unstable();
            slots.iter_mut().zip(&run).for_each(|(slot, &(_, t))| *slot = t);
        }
        let mut places = vec![UNUSED; simplices.len()];
        (0u32..).zip(&finite).for_each(|(place, &t)| places[t as usize] = place);
        numbers.shrink_to_fit();
        Self { numbers, sites, owned, finite, places }
    }

    /// The code in the tile of a facet of one of its simplices.
    pub(in super::super) fn side<const V: usize>(
        &self,
        simplices: &[Simplex<V>],
        slot: u32,
        facet: usize,
    ) -> u32 {
        let vertices = simplices[slot as usize].vertices.map(|v| self.numbers[v as usize]);
        let arranged = arrangement(&vertices);
        let place = arranged.iter().position(|&i| usize::from(i) == facet).unwrap_or(0);
        code(self.places[slot as usize], place as u32)
    }
}

/// Numbers the owned sites first, then the others that simplices of the tile have.
fn number_sites<const V: usize>(
    simplices: &[Simplex<V>],
    up: &[bool],
    is_ours: impl Fn(u32, &Simplex<V>) -> bool,
) -> (Vec<u32>, Vec<u32>, usize) {
    let mut numbers = vec![UNUSED; up.len()];
    let mut sites: Vec<u32> = (0u32..).zip(up).filter(|&(_, &up)| !up).map(|(v, _)| v).collect();
    (0u32..).zip(&sites).for_each(|(number, &v)| numbers[v as usize] = number);
    let owned = sites.len();
    if owned < up.len() {
        let mut is_copied = vec![false; up.len()];
        for (_, s) in (0u32..).zip(simplices).filter(|&(t, s)| is_ours(t, s)) {
            s.vertices.iter().for_each(|&v| is_copied[v as usize] |= up[v as usize]);
        }
        for (v, _) in (0u32..).zip(&is_copied).filter(|&(_, &copied)| copied) {
            numbers[v as usize] = sites.len() as u32;
            sites.push(v);
        }
    }
    (numbers, sites, owned)
}

/// Hashes of sites that were lately asked for, as simplices side by side have sites in common.
struct HashCache {
    entries: Vec<(u32, SiteHash)>,
}

impl HashCache {
    const ENTRIES: usize = 1 << 12;

    fn new() -> Self {
        Self { entries: vec![(GHOST, SiteHash::default()); Self::ENTRIES] }
    }

    #[inline(always)]
    fn get(&mut self, site: u32, hash: impl FnOnce() -> SiteHash) -> SiteHash {
        let entry = &mut self.entries[site as usize % Self::ENTRIES];
        if entry.0 != site {
            *entry = (site, hash());
        }
        entry.1
    }
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
        words.iter().for_each(|w| self.buffer.extend_from_slice(&w.to_le_bytes()));
        self.put(&[])
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

    fn header(&mut self, header: &TileHeader, dimension: usize) -> io::Result<()> {
        let TileHeader { vertices_per_simplex, row_bytes, tile, .. } = *header;
        self.put(MAGIC)?;
        self.all([VERSION, dimension as u32, vertices_per_simplex, row_bytes, tile, 0])?;
        let TileHeader { owned, sites, duplicates, simplices, links, hull, .. } = *header;
        for count in [owned, sites, duplicates, simplices, links, hull] {
            self.put(&count.to_le_bytes())?;
        }
        self.put(&header.fingerprint.0.to_le_bytes())?;
        self.put(&[0; HEADER - 96])
    }

    fn finish(mut self) -> io::Result<()> {
        self.flush()?;
        self.out.write_all(&self.sum.finish().to_le_bytes())
    }
}

/// Writes the tile of a node whose sites span all dimensions; returns what its header says.
pub(in super::super) fn write_solved<const D: usize, const V: usize, G: Geometry<D, V>>(
    solved: &Solved<D, V, G>,
    order: &TileOrder,
    (tile, row_bytes): (u32, u32),
    unscale: Scale,
    out: &mut impl Write,
) -> io::Result<TileHeader> {
    let simplices = solved.mesh.simplices();
    let at = |v: u32| solved.mesh.site(v).map(|x| unscale.apply(x));
    let mut header = TileHeader {
        vertices_per_simplex: V as u32,
        row_bytes,
        tile,
        owned: order.owned as u64,
        sites: order.sites.len() as u64,
        duplicates: solved.duplicates.len() as u64,
        simplices: order.finite.len() as u64,
        ..TileHeader::default()
    };
    let mut cache = HashCache::new();
    let mut links: Vec<TileLink> = Vec::new();
    for (place, &t) in (0u32..).zip(&order.finite) {
        let simplex = &simplices[t as usize];
        let hashes = simplex.vertices.map(|v| cache.get(v, || SiteHash::of(&at(v))));
        header.fingerprint.add(hashes);
        let arranged = arrangement(&simplex.vertices.map(|v| order.numbers[v as usize]));
        for (facet, &i) in (0u32..).zip(&arranged) {
            match neighbor(solved, order, t, usize::from(i)) {
                NO_NEIGHBOR => header.hull += 1,
                OTHER_TILE if solved.states.is_frozen(t, usize::from(i)) => {
                    let link = solved.links.get(t, usize::from(i));
                    links.push(TileLink { code: code(place, facet), link });
                }
                _ => {}
            }
        }
    }
    let outside = links_to_hull(solved);
    header.hull += outside.len() as u64;
    links.extend(outside.into_iter().map(|link| TileLink { code: Link::OUTSIDE, link }));
    header.links = links.len() as u64;

    let mut words = Words::new(out);
    words.header(&header, D)?;
    for &v in &order.sites {
        for x in at(v) {
            words.put(&x.to_le_bytes())?;
        }
    }
    for &v in &order.sites {
        words.row(solved.rows[v as usize], row_bytes)?;
    }
    write_duplicates(&mut words, &solved.duplicates, row_bytes)?;
    for &t in &order.finite {
        let vertices = simplices[t as usize].vertices.map(|v| order.numbers[v as usize]);
        words.all(arrangement(&vertices).map(|i| vertices[usize::from(i)]))?;
    }
    for &t in &order.finite {
        let vertices = simplices[t as usize].vertices.map(|v| order.numbers[v as usize]);
        words.all(arrangement(&vertices).map(|i| neighbor(solved, order, t, usize::from(i))))?;
    }
    for TileLink { code, link } in links {
        words.all([code, link.tile, link.code])?;
    }
    words.finish()?;
    Ok(header)
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

/// Writes the tile of a node with sites that are all its own and simplices that are listed.
pub(in super::super) fn write_lower<const D: usize>(
    sites: &Front<D>,
    lower: &LowerTile<'_>,
    duplicates: &[[u64; 2]],
    (tile, row_bytes): (u32, u32),
    out: &mut impl Write,
) -> io::Result<TileHeader> {
    let hull = lower.neighbors.iter().filter(|&&n| n == NO_NEIGHBOR).count() as u64;
    let vertices = lower.vertices_per_simplex;
    let hash = |v: u32| SiteHash::of(&sites.coordinates[v as usize]);
    let mut fingerprint = Fingerprint::default();
    for simplex in lower.simplices.chunks_exact(vertices.max(1)) {
        match *simplex {
            [a] => fingerprint.add([a].map(hash)),
            [a, b] => fingerprint.add([a, b].map(hash)),
            [a, b, c] => fingerprint.add([a, b, c].map(hash)),
            _ => {}
        }
    }
    let header = TileHeader {
        vertices_per_simplex: vertices as u32,
        row_bytes,
        tile,
        owned: sites.len() as u64,
        sites: sites.len() as u64,
        duplicates: duplicates.len() as u64,
        simplices: (lower.simplices.len() / vertices.max(1)) as u64,
        links: 0,
        hull,
        fingerprint,
    };
    let mut words = Words::new(out);
    words.header(&header, D)?;
    for x in sites.coordinates.as_flattened() {
        words.put(&x.to_le_bytes())?;
    }
    for &row in &sites.rows {
        words.row(row, row_bytes)?;
    }
    write_duplicates(&mut words, duplicates, row_bytes)?;
    for &word in lower.simplices.iter().chain(lower.neighbors) {
        words.all([word])?;
    }
    words.finish()?;
    Ok(header)
}
