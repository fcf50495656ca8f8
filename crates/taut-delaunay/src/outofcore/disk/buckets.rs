//! Files of points: each record is the coordinates and the row of a point.
//!
//! *Idea.* Threads fill buffers of their own, one for each bucket, and append a full one in a single write at the end that
//! the bucket has at that moment. In which order records come does not matter: a leaf orders its points.

use std::fs::File;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use taut_oblivious::machine::Store;

use super::folder::failed;
use crate::Error;
use crate::outofcore::points::NodePoints;

/// Bytes that are read from a bucket at once.
const READ_BYTES: usize = 1 << 20;

/// Bytes of a record.
pub(super) const fn record_bytes(d: usize, row_bytes: u32) -> usize {
    8 * d + row_bytes as usize
}

/// A file that records are appended to by several threads.
pub(super) struct Bucket {
    file: File,
    name: String,
    length: AtomicU64,
}

impl Bucket {
    /// Opens a bucket of which the first `length` bytes are kept.
    pub(super) fn open(path: &Path, length: u64) -> Result<Self, Error> {
        let file = File::options().read(true).write(true).create(true).truncate(false).open(path);
        let file = file.map_err(failed(path))?;
        let found = file.metadata().map_err(failed(path))?.len();
        if found < length {
            let detail = std::io::Error::other(format!(
                "{found} bytes, but {length} were written: it was changed meanwhile"
            ));
            return Err(failed(path)(detail));
        }
        file.set_len(length).map_err(failed(path))?;
        Ok(Self { file, name: path.display().to_string(), length: length.into() })
    }

    fn append(&self, bytes: &[u8]) -> Result<(), Error> {
        let at = self.length.fetch_add(bytes.len() as u64, Ordering::Relaxed);
        let written = self.file.write_all_at(bytes, at);
        written.map_err(|source| Error::File { path: self.name.clone(), source })
    }

    /// Brings all records to the disk; returns the bytes there are.
    pub(super) fn sync(&self) -> Result<u64, Error> {
        let synced = self.file.sync_data();
        synced.map_err(|source| Error::File { path: self.name.clone(), source })?;
        Ok(self.length.load(Ordering::Relaxed))
    }
}

/// The buffers of one thread.
pub(super) struct Buffers {
    /// One after another, each of `capacity` bytes.
    bytes: Vec<u8>,
    filled: Vec<u32>,
    capacity: usize,
    row_bytes: usize,
}

impl Buffers {
    /// Buffers of about so many bytes each.
    pub(super) fn new(buckets: usize, bytes: usize, d: usize, row_bytes: u32) -> Self {
        let record = record_bytes(d, row_bytes);
        let capacity = (bytes / record).max(1) * record;
        Self {
            bytes: vec![0; buckets * capacity],
            filled: vec![0; buckets],
            capacity,
            row_bytes: row_bytes as usize,
        }
    }

    /// Appends a record to a bucket.
    #[inline(always)]
    pub(super) fn push<const D: usize>(
        &mut self,
        buckets: &[Bucket],
        bucket: usize,
        p: [f64; D],
        row: u64,
    ) -> Result<(), Error> {
        // Copies of a length that is known take one instruction each.
        if self.row_bytes == 4 {
            self.push_with(buckets, bucket, p, (row as u32).to_le_bytes())
        } else {
            self.push_with(buckets, bucket, p, row.to_le_bytes())
        }
    }

    #[inline(always)]
    fn push_with<const D: usize, const ROW: usize>(
        &mut self,
        buckets: &[Bucket],
        bucket: usize,
        p: [f64; D],
        row: [u8; ROW],
    ) -> Result<(), Error> {
        let filled = self.filled[bucket] as usize;
        let record = 8 * D + ROW;
        let begin = bucket * self.capacity + filled;
        let place = &mut self.bytes[begin..begin + record];
        for (bytes, x) in place.as_chunks_mut::<8>().0.iter_mut().zip(p) {
            *bytes = x.to_le_bytes();
        }
        place[8 * D..].copy_from_slice(&row);
        self.filled[bucket] = (filled + record) as u32;
        if filled + record == self.capacity { self.flush_one(buckets, bucket) } else { Ok(()) }
    }

