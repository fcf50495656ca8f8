//! One cache: sets of blocks, the oldest of which makes room, and what happened to them.
//!
//! Idea: a table from block to slot, and a circular list of slots per set, newest first; a cache in which any block may
//! be anywhere is one set. O(1) per access for any number of ways. Where chance decides, a slot of the set is drawn when it is
//! full, and the list says nothing.

use super::shape::{CacheShape, Replacement};
use super::table::Table;
use crate::Access;
use crate::algorithms::random::Random;

/// The accesses and misses of a cache since it was empty. An access of bytes in several blocks counts once for each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Counts {
    /// Accesses of a block.
    pub accesses: u64,
    /// Those whose block was not there and came in; writes count as reads do.
    pub misses: u64,
    /// Blocks written to that had to go.
    pub write_backs: u64,
    /// Blocks written to that are still there.
    pub dirty: u64,
}

impl Counts {
    /// Blocks that moved, in or out, if in the end everything is written back.
    pub fn transfers(&self) -> u64 {
        self.misses + self.write_backs + self.dirty
    }
}

#[derive(Clone, Copy, Debug)]
struct Slot {
    block: u64,
    newer: u32,
    older: u32,
    dirty: bool,
}

/// The outcome of an access of a block.
pub(super) struct Outcome {
    pub(super) missed: bool,
    /// The block that was written back.
    pub(super) written: Option<u64>,
}

#[derive(Clone, Debug)]
pub(super) struct Cache {
    /// log₂ of the bytes of a block.
    pub(super) shift: u32,
    replacement: Replacement,
    /// Draws slots where chance decides.
    random: Random,
    sets: u64,
    ways: u32,
    /// Slot of a block, plus one.
    slot_of: Table,
    /// Those of set s begin at s·ways, unless there is one set, whose slots come as they are needed.
    slots: Vec<Slot>,
    /// Newest slot and number of slots in use, by set.
    heads: Vec<(u32, u32)>,
    /// The slot accessed last, where every second look goes.
    last: usize,
    counts: Counts,
}

impl Cache {
    /// An empty cache of a shape that was checked.
    pub(super) fn new(shape: &CacheShape) -> Self {
        let ways = shape.ways.unwrap_or(shape.blocks());
        let sets = shape.blocks() / ways;
        let empty = Slot { block: u64::MAX, newer: 0, older: 0, dirty: false };
        Self {
            shift: shape.block.trailing_zeros(),
            replacement: shape.replacement,
            random: Random::new(match shape.replacement {
                Replacement::Random(seed) => seed,
                Replacement::Lru | Replacement::Fifo => 0,
            }),
            sets: sets as u64,
            ways: ways as u32,
            slot_of: Table::default(),
            slots: if sets == 1 { Vec::new() } else { vec![empty; sets * ways] },
            heads: vec![(0, 0); sets],
            last: usize::MAX,
            counts: Counts::default(),
        }
    }

    pub(super) fn counts(&self) -> Counts {
        Counts { dirty: self.slots.iter().filter(|slot| slot.dirty).count() as u64, ..self.counts }
    }

    /// Accesses the block of that number.
    #[inline]
    pub(super) fn record(&mut self, block: u64, access: Access) -> Outcome {
        self.counts.accesses += 1;
        let write = access == Access::Write;
        if let Some(slot) = self.slots.get_mut(self.last)
            && slot.block == block
        {
            slot.dirty |= write;
            return Outcome { missed: false, written: None };
        }
        self.access_other(block, write)
    }

    fn access_other(&mut self, block: u64, write: bool) -> Outcome {
        let set = if self.sets == 1 {
            0
        } else if self.sets.is_power_of_two() {
            (block & (self.sets - 1)) as usize
        } else {
            (block % self.sets) as usize
        };
        let found = self.slot_of.get(block);
        if found != 0 {
            let slot = found as usize - 1;
            self.slots[slot].dirty |= write;
            self.last = slot;
            if self.replacement == Replacement::Lru && self.heads[set].0 as usize != slot {
                self.unlink(slot);
                self.link_first(set, slot);
            }
            return Outcome { missed: false, written: None };
        }
        self.counts.misses += 1;
        let (slot, written) = self.vacate(set);
        self.slot_of.set(block, slot as u32 + 1);
        self.slots[slot].block = block;
        self.slots[slot].dirty = write;
        self.last = slot;
        Outcome { missed: true, written }
    }

    /// A slot of the set, now its newest, and the block that was written back for it.
    fn vacate(&mut self, set: usize) -> (usize, Option<u64>) {
        let (head, used) = self.heads[set];
        if used == self.ways {
            let slot = match self.replacement {
                Replacement::Random(_) => {
                    set * self.ways as usize + self.random.below(self.ways as usize)
                }
                // The oldest stands before the newest in the circle: turning it by one makes it the newest.
                Replacement::Lru | Replacement::Fifo => self.slots[head as usize].newer as usize,
            };
            let Slot { block, dirty, .. } = self.slots[slot];
            self.heads[set].0 = slot as u32;
            self.slot_of.set(block, 0);
            self.counts.write_backs += u64::from(dirty);
            return (slot, dirty.then_some(block));
        }
        let slot = set * self.ways as usize + used as usize;
        if slot == self.slots.len() {
            self.slots.push(Slot { block: u64::MAX, newer: 0, older: 0, dirty: false });
        }
        if used == 0 {
            self.slots[slot].newer = slot as u32;
            self.slots[slot].older = slot as u32;
        } else {
            self.link_first(set, slot);
        }
        self.heads[set] = (slot as u32, used + 1);
        (slot, None)
    }

    fn unlink(&mut self, slot: usize) {
        let Slot { newer, older, .. } = self.slots[slot];
        self.slots[newer as usize].older = older;
        self.slots[older as usize].newer = newer;
    }

    /// Puts a slot that is in no circle before the newest of the set, as its newest.
    fn link_first(&mut self, set: usize, slot: usize) {
        let head = self.heads[set].0;
        let oldest = self.slots[head as usize].newer;
        self.slots[slot].older = head;
        self.slots[slot].newer = oldest;
        self.slots[head as usize].newer = slot as u32;
        self.slots[oldest as usize].older = slot as u32;
        self.heads[set].0 = slot as u32;
    }
}
