//! Records of one width in many buckets, in one file without a name.
//!
//! *Idea.* Each bucket has a buffer. Full ones are gathered in the order in which they fill and written together, and each bucket
//! remembers where its blocks are. Blocks are read ahead by some threads, as a disk takes several requests at once.
//! *Guarantee.* Records come back bucket by bucket, in the order in which they were added.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread;
use std::{io, mem};

use super::super::TilesError;
use super::pages::{PAGE_BYTES, PageFile, Pages};

/// Most bytes that are written at once. (Measured: less than 1 MiB past the cache takes longer.)
const WRITE_BYTES_MAX: usize = 1 << 20;

/// Most bytes that a thread reads for one call.
const READ_BYTES_MAX: usize = 1 << 20;

/// Threads that read ahead. (Measured: blocks of 80 KiB, one by one 0.6 GB a second, four at once 1.6.)
const READERS: usize = 4;

/// Takes records.
pub(super) struct Buckets {
    folder: PathBuf,
    file: PageFile,
    /// Bytes of a block, a whole number of records, in nearly whole pages.
    block: usize,
    buffers: Vec<Vec<u8>>,
    /// For each bucket its blocks.
    blocks: Vec<Vec<Block>>,
    /// What is written next, and where.
    gathered: Pages,
    end: u64,
}

/// Records of a bucket that are together in the file.
#[derive(Clone, Copy, Debug)]
struct Block {
    start: u64,
    bytes: u32,
}

impl Block {
    fn padded(self) -> usize {
        (self.bytes as usize).next_multiple_of(PAGE_BYTES)
    }
}

impl Buckets {
    /// Empty buckets with records of `width` bytes, and room for `block` bytes, a page or more, in memory for each, and half as
    /// much again for all together.
    pub(super) fn new(
        folder: &Path,
        count: usize,
        block: usize,
        width: usize,
    ) -> Result<Self, TilesError> {
        let failed = |source| TilesError::File { path: folder.to_owned(), source };
        let block = block / PAGE_BYTES * PAGE_BYTES;
        Ok(Buckets {
            folder: folder.to_owned(),
            file: PageFile::new_in(folder).map_err(failed)?,
            block: block / width * width,
            buffers: vec![vec![]; count],
            blocks: vec![vec![]; count],
            gathered: Pages::with_capacity((block * count / 2).clamp(block, WRITE_BYTES_MAX)),
            end: 0,
        })
    }

    /// Where the next record of a bucket goes, which must be added before the next call.
    #[inline(always)]
    pub(super) fn place(&mut self, bucket: usize) -> Result<&mut Vec<u8>, TilesError> {
        let buffer = &mut self.buffers[bucket];
        if buffer.len() >= self.block {
            self.gather(bucket)?;
        } else if buffer.is_empty() {
            // By doubling it could take nearly twice as much.
            buffer.reserve_exact(self.block);
        }
        Ok(&mut self.buffers[bucket])
    }

    fn gather(&mut self, bucket: usize) -> Result<(), TilesError> {
        let bytes = self.buffers[bucket].len();
        if bytes > 0 {
            let start = self.end + self.gathered.len() as u64;
            let block = Block { start, bytes: bytes as u32 };
            if self.gathered.len() + block.padded() > self.gathered.capacity() {
                self.write()?;
            }
            self.gathered.add(&self.buffers[bucket]);
            self.blocks[bucket].push(block);
            self.buffers[bucket].clear();
        }
        Ok(())
    }

    fn write(&mut self) -> Result<(), TilesError> {
        let failed = |source| TilesError::File { path: self.folder.clone(), source };
        self.file.write(&self.gathered, self.end).map_err(failed)?;
        self.end += self.gathered.len() as u64;
        self.gathered.clear();
        Ok(())
    }

    /// All records are there: `work` reads them, within about `memory` bytes or 8 blocks.
    pub(super) fn read<R>(
        mut self,
        memory: u64,
        work: impl FnOnce(&mut ReadBuckets<'_>) -> Result<R, TilesError>,
    ) -> Result<R, TilesError> {
        for bucket in 0..self.buffers.len() {
            self.gather(bucket)?;
        }
        self.write()?;
        self.buffers = vec![];
        self.gathered = Pages::with_capacity(0);
        // Each thread has a piece that it reads, and one that it hands on.
        let room = usize::try_from(memory).unwrap_or(usize::MAX) / (2 * READERS);
        let pieces: Vec<Vec<&[Block]>> =
            self.blocks.iter().map(|blocks| pieces(blocks, room.min(READ_BYTES_MAX))).collect();
        thread::scope(|scope| {
            let mut readers = vec![];
            for first in 0..READERS {
                let ((send, pieces_read), (give_back, used)) = (sync_channel(0), channel());
                readers.push(Reader { pieces: pieces_read, give_back });
                let pieces = pieces.iter().flatten().skip(first).step_by(READERS);
                let file = &self.file;
                thread::Builder::new()
                    .stack_size(READER_STACK_BYTES)
                    .spawn_scoped(scope, move || read_ahead(file, pieces, &send, &used))
                    .map_err(|source| TilesError::File { path: self.folder.clone(), source })?;
            }
            let counts = pieces.iter().map(Vec::len).collect();
            work(&mut ReadBuckets { folder: &self.folder, counts, readers, next: 0 })
        })
    }
}

/// Bytes of the stack of a thread that only reads.
const READER_STACK_BYTES: usize = 1 << 17;

/// Blocks in order, together of at most `room` bytes or one block.
fn pieces(blocks: &[Block], room: usize) -> Vec<&[Block]> {
    let (mut pieces, mut bytes, mut first) = (vec![], 0, 0);
    for (number, block) in blocks.iter().enumerate() {
        if bytes + block.padded() > room && number > first {
            pieces.push(&blocks[first..number]);
            (bytes, first) = (0, number);
        }
        bytes += block.padded();
    }
    if first < blocks.len() {
        pieces.push(&blocks[first..]);
    }
    pieces
}

/// The bytes of some blocks.
struct Piece {
    pages: Pages,
    blocks: Vec<Block>,
}

impl Piece {
    /// Reads them, into memory that was used before where it is large enough.
    fn read(file: &PageFile, blocks: &[Block], used: Option<Pages>) -> io::Result<Piece> {
        let bytes = blocks.iter().map(|block| block.padded()).sum();
        let used = used.filter(|used| used.capacity() >= bytes);
        let mut pages = used.unwrap_or_else(|| Pages::with_capacity(bytes));
        pages.clear();
        for block in blocks {
            file.read(pages.grow(block.bytes as usize), block.start)?;
        }
        Ok(Piece { pages, blocks: blocks.to_vec() })
    }

