//! Records in order, more of them than memory holds.
//!
//! *Idea.* Records gather in memory; when there is no more room they are sorted and written as a run to a file without a
//! name, and at the end the runs are merged. Few records never leave memory.
//! *Cost.* Each record is written once and read once.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use taut_points::bring_to_places;
use taut_points::parallel::ParallelSlice;

use super::TilesError;

/// Bytes that are written at once.
const WRITE_BYTES: usize = 1 << 16;

/// Fewest records of a run that are read at once.
const READ_RECORDS_MIN: usize = 16;

/// Records of more words are sorted by their numbers first.
const NARROW_WORDS_MAX: usize = 2;

/// Sorts records; wide ones by number, so that the sort is compiled once for all widths.
fn sort<const W: usize>(records: &mut [[u64; W]]) {
    if W <= NARROW_WORDS_MAX {
        return records.par_sort_unstable();
    }
    let order = order(records.as_flattened(), W);
    bring_to_places(records, order);
}

/// The numbers of the records, `width` words each, in ascending order of the records.
fn order(words: &[u64], width: usize) -> Vec<usize> {
    let record = |number: usize| &words[number * width..][..width];
    let mut order: Vec<usize> = (0..words.len() / width).collect();
    order.par_sort_unstable_by(|&a, &b| record(a).cmp(record(b)));
    order
}

/// Takes records of `W` words in any order.
pub(super) struct Sorter<const W: usize> {
    folder: PathBuf,
    /// Records that memory may hold.
    capacity: usize,
    records: Vec<[u64; W]>,
    /// The runs, and where each ends, in records.
    file: Option<File>,
    ends: Vec<u64>,
}

impl<const W: usize> Sorter<W> {
    /// An empty list that takes `bytes` of memory, and files in `folder`.
    pub(super) fn new(folder: &Path, bytes: u64) -> Self {
        let number = if W > NARROW_WORDS_MAX { size_of::<usize>() } else { 0 };
        let capacity = usize::try_from(bytes).unwrap_or(usize::MAX) / (8 * W + number);
        let capacity = capacity.max(READ_RECORDS_MIN);
        Sorter { folder: folder.to_owned(), capacity, records: vec![], file: None, ends: vec![] }
    }

    fn failed(&self) -> impl Fn(io::Error) -> TilesError + use<W> {
        let path = self.folder.clone();
        move |source| TilesError::File { path: path.clone(), source }
    }

    pub(super) fn push(&mut self, record: [u64; W]) -> Result<(), TilesError> {
        if self.records.len() == self.capacity {
            self.write_run()?;
        }
        if self.records.len() == self.records.capacity() {
            // Doubling could take half as much again as allowed.
            let more = self.records.len().clamp(1 << 10, 1 << 20);
            self.records.reserve_exact(more.min(self.capacity - self.records.len()));
        }
        self.records.push(record);
        Ok(())
    }

    fn write_run(&mut self) -> Result<(), TilesError> {
        let failed = self.failed();
        sort(&mut self.records);
        if self.file.is_none() {
            self.file = Some(tempfile::tempfile_in(&self.folder).map_err(&failed)?);
        }
        let Some(file) = &mut self.file else { return Ok(()) };
        let mut bytes = Vec::with_capacity(WRITE_BYTES + 8 * W);
        for record in &self.records {
            for word in record {
                bytes.extend_from_slice(&word.to_le_bytes());
            }
            if bytes.len() >= WRITE_BYTES {
                file.write_all(&bytes).map_err(&failed)?;
                bytes.clear();
            }
        }
        file.write_all(&bytes).map_err(&failed)?;
        let before = self.ends.last().copied().unwrap_or(0);
        self.ends.push(before + self.records.len() as u64);
        self.records.clear();
        Ok(())
    }

    /// All records, in ascending order.
    pub(super) fn sorted(mut self) -> Result<Sorted<W>, TilesError> {
        if self.file.is_none() {
            sort(&mut self.records);
            let records = std::mem::take(&mut self.records).into_iter();
            return Ok(Sorted { folder: self.folder, peeked: None, records, merge: None });
        }
        self.write_run()?;
        let room = (self.capacity / self.ends.len()).max(READ_RECORDS_MIN);
        self.records = vec![];
        let Some(file) = self.file.take() else {
            return Ok(Sorted {
                folder: self.folder,
                peeked: None,
                records: vec![].into_iter(),
                merge: None,
            });
        };
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        let runs =
            starts.zip(&self.ends).map(|(next, &end)| Run { next, end, read: vec![], at: 0 });
        let mut merge = Merge { file, room, runs: runs.collect(), heap: BinaryHeap::new() };
        let failed = self.failed();
        for run in 0..merge.runs.len() {
            merge.advance(run).map_err(&failed)?;
        }
        let records = vec![].into_iter();
        Ok(Sorted { folder: self.folder, peeked: None, records, merge: Some(merge) })
    }
}

