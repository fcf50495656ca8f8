//! Dealing items into buckets in their own place, each bucket in the order of the input.
//!
//! *Problem.* Scattering into fresh memory has every page of it mapped and every line of it read before it is written:
//! where pages are small or dear, that costs more than the sort it is for.
//! *Idea.* Each bucket has room for one block of items. A block that is full goes to the front of the array, where as many
//! items have already been read. Then buckets are taken one by one, in order: the blocks of a bucket are copied out,
//! which frees their places; blocks of others that lie where the bucket belongs move to places that are free; the bucket
//! is written, in whatever order its owner wants.
//! *Guarantee.* Each item is moved four times: to its block, to the front, to the copy, and from there to its place;
//! and about once more out of the way of others. Room for a block a bucket, a block to spare, and four numbers of 32
//! bits for each block of the array. A block has more than half a KiB, and at least four items however wide they are.
//! *Trap.* Buckets do not start where blocks do. Behind a place e of n items there are ⌊n/b⌋ − ⌈e/b⌉ whole blocks, and
//! the n − e items that belong there fill at most one block more: that is the block to spare.
//! *Reference.* M. Axtmann, S. Witt, D. Ferizovic, P. Sanders, *In-place parallel super scalar samplesort*, ESA 2017
//! (buffers and blocks); there blocks change places in cycles, which does not keep the order of equal items.

use std::ops::Range;

use crate::level::prefetch;
use crate::probe::Probe;

/// Bytes of a block: enough for a memory to deliver them at its speed.
const BLOCK_BYTES: usize = 1 << 10;
/// Fewest items of a block.
const BLOCK_MIN: usize = 4;
/// Bytes that are put in their places at once: they stay in the second-level cache.
const PIECE_BYTES: usize = 1 << 18;
/// Blocks are asked for when this many others are still to be copied before. They lie apart, each in a page whose
/// address is yet to be translated: without it, sorting 7.3 million records of 32 bytes took a fifth longer.
const PREFETCH_BLOCKS: usize = 4;
/// A line of memory.
const LINE: usize = 64;
/// Instead of the block in a slot.
const NONE: u32 = u32::MAX;

/// Items of a block, a power of two.
pub(crate) fn block<T>() -> usize {
    1 << (BLOCK_BYTES / size_of::<T>().max(1)).max(BLOCK_MIN).ilog2()
}

/// Items in blocks of one bucket each, which are taken from the first bucket to the last.
pub(crate) struct Dealt<'a, T> {
    items: &'a mut [T],
    /// Items of a block, a power of two.
    block: usize,
    /// The last items of each bucket, less than a block, and behind all of them a block to spare.
    rest: Vec<T>,
    /// Where these items of each bucket end.
    ends: Vec<usize>,
    /// Where the blocks of each bucket begin in `slots`; and the end.
    first: Vec<usize>,
    /// Where blocks are, in units of blocks, in order of bucket and input; the block to spare comes after the array.
    slots: Vec<u32>,
    /// Which of these is in a slot, or [`NONE`].
    holds: Vec<u32>,
    free: Vec<u32>,
    /// The bucket that is taken next, the block, and the items taken.
    bucket: usize,
    next: usize,
    taken: usize,
}

impl<'a, T: Copy> Dealt<'a, T> {
    /// Deals items into so many buckets; `bucket` is asked once for each item, in order.
    ///
    /// # Panics
    /// If `bucket` names one that there is not, or does itself; then some items may be doubled at the cost of others. Before
    /// anything is moved, if there are 2³² − 1 blocks or more.
    pub(crate) fn new<P: Probe>(
        items: &'a mut [T],
        buckets: usize,
        mut bucket: impl FnMut(&T) -> usize,
        probe: &mut P,
    ) -> Self {
        let block = block::<T>();
        let (n, mask) = (items.len(), block - 1);
        assert!(
            n / block < NONE as usize,
            "blocks have numbers of 32 bits: {n} items are too many"
        );
        let mut rest = items.first().map_or_else(Vec::new, |&any| vec![any; (buckets + 1) * block]);
        let mut ends: Vec<usize> = (0..buckets).map(|b| b * block).collect();
        let mut first = vec![0; buckets + 1];
        let mut owners = Vec::with_capacity(n / block);
        probe.place(&rest);
        for i in 0..n {
            let item = items[i];
            let owner = bucket(&item);
            let end = &mut ends[owner];
            rest[*end] = item;
            if P::IS_RECORDING {
                probe.read(&items[i..=i]);
                probe.write(&rest[*end..=*end]);
            }
            *end += 1;
            if *end & mask == 0 {
                *end -= block;
                let (to, from) =
                    (&mut items[owners.len() * block..][..block], &rest[*end..][..block]);
                to.copy_from_slice(from);
                probe.read(from);
                probe.write(to);
                owners.push(owner as u32);
                first[owner + 1] += 1;
            }
        }
        for b in 0..buckets {
            first[b + 1] += first[b];
        }
        let all = n / block;
        let mut slots = vec![0; owners.len()];
        let mut holds = vec![NONE; all + 1];
        let mut place = first.clone();
        for (slot, &owner) in owners.iter().enumerate() {
            let place = &mut place[owner as usize];
            slots[*place] = slot as u32;
            holds[slot] = *place as u32;
            *place += 1;
        }
        // All slots are free in the end.
        let mut free = Vec::with_capacity(all + 1);
        free.extend((owners.len() as u32..=all as u32).rev());
        Self { items, block, rest, ends, first, slots, holds, free, bucket: 0, next: 0, taken: 0 }
    }

