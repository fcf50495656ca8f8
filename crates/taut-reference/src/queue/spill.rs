//! Where entries go that memory does not hold.

use std::convert::Infallible;
use std::fs::File;
use std::path::{Path, PathBuf};

use bytemuck::Pod;

use super::room;
use crate::Error;
use crate::Store;

/// Takes blocks of entries and gives them back.
pub(super) trait Spill<V> {
    /// Why it could not.
    type Error;

    /// Entries that a bucket may have room for without giving it up.
    const ROOM_KEPT: usize;

    /// Entries that may be in memory.
    fn limit(&self) -> usize;

    fn block(&self) -> usize;

    /// Keeps a block; its number.
    fn keep(&mut self, keys: &[u64], values: &[V]) -> Result<u32, Self::Error>;

    /// Appends the entries of a block; it is free afterwards, but not if that failed.
    fn give_back(
        &mut self,
        block: u32,
        keys: &mut Vec<u64>,
        values: &mut Vec<V>,
    ) -> Result<(), Self::Error>;

    /// The key of one entry of a block.
    fn key(&self, block: u32, place: usize) -> Result<u64, Self::Error>;
}

/// All is in memory.
#[derive(Clone, Copy, Debug)]
pub(super) struct NoSpill;

impl<V> Spill<V> for NoSpill {
    type Error = Infallible;
    const ROOM_KEPT: usize = 1 << 12;

    fn limit(&self) -> usize {
        usize::MAX
    }

    fn block(&self) -> usize {
        usize::MAX
    }

    fn keep(&mut self, _: &[u64], _: &[V]) -> Result<u32, Infallible> {
        unreachable!("there is no limit, so nothing is spilled")
    }

    fn give_back(&mut self, _: u32, _: &mut Vec<u64>, _: &mut Vec<V>) -> Result<(), Infallible> {
        unreachable!("nothing was spilled")
    }

    fn key(&self, _: u32, _: usize) -> Result<u64, Infallible> {
        unreachable!("nothing was spilled")
    }
}

/// Blocks of a file: the keys, then the values.
#[derive(Debug)]
pub(super) struct Blocks<F = File> {
    file: F,
    folder: PathBuf,
    limit: usize,
    block: usize,
    /// Bytes of a block.
    bytes: u64,
    /// Blocks the file has.
    count: u32,
    free: Vec<u32>,
}

impl Blocks {
    /// A file without a name in `folder`, for values of a type, beside `limit` entries in memory.
    pub(super) fn new<V>(folder: &Path, limit: usize) -> Result<Self, Error> {
        let failed = |source| Error::File { path: folder.display().to_string(), source };
        Ok(Self::over::<V>(tempfile::tempfile_in(folder).map_err(failed)?, folder, limit))
    }
}

impl<F: Store> Blocks<F> {
    pub(super) fn over<V>(file: F, folder: &Path, limit: usize) -> Self {
        // There are at most 2·log₂ n + 10 buckets: less than a block in each of these is less than half of the limit for any
        // n below 2⁵⁰, and so is one that is fetched.
        let block = (limit / 256).clamp(1, 1 << 16);
        let bytes = (block * (8 + size_of::<V>())) as u64;
        Self { file, folder: folder.to_owned(), limit, block, bytes, count: 0, free: Vec::new() }
    }

    fn failed(&self) -> impl Fn(std::io::Error) -> Error {
        |source| Error::File {
            path: format!("temporary file in {}", self.folder.display()),
            source,
        }
    }

    fn at(&self, block: u32) -> u64 {
        u64::from(block) * self.bytes
    }
}

impl<V: Pod, F: Store> Spill<V> for Blocks<F> {
    type Error = Error;
    const ROOM_KEPT: usize = 4;

    fn limit(&self) -> usize {
        self.limit
    }

    fn block(&self) -> usize {
        self.block
    }

    fn keep(&mut self, keys: &[u64], values: &[V]) -> Result<u32, Error> {
        let block = self.free.last().copied().unwrap_or(self.count);
        let at = self.at(block);
        self.file.write_all_at(bytemuck::cast_slice(keys), at).map_err(self.failed())?;
        let at = at + 8 * self.block as u64;
        self.file.write_all_at(bytemuck::cast_slice(values), at).map_err(self.failed())?;
        if room::pop(&mut self.free).is_none() {
            self.count += 1;
        }
        Ok(block)
    }

    fn give_back(
        &mut self,
        block: u32,
        keys: &mut Vec<u64>,
        values: &mut Vec<V>,
    ) -> Result<(), Error> {
        let start = keys.len();
        room::grow(keys, self.block);
        room::grow(values, self.block);
        keys.resize(start + self.block, 0);
        values.resize(start + self.block, V::zeroed());
        let at = self.at(block);
        let read = self
            .file
            .read_exact_at(bytemuck::cast_slice_mut(&mut keys[start..]), at)
            .and_then(|()| {
                let at = at + 8 * self.block as u64;
                self.file.read_exact_at(bytemuck::cast_slice_mut(&mut values[start..]), at)
            });
        if let Err(error) = read {
            keys.truncate(start);
            values.truncate(start);
            return Err(self.failed()(error));
        }
        room::grow(&mut self.free, 1);
        self.free.push(block);
        Ok(())
    }

    fn key(&self, block: u32, place: usize) -> Result<u64, Error> {
        let mut key = [0; 8];
        let at = self.at(block) + 8 * place as u64;
        self.file.read_exact_at(&mut key, at).map_err(self.failed())?;
        Ok(u64::from_ne_bytes(key))
    }
}
