//! The sort itself: what is read, written and held in memory, and when.

use taut_points::Monitor;

use super::chunk::{self, Stage};
use super::digest;
use super::journal::Journal;
use super::medium::Medium;
use super::merge::Merge;
use super::plan::{Plan, Run, steps, whole};
use super::{FileSort, Multiset};
use crate::error::Error;
use crate::pages::Pages;
use crate::store::Store;

/// Bytes that are read at once while a run is made, or one record: half a second-level cache.
const READ_BLOCK: usize = 1 << 19;

/// Sorts records that fit into memory.
pub(super) fn within<I: Store, O: Store + Sync + Send>(
    plan: &Plan,
    input: &mut Medium<I>,
    output: &mut Medium<O>,
    monitor: &Monitor<'_>,
) -> Result<FileSort, Error> {
    monitor.pass(1, plan.records);
    let mut certificate = Multiset::default();
    let mut maker = Maker::new(plan)?;
    output.reserve(plan.bytes())?;
    maker.read(0, input, Some(&mut certificate), monitor)?;
    maker.make(0, output, 0, monitor)?;
    Ok(FileSort {
        certificate,
        header: 0,
        header_hash: 0,
        runs: plan.runs(),
        runs_resumed: 0,
        bytes_read: input.bytes_read,
        bytes_written: output.bytes_written,
    })
}

/// Sorts records by runs.
pub(super) fn beyond<I: Store, R: Store + Send + Sync, O: Store + Send + Sync>(
    plan: &Plan,
    input: &mut Medium<I>,
    runs: &mut Medium<R>,
    journal: Option<&Journal>,
    output: &mut Medium<O>,
    monitor: &Monitor<'_>,
) -> Result<FileSort, Error> {
    // Before anything is made that grows with the number of runs.
    output.reserve(plan.bytes())?;
    let start = journal.map_or(0, Journal::data_start);
    let made = plan.made(start);
    let (steps, last) = steps(made.clone(), plan);
    let mut maker = Maker::new(plan)?;
    runs.reserve(last.iter().map(|run| run.end(plan)).max().unwrap_or(start))?;
    if plan.past_cache {
        runs.past_cache();
        output.past_cache();
    }
    let done = journal.map_or(0, Journal::runs_done);
    let mut certificate = journal.map_or(Multiset::default(), Journal::certificate);
    monitor.pass(1, plan.records);
    for (i, run) in (0..).zip(&made) {
        // The journal's certificate has the records of runs that are done.
        let multiset = (i >= done).then_some(&mut certificate);
        maker.read(i, input, multiset, monitor)?;
        let Some(journal) = journal else {
            maker.make(i, runs, run.offset, monitor)?;
            continue;
        };
        let made_of = digest::hash(maker.read_of(i));
        if i >= done {
            maker.make(i, runs, run.offset, monitor)?;
            runs.sync()?;
            journal.enter(i, &certificate, made_of, runs)?;
        } else if made_of == journal.made_of(i) {
            monitor.points(run.records);
        } else {
            return Err(Journal::other(runs.path()));
        }
    }
    drop(maker);
    let mut pass = 2;
    for (group, to) in steps {
        monitor.pass(pass, to.records);
        let mut merge = Merging::start(plan, &group)?;
        let mut end = to.offset;
        loop {
            let bytes = merge.fill(runs, monitor)?;
            if bytes == 0 {
                break;
            }
            runs.write(&merge.block.words()[..bytes], end)?;
            end += bytes as u64;
        }
        pass += 1;
    }
    monitor.pass(pass, plan.records);
    let mut merge = Merging::start(plan, &last)?;
    let (mut written, mut offset) = (Multiset::default(), 0);
    let mut bytes = merge.fill(runs, monitor)?;
    let mut full = Pages::try_zeroed(plan.write_block)?;
    while bytes > 0 {
        std::mem::swap(&mut full, &mut merge.block);
        let put = || {
            let block = &full.words()[..bytes];
            written.add(block, plan.layout.width);
            output.write(block, offset)
        };
        let (put, next) = taut_points::parallel::join(put, || merge.fill(runs, monitor));
        put?;
        offset += bytes as u64;
        bytes = next?;
    }
    if written != certificate {
        let path = runs.path().to_owned();
        return Err(match journal {
            Some(_) => Error::DamagedRuns { path },
            None => Error::ReadBack { path },
        });
    }
    Ok(FileSort {
        certificate,
        header: 0,
        header_hash: 0,
        runs: plan.runs(),
        runs_resumed: done,
        bytes_read: input.bytes_read + runs.bytes_read,
        bytes_written: runs.bytes_written + output.bytes_written,
    })
}

/// A merge with the block that it fills.
struct Merging<'a> {
    merge: Merge<'a>,
    block: Pages<u8>,
    width: usize,
}

