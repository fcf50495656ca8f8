//! Which thread inserts which sites of a round.
//!
//! Idea: each thread has a run of the curve and goes along it, so that the walk from site to site is short; it ends where it begins in
//! the next round, as rounds go along the curve in turns. A thread that has done its run helps with the run that has most left, from
//! its other end.

use std::ops::Range;
use std::sync::atomic::Ordering::Relaxed;

use crate::threads::atomics::AtomicU64;

/// Sites that a thread takes at once.
const BLOCK: u32 = if cfg!(loom) {
    1
} else if cfg!(test) {
    4
} else {
    256
};
/// A run of which less is left is nobody else's: on a line of sites the walk to its end has as many steps as there are sites.
const HELP_MIN: u32 = if cfg!(loom) { 4 } else { 16 * BLOCK };

/// Places of a round, and whether they are gone through from the last to the first.
pub(super) struct Block {
    places: Range<u32>,
    backward: bool,
}

impl Block {
    /// The places in their order.
    pub(super) fn places(&self) -> impl Iterator<Item = u32> {
        let Range { start, end } = self.places;
        let backward = self.backward;
        (start..end).map(move |place| if backward { end - 1 - (place - start) } else { place })
    }
}

/// The places of a round that nobody has taken yet, a run for each thread.
pub(super) struct Runs {
    runs: Vec<AtomicU64>,
    /// The direction in which threads go along their own runs.
    backward: bool,
}

/// A run in one number, so that it can be exchanged.
fn packed(run: Range<u32>) -> u64 {
    u64::from(run.start) << 32 | u64::from(run.end)
}

fn unpacked(run: u64) -> Range<u32> {
    (run >> 32) as u32..run as u32
}

/// Takes a block from one end of a run that has at least so many places.
fn take(run: &AtomicU64, least: u32, backward: bool) -> Option<Block> {
    let split = |run: Range<u32>| {
        let block = BLOCK.min(run.len() as u32);
        if backward {
            (run.end - block..run.end, run.start..run.end - block)
        } else {
            (run.start..run.start + block, run.start + block..run.end)
        }
    };
    let rest = |run: u64| {
        let run = unpacked(run);
        (run.len() as u32 >= least).then(|| packed(split(run).1))
    };
    let before = run.fetch_update(Relaxed, Relaxed, rest).ok()?;
    Some(Block { places: split(unpacked(before)).0, backward })
}

impl Runs {
    /// Places 0 to `count` for so many threads.
    pub(super) fn new(count: u32, threads: usize, backward: bool) -> Self {
        let cut = |i: usize| (u64::from(count) * i as u64 / threads as u64) as u32;
        let run = |i: usize| AtomicU64::new(packed(cut(i)..cut(i + 1)));
        Runs { runs: (0..threads).map(run).collect(), backward }
    }

    /// The next block for a thread; none if all is taken.
    pub(super) fn take(&self, thread: usize) -> Option<Block> {
        if let Some(block) = take(&self.runs[thread], 1, self.backward) {
            return Some(block);
        }
        #[cfg(all(test, not(loom)))]
        if super::round::in_turn::ON.load(Relaxed) {
            return None;
        }
        loop {
            let left = |run: &&AtomicU64| unpacked(run.load(Relaxed)).len() as u32;
            let longest = self.runs.iter().max_by_key(left)?;
            if let Some(block) = take(longest, HELP_MIN, !self.backward) {
                return Some(block);
            }
            if left(&longest) < HELP_MIN {
                return None;
            }
        }
    }

    /// What nobody has taken.
    pub(super) fn rest(&self) -> impl Iterator<Item = u32> {
        self.runs.iter().flat_map(|run| unpacked(run.load(Relaxed)))
    }
}

#[cfg(all(test, not(loom)))]
mod tests {
    use super::*;

    #[test]
    fn each_place_is_taken_once() {
        for (count, threads) in [(0, 1), (1, 3), (1000, 2), (5000, 3), (100_000, 8)] {
            let runs = Runs::new(count, threads, count % 2 == 1);
            let mut taken: Vec<u32> = Vec::new();
            // The last thread is the first to be done, and helps the others.
            for turn in (0..threads).rev() {
                for _ in 0..30 {
                    taken.extend(runs.take(turn).iter().flat_map(Block::places));
                }
            }
            taken.extend(runs.rest());
            taken.sort_unstable();
            assert_eq!(taken, (0..count).collect::<Vec<_>>(), "{count} by {threads}");
        }
    }
}
