//! Merging runs: a tree of losers over the first records that are left.
//!
//! *Idea.* A node of the tree holds the loser of the game played there, the winner of all is outside. When the winner is
//! taken, its run's next record plays against the losers on the way from its leaf to the root: log₂ k games a record.
//! *Guarantee.* Stable: equal keys go by the number of the run. One block of memory for each run.
//! A record that comes before the one it follows in its run is an error.
//! *Trap.* Runs may have been written by another process, and their multiset says nothing of their order.
//! *Trap.* A player is one number, the rank and then the run, so that games need no look at the records and no branch;
//! keys of more than eight bytes need both.
//! *Reference.* D. Knuth, *The Art of Computer Programming* 3, 5.4.1.

use super::layout::RecordLayout;
use super::medium::Medium;
use super::plan::Run;
use crate::error::Error;
use crate::room::Pages;
use crate::store::Store;

/// Where a run is being read.
struct Input {
    /// What is left in the file.
    left: Run,
    /// What is left in the block.
    at: usize,
    end: usize,
}

/// A rank, and a number that tells players apart: the run, and the upper half for one that has ended.
type Player = u128;

const ENDED: u128 = 1 << 63;

pub(super) struct Merge<'a> {
    layout: &'a RecordLayout,
    inputs: Vec<Input>,
    /// Where each run begins.
    offsets: Vec<u64>,
    /// One block for each run.
    blocks: Pages<u8>,
    block: usize,
    /// A run that is not in order.
    disordered: Option<usize>,
    /// Losers of the inner nodes, which are numbered from 1; the run i comes in at node `(i + k) / 2`.
    losers: Vec<Player>,
    winner: Player,
    records_left: u64,
}

impl<'a> Merge<'a> {
    /// Starts to merge runs, with blocks of `block` bytes, a multiple of the width.
    pub(super) fn start<S: Store>(
        layout: &'a RecordLayout,
        runs: &[Run],
        block: usize,
        source: &mut Medium<S>,
    ) -> Result<Self, Error> {
        let inputs = runs.iter().map(|&left| Input { left, at: 0, end: 0 }).collect();
        let mut merge = Self {
            layout,
            inputs,
            offsets: runs.iter().map(|run| run.offset).collect(),
            blocks: Pages::try_zeroed(runs.len() * block)?,
            block,
            disordered: None,
            losers: vec![0; runs.len()],
            winner: 0,
            records_left: runs.iter().map(|run| run.records).sum(),
        };
        let k = runs.len();
        let mut winners = vec![0; 2 * k];
        for i in 0..k {
            winners[i + k] = merge.player(i, source)?;
        }
        for node in (1..k).rev() {
            let (a, b) = (winners[2 * node], winners[2 * node + 1]);
            (winners[node], merge.losers[node]) = if merge.before(a, b) { (a, b) } else { (b, a) };
        }
        merge.winner = winners[1];
        Ok(merge)
    }

    /// Puts the next records into `to`, as many as there is room for; the number of bytes, 0 at the end.
    pub(super) fn fill<S: Store>(
        &mut self,
        to: &mut [u8],
        source: &mut Medium<S>,
    ) -> Result<usize, Error> {
        match self.layout.width {
            8 => self.fill_width::<8, S>(to, source),
            16 => self.fill_width::<16, S>(to, source),
            32 => self.fill_width::<32, S>(to, source),
            _ => self.fill_width::<0, S>(to, source),
        }
    }

    /// [`Self::fill`] where the width is known, or 0.
    fn fill_width<const W: usize, S: Store>(
        &mut self,
        to: &mut [u8],
        source: &mut Medium<S>,
    ) -> Result<usize, Error> {
        let width = if W == 0 { self.layout.width } else { W };
        let room = (to.len() / width) as u64;
        let records = room.min(self.records_left);
        let (k, long) = (self.inputs.len(), self.layout.is_long());
        for place in to.chunks_exact_mut(width).take(records as usize) {
            let run = self.winner as u32 as usize;
            let input = &mut self.inputs[run];
            place.copy_from_slice(&self.blocks.words()[input.at..input.at + width]);
            input.at += width;
            let mut winner = if input.at < input.end {
                let rank = self.layout.rank(&self.blocks.words()[input.at..input.at + width]);
                player(rank, run)
            } else {
                self.player(run, source)?
            };
            // Both are players of one run, so that this compares their ranks.
            if winner < self.winner || long && self.falls(place, winner) {
                self.disordered = Some(run);
            }
            let mut node = (run + k) / 2;
            if long {
                while node > 0 {
                    if self.before(self.losers[node], winner) {
                        (self.losers[node], winner) = (winner, self.losers[node]);
                    }
                    node /= 2;
                }
            } else {
                while node > 0 {
                    // Who wins is a coin toss: a jump would be mispredicted in every second game, so both
                    // numbers change in the bits where they differ, or in none.
                    let loser = self.losers[node];
                    let changes = 0u128.wrapping_sub(u128::from(loser < winner));
                    let bits = (loser ^ winner) & changes;
                    self.losers[node] = loser ^ bits;
                    winner ^= bits;
                    node /= 2;
                }
            }
            self.winner = winner;
        }
        if let Some(run) = self.disordered {
            let path = source.path().to_owned();
            return Err(Error::UnsortedRun { path, offset: self.offsets[run] });
        }
        self.records_left -= records;
        Ok(records as usize * width)
    }

    /// The next player of a run whose block is used up.
    #[cold]
    fn player<S: Store>(&mut self, run: usize, source: &mut Medium<S>) -> Result<Player, Error> {
        let (width, input) = (self.layout.width, &mut self.inputs[run]);
        let bytes = (input.left.records * width as u64).min(self.block as u64);
        if bytes == 0 {
            return Ok(player(u64::MAX, run) | ENDED);
        }
        let start = run * self.block;
        (input.at, input.end) = (start, start + bytes as usize);
        source.read(&mut self.blocks.words_mut()[start..input.end], input.left.offset)?;
        input.left.offset += bytes;
        input.left.records -= bytes / width as u64;
        let next = (input.left.records * width as u64).min(self.block as u64);
        if next > 0 {
            source.soon(input.left.offset, next);
        }
        Ok(player(self.layout.rank(&self.blocks.words()[start..start + width]), run))
    }

    /// Whether the record of `next`, whose key is longer than its rank, comes before `last` of the same run.
    fn falls(&self, last: &[u8], next: Player) -> bool {
        next >> 64 == self.winner >> 64
            && next & ENDED == 0
            && self.layout.compare_rest(last, self.record(next)).is_gt()
    }

    /// The record of a player whose run has not ended.
    fn record(&self, player: Player) -> &[u8] {
        &self.blocks.words()[self.inputs[player as u32 as usize].at..][..self.layout.width]
    }

    /// Whether the record of `a` comes before that of `b`.
    fn before(&self, a: Player, b: Player) -> bool {
        if a >> 64 != b >> 64 || (a | b) & ENDED != 0 || !self.layout.is_long() {
            return a < b;
        }
        self.layout.compare_rest(self.record(a), self.record(b)).then(a.cmp(&b)).is_lt()
    }
}

fn player(rank: u64, run: usize) -> Player {
    u128::from(rank) << 64 | run as u128
}
