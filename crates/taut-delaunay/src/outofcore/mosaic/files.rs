//! The tiles of a folder: one read whole, parts of others.

use std::collections::HashMap;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use taut_oblivious::machine::Store;
use taut_points::InputError;

use super::Corners;
use crate::Error;
use crate::outofcore::bytes::Reader;
use crate::outofcore::disk::complete_manifest;
use crate::outofcore::disk::tile_name;
use crate::outofcore::front::Link;
use crate::outofcore::tile::{COUNTS_BYTES, HEAD_BYTES, Tile, TileCounts, TileLink};

/// Open files that are kept; systems allow a process 256 or more.
const OPEN_FILES_MAX: usize = 100;

/// Sites that are read at once.
const SITES_AT_ONCE: u64 = 1 << 14;

pub(super) struct TileFiles<const D: usize> {
    folder: PathBuf,
    /// Numbers and counts of the tiles, by number.
    tiles: Vec<(u32, TileCounts)>,
    open: Mutex<HashMap<u32, Arc<File>>>,
}

impl<const D: usize> TileFiles<D> {
    pub(super) fn open(folder: &Path) -> Result<Self, Error> {
        let manifest = complete_manifest(folder)?;
        if manifest.dimension != D as u64 {
            let expected = if D == 2 { "2, the plane" } else { "3, space" };
            let dim = manifest.dimension as usize;
            return Err(InputError::Dimension { dim, expected }.into());
        }
        let mut files = Self { folder: folder.to_owned(), tiles: vec![], open: Mutex::default() };
        for number in manifest.tiles {
            let counts = files.read_counts(number)?;
            files.tiles.push((number, counts));
        }
        Ok(files)
    }

    pub(super) fn numbers(&self) -> impl Iterator<Item = u32> {
        self.tiles.iter().map(|tile| tile.0)
    }

    pub(super) fn counts(&self) -> impl Iterator<Item = &TileCounts> {
        self.tiles.iter().map(|tile| &tile.1)
    }

    fn path(&self, number: u32) -> PathBuf {
        self.folder.join(tile_name(number))
    }

    fn damaged(&self, number: u32) -> Error {
        Error::DamagedFolder { path: self.path(number).display().to_string() }
    }

    fn failed(&self, number: u32) -> impl Fn(std::io::Error) -> Error {
        let path = self.path(number).display().to_string();
        move |source| Error::File { path: path.clone(), source }
    }

    fn file(&self, number: u32) -> Result<Arc<File>, Error> {
        let Ok(mut open) = self.open.lock() else { return Err(self.damaged(number)) };
        if let Some(file) = open.get(&number) {
            return Ok(file.clone());
        }
        if open.len() >= OPEN_FILES_MAX {
            open.clear();
        }
        let file = File::open(self.path(number)).map_err(self.failed(number))?;
        let file = Arc::new(file);
        open.insert(number, file.clone());
        Ok(file)
    }

    fn read(&self, number: u32, at: u64, bytes: u64) -> Result<Vec<u8>, Error> {
        let mut read = vec![0; usize::try_from(bytes).map_err(|_| self.damaged(number))?];
        self.file(number)?.read_exact_at(&mut read, at).map_err(self.failed(number))?;
        Ok(read)
    }

    fn read_counts(&self, number: u32) -> Result<TileCounts, Error> {
        let length = self.file(number)?.metadata().map_err(self.failed(number))?.len();
        let begin = length.checked_sub(COUNTS_BYTES as u64).ok_or_else(|| self.damaged(number))?;
        let bytes = self.read(number, begin, COUNTS_BYTES as u64)?;
        let counts = TileCounts::from_bytes::<D>(&bytes);
        let is_whole =
            |counts: &TileCounts| counts.bytes(D) == Some(length) && counts.tile == number;
        counts.filter(is_whole).ok_or_else(|| self.damaged(number))
    }

    fn counts_of(&self, number: u32) -> Result<&TileCounts, Error> {
        let place = self.tiles.binary_search_by_key(&number, |tile| tile.0);
        place.map(|place| &self.tiles[place].1).map_err(|_| self.damaged(number))
    }

    /// The whole tile.
    pub(super) fn tile(&self, number: u32) -> Result<Tile<D>, Error> {
        let bytes = std::fs::read(self.path(number)).map_err(self.failed(number))?;
        Tile::from_bytes(&bytes).map_err(|_| self.damaged(number))
    }

    pub(super) fn links(&self, number: u32) -> Result<Vec<TileLink>, Error> {
        let counts = self.counts_of(number)?;
        let bytes = counts.links * 12;
        let end = counts.bytes(D).unwrap_or(0) - COUNTS_BYTES as u64;
        let read = self.read(number, end - bytes, bytes)?;
        let mut reader = Reader::new(&read);
        let mut link = || {
            let code = reader.u32()?;
            Some(TileLink { code, link: Link { tile: reader.u32()?, code: reader.u32()? } })
        };
        (0..counts.links).map(|_| link().ok_or_else(|| self.damaged(number))).collect()
    }

    pub(super) fn each_site(
        &self,
        number: u32,
        add: &mut impl FnMut(&[f64; D]),
    ) -> Result<(), Error> {
        let sites = self.counts_of(number)?.sites;
        let mut done = 0;
        while done < sites {
            let count = SITES_AT_ONCE.min(sites - done);
            let width = 8 * D as u64;
            let bytes = self.read(number, HEAD_BYTES as u64 + done * width, count * width)?;
            let mut reader = Reader::new(&bytes);
            while let Some(p) = reader.points() {
                add(&p);
            }
            done += count;
        }
        Ok(())
    }

    /// The corners of one simplex.
    pub(super) fn corners<const W: usize>(
        &self,
        number: u32,
        simplex: u32,
    ) -> Result<Corners<D, W>, Error> {
        let counts = self.counts_of(number)?;
        let (sites, row_bytes) = (counts.sites, u64::from(counts.row_bytes));
        let coordinates = HEAD_BYTES as u64;
        let rows = coordinates + sites * 8 * D as u64;
        let simplices = rows + (sites + 2 * counts.duplicates) * row_bytes;
        let damaged = || self.damaged(number);
        if u64::from(simplex) >= counts.simplices || counts.vertices_per_simplex != W as u32 {
            return Err(damaged());
        }
        let bytes =
            self.read(number, simplices + u64::from(simplex) * 8 * W as u64, 8 * W as u64)?;
        let mut reader = Reader::new(&bytes);
        let mut corners = Corners { rows: [0; W], at: [[0.0; D]; W], neighbors: [0; W] };
        let mut vertices = [0u32; W];
        for word in vertices.iter_mut().chain(&mut corners.neighbors) {
            *word = reader.u32().ok_or_else(damaged)?;
        }
        for (i, v) in vertices.into_iter().map(u64::from).enumerate() {
            if v >= sites {
                return Err(damaged());
            }
            let at = self.read(number, coordinates + v * 8 * D as u64, 8 * D as u64)?;
            corners.at[i] = Reader::new(&at).points().ok_or_else(damaged)?;
            let row = self.read(number, rows + v * row_bytes, row_bytes)?;
            let mut reader = Reader::new(&row);
            let row = if row_bytes == 8 { reader.u64() } else { reader.u32().map(u64::from) };
            corners.rows[i] = row.ok_or_else(damaged)?;
        }
        Ok(corners)
    }
}
