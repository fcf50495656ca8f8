//! Reads a tile from bytes that may be anything.

use super::super::bytes::{Reader, word_sum};
use super::super::front::Link;
use super::{COUNTS_BYTES, MAGIC, NO_NEIGHBOR, OTHER_TILE, TileCounts, TileLink, VERSION};
use crate::Error;
use crate::simplex::decode;

/// One tile in memory; the module says what it holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile<const D: usize> {
    /// The counts.
    pub counts: TileCounts,
    /// The coordinates of the sites.
    pub coordinates: Vec<[f64; D]>,
    /// The smallest row of each site.
    pub rows: Vec<u64>,
    /// Rows that equal a smaller row, with the smallest row they equal.
    pub duplicates: Vec<[u64; 2]>,
    /// The vertices of the simplices, as numbers of sites of the tile.
    pub simplices: Vec<u32>,
    /// For each vertex of each simplex the simplex across the facet opposite, [`NO_NEIGHBOR`] or [`OTHER_TILE`].
    pub neighbors: Vec<u32>,
    /// The sites that other tiles own, ascending.
    pub copies: Vec<u32>,
    /// The facets whose other side an earlier tile has.
    pub links: Vec<TileLink>,
}

fn damaged(what: &'static str) -> Error {
    Error::DamagedTile { what }
}

impl TileCounts {
    /// The counts of a tile of points of dimension `D` from its last 104 bytes; `None` if these are no such counts.
    pub fn from_bytes<const D: usize>(bytes: &[u8]) -> Option<Self> {
        let mut reader = Reader::new(bytes);
        if reader.take(8)? != MAGIC || reader.u32()? != VERSION || reader.u32()? != D as u32 {
            return None;
        }
        let counts = Self {
            vertices_per_simplex: reader.u32()?,
            row_bytes: reader.u32()?,
            tile: reader.u32().filter(|_| reader.u32().is_some())?,
            copies: reader.u64()?,
            sites: reader.u64()?,
            duplicates: reader.u64()?,
            simplices: reader.u64()?,
            links: reader.u64()?,
            hull: reader.u64()?,
            fingerprint: taut_certify::Fingerprint(
                u128::from(reader.u64()?) | u128::from(reader.u64()?) << 64,
            ),
        };
        let known =
            counts.vertices_per_simplex <= D as u32 + 1 && [4, 8].contains(&counts.row_bytes);
        (known && counts.copies <= counts.sites).then_some(counts)
    }
}

impl<const D: usize> Tile<D> {
    /// The tile that these bytes are.
    ///
    /// # Errors
    /// [`Error::DamagedTile`] if they are other bytes, or name sites or simplices that are not there.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let body = bytes.len().checked_sub(8).ok_or(damaged("it ends too early"))?;
        if Reader::new(&bytes[body..]).u64() != Some(word_sum(&bytes[..body])) {
            return Err(damaged("its sum is wrong"));
        }
        let end = bytes.len().checked_sub(COUNTS_BYTES).ok_or(damaged("it ends too early"))?;
        let counts = TileCounts::from_bytes::<D>(&bytes[end..])
            .ok_or(damaged("it does not end like a tile of points of this dimension"))?;
        if counts.bytes(D) != Some(bytes.len() as u64) {
            return Err(damaged("its length is wrong"));
        }
        let tile = Self::read_body(counts, &mut Reader::new(&bytes[..end]));
        let tile = tile.ok_or(damaged("it does not begin like a tile"))?;
        tile.check_numbers()?;
        Ok(tile)
    }

    fn read_body(counts: TileCounts, reader: &mut Reader<'_>) -> Option<Self> {
        fn list<T>(count: u64, mut read: impl FnMut() -> Option<T>) -> Option<Vec<T>> {
            (0..count).map(|_| read()).collect()
        }
        if reader.take(8)? != MAGIC || reader.u32()? != VERSION || reader.u32()? != D as u32 {
            return None;
        }
        let wide = counts.row_bytes == 8;
        let row = |reader: &mut Reader<'_>| {
            if wide { reader.u64() } else { reader.u32().map(u64::from) }
        };
        let mut tile = Self {
            counts,
            coordinates: list(counts.sites, || reader.points())?,
            rows: list(counts.sites, || row(reader))?,
            duplicates: list(counts.duplicates, || Some([row(reader)?, row(reader)?]))?,
            simplices: vec![],
            neighbors: vec![],
            copies: vec![],
            links: vec![],
        };
        for _ in 0..counts.simplices {
            for list in [&mut tile.simplices, &mut tile.neighbors] {
                for _ in 0..counts.vertices_per_simplex {
                    list.push(reader.u32()?);
                }
            }
        }
        tile.copies = list(counts.copies, || reader.u32())?;
        tile.links = list(counts.links, || {
            let code = reader.u32()?;
            Some(TileLink { code, link: Link { tile: reader.u32()?, code: reader.u32()? } })
        })?;
        Some(tile)
    }

    fn check_numbers(&self) -> Result<(), Error> {
        let TileCounts { sites, simplices, vertices_per_simplex, .. } = self.counts;
        if self.simplices.iter().any(|&v| u64::from(v) >= sites) {
            return Err(damaged("a simplex has a site that is not there"));
        }
        let is_ascending = self.copies.is_sorted_by(|a, b| a < b);
        if !is_ascending || self.copies.last().is_some_and(|&v| u64::from(v) >= sites) {
            return Err(damaged("a copy is of a site that is not there"));
        }
        let is_known = |&n: &u32| n == NO_NEIGHBOR || n == OTHER_TILE || u64::from(n) < simplices;
        if !self.neighbors.iter().all(is_known) {
            return Err(damaged("a neighbor is not there"));
        }
        let is_here = |link: &TileLink| {
            let (simplex, facet) = decode(link.code);
            let is_simplex =
                u64::from(simplex) < simplices && (facet as u32) < vertices_per_simplex;
            is_simplex || link.code == Link::OUTSIDE
        };
        if !self.links.iter().all(is_here) || !self.links.is_sorted_by_key(|link| link.code) {
            return Err(damaged("a link is not of a simplex of the tile"));
        }
        Ok(())
    }

    /// The vertices of each simplex.
    pub fn simplex_rows(&self) -> std::slice::ChunksExact<'_, u32> {
        self.simplices.chunks_exact(self.counts.vertices_per_simplex.max(1) as usize)
    }
}