    /// The records of each block.
    fn records(&self) -> Vec<&[u8]> {
        let mut rest = self.pages.bytes();
        let next = |block: &Block| {
            let (bytes, after) = rest.split_at(block.padded());
            rest = after;
            &bytes[..block.bytes as usize]
        };
        self.blocks.iter().map(next).collect()
    }
}

/// Reads pieces and hands them on, until nobody wants them. (New memory for each would cost as much as to read it.)
fn read_ahead<'a>(
    file: &PageFile,
    pieces: impl Iterator<Item = &'a &'a [Block]>,
    send: &SyncSender<io::Result<Piece>>,
    used: &Receiver<Pages>,
) {
    for blocks in pieces {
        let piece = Piece::read(file, blocks, used.try_recv().ok());
        if send.send(piece).is_err() {
            return;
        }
    }
}

/// Gives records back.
pub(super) struct ReadBuckets<'a> {
    folder: &'a Path,
    /// Pieces of each bucket that are still to come.
    counts: Vec<usize>,
    readers: Vec<Reader>,
    next: usize,
}

/// The other side of a thread that reads.
struct Reader {
    pieces: Receiver<io::Result<Piece>>,
    /// Takes memory for further pieces.
    give_back: Sender<Pages>,
}

impl ReadBuckets<'_> {
    /// Calls `work` with the records of a bucket, some runs of them at a time. Buckets must be asked for in order.
    pub(super) fn for_each_piece(
        &mut self,
        bucket: usize,
        mut work: impl FnMut(&[&[u8]]) -> Result<(), TilesError>,
    ) -> Result<(), TilesError> {
        for _ in 0..mem::take(&mut self.counts[bucket]) {
            let failed = |source| TilesError::File { path: self.folder.to_owned(), source };
            let Reader { pieces, give_back } = &self.readers[self.next % self.readers.len()];
            self.next += 1;
            let piece = pieces.recv().unwrap_or_else(|_| Err(io::ErrorKind::BrokenPipe.into()));
            let piece = piece.map_err(failed)?;
            work(&piece.records())?;
            // A thread that has read all takes no more.
            let _ = give_back.send(piece.pages);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_come_back_by_bucket_and_in_order() {
        let folder = tempfile::tempdir().unwrap();
        for (width, block, memory) in
            [(20, 1 << 12, 0), (28, 3 << 12, 1 << 17), (20, 1 << 18, 1 << 30)]
        {
            // The third bucket has nothing, the last less than a block.
            let counts = [1000, 40_000, 0, 7919, 3];
            let record = |bucket: usize, number: usize| {
                let word = (bucket * 1_000_003 + number) as u32;
                (0..width / 4).flat_map(|k| (word ^ k as u32).to_le_bytes()).collect::<Vec<u8>>()
            };
            let mut buckets = Buckets::new(folder.path(), counts.len(), block, width).unwrap();
            for number in 0..40_000 {
                for bucket in (0..counts.len()).filter(|&bucket| number < counts[bucket]) {
                    let record = record(bucket, number);
                    buckets.place(bucket).unwrap().extend_from_slice(&record);
                }
            }
            let read = |sites: &mut ReadBuckets<'_>| {
                for (bucket, count) in counts.into_iter().enumerate() {
                    let mut found = vec![];
                    sites.for_each_piece(bucket, |runs| {
                        found.extend(runs.concat());
                        Ok(())
                    })?;
                    let expected: Vec<u8> = (0..count).flat_map(|i| record(bucket, i)).collect();
                    assert!(found == expected, "{width}, {block}: bucket {bucket}");
                }
                Ok(())
            };
            buckets.read(memory, read).unwrap();
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn who_stops_reading_waits_for_nobody() {
        let folder = tempfile::tempdir().unwrap();
        let mut buckets = Buckets::new(folder.path(), 2, 1 << 12, 4).unwrap();
        for number in 0..100_000u32 {
            buckets.place(0).unwrap().extend_from_slice(&number.to_le_bytes());
        }
        let stop =
            || TilesError::File { path: PathBuf::new(), source: io::ErrorKind::Other.into() };
        let read = buckets.read(1 << 16, |sites| sites.for_each_piece(0, |_| Err(stop())));
        assert!(read.is_err());
    }

    #[test]
    fn what_cannot_pass_by_the_cache_is_read_from_it() {
        let folder = tempfile::tempdir().unwrap();
        let file = PageFile::new_in(folder.path()).unwrap();
        let mut pages = Pages::with_capacity(2 * PAGE_BYTES);
        pages.add(&[7; PAGE_BYTES + 1]);
        file.write(&pages, PAGE_BYTES as u64).unwrap();
        let mut bytes = [0; 11];
        file.read(&mut bytes, 2 * PAGE_BYTES as u64 - 10).unwrap();
        assert_eq!(bytes, [7; 11]);
    }
}
