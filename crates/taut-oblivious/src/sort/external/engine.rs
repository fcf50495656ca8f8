//! The sort itself: what is read, written and held in memory, and when.

use taut_points::Monitor;

use super::chunk;
use super::journal::Journal;
use super::layout::RecordLayout;
use super::medium::{Medium, Storage};
use super::merge::{Merge, Run};
use super::{FileSort, Multiset};
use crate::error::Error;
use crate::room;

/// Blocks of this size keep a disk busy; larger ones leave the cache before the system has copied them.
const BLOCK_MAX: usize = 1 << 20;
/// Blocks that are written. There are two: one is filled while the other is written.
const WRITE_BLOCK: usize = 256 << 10;
/// Rather than with smaller blocks, runs are merged in several steps.
const BLOCK_MIN: usize = 256 << 10;

/// How the memory is used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Plan {
    pub(super) layout: RecordLayout,
    /// Records in the input.
    pub(super) records: u64,
    /// Most records of a run: what fits.
    pub(super) chunk: usize,
    /// Bytes that are written at once.
    write_block: usize,
    memory: usize,
}

impl Plan {
    pub(super) fn new(layout: &RecordLayout, records: u64, memory: usize) -> Result<Self, Error> {
        layout.check()?;
        let width = layout.width;
        let write_block = whole((memory / 32).min(WRITE_BLOCK), width);
        let chunk = memory.saturating_sub(2 * write_block) / (width + size_of::<u64>());
        if memory < 64 << 10 || chunk < 64 {
            return Err(Error::Option {
                name: "memory",
                value: format!("{memory} bytes"),
                expected: "at least 65536 bytes, and room for 64 records",
            });
        }
        let layout = layout.clone();
        Ok(Self { layout, records, chunk, write_block, memory })
    }

    /// Whether the records fit into memory.
    pub(super) fn fits(&self) -> bool {
        self.records <= self.chunk as u64
    }

    pub(super) fn runs(&self) -> u64 {
        self.records.div_ceil(self.chunk as u64)
    }

    pub(super) fn bytes(&self) -> u64 {
        self.records * self.layout.width as u64
    }

    /// The most runs that are merged at once.
    fn fan_in(&self) -> usize {
        let least = (self.memory / 64).clamp(4096, BLOCK_MIN).max(self.layout.width);
        ((self.memory - 2 * self.write_block) / least).max(2)
    }

    /// Bytes of each block when so many runs are merged.
    fn merge_block(&self, runs: usize) -> usize {
        whole(((self.memory - 2 * self.write_block) / runs).min(BLOCK_MAX), self.layout.width)
    }
}

/// The largest multiple of `width` that is at most `bytes`, but one `width` at least.
fn whole(bytes: usize, width: usize) -> usize {
    (bytes / width).max(1) * width
}

