//! The stack of buckets, in memory and beyond.

use super::spill::Spill;
use super::{partition, room};

/// Buckets of up to this many entries are searched for their smallest key.
const LINEAR_SEARCH_MAX: usize = 16;
/// Keys that are drawn for a pivot of a small bucket, and of a large one.
const SPLITTER_SAMPLE: (usize, usize) = (3, 15);
/// A bucket is large from this many entries on.
const LARGE_BUCKET_MIN: u64 = 1 << 10;
/// Small neighbors are joined from this many buckets beside 2·log₂ n on.
const SPARE_BUCKETS: usize = 8;

/// Entries between two pivots.
#[derive(Clone, Debug)]
struct Bucket<V> {
    keys: Vec<u64>,
    values: Vec<V>,
    /// Blocks beyond memory.
    blocks: Vec<u32>,
    /// The key of all, if they are known to be equal.
    uniform: Option<u64>,
}

impl<V: Copy> Bucket<V> {
    fn new() -> Self {
        Self { keys: Vec::new(), values: Vec::new(), blocks: Vec::new(), uniform: None }
    }

    /// Entries, of blocks of `block` entries.
    fn len(&self, block: usize) -> u64 {
        // Nothing times a block without end is nothing.
        self.keys.len() as u64 + (self.blocks.len() as u64).wrapping_mul(block as u64)
    }

    fn push(&mut self, key: u64, value: V) {
        room::grow(&mut self.keys, 1);
        room::grow(&mut self.values, 1);
        self.keys.push(key);
        self.values.push(value);
    }

    fn append(&mut self, other: &mut Self) {
        room::grow(&mut self.keys, other.keys.len());
        room::grow(&mut self.values, other.values.len());
        self.keys.append(&mut other.keys);
        self.values.append(&mut other.values);
        room::grow(&mut self.blocks, other.blocks.len());
        self.blocks.append(&mut other.blocks);
    }

    fn give_up_room(&mut self, kept: usize) {
        room::give_up(&mut self.keys, kept);
        room::give_up(&mut self.values, kept);
    }
}

/// A queue of keys of 64 bits.
#[derive(Clone, Debug)]
pub(super) struct Core<V, S> {
    /// At least one. Keys in bucket i are below `pivots[i − 1]` and not below `pivots[i]`.
    buckets: Vec<Bucket<V>>,
    /// One less than buckets, strictly decreasing.
    pivots: Vec<u64>,
    /// Entries in memory.
    held: usize,
    /// Blocks beyond it.
    blocks: u64,
    spill: S,
    /// State of the generator of the pivots.
    state: u64,
    /// Comparisons of keys and moves of entries, for tests.
    #[cfg(test)]
    work: u64,
}

impl<V: Copy, S: Spill<V>> Core<V, S> {
    pub(super) fn new(spill: S) -> Self {
        let buckets = vec![Bucket::new()];
        Self {
            buckets,
            pivots: Vec::new(),
            held: 0,
            blocks: 0,
            spill,
            state: 0,
            #[cfg(test)]
            work: 0,
        }
    }

    /// Counts comparisons or moves, in tests.
    #[inline(always)]
    fn count(&mut self, work: usize) {
        #[cfg(test)]
        {
            self.work += work as u64;
        }
        #[cfg(not(test))]
        let _ = work;
    }

    pub(super) fn len(&self) -> u64 {
        self.held as u64 + self.spilled()
    }

    pub(super) fn spilled(&self) -> u64 {
        // Nothing times a block without end is nothing.
        self.blocks.wrapping_mul(self.spill.block() as u64)
    }

    pub(super) fn push(&mut self, key: u64, value: V) -> Result<(), S::Error> {
        let room = self.make_room(self.buckets.len(), 1);
        self.count(self.pivots.len());
        let level = self.pivots.iter().map(|&pivot| usize::from(key < pivot)).sum::<usize>();
        let level = self.beside_equals(level, key);
        self.buckets[level].push(key, value);
        self.held += 1;
        room
    }

    /// The bucket for a key: that of its level, or a new one beside it if that has nothing but another key. Were it mixed,
    /// the equal keys would be split off again for each key that comes between.
    fn beside_equals(&mut self, level: usize, key: u64) -> usize {
        let Some(equal) = self.buckets[level].uniform.filter(|&equal| equal != key) else {
            return level;
        };
        let (bucket, pivot) = if key < equal { (level + 1, equal) } else { (level, equal + 1) };
        self.buckets.insert(bucket, Bucket::new());
        self.pivots.insert(level, pivot);
        if self.too_many() {
            self.join_small();
            return self.pivots.partition_point(|&pivot| key < pivot);
        }
        bucket
    }