    fn flush_one(&mut self, buckets: &[Bucket], bucket: usize) -> Result<(), Error> {
        let begin = bucket * self.capacity;
        let filled = std::mem::take(&mut self.filled[bucket]) as usize;
        if filled == 0 {
            Ok(())
        } else {
            buckets[bucket].append(&self.bytes[begin..begin + filled])
        }
    }

    /// Appends what is left in all buffers.
    pub(super) fn flush(&mut self, buckets: &[Bucket]) -> Result<(), Error> {
        (0..self.filled.len()).try_for_each(|bucket| self.flush_one(buckets, bucket))
    }
}

/// Hands each record of a bucket to `take`, a file of `length` bytes at least; none if there is no file.
pub(super) fn read_records<const D: usize>(
    path: &Path,
    row_bytes: u32,
    mut take: impl FnMut([f64; D], u64) -> Result<(), Error>,
) -> Result<(), Error> {
    let file = match File::open(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(()),
        opened => opened.map_err(failed(path))?,
    };
    let length = file.metadata().map_err(failed(path))?.len();
    let record = record_bytes(D, row_bytes);
    let mut block = vec![0u8; READ_BYTES / record * record];
    let mut at = 0;
    while at < length {
        let bytes = block.len().min((length - at) as usize);
        file.read_exact_at(&mut block[..bytes], at).map_err(failed(path))?;
        at += bytes as u64;
        for record in block[..bytes].chunks_exact(record) {
            let mut p = [0.0; D];
            for (x, word) in p.iter_mut().zip(record.chunks_exact(8)) {
                *x = f64::from_le_bytes(word.try_into().unwrap_or_default());
            }
            let mut row = [0u8; 8];
            row[..row_bytes as usize].copy_from_slice(&record[8 * D..]);
            take(p, u64::from_le_bytes(row))?;
        }
    }
    Ok(())
}

/// All points of a bucket of about `expected` points.
pub(super) fn read_points<const D: usize>(
    path: &Path,
    row_bytes: u32,
    expected: u64,
) -> Result<NodePoints<D>, Error> {
    let mut points = NodePoints::with_capacity(expected as usize);
    read_records(path, row_bytes, |p, row| {
        points.push(p, row);
        Ok(())
    })?;
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_several_threads_come_back_with_rows_of_any_size() {
        for row_bytes in [4, 8] {
            let folder = tempfile::tempdir().unwrap();
            let paths = [0, 1].map(|k| folder.path().join(format!("bucket-{k}")));
            let buckets = [0, 1].map(|k| Bucket::open(&paths[k], 0).unwrap());
            let last = if row_bytes == 4 { u64::from(u32::MAX) } else { u64::MAX };
            std::thread::scope(|scope| {
                for thread in 0..4u64 {
                    let buckets = &buckets;
                    scope.spawn(move || {
                        let mut buffers = Buffers::new(2, 100, 3, row_bytes);
                        for i in 0..500 {
                            let row = last - 4 * i - thread;
                            let p = [row as f64, thread as f64, -1.5];
                            buffers.push(buckets, (i % 2) as usize, p, row).unwrap();
                        }
                        buffers.flush(buckets).unwrap();
                    });
                }
            });
            let mut rows = Vec::new();
            for path in &paths {
                let points = read_points::<3>(path, row_bytes, 1000).unwrap();
                for (p, &row) in points.coordinates.iter().zip(&points.rows) {
                    assert_eq!((p[0], p[2]), (row as f64, -1.5));
                }
                rows.extend(points.rows);
            }
            rows.sort_unstable();
            assert_eq!(rows, (last - 1999..=last).collect::<Vec<_>>());
        }
    }

    #[test]
    fn a_bucket_is_cut_to_what_was_committed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("bucket");
        std::fs::write(&path, [7; 60]).unwrap();
        assert_eq!(Bucket::open(&path, 40).unwrap().sync().unwrap(), 40);
        assert_eq!(std::fs::metadata(&path).unwrap().len(), 40);
        assert!(Bucket::open(&path, 41).is_err());
    }
}
