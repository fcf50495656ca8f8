//! The stack of buckets, in memory and beyond.

use super::partition;
use super::spill::Spill;

/// Buckets of up to so many entries are searched for their smallest key.
const FEW: usize = 16;
/// Keys that are drawn for a pivot of a small bucket, and of a large one.
const DRAWN: (usize, usize) = (3, 15);
/// Entries from which on a bucket is large.
const LARGE: u64 = 1 << 10;

/// Entries between two pivots.
#[derive(Clone, Debug)]
struct Bucket<V> {
    keys: Vec<u64>,
    values: Vec<V>,
    /// Blocks beyond memory.
    blocks: Vec<u32>,
    /// Whether all keys are equal.
    uniform: bool,
}

impl<V> Bucket<V> {
    fn new() -> Self {
        Self { keys: Vec::new(), values: Vec::new(), blocks: Vec::new(), uniform: false }
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
}

impl<V: Copy, S: Spill<V>> Core<V, S> {
    pub(super) fn new(spill: S) -> Self {
        let buckets = vec![Bucket::new()];
        Self { buckets, pivots: Vec::new(), held: 0, blocks: 0, spill, state: 0 }
    }

    pub(super) fn len(&self) -> u64 {
        self.held as u64 + self.spilled()
    }

    pub(super) fn spilled(&self) -> u64 {
        // Nothing times a block without end is nothing.
        self.blocks.wrapping_mul(self.spill.block() as u64)
    }

    pub(super) fn push(&mut self, key: u64, value: V) -> Result<(), S::Error> {
        let level = self.pivots.iter().map(|&pivot| usize::from(key < pivot)).sum::<usize>();
        let bucket = &mut self.buckets[level];
        bucket.uniform &= bucket.keys.last() == Some(&key);
        bucket.keys.push(key);
        bucket.values.push(value);
        self.held += 1;
        self.make_room(self.buckets.len())
    }

    pub(super) fn pop(&mut self) -> Result<Option<(u64, V)>, S::Error> {
        let Some(place) = self.smallest()? else { return Ok(None) };
        let top = self.top();
        let entry = (top.keys.swap_remove(place), top.values.swap_remove(place));
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
                    return Ok(None);
                }
                self.buckets.pop();
                self.pivots.pop();
            } else if top.uniform && !top.keys.is_empty() {
                return Ok(Some(top.keys.len() - 1));
            } else if top.blocks.is_empty() && top.keys.len() <= FEW {
                let smallest = (0..top.keys.len()).min_by_key(|&i| top.keys[i]);
                return Ok(smallest);
            } else if !top.blocks.is_empty()
                && (top.uniform || top.keys.len() + top.blocks.len() * block <= limit / 4)
            {
                self.fetch()?;
            } else {
                self.split()?;
            }
        }
    }

    /// Brings the blocks of the topmost bucket back to memory: one if it is uniform, else all.
    fn fetch(&mut self) -> Result<(), S::Error> {
        let mut top = self.buckets.pop().expect("there is always a bucket");
        let mut result = Ok(());
        while let Some(&block) = top.blocks.last() {
            result = self.spill.give_back(block, &mut top.keys, &mut top.values);
            if result.is_err() {
                break;
            }
            top.blocks.pop();
            self.blocks -= 1;
            self.held += self.spill.block();
            if top.uniform {
                break;
            }
        }
        self.buckets.push(top);
        result?;
        // Not of these again.
        self.make_room(self.buckets.len() - 1)
    }

    /// Splits the topmost bucket in two, or finds that all its keys are equal.
    fn split(&mut self) -> Result<(), S::Error> {
        let pivot = self.draw()?;
        if self.split_at(pivot)? {
            return Ok(());
        }
        // Nothing is below the pivot, so those equal to it are the smallest.
        if pivot == u64::MAX || !self.split_at(pivot + 1)? {
            self.top().uniform = true;
        }
        Ok(())
    }

    /// Moves what is below the pivot to a new topmost bucket; whether that left two.
    fn split_at(&mut self, pivot: u64) -> Result<bool, S::Error> {
        let mut high = self.buckets.pop().expect("there is always a bucket");
        let mut low = Bucket::new();
        partition::split(
            pivot,
            (&mut high.keys, &mut high.values),
            (&mut low.keys, &mut low.values),
        );
        give_up_room(&mut high.keys);
        give_up_room(&mut high.values);
        let blocks = std::mem::take(&mut high.blocks);
        self.buckets.push(high);
        self.buckets.push(low);
        self.pivots.push(pivot);
        let last = self.buckets.len() - 1;
        for (k, &block) in blocks.iter().enumerate() {
            let mut part = Bucket::new();
            let read = self.spill.give_back(block, &mut part.keys, &mut part.values);
            if read.is_ok() {
                self.held += part.keys.len();
                self.blocks -= 1;
                let low = &mut self.buckets[last];
                let from = (&mut part.keys, &mut part.values);
                partition::split(pivot, from, (&mut low.keys, &mut low.values));
                let high = &mut self.buckets[last - 1];
                high.keys.append(&mut part.keys);
                high.values.append(&mut part.values);
            }
            let rest = if read.is_ok() { k + 1 } else { k };
            if let Err(error) = read.and_then(|()| self.make_room(self.buckets.len())) {
                // As it was: what has been read stays with what has not.
                self.join();
                self.top().blocks.extend(&blocks[rest..]);
                return Err(error);
            }
        }
        let empty = |bucket: &Bucket<V>| bucket.keys.is_empty() && bucket.blocks.is_empty();
        let divided = !empty(&self.buckets[last]) && !empty(&self.buckets[last - 1]);
        if !divided {
            self.join();
        }
        Ok(divided)
    }

    /// Makes one bucket of the two topmost.
    fn join(&mut self) {
        let mut low = self.buckets.pop().expect("there are two buckets");
        self.pivots.pop();
        let top = self.top();
        top.keys.append(&mut low.keys);
        top.values.append(&mut low.values);
        top.blocks.append(&mut low.blocks);
    }

    /// A pivot: the median of keys that are drawn from the topmost bucket.
    fn draw(&mut self) -> Result<u64, S::Error> {
        let block = self.spill.block();
        let top = self.buckets.last().expect("there is always a bucket");
        let all = top.keys.len() as u64 + (top.blocks.len() as u64).wrapping_mul(block as u64);
        let mut keys = [0; DRAWN.1];
        let drawn = if all < LARGE { DRAWN.0 } else { DRAWN.1 };
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

    /// Spills blocks of the largest keys, of buckets below a level, while there are too many entries in memory.
    fn make_room(&mut self, below: usize) -> Result<(), S::Error> {
        let (limit, block) = (self.spill.limit(), self.spill.block());
        while self.held > limit {
            let Some(level) =
                self.buckets[..below].iter().position(|bucket| bucket.keys.len() >= block)
            else {
                // Less than a block in each bucket: more buckets than there are by any chance.
                return Ok(());
            };
            let bucket = &mut self.buckets[level];
            let start = bucket.keys.len() - block;
            let kept = self.spill.keep(&bucket.keys[start..], &bucket.values[start..])?;
            bucket.blocks.push(kept);
            bucket.keys.truncate(start);
            bucket.values.truncate(start);
            give_up_room(&mut bucket.keys);
            give_up_room(&mut bucket.values);
            self.held -= block;
            self.blocks += 1;
        }
        Ok(())
    }
}

/// Half of a room that is three quarters empty.
fn give_up_room<T>(entries: &mut Vec<T>) {
    if entries.capacity() > 4 * entries.len().max(LARGE as usize) {
        entries.shrink_to(entries.capacity() / 2);
    }
}
