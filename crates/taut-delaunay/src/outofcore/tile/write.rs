//! Writes what a node finished, in canonical order, straight from its mesh.
//!
//! *Trap.* Slots are not in this order (`order`), so each pass over the simplices is a walk through memory. There is one pass
//! to write, vertices and neighbors together, and it asks for slots ahead of their use; three passes to write took as long as
//! the triangulation (2·10⁶ uniform points of space: 1240 of 3860 ns a point).
//! *Profile*, 10⁷ uniform points of the plane, one thread, 265 ns a point of processor time where the build in memory takes 180:
//! insertion 105, this file 28, order 17, distribution 22, sums 3, curve and gathering 25, the system 50. The first version
//! took 325: cells were found one point at a time (distribution 44), runs were sorted with branches (30), each simplex hashed
//! its sites (44), and a sum waited for each word (10). What insertion takes is less than in memory, as leaves fit the cache.

use std::io::{self, Write};

use taut_certify::{Fingerprint, SiteHash};
use taut_oblivious::machine::prefetch;
use taut_points::OrderBy;

use super::super::bytes::WordSum;
use super::super::front::{Front, Link};
use super::super::solve::Solved;
use super::order::{FETCH_AHEAD, TileOrder, UNUSED, fetch};
use super::{MAGIC, NO_NEIGHBOR, OTHER_TILE, TileCounts, TileLink, VERSION};
use crate::canonical::arrangement;
use crate::geometry::Geometry;
use crate::kernel::Kernel;
use crate::simplex::{GHOST, Simplex, code, decode};
use crate::sites::Scale;

/// Words on their way to the output, with their sum.
struct Words<'a, W> {
    out: &'a mut W,
    sum: WordSum,
    buffer: Vec<u8>,
    filled: usize,
}

impl<'a, W: Write> Words<'a, W> {
    /// Bytes that are written at once.
    const BLOCK: usize = 1 << 16;
    /// Most bytes that are put at once.
    const PUT_MAX: usize = 64;

    fn new(out: &'a mut W) -> Self {
        Self {
            out,
            sum: WordSum::default(),
            buffer: vec![0; Self::BLOCK + Self::PUT_MAX],
            filled: 0,
        }
    }

    #[inline(always)]
    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        debug_assert!(bytes.len() <= Self::PUT_MAX, "the buffer has room for one more piece");
        self.buffer[self.filled..self.filled + bytes.len()].copy_from_slice(bytes);
        self.filled += bytes.len();
        if self.filled >= Self::BLOCK { self.flush() } else { Ok(()) }
    }

    /// The vertices and the neighbors of a simplex.
    #[inline(always)]
    fn pair<const N: usize>(&mut self, vertices: [u32; N], neighbors: [u32; N]) -> io::Result<()> {
        let bytes = [vertices, neighbors].map(|words| words.map(u32::to_le_bytes));
        self.put(bytes.as_flattened().as_flattened())
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
        let filled = &self.buffer[..std::mem::take(&mut self.filled)];
        self.sum.add(filled);
        self.out.write_all(filled)
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
    // Each is looked up six times in the plane, 27 times in space.
    let mut hashes = vec![SiteHash::default(); solved.rows.len()];
    for &v in &order.sites {
        let p = at(v);
        hashes[v as usize] = SiteHash::of(&p);
        words.put(p.map(f64::to_le_bytes).as_flattened())?;
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
                prefetch(&hashes, vertices[i] as usize);
            }
        }
        let simplex = &simplices[t as usize];
        counts.fingerprint.add(simplex.vertices.map(|v| hashes[v as usize]));
        let numbers = simplex.vertices.map(|v| order.numbers[v as usize]);
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
        words.pair(vertices, neighbors)?;
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
    links.order_by_key(|link| (link.tile, link.code));
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