    pub(crate) fn size(&self, bucket: usize) -> usize {
        let blocks = self.first[bucket + 1] - self.first[bucket];
        blocks * self.block + self.ends[bucket] - bucket * self.block
    }

    /// Copies the next items of a bucket to `copy`, all of them if they are at most `most`, else that many or a few less;
    /// the bucket, and where the items belong. They must be written there before the next are taken.
    pub(crate) fn take<P: Probe>(
        &mut self,
        most: usize,
        copy: &mut Vec<T>,
        probe: &mut P,
    ) -> Option<(usize, Range<usize>)> {
        let (bucket, range) = self.take_out(most, copy, probe)?;
        self.clear(range.clone(), probe);
        Some((bucket, range))
    }

    /// The same for items that are not to be written back: their place is not cleared of others. After it, [`Self::take`]
    /// must not be called.
    pub(crate) fn take_out<P: Probe>(
        &mut self,
        most: usize,
        copy: &mut Vec<T>,
        probe: &mut P,
    ) -> Option<(usize, Range<usize>)> {
        while self.bucket < self.ends.len()
            && self.next == self.first[self.bucket + 1]
            && self.ends[self.bucket] == self.bucket * self.block
        {
            self.bucket += 1;
        }
        let bucket = self.bucket;
        let (&end, last) = (self.ends.get(bucket)?, self.first[bucket + 1]);
        let left = last - self.next;
        let is_end = left == 0 || left * self.block + end - bucket * self.block <= most;
        let blocks = if is_end { left } else { (most / self.block).max(1).min(left) };
        copy.clear();
        for i in self.next..self.next + blocks {
            let slot = self.slots[i];
            if let Some(&later) = self.slots.get(i + PREFETCH_BLOCKS) {
                self.fetch(later);
            }
            let from = self.slot(slot);
            copy.extend_from_slice(from);
            probe.read(from);
            self.holds[slot as usize] = NONE;
            self.free.push(slot);
        }
        self.next += blocks;
        if is_end {
            let from = &self.rest[bucket * self.block..end];
            copy.extend_from_slice(from);
            probe.read(from);
            self.bucket += 1;
        }
        let range = self.taken..self.taken + copy.len();
        self.taken = range.end;
        Some((bucket, range))
    }

    /// Items of the bucket of which some are taken next; 0 if none is left.
    pub(crate) fn next_size(&self) -> usize {
        (self.bucket..self.ends.len()).map(|bucket| self.size(bucket)).find(|&n| n > 0).unwrap_or(0)
    }

    /// Items of the largest bucket.
    pub(crate) fn largest(&self) -> usize {
        (0..self.ends.len()).map(|bucket| self.size(bucket)).max().unwrap_or(0)
    }

