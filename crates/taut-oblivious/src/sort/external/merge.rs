//! Merging runs by sorting what is next in them.
//!
//! *Idea.* Of each run the next records stand in a window of its block. The smallest of the last keys of all windows is a
//! bound: no run has a record below it that is not in a window. The records up to the bound are represented by a word each,
//! with their places in the blocks; the words are sorted by the vector kernels, as in [`super::chunk`], and the windows
//! move on.
//! *Guarantee.* Stable: the blocks stand in the order of the runs, so places are in the order of equal records. One
//! block of memory for each run, and a word for each record of the windows. The window whose last key is the bound is
//! used up, so each step has one run at least move by a window. A record that comes before the one it follows in its
//! run is an error.
//! *Trap.* Keys equal to the bound: more of them may follow behind the window that ends with it. So records of later runs
//! must be below the bound, those of this run and of earlier ones up to it.
//! *Trap.* Runs may have been written by another process, and their multiset says nothing of their order.
//! *Trap.* A tree of losers (D. Knuth, *The Art of Computer Programming* 3, 5.4.1) needs log₂ k games a record, each of
//! which waits for the one before: 20 ns for 16 runs, where collecting and sorting takes 13 for any number of runs.

use std::cmp::Ordering;
use std::ops::Range;

use super::chunk;
use super::layout::RecordLayout;
use super::medium::Medium;
use super::plan::{Plan, Run};
use crate::error::Error;
use crate::pages::Pages;
use crate::store::Store;

/// Where a run is being read.
struct Input {
    /// Where it begins in the file.
    offset: u64,
    /// The rest of the file.
    left: Run,
    /// The rest of its block, in bytes of all blocks.
    at: usize,
    end: usize,
    /// True if the last record that was collected is in `Merge::last`.
    begun: bool,
}

pub(super) struct Merge<'a> {
    layout: &'a RecordLayout,
    inputs: Vec<Input>,
    /// One block for each run.
    blocks: Pages<u8>,
    block: usize,
    /// Bytes of a window.
    window: usize,
    /// The last record that was collected of each run.
    last: Vec<u8>,
    /// Which records were collected, by numbers in all blocks, and a word for each, in order.
    parts: Vec<Range<usize>>,
    words: Pages<u64>,
    /// Records that were collected, and those of them that were taken.
    collected: usize,
    taken: usize,
}

impl<'a> Merge<'a> {
    pub(super) fn start(plan: &'a Plan, runs: &[Run]) -> Result<Self, Error> {
        let width = plan.layout.width;
        let (block, window) = plan.merge_sizes(runs.len());
        let records = runs.len() * window;
        let input = |&left: &Run| Input { offset: left.offset, left, at: 0, end: 0, begun: false };
        Ok(Self {
            layout: &plan.layout,
            inputs: runs.iter().map(input).collect(),
            blocks: Pages::try_zeroed(runs.len() * block)?,
            block,
            window: window * width,
            last: vec![0; runs.len() * width],
            parts: Vec::with_capacity(runs.len()),
            words: Pages::try_zeroed(records)?,
            collected: 0,
            taken: 0,
        })
    }

    /// Puts the next records into `to`, as many as there is room for; the number of bytes, 0 at the end.
    pub(super) fn fill<S: Store>(
        &mut self,
        to: &mut [u8],
        source: &mut Medium<S>,
    ) -> Result<usize, Error> {
        let (width, mut filled) = (self.layout.width, 0);
        while filled + width <= to.len() {
            if self.taken == self.collected {
                self.collect(source)?;
                if self.collected == 0 {
                    break;
                }
            }
            let room = (to.len() - filled) / width;
            let words = &self.words.words()[self.taken..self.collected];
            let words = &words[..words.len().min(room)];
            chunk::gather(self.blocks.words(), words, &mut to[filled..], width);
            self.taken += words.len();
            filled += words.len() * width;
        }
        Ok(filled)
    }