    pub(super) fn pop(&mut self) -> Result<Option<(u64, V)>, S::Error> {
        let Some(place) = self.smallest()? else { return Ok(None) };
        let top = self.top();
        let entry = (top.keys.swap_remove(place), top.values.swap_remove(place));
        if top.uniform.is_some() && top.keys.len() < top.keys.capacity() / 2 {
            top.give_up_room(S::ROOM_KEPT);
        }
        self.held -= 1;
        Ok(Some(entry))
    }

    pub(super) fn peek(&mut self) -> Result<Option<(u64, V)>, S::Error> {
        let Some(place) = self.smallest()? else { return Ok(None) };
        let top = self.top();
        Ok(Some((top.keys[place], top.values[place])))
    }

    fn top(&mut self) -> &mut Bucket<V> {
        self.buckets.last_mut().expect("there is always a bucket")
    }

    /// Where the smallest key is in the topmost bucket, which it makes small.
    fn smallest(&mut self) -> Result<Option<usize>, S::Error> {
        loop {
            let (limit, block) = (self.spill.limit(), self.spill.block());
            let levels = self.buckets.len();
            let top = self.top();
            if top.keys.is_empty() && top.blocks.is_empty() {
                if levels == 1 {
                    top.uniform = None;
                    return Ok(None);
                }
                self.buckets.pop();
                self.pivots.pop();
            } else if top.uniform.is_some() && !top.keys.is_empty() {
                return Ok(Some(top.keys.len() - 1));
            } else if top.blocks.is_empty() && top.keys.len() <= LINEAR_SEARCH_MAX {
                let smallest = (0..top.keys.len()).min_by_key(|&i| top.keys[i]);
                self.count(LINEAR_SEARCH_MAX);
                return Ok(smallest);
            } else if !top.blocks.is_empty()
                && (top.uniform.is_some() || top.keys.len() + top.blocks.len() * block <= limit / 4)
            {
                self.fetch()?;
            } else {
                self.split()?;
            }
        }
    }

    /// Brings the blocks of the topmost bucket back to memory: one if it is uniform, else all.
    fn fetch(&mut self) -> Result<(), S::Error> {
        let block = self.spill.block();
        let below = self.buckets.len() - 1;
        let blocks = if self.top().uniform.is_some() { 1 } else { self.top().blocks.len() };
        for _ in 0..blocks {
            // Not of these again.
            self.make_room(below, block)?;
            let top = self.buckets.last_mut().expect("there is always a bucket");
            let Some(&last) = top.blocks.last() else { break };
            self.spill.give_back(last, &mut top.keys, &mut top.values)?;
            room::pop(&mut top.blocks);
            self.blocks -= 1;
            self.held += block;
        }
        Ok(())
    }

    /// Splits the topmost bucket in two, or finds that all its keys are equal.
    fn split(&mut self) -> Result<(), S::Error> {
        let pivot = self.draw()?;
        if self.split_at(pivot)? {
            return Ok(());
        }
        // Nothing is below the pivot, so those equal to it are the smallest, if not all.
        if pivot < u64::MAX {
            self.split_at(pivot + 1)?;
        }
        self.top().uniform = Some(pivot);
        Ok(())
    }

    /// Moves what is below the pivot to a new topmost bucket; whether that left two.
    fn split_at(&mut self, pivot: u64) -> Result<bool, S::Error> {
        let mut high = self.buckets.pop().expect("there is always a bucket");
        self.count(high.len(self.spill.block()) as usize);
        let mut low = Bucket::new();
        partition::split(
            pivot,
            (&mut high.keys, &mut high.values),
            (&mut low.keys, &mut low.values),
        );
        high.give_up_room(S::ROOM_KEPT);
        let blocks = std::mem::take(&mut high.blocks);
        self.buckets.push(high);
        self.buckets.push(low);
        self.pivots.push(pivot);
        let last = self.buckets.len() - 1;
        for (k, &block) in blocks.iter().enumerate() {
            let mut part = Bucket::new();
            let read = self
                .make_room(self.buckets.len(), self.spill.block())
                .and_then(|()| self.spill.give_back(block, &mut part.keys, &mut part.values));
            if let Err(error) = read {
                // As it was: what has been read stays with what has not.
                self.join(last - 1);
                self.top().blocks.extend(&blocks[k..]);
                return Err(error);
            }
            self.held += part.keys.len();
            self.blocks -= 1;
            let low = &mut self.buckets[last];
            let from = (&mut part.keys, &mut part.values);
            partition::split(pivot, from, (&mut low.keys, &mut low.values));
            self.buckets[last - 1].append(&mut part);
        }
        let empty = |bucket: &Bucket<V>| bucket.keys.is_empty() && bucket.blocks.is_empty();
        let divided = !empty(&self.buckets[last]) && !empty(&self.buckets[last - 1]);
        if !divided {
            self.join(last - 1);
        } else if self.too_many() {
            self.join_small();
        }
        Ok(divided)
    }