/// Sorts records that fit into memory.
pub(super) fn within<I: Storage, O: Storage>(
    plan: &Plan,
    input: &mut Medium<I>,
    output: &mut Medium<O>,
    monitor: &Monitor<'_>,
) -> Result<FileSort, Error> {
    monitor.pass(1, plan.records);
    let mut certificate = Multiset::default();
    let mut maker = Maker::new(plan);
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
pub(super) fn beyond<I: Storage, R: Storage, O: Storage>(
    plan: &Plan,
    input: &mut Medium<I>,
    runs: &mut Medium<R>,
    journal: Option<&Journal>,
    output: &mut Medium<O>,
    monitor: &Monitor<'_>,
) -> Result<FileSort, Error> {
    let width = plan.layout.width as u64;
    let start = journal.map_or(0, Journal::data_start);
    output.reserve(plan.bytes())?;
    runs.reserve(start + plan.bytes())?;
    let done = journal.map_or(0, Journal::runs_done);
    let mut certificate = journal.map_or(Multiset::default(), Journal::certificate);
    monitor.pass(1, plan.records);
    monitor.points(certificate.records);
    let mut maker = Maker::new(plan);
    for i in done..plan.runs() {
        let offset = start + i * plan.chunk as u64 * width;
        maker.make(i, input, runs, offset, &mut certificate, monitor)?;
        if let Some(journal) = journal {
            runs.sync()?;
            journal.enter(i, &certificate, runs)?;
        }
    }
    drop(maker);
    let chunk = plan.chunk as u64;
    let made = (0..plan.runs()).map(|i| Run {
        offset: start + i * chunk * width,
        records: chunk.min(plan.records - i * chunk),
    });
    let mut left: Vec<Run> = made.collect();
    let mut end = start + plan.bytes();
    let mut pass = 2;
    while left.len() > plan.fan_in() {
        let group = smallest_group(&left, plan.fan_in());
        let (offset, records) = (end, left[group.clone()].iter().map(|run| run.records).sum());
        monitor.pass(pass, records);
        let mut merge = Merging::start(plan, &left[group.clone()], runs)?;
        loop {
            let bytes = merge.fill(runs, monitor)?;
            if bytes == 0 {
                break;
            }
            runs.write(&merge.block[..bytes], end)?;
            end += bytes as u64;
        }
        left.splice(group, [Run { offset, records }]);
        pass += 1;
    }
    monitor.pass(pass, plan.records);
    let mut merge = Merging::start(plan, &left, runs)?;
    let (mut written, mut offset) = (Multiset::default(), 0);
    let mut bytes = merge.fill(runs, monitor)?;
    let mut full = vec![0; merge.block.len()];
    while bytes > 0 {
        std::mem::swap(&mut full, &mut merge.block);
        let put = || {
            written.add(&full[..bytes], plan.layout.width);
            output.write(&full[..bytes], offset)
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

/// Which neighbouring runs to merge so that at most `fan_in` are left, or as many as can be: the fewest records.
fn smallest_group(runs: &[Run], fan_in: usize) -> std::ops::Range<usize> {
    let size = fan_in.min(runs.len() - fan_in + 1);
    let records =
        |start: usize| runs[start..start + size].iter().map(|run| run.records).sum::<u64>();
    let start = (0..=runs.len() - size).min_by_key(|&start| records(start)).unwrap_or(0);
    start..start + size
}

/// A merge with the block that it fills.
struct Merging<'a> {
    merge: Merge<'a>,
    block: Vec<u8>,
    width: usize,
}

impl<'a> Merging<'a> {
    fn start<S: Storage>(
        plan: &'a Plan,
        runs: &[Run],
        source: &mut Medium<S>,
    ) -> Result<Self, Error> {
        let merge = Merge::start(&plan.layout, runs, plan.merge_block(runs.len()), source)?;
        Ok(Self { merge, block: vec![0; plan.write_block], width: plan.layout.width })
    }

    /// Fills the block with the next merged records; the number of bytes, 0 at the end.
    fn fill<S: Storage>(
        &mut self,
        source: &mut Medium<S>,
        monitor: &Monitor<'_>,
    ) -> Result<usize, Error> {
        monitor.check()?;
        let bytes = self.merge.fill(&mut self.block, source)?;
        monitor.points((bytes / self.width) as u64);
        Ok(bytes)
    }
}

/// Makes runs; holds the memory for it.
struct Maker<'a> {
    plan: &'a Plan,
    records: Vec<u8>,
    words: Vec<u64>,
    /// One block is filled while the other is written.
    blocks: [Vec<u8>; 2],
}

impl<'a> Maker<'a> {
    fn new(plan: &'a Plan) -> Self {
        let most = plan.records.min(plan.chunk as u64) as usize;
        Self {
            plan,
            records: room::filled(std::iter::repeat_n(0, most * plan.layout.width)),
            words: Vec::with_capacity(most),
            blocks: [vec![0; plan.write_block], vec![0; plan.write_block]],
        }
    }

    /// Reads run number `run`, sorts it and writes it from `offset`.
    fn make<I: Storage, S: Storage>(
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
        let bytes = &mut self.records[..records * width];
        let from = run * chunk * width as u64;
        for (i, part) in bytes.chunks_mut(WRITE_BLOCK).enumerate() {
            monitor.check()?;
            input.read(part, from + (i * WRITE_BLOCK) as u64)?;
        }
        let after = from + bytes.len() as u64;
        input.soon(after, (chunk * width as u64).min(self.plan.bytes() - after));
        certificate.add(bytes, width);
        chunk::order(bytes, &self.plan.layout, &mut self.words);
        let mask = (1 << chunk::number_bits(records)) - 1;
        let [full, next] = &mut self.blocks;
        let mut filled = 0;
        for words in self.words.chunks(next.len() / width) {
            monitor.check()?;
            let block = &mut next[..words.len() * width];
            let fill = || gather(bytes, words, mask, block, width);
            let (put, ()) = rayon::join(|| to.write(&full[..filled], offset), fill);
            put?;
            offset += filled as u64;
            monitor.points(words.len() as u64);
            filled = words.len() * width;
            std::mem::swap(full, next);
        }
        to.write(&full[..filled], offset)
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
