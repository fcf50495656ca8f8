//! Misses of LRU memories of all sizes at once.
//!
//! *Problem.* Misses as a function of M, for one B, without a run per M.
//! *Idea.* An access hits a memory of m blocks exactly if fewer than m other blocks were accessed since its block was: its
//! stack distance, itself included, is at most m. A bit per time, set at the last access of each block, and a Fenwick tree
//! over words of 64 of them count these.
//! *Guarantee.* Exact; O(log n) per access with n blocks in use.
//! *Trap.* Time grows without end, blocks do not: when the tree is full the times in use are renumbered.
//! *Reference.* Mattson, Gecsei, Slutz, Traiger, IBM Systems Journal 9(2), 1970; Bennett and Kruskal, IBM Journal of
//! Research and Development 19(4), 1975 (the tree).

use super::shape::CacheShape;
use super::space::Space;
use super::table::Table;
use crate::{Access, Error, Probe};

/// The first tree has room for this many times.
const FIRST_TREE_TIMES: usize = 1 << 10;

/// Records the accesses of an algorithm and knows the misses of an LRU memory of every size.
#[derive(Clone, Debug)]
pub struct StackDistances {
    space: Space,
    shift: u32,
    /// Time of the last access of a block, plus one.
    last: Table,
    /// The block accessed at a time.
    block_at: Vec<u64>,
    /// A bit for each time, set where it is some block's last; times begin at 1.
    last_at: Vec<u64>,
    /// Fenwick tree of the bits set in each word; entry i + 1 belongs to word i.
    tree: Vec<u32>,
    /// Blocks accessed so far.
    blocks: usize,
    /// The number of accesses that had the stack distance that is the index.
    histogram: Vec<u64>,
}

impl StackDistances {
    /// Nothing recorded yet, in blocks of `block` bytes, at whose multiples arrays begin.
    ///
    /// # Errors
    /// [`Error::Option`] if `block` is no power of two.
    pub fn new(block: usize) -> Result<Self, Error> {
        CacheShape::lru(block, block).check()?;
        Ok(Self::aligned(block, block))
    }

    /// The same with arrays at multiples of `align`; both are powers of two.
    pub(super) fn aligned(block: usize, align: usize) -> Self {
        Self {
            space: Space::new(align),
            shift: block.trailing_zeros(),
            last: Table::default(),
            block_at: Vec::new(),
            last_at: vec![0; FIRST_TREE_TIMES / 64],
            tree: vec![0; FIRST_TREE_TIMES / 64 + 1],
            blocks: 0,
            histogram: vec![0; 2],
        }
    }

    /// Misses of an LRU memory of `memory` bytes; of the part of it that is whole blocks.
    ///
    /// O(distances); see [`Self::curve`] for many sizes.
    pub fn misses(&self, memory: usize) -> u64 {
        let held = memory >> self.shift;
        let far: u64 = self.histogram.iter().skip(held.saturating_add(1)).sum();
        self.blocks as u64 + far
    }

    /// Bytes of a block.
    pub fn block(&self) -> usize {
        1 << self.shift
    }

    /// Accesses of a block so far.
    pub fn accesses(&self) -> u64 {
        self.blocks as u64 + self.histogram.iter().sum::<u64>()
    }

    /// Blocks accessed so far: the misses of a memory without end.
    pub fn cold(&self) -> u64 {
        self.blocks as u64
    }

    /// Misses of memories of 0, 1, 2, … blocks, up to the first that has cold misses only.
    pub fn curve(&self) -> Vec<u64> {
        let mut misses = self.accesses();
        let mut curve = vec![misses];
        for near in &self.histogram[1..] {
            misses -= near;
            curve.push(misses);
        }
        while curve.len() > 1 && curve[curve.len() - 2] == misses {
            curve.pop();
        }
        curve
    }

    /// Accesses that lay outside all announced arrays, at least in part.
    pub fn unannounced(&self) -> u64 {
        self.space.unannounced()
    }

    /// Records an access of `bytes` simulated bytes, at least one.
    #[inline]
    pub(super) fn record_at(&mut self, at: u64, bytes: usize) {
        for block in at >> self.shift..=(at + (bytes as u64 - 1)) >> self.shift {
            if self.block_at.last() == Some(&block) {
                self.histogram[1] += 1;
            } else {
                self.access_other(block);
            }
        }
    }

    fn access_other(&mut self, block: u64) {
        if self.block_at.len() + 1 == 64 * self.last_at.len() {
            self.renumber();
        }
        let before = self.last.get(block) as usize;
        if before == 0 {
            self.blocks += 1;
            self.histogram.push(0);
        } else {
            // Blocks whose last access came later, and the block itself.
            let distance = self.blocks - self.last_up_to(before) + 1;
            self.histogram[distance] += 1;
            self.last_at[before / 64] ^= 1 << (before % 64);
            self.add(before / 64, u32::MAX);
        }
        self.block_at.push(block);
        let now = self.block_at.len();
        self.last.set(block, now as u32);
        self.last_at[now / 64] |= 1 << (now % 64);
        self.add(now / 64, 1);
    }

    /// Blocks whose last access was at that time or earlier.
    fn last_up_to(&self, time: usize) -> usize {
        let within = self.last_at[time / 64] & (u64::MAX >> (63 - time % 64));
        let mut count = within.count_ones() as usize;
        let mut words = time / 64;
        while words > 0 {
            count += self.tree[words] as usize;
            words &= words - 1;
        }
        count
    }

    /// Adds to the count of a word modulo 2³², so that `u32::MAX` takes one away.
    fn add(&mut self, word: usize, ones: u32) {
        let mut entry = word + 1;
        while entry < self.tree.len() {
            self.tree[entry] = self.tree[entry].wrapping_add(ones);
            entry += entry & entry.wrapping_neg();
        }
    }

    /// Gives the blocks the times 1, 2, … in the order of their last accesses, and room for three times as many accesses.
    fn renumber(&mut self) {
        let mut kept = 0;
        for time in 1..=self.block_at.len() {
            let block = self.block_at[time - 1];
            if self.last.get(block) as usize == time {
                self.block_at[kept] = block;
                kept += 1;
                self.last.set(block, kept as u32);
            }
        }
        self.block_at.truncate(kept);
        let words = FIRST_TREE_TIMES.max(4 * kept).div_ceil(64);
        // The bits 1 to `kept`, and how many of them are below a word.
        let below = |word: usize| (64 * word).min(kept + 1).saturating_sub(1);
        let bits = |word: usize| match (kept + 1).saturating_sub(64 * word) {
            0 => 0,
            set => u64::MAX >> (64 - set.min(64)),
        };
        self.last_at = (0..words).map(|word| bits(word) & !u64::from(word == 0)).collect();
        let entry = |i: usize| below(i) - below(i - (i & i.wrapping_neg()));
        self.tree = (0..=words).map(|i| entry(i) as u32).collect();
    }
}

impl Probe for StackDistances {
    const IS_RECORDING: bool = true;

    fn place_at(&mut self, address: usize, bytes: usize) {
        self.space.place(address, bytes);
    }

    fn lift_from(&mut self, address: usize) {
        self.space.lift(address);
    }

    #[inline]
    fn record(&mut self, mut address: usize, mut bytes: usize, _: Access) {
        while bytes > 0 {
            let (at, run) = self.space.translate(address, bytes);
            self.record_at(at, run);
            address = address.wrapping_add(run);
            bytes -= run;
        }
    }
}
