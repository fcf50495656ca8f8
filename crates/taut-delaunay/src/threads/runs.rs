//! Which thread inserts which sites of a round.
//!
//! Idea: each thread has a run of the curve and takes blocks from its front, so that the walk from site to site is short; a
//! thread that has done its run takes blocks from the back of the run that has most left.

use std::ops::Range;
use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;

/// Sites that a thread takes at once.
const BLOCK: u32 = 1024;

/// The places of a round that nobody has taken yet, a run for each thread.
pub(super) struct Runs(Vec<AtomicU64>);

/// A run in one number, so that it can be exchanged.
fn packed(run: Range<u32>) -> u64 {
    u64::from(run.start) << 32 | u64::from(run.end)
}

fn unpacked(run: u64) -> Range<u32> {
    (run >> 32) as u32..run as u32
}

impl Runs {
    /// Places 0 to `count` for so many threads.
    pub(super) fn new(count: u32, threads: usize) -> Self {
        let cut = |i: usize| (u64::from(count) * i as u64 / threads as u64) as u32;
        Runs((0..threads).map(|i| AtomicU64::new(packed(cut(i)..cut(i + 1)))).collect())
    }

    /// The next block for a thread; none if all is taken.
    pub(super) fn take(&self, thread: usize) -> Option<Range<u32>> {
        let front = |run: u64| {
            let run = unpacked(run);
            (!run.is_empty()).then(|| packed(run.start + BLOCK.min(run.len() as u32)..run.end))
        };
        if let Ok(run) = self.0[thread].fetch_update(Relaxed, Relaxed, front) {
            let run = unpacked(run);
            return Some(run.start..run.start + BLOCK.min(run.len() as u32));
        }
        let back = |run: u64| {
            let run = unpacked(run);
            (!run.is_empty()).then(|| packed(run.start..run.end - BLOCK.min(run.len() as u32)))
        };
        loop {
            let longest = self.0.iter().max_by_key(|run| unpacked(run.load(Relaxed)).len())?;
            if unpacked(longest.load(Relaxed)).is_empty() {
                return None;
            }
            if let Ok(run) = longest.fetch_update(Relaxed, Relaxed, back) {
                let run = unpacked(run);
                return Some(run.end - BLOCK.min(run.len() as u32)..run.end);
            }
        }
    }

    /// What nobody has taken.
    pub(super) fn rest(&self) -> impl Iterator<Item = u32> {
        self.0.iter().flat_map(|run| unpacked(run.load(Relaxed)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_place_is_taken_once() {
        for (count, threads) in [(0, 1), (1, 3), (1000, 2), (5000, 3), (100_000, 8)] {
            let runs = Runs::new(count, threads);
            let mut taken: Vec<u32> = Vec::new();
            // The last thread is the first to be done.
            for turn in (0..threads).rev().cycle().take(40 * threads) {
                taken.extend(runs.take(turn).into_iter().flatten());
            }
            taken.extend(runs.rest());
            taken.sort_unstable();
            assert_eq!(taken, (0..count).collect::<Vec<_>>(), "{count} by {threads}");
        }
    }
}
