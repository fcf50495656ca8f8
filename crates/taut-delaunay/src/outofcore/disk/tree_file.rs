//! The tree of cells and its leaves in a file: from here on the input is not needed any more.
//!
//! *Bytes*, little-endian: magic `TAUTTREE`, version u32, D u32; hash of the points u64; largest magnitude f64, lowest
//! exponent i32; nodes u64 and for each its corners, points and children (u32 each, 0xFFFF_FFFF for none); leaves u64 and
//! their nodes u32; the sum of the words.

use std::path::Path;

use taut_points::PointsHash;

use super::commit::{read_cell, write_cell};
use super::folder::{failed, write_bytes};
use crate::Error;
use crate::outofcore::bytes::{Reader, word_sum};
use crate::outofcore::tree::Tree;
use crate::sites::Magnitudes;

const MAGIC: &[u8; 8] = b"TAUTTREE";
const VERSION: u32 = 1;
const NO_CHILD: u32 = u32::MAX;

/// The cut of all points into leaves.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CutPoints<const D: usize> {
    pub(super) tree: Tree<D>,
    /// The nodes whose points are in a bucket.
    pub(super) leaves: Vec<u32>,
    pub(super) magnitudes: Magnitudes,
    pub(super) points_hash: PointsHash,
}

impl<const D: usize> CutPoints<D> {
    pub(super) fn write(&self, path: &Path) -> Result<(), Error> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend((D as u32).to_le_bytes());
        bytes.extend(self.points_hash.0.to_le_bytes());
        bytes.extend(self.magnitudes.largest.to_le_bytes());
        bytes.extend(self.magnitudes.lowest.to_le_bytes());
        bytes.extend((self.tree.len() as u64).to_le_bytes());
        for node in 0..self.tree.len() as u32 {
            write_cell(&mut bytes, self.tree.cell(node));
            let children = self.tree.children(node).unwrap_or([NO_CHILD; 2]);
            children.iter().for_each(|child| bytes.extend(child.to_le_bytes()));
        }
        bytes.extend((self.leaves.len() as u64).to_le_bytes());
        for leaf in &self.leaves {
            bytes.extend(leaf.to_le_bytes());
        }
        let sum = word_sum(&bytes);
        bytes.extend(sum.to_le_bytes());
        write_bytes(path, &bytes)
    }

    /// The cut in a file; `None` if there is no such file.
    pub(super) fn read(path: &Path) -> Result<Option<Self>, Error> {
        let bytes = match std::fs::read(path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
            read => read.map_err(failed(path))?,
        };
        let damaged = || Error::DamagedFolder { path: path.display().to_string() };
        Self::parse(&bytes).map(Some).ok_or_else(damaged)
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
        let points_hash = PointsHash(reader.u64()?);
        let magnitudes = Magnitudes { largest: reader.f64()?, lowest: reader.u32()? as i32 };
        let nodes = reader.u64()?;
        let node = |reader: &mut Reader<'_>| {
            let cell = read_cell(reader)?;
            let children = [reader.u32()?, reader.u32()?];
            Some((cell, (children[0] != NO_CHILD).then_some(children)))
        };
        let nodes = (0..nodes).map(|_| node(&mut reader)).collect::<Option<_>>()?;
        let tree = Tree::of_nodes(nodes)?;
        let leaves = reader.u64()?;
        let leaf =
            |reader: &mut Reader<'_>| reader.u32().filter(|&leaf| (leaf as usize) < tree.len());
        let leaves = (0..leaves).map(|_| leaf(&mut reader)).collect::<Option<_>>()?;
        Some(Self { tree, leaves, magnitudes, points_hash })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outofcore::tree::CellBox;

    #[test]
    fn a_tree_comes_back() {
        let mut cells = vec![CellBox::<2>::EMPTY; 4];
        cells[1].add([1.0, 2.0]);
        let mut tree = Tree::new(&cells);
        tree.grow(5, &cells);
        let magnitudes = Magnitudes { largest: 2.0, lowest: -3 };
        let cut = CutPoints { tree, leaves: vec![3, 4], magnitudes, points_hash: PointsHash(9) };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("tree");
        assert_eq!(CutPoints::<2>::read(&path).unwrap(), None);
        cut.write(&path).unwrap();
        assert_eq!(CutPoints::read(&path).unwrap(), Some(cut));
        assert!(CutPoints::<3>::read(&path).is_err());
    }
}