impl<'a> Merging<'a> {
    fn start(plan: &'a Plan, runs: &[Run]) -> Result<Self, Error> {
        let merge = Merge::start(plan, runs)?;
        let block = Pages::try_zeroed(plan.write_block)?;
        Ok(Self { merge, block, width: plan.layout.width })
    }

    /// Fills the block with the next merged records; the number of bytes, 0 at the end.
    fn fill<S: Store>(
        &mut self,
        source: &mut Medium<S>,
        monitor: &Monitor<'_>,
    ) -> Result<usize, Error> {
        monitor.check()?;
        let bytes = self.merge.fill(self.block.words_mut(), source)?;
        monitor.points((bytes / self.width) as u64);
        Ok(bytes)
    }
}

/// Makes runs; holds the memory for it.
struct Maker<'a> {
    plan: &'a Plan,
    records: Pages<u8>,
    beside: ExtraMemory,
}

/// The memory that sorting takes beside the records.
enum ExtraMemory {
    /// Where they are dealt in their own place.
    Stage(Stage),
    /// A word for each, and two blocks: one is filled while the other is written.
    Words { words: Pages<u64>, blocks: [Pages<u8>; 2] },
}

impl<'a> Maker<'a> {
    fn new(plan: &'a Plan) -> Result<Self, Error> {
        let most = plan.records.min(plan.chunk as u64) as usize;
        let records = Pages::try_zeroed(most * plan.layout.width)?;
        let beside = if plan.in_place > 0 {
            ExtraMemory::Stage(Stage::new(most * plan.layout.width, plan.unit, plan.write_block)?)
        } else {
            let block = || Pages::try_zeroed(plan.write_block);
            ExtraMemory::Words { words: Pages::try_zeroed(most)?, blocks: [block()?, block()?] }
        };
        Ok(Self { plan, records, beside })
    }

    fn records_of(&self, run: u64) -> usize {
        let chunk = self.plan.chunk as u64;
        chunk.min(self.plan.records - run * chunk) as usize
    }

    /// Returns what was last read, which is run number `run`.
    fn read_of(&self, run: u64) -> &[u8] {
        &self.records.words()[..self.records_of(run) * self.plan.layout.width]
    }

    /// Reads run number `run`, and adds its records to a multiset, if there is one, while they are in the cache.
    fn read<I: Store>(
        &mut self,
        run: u64,
        input: &mut Medium<I>,
        mut multiset: Option<&mut Multiset>,
        monitor: &Monitor<'_>,
    ) -> Result<(), Error> {
        let (records, width) = (self.records_of(run), self.plan.layout.width);
        let most = self.plan.chunk as u64 * width as u64;
        let bytes = &mut self.records.words_mut()[..records * width];
        let from = run * most;
        let block = whole(READ_BLOCK, width);
        for (i, part) in bytes.chunks_mut(block).enumerate() {
            monitor.check()?;
            input.read(part, from + (i * block) as u64)?;
            if let Some(multiset) = &mut multiset {
                multiset.add(part, width);
            }
        }
        let after = from + bytes.len() as u64;
        input.soon(after, most.min(self.plan.bytes() - after));
        Ok(())
    }

    /// Sorts what was read, which is run number `run`, and writes it from `offset`.
    fn make<S: Store + Send + Sync>(
        &mut self,
        run: u64,
        to: &mut Medium<S>,
        mut offset: u64,
        monitor: &Monitor<'_>,
    ) -> Result<(), Error> {
        let (layout, records) = (&self.plan.layout, self.records_of(run));
        let (width, write_block) = (layout.width, self.plan.write_block);
        let bytes = &mut self.records.words_mut()[..records * width];
        let (words, [full, next]) = match &mut self.beside {
            ExtraMemory::Words { words, blocks } => (&mut words.words_mut()[..records], blocks),
            ExtraMemory::Stage(stage) => {
                let put = |part: &[u8]| {
                    for block in part.chunks(write_block) {
                        monitor.check()?;
                        to.write(block, offset)?;
                        offset += block.len() as u64;
                        monitor.points((block.len() / width) as u64);
                    }
                    Ok(())
                };
                return chunk::sort(bytes, layout, self.plan.in_place, stage, put);
            }
        };
        layout.ranks(bytes, words);
        chunk::order(bytes, std::slice::from_ref(&(0..records)), layout, words);
        let mut filled = 0;
        for words in words.chunks(write_block / width) {
            monitor.check()?;
            let block = &mut next.words_mut()[..words.len() * width];
            let fill = || chunk::gather(bytes, words, block, width);
            let (put, ()) =
                taut_points::parallel::join(|| to.write(&full.words()[..filled], offset), fill);
            put?;
            offset += filled as u64;
            monitor.points(words.len() as u64);
            filled = words.len() * width;
            std::mem::swap(full, next);
        }
        to.write(&full.words()[..filled], offset)
    }
}
