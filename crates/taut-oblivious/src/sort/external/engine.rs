//! The sort itself: what is read, written and held in memory, and when.

use taut_points::Monitor;

use super::chunk;
use super::journal::Journal;
use super::medium::Medium;
use super::merge::Merge;
use super::plan::{Plan, Run, steps};
use super::{FileSort, Multiset};
use crate::error::Error;
use crate::room::Pages;
use crate::store::Store;

/// Bytes that are read at once while a run is made.
const READ_BLOCK: usize = 1 << 20;

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
    maker.make(0, input, output, 0, &mut certificate, monitor)?;
    output.sync()?;
    Ok(FileSort {
        certificate,
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
    let start = journal.map_or(0, Journal::data_start);
    let made = plan.made(start);
    let (steps, last) = steps(made.clone(), plan);
    let mut maker = Maker::new(plan)?;
    output.reserve(plan.bytes())?;
    runs.reserve(last.iter().map(|run| run.end(plan)).max().unwrap_or(start))?;
    if plan.past_cache {
        runs.past_cache();
        output.past_cache();
    }
    let done = journal.map_or(0, Journal::runs_done);
    let mut certificate = journal.map_or(Multiset::default(), Journal::certificate);
    monitor.pass(1, plan.records);
    monitor.points(certificate.records);
    for (i, run) in (0..).zip(&made).skip(done as usize) {
        maker.make(i, input, runs, run.offset, &mut certificate, monitor)?;
        if let Some(journal) = journal {
            runs.sync()?;
            journal.enter(i, &certificate, runs)?;
        }
    }
    drop(maker);
    let mut pass = 2;
    for (group, to) in steps {
        monitor.pass(pass, to.records);
        let mut merge = Merging::start(plan, &group, runs)?;
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
    let mut merge = Merging::start(plan, &last, runs)?;
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
        let (put, next) = rayon::join(put, || merge.fill(runs, monitor));
        put?;
        offset += bytes as u64;
        bytes = next?;
    }
    if written != certificate {
        return Err(Error::ReadBack { path: runs.path().to_owned() });
    }
    output.sync()?;
    Ok(FileSort {
        certificate,
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
    fn start<S: Store>(
        plan: &'a Plan,
        runs: &[Run],
        source: &mut Medium<S>,
    ) -> Result<Self, Error> {
        let merge = Merge::start(&plan.layout, runs, plan.merge_block(runs.len()), source)?;
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
    words: Pages<u64>,
    /// One block is filled while the other is written.
    blocks: [Pages<u8>; 2],
}

impl<'a> Maker<'a> {
    fn new(plan: &'a Plan) -> Result<Self, Error> {
        let most = plan.records.min(plan.chunk as u64) as usize;
        let block = || Pages::try_zeroed(plan.write_block);
        Ok(Self {
            plan,
            records: Pages::try_zeroed(most * plan.layout.width)?,
            words: Pages::try_zeroed(most)?,
            blocks: [block()?, block()?],
        })
    }

    /// Reads run number `run`, sorts it and writes it from `offset`.
    fn make<I: Store, S: Store + Send + Sync>(
        &mut self,
        run: u64,
        input: &mut Medium<I>,
        to: &mut Medium<S>,
        mut offset: u64,
        certificate: &mut Multiset,
        monitor: &Monitor<'_>,
    ) -> Result<(), Error> {
        let (width, chunk) = (self.plan.layout.width, self.plan.chunk as u64);
        let records = chunk.min(self.plan.records - run * chunk) as usize;
        let bytes = &mut self.records.words_mut()[..records * width];
        let words = &mut self.words.words_mut()[..records];
        let from = run * chunk * width as u64;
        for (i, part) in bytes.chunks_mut(READ_BLOCK).enumerate() {
            monitor.check()?;
            input.read(part, from + (i * READ_BLOCK) as u64)?;
        }
        let after = from + bytes.len() as u64;
        input.soon(after, (chunk * width as u64).min(self.plan.bytes() - after));
        certificate.add(bytes, width);
        chunk::order(bytes, &self.plan.layout, words);
        let mask = (1 << chunk::number_bits(records)) - 1;
        let [full, next] = &mut self.blocks;
        let mut filled = 0;
        for words in words.chunks(self.plan.write_block / width) {
            monitor.check()?;
            let block = &mut next.words_mut()[..words.len() * width];
            let fill = || gather(bytes, words, mask, block, width);
            let (put, ()) = rayon::join(|| to.write(&full.words()[..filled], offset), fill);
            put?;
            offset += filled as u64;
            monitor.points(words.len() as u64);
            filled = words.len() * width;
            std::mem::swap(full, next);
        }
        to.write(&full.words()[..filled], offset)
    }
}

/// Copies the records whose numbers the words hold.
fn gather(records: &[u8], words: &[u64], mask: u64, to: &mut [u8], width: usize) {
    match width {
        8 => gather_width::<8>(records, words, mask, to),
        16 => gather_width::<16>(records, words, mask, to),
        32 => gather_width::<32>(records, words, mask, to),
        _ => {
            for (place, word) in to.chunks_exact_mut(width).zip(words) {
                place.copy_from_slice(&records[(word & mask) as usize * width..][..width]);
            }
        }
    }
}

fn gather_width<const W: usize>(records: &[u8], words: &[u64], mask: u64, to: &mut [u8]) {
    let records = records.as_chunks::<W>().0;
    for (place, word) in to.as_chunks_mut::<W>().0.iter_mut().zip(words) {
        *place = records[(word & mask) as usize];
    }
}