    /// The items, if all were put in their places.
    pub(crate) fn into_items(self) -> &'a mut [T] {
        self.items
    }

    /// A part of the items, to be written.
    pub(crate) fn items(&mut self, range: Range<usize>) -> &mut [T] {
        &mut self.items[range]
    }

    /// Puts all buckets in their places; where they end.
    pub(crate) fn put<P: Probe>(mut self, probe: &mut P) -> Vec<usize> {
        let most = PIECE_BYTES / size_of::<T>().max(1);
        let mut copy = Vec::new();
        while let Some((_, range)) = self.take(most, &mut copy, probe) {
            self.items[range.clone()].copy_from_slice(&copy);
            probe.write(&self.items[range]);
        }
        self.lift(probe);
        let sizes = (0..self.ends.len()).map(|bucket| self.size(bucket));
        sizes.scan(0, |end, size| Some(std::mem::replace(end, *end + size) + size)).collect()
    }

    /// Tells that the room beside the items is given back.
    pub(crate) fn lift<P: Probe>(&self, probe: &mut P) {
        probe.lift(&self.rest);
    }

    /// Moves blocks out of the slots that a range of items needs.
    fn clear<P: Probe>(&mut self, range: Range<usize>, probe: &mut P) {
        let beyond = range.end.div_ceil(self.block);
        for from in range.start / self.block..beyond.min(self.items.len() / self.block) {
            let held = std::mem::replace(&mut self.holds[from], NONE);
            if held == NONE {
                continue;
            }
            let to = loop {
                let to = self.free.pop().expect("a block to spare, as argued at the head");
                if to as usize >= beyond {
                    break to;
                }
            };
            self.copy(from, to as usize);
            probe.read(self.slot(from as u32));
            probe.write(self.slot(to));
            self.holds[to as usize] = held;
            self.slots[held as usize] = to;
        }
    }

    /// Asks for the items in a slot.
    fn fetch(&self, slot: u32) {
        let from = self.slot(slot);
        for at in (0..from.len()).step_by((LINE / size_of::<T>().max(1)).max(1)) {
            prefetch(from, at);
        }
    }

    fn slot(&self, slot: u32) -> &[T] {
        let at = slot as usize * self.block;
        if at + self.block <= self.items.len() {
            &self.items[at..][..self.block]
        } else {
            &self.rest[self.ends.len() * self.block..]
        }
    }

    /// Copies a block from a slot in the array to another one.
    fn copy(&mut self, from: usize, to: usize) {
        let from = from * self.block..(from + 1) * self.block;
        if (to + 1) * self.block <= self.items.len() {
            self.items.copy_within(from, to * self.block);
        } else {
            let spare = self.ends.len() * self.block;
            self.rest[spare..].copy_from_slice(&self.items[from]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::probe::NoProbe;

    /// Items with their places, dealt by a table.
    fn check<T: Copy + PartialEq + std::fmt::Debug>(
        owners: &[usize],
        buckets: usize,
        most: usize,
        item: fn(usize) -> T,
    ) {
        let mut items: Vec<T> = (0..owners.len()).map(item).collect();
        let mut expected = vec![];
        for bucket in 0..buckets {
            expected.extend((0..owners.len()).filter(|&i| owners[i] == bucket).map(item));
        }
        let given = items.clone();
        let mut owner = owners.iter().copied();
        let mut dealt =
            Dealt::new(&mut items, buckets, |_| owner.next().expect("one each"), &mut NoProbe);
        let mut copy = vec![];
        while let Some((bucket, range)) = dealt.take(most, &mut copy, &mut NoProbe) {
            assert!(copy.len() <= most.max(2 * block::<T>()) && !copy.is_empty());
            assert!(dealt.size(bucket) > most || copy.len() == dealt.size(bucket));
            dealt.items(range).copy_from_slice(&copy);
        }
        assert!(items == expected, "{} items, {buckets} buckets, {most} at once", owners.len());
        let (mut items, mut owner) = (given, owners.iter().copied());
        let dealt =
            Dealt::new(&mut items, buckets, |_| owner.next().expect("one each"), &mut NoProbe);
        let ends = dealt.put(&mut NoProbe);
        assert!(items == expected);
        for (bucket, &end) in ends.iter().enumerate() {
            assert_eq!(end, owners.iter().filter(|&&owner| owner <= bucket).count());
        }
    }

    #[test]
    fn every_bucket_in_its_place_and_in_order() {
        let mut state = 1;
        let mut random = move || crate::random::split_mix(&mut state) as usize;
        let counts = [3, 1, 2, 7, 64];
        let sizes = [0, 1, 2, 3, 4, 5, 7, 8, 9, 31, 32, 33, 100, 513, 3000];
        for &n in &sizes[..if cfg!(miri) { 10 } else { sizes.len() }] {
            for &buckets in &counts[..if cfg!(miri) { 1 } else { counts.len() }] {
                for kind in 0..4 {
                    let owners: Vec<usize> = (0..n)
                        .map(|i| match kind {
                            0 => random() % buckets,
                            1 => (n - 1 - i) * buckets / n,
                            // One bucket holds nearly all.
                            2 => {
                                if random() % 50 > 0 {
                                    buckets / 2
                                } else {
                                    random() % buckets
                                }
                            }
                            // Whole blocks in turn, the last bucket first.
                            _ => buckets - 1 - i / 4 % buckets,
                        })
                        .collect();
                    // Blocks of four items, and of thirty-two.
                    for most in [10, 1, 10_000].into_iter().take(if cfg!(miri) { 1 } else { 3 }) {
                        check(&owners, buckets, most, |i| [i as u64; 32]);
                        check(&owners, buckets, most, |i| [i as u32; 8]);
                    }
                }
            }
        }
    }
}
