//! Nodes as files: a tile, and behind it the front while it is needed.
//!
//! *Guarantee.* A node is one file that appears whole; its bucket goes only when it is there. So after a crash each node is
//! done or can be done again. Fronts are cut off when all nodes are done.
//! *Trap.* The counts of a tile are read from its end. A resumed run compares the sum of all of it, or it would write a
//! manifest for tiles that were changed meanwhile, unless [`Stamps`] say that nobody wrote to it: reading all finished tiles
//! took up to a tenth of the time of the whole work.
//! *Bytes* behind the tile: the front; bytes of the tile u64, of the front u64, sites and facets of the front u64 each; magic
//! `TAUTNODE`.

use std::fs::File;
use std::io::Write;

use taut_oblivious::machine::Store;

use super::buckets::read_points;
use super::folder::{Folder, failed, remove, write_whole};
use super::stamps::Stamps;
use crate::Error;
use crate::outofcore::bytes::{Reader, WordSum};
use crate::outofcore::driver::{NodeRecord, Storage, WriteNode};
use crate::outofcore::front::Front;
use crate::outofcore::points::NodePoints;
use crate::outofcore::tile::{COUNTS_BYTES, TileCounts};
use crate::outofcore::tree::Tree;

const MAGIC: &[u8; 8] = b"TAUTNODE";
/// Four counts and the magic.
const TRAILER_BYTES: usize = 40;
/// Bytes of a tile that are read at once.
const READ_BYTES: usize = 1 << 18;

/// The files of the nodes of a tree.
pub(super) struct NodeFiles<'a, const D: usize> {
    pub(super) folder: &'a Folder,
    pub(super) tree: &'a Tree<D>,
    pub(super) row_bytes: u32,
    pub(super) stamps: Stamps,
}

/// The last bytes of the file of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Trailer {
    tile_bytes: u64,
    front_bytes: u64,
    front_sites: u64,
    front_facets: u64,
}

impl Trailer {
    fn to_bytes(self) -> [u8; TRAILER_BYTES] {
        let counts = [self.tile_bytes, self.front_bytes, self.front_sites, self.front_facets];
        let mut bytes = [0; TRAILER_BYTES];
        for (word, count) in bytes.chunks_exact_mut(8).zip(counts) {
            word.copy_from_slice(&count.to_le_bytes());
        }
        bytes[32..].copy_from_slice(MAGIC);
        bytes
    }

    /// The trailer of a file; `None` if it has none.
    fn read(file: &File) -> Option<Self> {
        let length = file.metadata().ok()?.len();
        let begin = length.checked_sub(TRAILER_BYTES as u64)?;
        let mut bytes = [0; TRAILER_BYTES];
        file.read_exact_at(&mut bytes, begin).ok()?;
        let mut reader = Reader::new(&bytes);
        let trailer = Self {
            tile_bytes: reader.u64()?,
            front_bytes: reader.u64()?,
            front_sites: reader.u64()?,
            front_facets: reader.u64()?,
        };
        let whole = trailer.tile_bytes.checked_add(trailer.front_bytes)? == begin;
        (whole && reader.take(8)? == MAGIC).then_some(trailer)
    }
}

/// Cuts the front off the file of a node; it may have been cut off before.
pub(super) fn strip(folder: &Folder, node: u32) -> Result<(), Error> {
    let path = folder.tile(node);
    let file = File::options().read(true).write(true).open(&path).map_err(failed(&path))?;
    match Trailer::read(&file) {
        Some(trailer) => file.set_len(trailer.tile_bytes).map_err(failed(&path)),
        None => Ok(()),
    }
}

impl<const D: usize> NodeFiles<'_, D> {
    /// The bytes of the tile of a node that was stored.
    pub(super) fn tile_bytes(&self, node: u32) -> Option<u64> {
        let file = File::open(self.folder.tile(node)).ok()?;
        Trailer::read(&file).map(|trailer| trailer.tile_bytes)
    }

    /// The trailer of the file of a node and the counts of its tile; `None` if these are of something else.
    fn counts(&self, file: &File, node: u32) -> Option<(Trailer, TileCounts)> {
        let trailer = Trailer::read(file)?;
        let mut bytes = [0; COUNTS_BYTES];
        file.read_exact_at(&mut bytes, trailer.tile_bytes.checked_sub(COUNTS_BYTES as u64)?)
            .ok()?;
        let counts = TileCounts::from_bytes::<D>(&bytes)?;
        let is_ours = counts.tile == node && counts.bytes(D) == Some(trailer.tile_bytes);
        is_ours.then_some((trailer, counts))
    }
}

