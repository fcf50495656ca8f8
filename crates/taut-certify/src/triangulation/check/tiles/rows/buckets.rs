//! Records of one width in many buckets, in one file without a name.
//!
//! *Idea.* Each bucket has a buffer; a full one is written as the next block of the file, and the bucket remembers where.

use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::super::TilesError;

/// Takes records.
pub(super) struct Buckets {
    folder: PathBuf,
    file: File,
    /// Bytes of a block, a whole number of records.
    block: usize,
    buffers: Vec<Vec<u8>>,
    /// For each bucket its blocks: where each begins, and its bytes.
    blocks: Vec<Vec<(u64, u32)>>,
    end: u64,
}

impl Buckets {
    /// Empty buckets with records of `width` bytes, and room for about `block` bytes in memory for each.
    pub(super) fn new(
        folder: &Path,
        count: usize,
        block: usize,
        width: usize,
    ) -> Result<Self, TilesError> {
        let failed = |source| TilesError::File { path: folder.to_owned(), source };
        Ok(Buckets {
            folder: folder.to_owned(),
            file: tempfile::tempfile_in(folder).map_err(failed)?,
            block: block / width * width,
            buffers: vec![vec![]; count],
            blocks: vec![vec![]; count],
            end: 0,
        })
    }

    /// Where the next record of a bucket goes, which must be added before the next call.
    #[inline(always)]
    pub(super) fn place(&mut self, bucket: usize) -> Result<&mut Vec<u8>, TilesError> {
        if self.buffers[bucket].len() >= self.block {
            self.flush(bucket)?;
        }
        Ok(&mut self.buffers[bucket])
    }

    fn flush(&mut self, bucket: usize) -> Result<(), TilesError> {
        let buffer = &mut self.buffers[bucket];
        if !buffer.is_empty() {
            let failed = |source| TilesError::File { path: self.folder.clone(), source };
            self.file.write_all(buffer).map_err(failed)?;
            self.blocks[bucket].push((self.end, buffer.len() as u32));
            self.end += buffer.len() as u64;
            buffer.clear();
        }
        Ok(())
    }

    /// The buckets, to be read.
    pub(super) fn finish(mut self) -> Result<ReadBuckets, TilesError> {
        for bucket in 0..self.buffers.len() {
            self.flush(bucket)?;
        }
        let Buckets { folder, file, blocks, .. } = self;
        Ok(ReadBuckets { folder, file, blocks, bytes: vec![] })
    }
}

/// Bytes of a bucket that are read for one call.
const READ_BYTES: usize = 1 << 20;

/// Gives records back.
pub(super) struct ReadBuckets {
    folder: PathBuf,
    file: File,
    blocks: Vec<Vec<(u64, u32)>>,
    bytes: Vec<u8>,
}

impl ReadBuckets {
    /// Calls `work` with the records of a bucket, some at a time.
    pub(super) fn for_each_block(
        &mut self,
        bucket: usize,
        mut work: impl FnMut(&[u8]) -> Result<(), TilesError>,
    ) -> Result<(), TilesError> {
        self.bytes.clear();
        for &(start, bytes) in &self.blocks[bucket] {
            let failed = |source| TilesError::File { path: self.folder.clone(), source };
            let at = self.bytes.len();
            self.bytes.resize(at + bytes as usize, 0);
            self.file.seek(SeekFrom::Start(start)).map_err(failed)?;
            self.file.read_exact(&mut self.bytes[at..]).map_err(failed)?;
            if self.bytes.len() >= READ_BYTES {
                work(&self.bytes)?;
                self.bytes.clear();
            }
        }
        work(&self.bytes)
    }
}
