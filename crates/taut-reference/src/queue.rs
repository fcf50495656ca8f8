//! Priority queues of many entries: a key and what comes with it, smallest key first.
//!
//! *Problem.* A binary heap of n entries misses the caches log n times for each entry that leaves it.
//! *Idea.* A stack of buckets, smaller keys above: pushing appends to the bucket that the key falls into, popping splits
//! the topmost bucket at a random pivot until few entries are left, and takes the smallest of those. It is quicksort that
//! goes only as far as it is asked; almost all buckets are only ever appended to, so they can lie in a file.
//! *Guarantee.* Keys leave in order. Expected, amortized O(log n) comparisons for each entry, whatever the order of pushes and
//! pops, and with blocks of B entries and memory for M some O((1/B)·log₂(n/M)) transfers; the order in which equal keys leave
//! is fixed but not said.
//! *Why.* Buckets that pops leave behind can be many and small, above all if keys come in groups below all earlier ones. So
//! neighbors of s₁ and s₂ entries are joined once there are more than 2·log₂ n + 8 buckets, if the a entries above them are
//! not fewer than s₁ + s₂; then each second bucket at least doubles what is above, and 2·log₂ n + 2 are left. A bucket of s
//! entries below a others has the potential s·log₂ s + 6·s·log₂((a + s)/s): a push adds O(1) for each of the O(log n) buckets
//! and O(log n) for its own, a split releases in the mean what it costs, and a join, which moves the smaller bucket, does too,
//! because a ≥ s₁ + s₂.
//! *Trap.* Where all keys of a bucket are equal there is no pivot: such a bucket is marked and popped from its end.
//! *Reference.* Navarro, Paredes, *On sorting, heaps, and minimum spanning trees*, Algorithmica 57, 2010 (quickheaps); Groot
//! Koerkamp, *SimdQuickHeap*, 2026, for pivots side by side; thesis, section 5.8.

use std::convert::Infallible;
use std::path::Path;

use bytemuck::Pod;

use crate::{Error, Key, Word};
use core::Core;
use spill::{Blocks, NoSpill};

mod core;
mod partition;
mod room;
mod spill;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod transfers;

/// A queue of entries in memory, smallest key first.
///
/// ```
/// let mut queue = taut_reference::PriorityQueue::new();
/// queue.push(2.5, 'b');
/// queue.push(-1.0, 'a');
/// assert_eq!(queue.pop(), Some((-1.0, 'a')));
/// assert_eq!(queue.pop(), Some((2.5, 'b')));
/// assert_eq!(queue.pop(), None);
/// ```
#[derive(Clone, Debug)]
pub struct PriorityQueue<K, V> {
    core: Core<V, NoSpill>,
    keys: std::marker::PhantomData<K>,
}

impl<K: Key, V: Copy> Default for PriorityQueue<K, V> {
    fn default() -> Self {
        Self::new()
    }
}

impl<K: Key, V: Copy> PriorityQueue<K, V> {
    /// An empty queue.
    pub fn new() -> Self {
        Self { core: Core::new(NoSpill), keys: std::marker::PhantomData }
    }

    /// Entries in the queue.
    pub fn len(&self) -> u64 {
        self.core.len()
    }

    /// Returns true if there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds an entry. Amortized O(log n): a comparison with each of at most 2·log₂ n + 9 pivots, several at a time.
    pub fn push(&mut self, key: K, value: V) {
        never(self.core.push(rank(key), value));
    }

    /// Takes an entry with the smallest key. Amortized, expected O(log n) for each entry that is ever taken.
    pub fn pop(&mut self) -> Option<(K, V)> {
        never(self.core.pop()).map(|(rank, value)| (of_rank(rank), value))
    }

    /// The smallest key, and what comes with it. Amortized as [`Self::pop`], which may split buckets.
    pub fn peek(&mut self) -> Option<(K, V)> {
        never(self.core.peek()).map(|(rank, value)| (of_rank(rank), value))
    }
}

/// Returns the word of a key among those of 64 bits.
fn rank<K: Key>(key: K) -> u64 {
    key.word().into()
}

fn of_rank<K: Key>(rank: u64) -> K {
    K::of_word(K::Word::low_bits(rank))
}

fn never<T>(result: Result<T, Infallible>) -> T {
    match result {
        Ok(value) => value,
    }
}

/// A queue of which only so much is in memory, smallest key first; the rest is in a file without a name, which is gone
/// whenever the process ends.
///
/// ```
/// let mut queue = taut_reference::SpillingQueue::new(&std::env::temp_dir(), 4 << 20)?;
/// for key in (0..300_000u64).rev() {
///     queue.push(key, 2 * key)?;                                          // 4.8 MB
/// }
/// assert!(queue.spilled() > 200_000);
/// assert_eq!(queue.pop()?, Some((0, 0)));
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
#[derive(Debug)]
pub struct SpillingQueue<K, V> {
    core: Core<V, Blocks>,
    keys: std::marker::PhantomData<K>,
}

impl<K: Key, V: Pod> SpillingQueue<K, V> {
    /// An empty queue of at most `memory` bytes, whose file is in `folder`.
    ///
    /// Three tenths of that are for entries, half as much again for the room that vectors keep as they grow, and the rest for
    /// one that is moved as it grows or shrinks. Beside it there are some KiB, and up to 24 bytes for each block of the file.
    /// A block has 4 KiB or more, a 256th of the entries up to 65 536 of them, so that is less than a hundredth of the file.
    ///
    /// # Errors
    /// [`Error::Option`] if the memory is less than 4 MiB or than 6830 entries, [`Error::File`] if there can be no file.
    pub fn new(folder: &Path, memory: usize) -> Result<Self, Error> {
        let entries = memory / (8 + size_of::<V>()) / 10 * 3;
        if memory < 4 << 20 || entries < 2048 {
            let value = format!("{memory} bytes");
            let expected = "at least 4 MiB and 6830 entries";
            return Err(Error::Option { name: "memory", value, expected });
        }
        let blocks = Blocks::new::<V>(folder, entries)?;
        Ok(Self { core: Core::new(blocks), keys: std::marker::PhantomData })
    }

    /// Entries in the queue.
    pub fn len(&self) -> u64 {
        self.core.len()
    }

    /// Returns true if there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Entries of the queue that are in the file now.
    pub fn spilled(&self) -> u64 {
        self.core.spilled()
    }

    /// Adds an entry.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be written; the entry is in the queue all the same, and all others are.
    pub fn push(&mut self, key: K, value: V) -> Result<(), Error> {
        self.core.push(rank(key), value)
    }

    /// Takes an entry with the smallest key.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be read or written; no entry is lost by that.
    pub fn pop(&mut self) -> Result<Option<(K, V)>, Error> {
        Ok(self.core.pop()?.map(|(rank, value)| (of_rank(rank), value)))
    }

    /// The smallest key, and what comes with it.
    ///
    /// # Errors
    /// As of [`Self::pop`].
    pub fn peek(&mut self) -> Result<Option<(K, V)>, Error> {
        Ok(self.core.peek()?.map(|(rank, value)| (of_rank(rank), value)))
    }
}