/// Tests whether the first `length` bytes of a file end with the sum of those before.
fn has_its_sum(file: &File, length: u64) -> std::io::Result<bool> {
    let (mut sum, mut block, mut at) = (WordSum::default(), vec![0; READ_BYTES], 0);
    let body = length.saturating_sub(8);
    while at < body {
        let bytes = block.len().min((body - at) as usize);
        file.read_exact_at(&mut block[..bytes], at)?;
        sum.add(&block[..bytes]);
        at += bytes as u64;
    }
    let mut expected = [0; 8];
    file.read_exact_at(&mut expected, body)?;
    Ok(u64::from_le_bytes(expected) == sum.finish())
}

impl<const D: usize> Storage<D> for NodeFiles<'_, D> {
    fn points(&self, leaf: u32) -> Result<NodePoints<D>, Error> {
        let path = self.folder.bucket(leaf);
        let expected = self.tree.cell(leaf).count;
        let points = read_points(&path, self.row_bytes, expected)?;
        if points.rows.len() as u64 == expected {
            Ok(points)
        } else {
            Err(Error::DamagedFolder { path: path.display().to_string() })
        }
    }

    fn front(&self, node: u32) -> Result<Front<D>, Error> {
        let path = self.folder.tile(node);
        let damaged = || Error::DamagedFolder { path: path.display().to_string() };
        let file = File::open(&path).map_err(failed(&path))?;
        let trailer = Trailer::read(&file).ok_or_else(damaged)?;
        let length = usize::try_from(trailer.front_bytes).map_err(|_| damaged())?;
        let mut bytes = vec![0; length];
        file.read_exact_at(&mut bytes, trailer.tile_bytes).map_err(failed(&path))?;
        Front::from_bytes(&bytes)
    }

    fn store(&self, node: u32, write: &mut WriteNode<'_, D>) -> Result<NodeRecord, Error> {
        let path = self.folder.tile(node);
        let name = path.display().to_string();
        let (record, found) = write_whole(&path, |file| {
            let (counts, front) = write(&name, file)?;
            let bytes = front.to_bytes();
            let trailer = Trailer {
                tile_bytes: counts.bytes(D).unwrap_or(0),
                front_bytes: bytes.len() as u64,
                front_sites: front.len() as u64,
                front_facets: front.facets.len() as u64,
            };
            file.write_all(&bytes).map_err(failed(&path))?;
            file.write_all(&trailer.to_bytes()).map_err(failed(&path))?;
            Ok(NodeRecord {
                counts,
                front_sites: trailer.front_sites,
                front_facets: trailer.front_facets,
            })
        })?;
        if let Some(found) = found {
            self.stamps.note(node, &found);
        }
        Ok(record)
    }

    fn stored(&self, node: u32) -> Result<Option<NodeRecord>, Error> {
        let path = self.folder.tile(node);
        let Ok(file) = File::open(&path) else { return Ok(None) };
        let Some((trailer, counts)) = self.counts(&file, node) else { return Ok(None) };
        let found = file.metadata().map_err(failed(&path))?;
        if !self.stamps.is_untouched(node, &found) {
            if !has_its_sum(&file, trailer.tile_bytes).map_err(failed(&path))? {
                return Err(Error::DamagedFolder { path: path.display().to_string() });
            }
            self.stamps.note(node, &found);
        }
        Ok(Some(NodeRecord {
            counts,
            front_sites: trailer.front_sites,
            front_facets: trailer.front_facets,
        }))
    }

    fn release(&self, leaf: u32) {
        // What cannot be removed now goes with the folder of the work. Fronts stay until the end: a resumed run asks how
        // large they were.
        drop(remove(&self.folder.bucket(leaf)));
    }
}