    /// Returns true if small neighbors have to be joined.
    fn too_many(&self) -> bool {
        self.buckets.len() > SPARE_BUCKETS + 2 * self.len().max(1).ilog2() as usize
    }

    /// Makes one bucket of one and the next above it.
    fn join(&mut self, lower: usize) {
        let mut above = self.buckets.remove(lower + 1);
        self.pivots.remove(lower);
        self.count(above.keys.len());
        let below = &mut self.buckets[lower];
        if below.keys.len() < above.keys.len() {
            // The fewer are moved.
            std::mem::swap(&mut below.keys, &mut above.keys);
            std::mem::swap(&mut below.values, &mut above.values);
        }
        below.append(&mut above);
        below.uniform = None;
    }

    /// Joins neighbors that together are not more than what is above them; then 2·log₂ n + 2 buckets are left at most.
    fn join_small(&mut self) {
        let block = self.spill.block();
        let len = |bucket: &Bucket<V>| bucket.len(block);
        // Entries above both.
        let mut above = self.buckets.last().map_or(0, len);
        for lower in (0..self.buckets.len() - 2).rev() {
            let both = len(&self.buckets[lower]) + len(&self.buckets[lower + 1]);
            if both <= above {
                self.join(lower);
            } else {
                above += len(&self.buckets[lower + 1]);
            }
        }
    }

    /// A pivot: the median of keys that are drawn from the topmost bucket.
    fn draw(&mut self) -> Result<u64, S::Error> {
        let block = self.spill.block();
        let top = self.buckets.last().expect("there is always a bucket");
        let all = top.keys.len() as u64 + (top.blocks.len() as u64).wrapping_mul(block as u64);
        let mut keys = [0; SPLITTER_SAMPLE.1];
        let drawn = if all < LARGE_BUCKET_MIN { SPLITTER_SAMPLE.0 } else { SPLITTER_SAMPLE.1 };
        for key in &mut keys[..drawn] {
            self.state =
                self.state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let place = ((u128::from(self.state) * u128::from(all)) >> 64) as usize;
            *key = match place.checked_sub(top.keys.len()) {
                None => top.keys[place],
                Some(beyond) => self.spill.key(top.blocks[beyond / block], beyond % block)?,
            };
        }
        keys[..drawn].sort_unstable();
        Ok(keys[drawn / 2])
    }

    /// Spills blocks of the largest keys, of buckets below a level, while there is no room for so many more in memory.
    fn make_room(&mut self, below: usize, more: usize) -> Result<(), S::Error> {
        let (limit, block) = (self.spill.limit(), self.spill.block());
        while self.held + more > limit {
            let Some(level) =
                self.buckets[..below].iter().position(|bucket| bucket.keys.len() >= block)
            else {
                // There are too few buckets to hold the limit in less than a block each, see `Blocks::over`.
                debug_assert!(false, "{} entries in {below} buckets, no block", self.held);
                return Ok(());
            };
            let bucket = &mut self.buckets[level];
            let start = bucket.keys.len() - block;
            let kept = self.spill.keep(&bucket.keys[start..], &bucket.values[start..])?;
            room::grow(&mut bucket.blocks, 1);
            bucket.blocks.push(kept);
            bucket.keys.truncate(start);
            bucket.values.truncate(start);
            bucket.give_up_room(S::ROOM_KEPT);
            self.held -= block;
            self.blocks += 1;
        }
        Ok(())
    }

    /// Entries that buckets in memory have room for.
    #[cfg(test)]
    pub(super) fn room(&self) -> usize {
        self.buckets.iter().map(|bucket| bucket.keys.capacity().max(bucket.values.capacity())).sum()
    }

    /// What is beyond memory.
    #[cfg(test)]
    pub(super) fn spill(&self) -> &S {
        &self.spill
    }

    /// Buckets, and the comparisons and moves so far.
    #[cfg(test)]
    pub(super) fn buckets_and_work(&self) -> (usize, u64) {
        (self.buckets.len(), self.work)
    }
}