    /// Collects the records up to the next bound, and orders them; none at the end.
    fn collect<S: Store>(&mut self, source: &mut Medium<S>) -> Result<(), Error> {
        (self.collected, self.taken) = (0, 0);
        for run in 0..self.inputs.len() {
            if self.inputs[run].at == self.inputs[run].end {
                self.refill(run, source)?;
            }
        }
        let (layout, width) = (self.layout, self.layout.width);
        let blocks = self.blocks.words();
        let window = |input: &Input| &blocks[input.at..input.end.min(input.at + self.window)];
        // The first run with the smallest last key.
        let mut bound: Option<(usize, &[u8])> = None;
        for (run, input) in self.inputs.iter().enumerate() {
            if let Some(last) = window(input).chunks_exact(width).next_back()
                && bound.is_none_or(|(_, bound)| compare(layout, last, bound).is_lt())
            {
                bound = Some((run, last));
            }
        }
        let Some((first, bound)) = bound else { return Ok(()) };
        self.parts.clear();
        for (run, input) in self.inputs.iter_mut().enumerate() {
            let window = window(input);
            let is_next = |record: &[u8]| match compare(layout, record, bound) {
                Ordering::Less => true,
                Ordering::Equal => run <= first,
                Ordering::Greater => false,
            };
            let records = partition(window, width, is_next);
            if records == 0 {
                continue;
            }
            let part = &window[..records * width];
            let words = &mut self.words.words_mut()[self.collected..][..records];
            layout.ranks(part, words);
            let last = &mut self.last[run * width..][..width];
            let falls = input.begun && compare(layout, last, &part[..width]).is_gt();
            if falls || !is_in_order(layout, part, words) {
                let path = source.path().to_owned();
                return Err(Error::UnsortedRun { path, offset: input.offset });
            }
            last.copy_from_slice(&part[part.len() - width..]);
            let number = input.at / width;
            self.parts.push(number..number + records);
            input.begun = true;
            input.at += part.len();
            self.collected += records;
        }
        let words = &mut self.words.words_mut()[..self.collected];
        chunk::order(blocks, &self.parts, layout, words);
        Ok(())
    }

    /// Reads the next block of a run, if there is one.
    fn refill<S: Store>(&mut self, run: usize, source: &mut Medium<S>) -> Result<(), Error> {
        let (width, input) = (self.layout.width as u64, &mut self.inputs[run]);
        let bytes = (input.left.records * width).min(self.block as u64);
        if bytes == 0 {
            return Ok(());
        }
        let start = run * self.block;
        (input.at, input.end) = (start, start + bytes as usize);
        source.read(&mut self.blocks.words_mut()[start..input.end], input.left.offset)?;
        input.left.offset += bytes;
        input.left.records -= bytes / width;
        let next = (input.left.records * width).min(self.block as u64);
        if next > 0 {
            source.soon(input.left.offset, next);
        }
        Ok(())
    }
}

/// The order of the keys of two records.
fn compare(layout: &RecordLayout, a: &[u8], b: &[u8]) -> Ordering {
    layout.rank(a).cmp(&layout.rank(b)).then_with(|| layout.compare_rest(a, b))
}

/// Returns how many records at the front hold, in a row of records of which none holds behind one that does not.
fn partition(records: &[u8], width: usize, holds: impl Fn(&[u8]) -> bool) -> usize {
    let (mut low, mut high) = (0, records.len() / width);
    while low < high {
        let middle = (low + high) / 2;
        if holds(&records[middle * width..][..width]) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low
}

/// Returns true if no record comes before the one before it; `ranks` are theirs.
fn is_in_order(layout: &RecordLayout, records: &[u8], ranks: &[u64]) -> bool {
    let pairs = ranks.iter().zip(&ranks[1..]);
    let rise = pairs.fold(true, |holds, (a, b)| holds & (a <= b));
    let (front, back) = (&records[..records.len() - layout.width], &records[layout.width..]);
    let mut pairs = front.chunks_exact(layout.width).zip(back.chunks_exact(layout.width));
    rise && (!layout.is_long() || pairs.all(|(a, b)| compare(layout, a, b).is_le()))
}
