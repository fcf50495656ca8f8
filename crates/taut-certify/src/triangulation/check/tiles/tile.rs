//! A tile, read from front to back from its definition in docs/delaunay.md, some simplices at a time.
//!
//! *Order.* The counts are at the end of the file and the links just before, so these are read first; then all bytes in
//! order, for their sum. Sites stay in memory until the last simplex; simplices pass.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::super::super::Fingerprint;
use super::sum::Sum;
use super::{TilesError, TilesViolation};

const MAGIC: &[u8; 8] = b"TAUTTILE";
const VERSION: u32 = 1;
const HEAD_BYTES: u64 = 16;
/// Bytes of the counts at the end, with the sum.
const COUNTS_BYTES: u64 = 104;
/// Among neighbors: the simplex is in another tile.
pub(super) const OTHER_TILE: u32 = u32::MAX - 1;
/// The side of a link that is no simplex: the facet of the other tile lies on the hull.
const OUTSIDE: u32 = u32::MAX;
/// Simplices of a tile: a number and a facet make a code, which must not be [`OUTSIDE`].
const SIMPLICES_MAX: u64 = (1 << 30) - 1;
/// Bytes that are read at once.
const READ_BYTES: usize = 1 << 18;

/// The counts at the end of a tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Counts {
    pub(super) vertices: u32,
    pub(super) copies: u64,
    pub(super) sites: u64,
    pub(super) duplicates: u64,
    pub(super) simplices: u64,
    pub(super) links: u64,
    pub(super) hull: u64,
    pub(super) fingerprint: Fingerprint,
}

/// The sites and links of a tile.
pub(super) struct TileSites<const D: usize> {
    pub(super) tile: u32,
    pub(super) coordinates: Vec<[f64; D]>,
    pub(super) rows: Vec<u64>,
    /// The facets with a link, ascending: code here, tile, code there.
    pub(super) links: Vec<[u32; 3]>,
    /// The facets of other tiles that are said to lie on the hull: tile, code.
    pub(super) outside: Vec<[u32; 2]>,
}

/// The expectations of a tile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Expected {
    /// Points of the input.
    pub(super) points: u64,
    pub(super) row_bytes: u32,
    /// Vertices of a simplex.
    pub(super) vertices: u32,
    /// Bytes of memory for what stays of a tile while it is read.
    pub(super) memory: u64,
}

/// Simplices one after the other, and the neighbors of each.
pub(super) type WithNeighbors = (Vec<u32>, Vec<u32>);

/// The file of a tile that is being read.
pub(super) struct TileFile<const D: usize> {
    path: PathBuf,
    file: File,
    tile: u32,
    pub(super) counts: Counts,
    row_bytes: usize,
    sum: Sum,
}

/// The name of the file of a tile.
pub(super) fn file_name(tile: u32) -> String {
    format!("tile-{tile:08}.ttd")
}

fn word(bytes: &[u8], at: usize) -> u32 {
    bytes[at..].first_chunk().map_or(0, |bytes| u32::from_le_bytes(*bytes))
}

fn long(bytes: &[u8], at: usize) -> u64 {
    bytes[at..].first_chunk().map_or(0, |bytes| u64::from_le_bytes(*bytes))
}

