//! How far the first pass came: what a resumed run needs to go on.
//!
//! *Bytes*, little-endian: magic `TAUTDIST`, version u32, D u32; the hash of the sample u64; largest magnitude f64, lowest
//! exponent i32; blocks u64 and the hash of each; buckets u64 and the length of each; cells u64 and for each its smallest and
//! largest coordinates and its points; the sum of the words.
//! *Trap.* A resumed run draws the sample again. If rows that were not distributed yet are others now, so is the sample,
//! and with it the cells: the first part of the points would lie in cells of another cut.

use std::path::Path;

use taut_points::BlockHash;

use super::folder::{failed, write_bytes};
use crate::Error;
use crate::outofcore::bytes::{Reader, word_sum};
use crate::outofcore::tree::CellBox;
use crate::sites::Magnitudes;

const MAGIC: &[u8; 8] = b"TAUTDIST";
const VERSION: u32 = 1;

/// The state of the distribution after whole blocks.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Commit<const D: usize> {
    /// The hash of the sample that the cells were cut by.
    pub(super) sample: u64,
    /// The hash of each block that was read, in order.
    pub(super) hashes: Vec<(u64, BlockHash)>,
    /// Bytes of each bucket.
    pub(super) lengths: Vec<u64>,
    /// The fine cells.
    pub(super) cells: Vec<CellBox<D>>,
    pub(super) magnitudes: Magnitudes,
}

impl<const D: usize> Commit<D> {
    /// Before the first block.
    pub(super) fn new(sample: u64, buckets: usize, cells: usize) -> Self {
        Self {
            sample,
            hashes: vec![],
            lengths: vec![0; buckets],
            cells: vec![CellBox::EMPTY; cells],
            magnitudes: Magnitudes::EMPTY,
        }
    }

    /// Blocks that were read.
    pub(super) fn blocks(&self) -> u64 {
        self.hashes.len() as u64
    }

    pub(super) fn write(&self, path: &Path) -> Result<(), Error> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend((D as u32).to_le_bytes());
        bytes.extend(self.sample.to_le_bytes());
        bytes.extend(self.magnitudes.largest.to_le_bytes());
        bytes.extend(self.magnitudes.lowest.to_le_bytes());
        bytes.extend((self.hashes.len() as u64).to_le_bytes());
        for (_, hash) in &self.hashes {
            bytes.extend(hash.to_bits().to_le_bytes());
        }
        bytes.extend((self.lengths.len() as u64).to_le_bytes());
        for length in &self.lengths {
            bytes.extend(length.to_le_bytes());
        }
        bytes.extend((self.cells.len() as u64).to_le_bytes());
        for cell in &self.cells {
            write_cell(&mut bytes, cell);
        }
        let sum = word_sum(&bytes);
        bytes.extend(sum.to_le_bytes());
        write_bytes(path, &bytes)
    }

    /// The commit of so many buckets and cells in a file; `None` if there is no such file.
    pub(super) fn read(path: &Path, buckets: usize, cells: usize) -> Result<Option<Self>, Error> {
        let bytes = match std::fs::read(path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            read => read.map_err(failed(path))?,
        };
        let found = Self::parse(&bytes)
            .filter(|found| found.lengths.len() == buckets && found.cells.len() == cells);
        let other = || Error::DamagedFolder { path: path.display().to_string() };
        found.map(Some).ok_or_else(other)
    }

    fn parse(bytes: &[u8]) -> Option<Self> {
        let body = bytes.len().checked_sub(8)?;
        if Reader::new(&bytes[body..]).u64()? != word_sum(&bytes[..body]) {
            return None;
        }
        let mut reader = Reader::new(&bytes[..body]);
        if reader.take(8)? != MAGIC || reader.u32()? != VERSION || reader.u32()? != D as u32 {
            return None;
        }
        let sample = reader.u64()?;
        let magnitudes = Magnitudes { largest: reader.f64()?, lowest: reader.u32()? as i32 };
        let blocks = reader.u64()?;
        let hash =
            |reader: &mut Reader<'_>, block| Some((block, BlockHash::from_bits(reader.u64()?)));
        let hashes = (0..blocks).map(|block| hash(&mut reader, block)).collect::<Option<_>>()?;
        let buckets = reader.u64()?;
        let lengths = (0..buckets).map(|_| reader.u64()).collect::<Option<_>>()?;
        let cells = reader.u64()?;
        let cells = (0..cells).map(|_| read_cell(&mut reader)).collect::<Option<_>>()?;
        Some(Self { sample, hashes, lengths, cells, magnitudes })
    }
}

/// Appends the corners and the count of a cell.
pub(super) fn write_cell<const D: usize>(bytes: &mut Vec<u8>, cell: &CellBox<D>) {
    for x in cell.corners().as_flattened() {
        bytes.extend(x.to_le_bytes());
    }
    bytes.extend(cell.count.to_le_bytes());
}

/// Reads what [`write_cell`] wrote.
pub(super) fn read_cell<const D: usize>(reader: &mut Reader<'_>) -> Option<CellBox<D>> {
    let corners = [reader.points()?, reader.points()?];
    Some(CellBox::of(corners, reader.u64()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_commit_comes_back_and_damage_is_seen() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("distribution");
        assert_eq!(Commit::<2>::read(&path, 4, 8).unwrap(), None);
        let mut commit = Commit::<2>::new(3, 4, 8);
        commit.hashes = vec![(0, BlockHash::from_bits(5)), (1, BlockHash::from_bits(7))];
        commit.lengths[2] = 40;
        commit.cells[3].add([1.0, -2.0]);
        commit.magnitudes.add(-2.0);
        commit.write(&path).unwrap();
        assert_eq!(Commit::read(&path, 4, 8).unwrap(), Some(commit));
        assert!(Commit::<2>::read(&path, 4, 16).is_err());
        assert!(Commit::<3>::read(&path, 4, 8).is_err());
        let mut bytes = std::fs::read(&path).unwrap();
        bytes[20] ^= 1;
        std::fs::write(&path, bytes).unwrap();
        assert!(Commit::<2>::read(&path, 4, 8).is_err());
    }
}