/// A run that is being read.
struct Run {
    /// The records that have not been read, by number.
    next: u64,
    end: u64,
    read: Vec<u8>,
    at: usize,
}

struct Merge<const W: usize> {
    file: File,
    /// Records of each run that are read at once.
    room: usize,
    runs: Vec<Run>,
    heap: BinaryHeap<Reverse<([u64; W], usize)>>,
}

impl<const W: usize> Merge<W> {
    /// Puts the next record of a run into the heap, if there is one.
    fn advance(&mut self, number: usize) -> io::Result<()> {
        let run = &mut self.runs[number];
        if run.at == run.read.len() {
            let count = (self.room as u64).min(run.end - run.next) as usize;
            if count == 0 {
                run.read = vec![];
                run.at = 0;
                return Ok(());
            }
            run.read.resize(count * 8 * W, 0);
            self.file.seek(SeekFrom::Start(run.next * 8 * W as u64))?;
            self.file.read_exact(&mut run.read)?;
            run.next += count as u64;
            run.at = 0;
        }
        let mut record = [0; W];
        for (word, bytes) in record.iter_mut().zip(run.read[run.at..].as_chunks::<8>().0) {
            *word = u64::from_le_bytes(*bytes);
        }
        run.at += 8 * W;
        self.heap.push(Reverse((record, number)));
        Ok(())
    }
}

/// Records in ascending order.
pub(super) struct Sorted<const W: usize> {
    folder: PathBuf,
    peeked: Option<[u64; W]>,
    records: std::vec::IntoIter<[u64; W]>,
    merge: Option<Merge<W>>,
}

impl<const W: usize> Sorted<W> {
    /// The next record.
    pub(super) fn next(&mut self) -> Result<Option<[u64; W]>, TilesError> {
        if let Some(record) = self.peeked.take() {
            return Ok(Some(record));
        }
        let Some(merge) = &mut self.merge else { return Ok(self.records.next()) };
        let Some(Reverse((record, run))) = merge.heap.pop() else { return Ok(None) };
        let failed = |source| TilesError::File { path: self.folder.clone(), source };
        merge.advance(run).map_err(failed)?;
        Ok(Some(record))
    }

    /// The next record if `wanted` holds of it.
    pub(super) fn next_if(
        &mut self,
        wanted: impl FnOnce(&[u64; W]) -> bool,
    ) -> Result<Option<[u64; W]>, TilesError> {
        match self.next()? {
            Some(record) if wanted(&record) => Ok(Some(record)),
            other => {
                self.peeked = other;
                Ok(None)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_any_width_are_sorted() {
        fn sorts<const W: usize>() {
            let mut state = 1u64;
            let mut records = vec![[0; W]; 1000];
            for word in records.as_flattened_mut() {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                *word = state >> 60;
            }
            let mut expected = records.clone();
            expected.sort_unstable();
            sort(&mut records);
            assert_eq!(records, expected);
        }
        sorts::<1>();
        sorts::<2>();
        sorts::<3>();
        sorts::<5>();
        sorts::<17>();
    }

    #[test]
    fn records_come_back_in_order_from_memory_and_from_files() {
        let folder = tempfile::tempdir().unwrap();
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            state >> 50
        };
        let records: Vec<[u64; 3]> = (0..10_000).map(|_| [next(), next(), next()]).collect();
        let mut expected = records.clone();
        expected.sort_unstable();
        for bytes in [1 << 30, 24 * 10_000, 24 * 777, 1] {
            let mut sorter = Sorter::new(folder.path(), bytes);
            records.iter().for_each(|&record| sorter.push(record).unwrap());
            let mut sorted = sorter.sorted().unwrap();
            for &record in &expected {
                assert_eq!(sorted.next_if(|_| false).unwrap(), None);
                assert_eq!(sorted.next().unwrap(), Some(record));
            }
            assert_eq!(sorted.next().unwrap(), None);
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