impl<const D: usize> TileFile<D> {
    /// Opens a tile and reads its counts.
    pub(super) fn open(
        folder: &Path,
        (tile, bytes): (u32, u64),
        expected: &Expected,
    ) -> Result<Self, TilesError> {
        let path = folder.join(file_name(tile));
        let wrong = |problem: String| TilesError::from(TilesViolation::Tile { tile, problem });
        let failed = |source| TilesError::File { path: path.clone(), source };
        let length = match fs::metadata(&path) {
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return Err(wrong("is not there".into()));
            }
            // To open a pipe would wait for its writer.
            Ok(found) if !found.is_file() => return Err(wrong("is not a file".into())),
            found => found.map_err(failed)?.len(),
        };
        let mut file = File::open(&path).map_err(failed)?;
        if length != bytes {
            return Err(wrong(format!("has {length} bytes, the manifest says {bytes}")));
        }
        if length < HEAD_BYTES + COUNTS_BYTES {
            return Err(wrong(format!("has {length} bytes, which is too short for a tile")));
        }
        let mut end = [0; COUNTS_BYTES as usize];
        file.seek(SeekFrom::Start(length - COUNTS_BYTES)).map_err(failed)?;
        file.read_exact(&mut end).map_err(failed)?;
        if &end[..8] != MAGIC || word(&end, 8) != VERSION || word(&end, 12) != D as u32 {
            return Err(wrong(format!("does not end like a tile of points of dimension {D}")));
        }
        let counts = Counts {
            vertices: word(&end, 16),
            copies: long(&end, 32),
            sites: long(&end, 40),
            duplicates: long(&end, 48),
            simplices: long(&end, 56),
            links: long(&end, 64),
            hull: long(&end, 72),
            fingerprint: Fingerprint(u128::from(long(&end, 80)) | u128::from(long(&end, 88)) << 64),
        };
        let row_bytes = word(&end, 20);
        let is_empty = counts.vertices == 0 && counts.simplices == 0;
        if word(&end, 24) != tile || row_bytes != expected.row_bytes {
            return Err(wrong("is another tile than its name and the manifest say".into()));
        }
        if counts.vertices != expected.vertices && !is_empty {
            let (claimed, found) = (counts.vertices, expected.vertices);
            return Err(wrong(format!("has simplices of {claimed} vertices, expected {found}")));
        }
        if counts.simplices > SIMPLICES_MAX || counts.sites > u64::from(u32::MAX) {
            return Err(wrong("has more simplices or sites than a tile can have".into()));
        }
        if counts.copies > counts.sites || counts.length::<D>(row_bytes) != Some(length) {
            return Err(wrong("has another length than its counts say".into()));
        }
        let needed = counts.memory::<D>();
        if needed > expected.memory {
            let (what, allowed) = (file_name(tile), expected.memory);
            return Err(TilesError::Memory { what, needed, allowed });
        }
        Ok(TileFile {
            path,
            file,
            tile,
            counts,
            row_bytes: row_bytes as usize,
            sum: Sum::default(),
        })
    }

    fn failed(&self) -> impl Fn(io::Error) -> TilesError + use<D> {
        let path = self.path.clone();
        move |source| TilesError::File { path: path.clone(), source }
    }

    fn wrong(&self, problem: impl Into<String>) -> TilesError {
        TilesViolation::Tile { tile: self.tile, problem: problem.into() }.into()
    }

    /// Reads links, head and sites. What follows is read in order.
    pub(super) fn sites(&mut self, expected: &Expected) -> Result<Arc<TileSites<D>>, TilesError> {
        let Counts { sites, links, simplices, vertices, .. } = self.counts;
        let failed = self.failed();
        let end = -i64::try_from(COUNTS_BYTES + 12 * links).unwrap_or(i64::MAX);
        self.file.seek(SeekFrom::End(end)).map_err(&failed)?;
        let (mut inner, mut outside) = (vec![], vec![]);
        let mut last: Option<u32> = None;
        let tile = self.tile;
        self.unsummed(12, links, |link| {
            let [code, other, there] = [word(link, 0), word(link, 4), word(link, 8)];
            if code == OUTSIDE {
                outside.push([other, there]);
                return Ok(());
            }
            let is_facet = u64::from(code >> 2) < simplices && (code & 3) < vertices;
            if !is_facet || !outside.is_empty() || last.is_some_and(|last| last >= code) {
                let problem = "has links that do not ascend, or are of no simplex".to_owned();
                return Err(TilesViolation::Tile { tile, problem }.into());
            }
            last = Some(code);
            inner.push([code, other, there]);
            Ok(())
        })?;
        self.file.seek(SeekFrom::Start(0)).map_err(&failed)?;
        let mut head = [0; HEAD_BYTES as usize];
        self.file.read_exact(&mut head).map_err(&failed)?;
        self.sum.add(&head);
        if &head[..8] != MAGIC || word(&head, 8) != VERSION || word(&head, 12) != D as u32 {
            return Err(self.wrong("does not begin like a tile of points of this dimension"));
        }
        let mut coordinates: Vec<[f64; D]> = Vec::with_capacity(sites as usize);
        self.items(8 * D, sites, |bytes| {
            let site = coordinates.len();
            let mut p = [0.0; D];
            for (x, bytes) in p.iter_mut().zip(bytes.as_chunks::<8>().0) {
                // Adding 0 turns −0 into 0, as for the input.
                *x = f64::from_le_bytes(*bytes) + 0.0;
            }
            if p.iter().any(|x| !x.is_finite()) {
                let problem = format!("has a site {site} with a coordinate that is not finite");
                return Err(TilesViolation::Tile { tile, problem }.into());
            }
            coordinates.push(p);
            Ok(())
        })?;
        let mut rows: Vec<u64> = Vec::with_capacity(sites as usize);
        self.rows(sites, |[row]| {
            if row >= expected.points {
                let site = rows.len();
                let problem =
                    format!("has a site {site} that is point {row}, but there are not so many");
                return Err(TilesViolation::Tile { tile, problem }.into());
            }
            rows.push(row);
            Ok(())
        })?;
        Ok(Arc::new(TileSites { tile, coordinates, rows, links: inner, outside }))
    }

    /// Reads the duplicates.
    pub(super) fn duplicates(
        &mut self,
        work: impl FnMut([u64; 2]) -> Result<(), TilesError>,
    ) -> Result<(), TilesError> {
        self.rows(self.counts.duplicates, work)
    }

    /// Reads `count` simplices, which must be there, and the neighbors of each.
    pub(super) fn simplices<const V: usize>(
        &mut self,
        count: usize,
        first: u64,
    ) -> Result<WithNeighbors, TilesError> {
        let (mut simplices, mut neighbors): (Vec<[u32; V]>, Vec<[u32; V]>) =
            (Vec::with_capacity(count), Vec::with_capacity(count));
        let (tile, sites, all) = (self.tile, self.counts.sites, self.counts.simplices);
        self.items(8 * V, count as u64, |bytes| {
            let (words, _) = bytes.as_chunks::<4>();
            let simplex: [u32; V] = std::array::from_fn(|i| u32::from_le_bytes(words[i]));
            let across: [u32; V] = std::array::from_fn(|i| u32::from_le_bytes(words[V + i]));
            let largest = simplex.iter().fold(0, |largest, &v| largest.max(v));
            let is_known = |&n: &u32| u64::from(n) < all || n >= OTHER_TILE;
            if u64::from(largest) >= sites || !across.iter().all(is_known) {
                let simplex = first + simplices.len() as u64;
                let problem =
                    format!("has a simplex {simplex} with a site or neighbor that is not there");
                return Err(TilesViolation::Tile { tile, problem }.into());
            }
            simplices.push(simplex);
            neighbors.push(across);
            Ok(())
        })?;
        Ok((simplices.into_flattened(), neighbors.into_flattened()))
    }

    /// Reads the copies and all that is left; the copies ascend.
    pub(super) fn finish(mut self) -> Result<Vec<u32>, TilesError> {
        let (tile, sites) = (self.tile, self.counts.sites);
        let mut copies: Vec<u32> = Vec::with_capacity(self.counts.copies as usize);
        self.items(4, self.counts.copies, |bytes| {
            let copy = word(bytes, 0);
            if u64::from(copy) >= sites || copies.last().is_some_and(|&last| last >= copy) {
                let problem = "lists copies that do not ascend, or are of no site".to_owned();
                return Err(TilesViolation::Tile { tile, problem }.into());
            }
            copies.push(copy);
            Ok(())
        })?;
        self.items(12, self.counts.links, |_| Ok(()))?;
        let mut end = [0; COUNTS_BYTES as usize];
        let failed = self.failed();
        self.file.read_exact(&mut end).map_err(failed)?;
        self.sum.add(&end[..COUNTS_BYTES as usize - 8]);
        if std::mem::take(&mut self.sum).finish() != long(&end, COUNTS_BYTES as usize - 8) {
            return Err(self.wrong("is damaged: its sum is wrong"));
        }
        Ok(copies)
    }

    fn rows<const N: usize>(
        &mut self,
        count: u64,
        mut work: impl FnMut([u64; N]) -> Result<(), TilesError>,
    ) -> Result<(), TilesError> {
        let width = self.row_bytes;
        self.items(N * width, count, |bytes| {
            work(std::array::from_fn(|i| match width {
                4 => u64::from(word(bytes, 4 * i)),
                _ => long(bytes, 8 * i),
            }))
        })
    }

    /// Calls `work` with each of `count` items of `width` bytes.
    fn items(
        &mut self,
        width: usize,
        count: u64,
        work: impl FnMut(&[u8]) -> Result<(), TilesError>,
    ) -> Result<(), TilesError> {
        let mut sum = std::mem::take(&mut self.sum);
        let read = self.read_items(width, count, Some(&mut sum), work);
        self.sum = sum;
        read
    }

    /// The same of items that are read again in their turn.
    fn unsummed(
        &mut self,
        width: usize,
        count: u64,
        work: impl FnMut(&[u8]) -> Result<(), TilesError>,
    ) -> Result<(), TilesError> {
        self.read_items(width, count, None, work)
    }

    fn read_items(
        &mut self,
        width: usize,
        count: u64,
        mut sum: Option<&mut Sum>,
        mut work: impl FnMut(&[u8]) -> Result<(), TilesError>,
    ) -> Result<(), TilesError> {
        let at_once = (READ_BYTES / width) as u64;
        let mut buffer = vec![0; (at_once.min(count) as usize) * width];
        let (mut left, failed) = (count, self.failed());
        while left > 0 {
            let items = at_once.min(left);
            let bytes = &mut buffer[..items as usize * width];
            self.file.read_exact(bytes).map_err(&failed)?;
            if let Some(sum) = &mut sum {
                sum.add(bytes);
            }
            bytes.chunks_exact(width).try_for_each(&mut work)?;
            left -= items;
        }
        Ok(())
    }
}

impl Counts {
    /// Bytes of the file.
    fn length<const D: usize>(&self, row_bytes: u32) -> Option<u64> {
        let row = u128::from(row_bytes);
        let total = u128::from(HEAD_BYTES + COUNTS_BYTES)
            + u128::from(self.sites) * (8 * D as u128 + row)
            + u128::from(self.duplicates) * 2 * row
            + u128::from(self.simplices) * 8 * u128::from(self.vertices)
            + u128::from(self.copies) * 4
            + u128::from(self.links) * 12;
        u64::try_from(total).ok()
    }

    /// Bytes of memory that stay while the tile is read: its sites with two marks and the copies, and the links.
    pub(super) fn memory<const D: usize>(&self) -> u64 {
        self.sites * (8 * D as u64 + 8 + 2) + 4 * self.copies + 12 * self.links
    }
}
