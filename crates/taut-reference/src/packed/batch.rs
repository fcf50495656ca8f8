//! Many insertions at once.
//!
//! Idea: sorted, a batch goes through the array from left to right. Leaves of all keys are found together, at the rate of
//! a batched search; what fits its leaf is put there; leaves that overflow are merged aside, the windows that have to be
//! spread are found for all of them, and each is spread once. A batch of an eighth of all and more is merged with the
//! whole array instead.
//! Guarantee: the same map as by insertions one after the other; no leaf is spread twice.
//! Trap: where a key comes several times in a batch, its last value holds.

use std::ops::Range;

use super::density::{LEAF_SLOTS, Windows};
use super::map::{PackedMap, Writer};
use super::spread;
use crate::prefetch;
use crate::{Key, NoProbe, Probe, sort_records};

/// Batches of at least this share of all entries, one in so many, are merged with all.
const MERGE_SHARE: usize = 8;
/// This many keys lie between asking for the lines of a leaf and their use.
const PREFETCH_KEYS: usize = 12;

/// A leaf that overflows, with all its entries.
struct Overflow<K, V> {
    leaf: usize,
    keys: Vec<K>,
    values: Vec<V>,
}

impl<K: Key, V: Copy + Default + Send + Sync> PackedMap<K, V> {
    /// Sets the values of many keys, in any order, and returns how many keys are new; of a key that comes several times
    /// the last value holds. O(k log k) for the order of k entries, and for a large batch O(n + k).
    pub fn insert_batch(&mut self, entries: &[(K, V)]) -> usize {
        self.insert_batch_instrumented(entries, &mut NoProbe)
    }

    /// [`PackedMap::insert_batch`], recorded by a probe; the sorting of the batch is not told.
    pub fn insert_batch_instrumented<P: Probe>(
        &mut self,
        entries: &[(K, V)],
        probe: &mut P,
    ) -> usize {
        let mut batch = entries.to_vec();
        // Stable: of equal keys the last one comes last.
        sort_records(&mut batch, |entry| entry.0.word());
        // Keeps the last of equal keys: later values are written over the one that is kept.
        batch.dedup_by(|later, kept| {
            let equal = later.0.word() == kept.0.word();
            if equal {
                kept.1 = later.1;
            }
            equal
        });
        let before = self.len;
        if batch.len() * MERGE_SHARE >= self.len {
            self.merge_all(&batch, probe);
        } else {
            self.merge_by_leaves(&batch, probe);
        }
        self.len - before
    }

    /// Merges a sorted batch without equal keys with all entries.
    fn merge_all<P: Probe>(&mut self, batch: &[(K, V)], probe: &mut P) {
        if batch.is_empty() {
            return;
        }
        let (mut keys, mut values) = (Vec::new(), Vec::new());
        keys.reserve(self.len + batch.len());
        values.reserve(self.len + batch.len());
        merge(self.iter(), batch, &mut keys, &mut values);
        let leaves = Windows::leaves_for(keys.len());
        let mut fresh = Self::with_leaves(leaves);
        fresh.place(probe);
        for (old, old_values) in self.runs(..) {
            probe.read(old);
            probe.read(old_values);
        }
        let mut to = Writer::new(&mut fresh, leaves, keys.len());
        to.extend(&keys, &values, probe);
        to.finish(probe);
        fresh.moves = self.moves + self.len as u64;
        self.lift(probe);
        *self = fresh;
    }

    /// Merges a sorted batch without equal keys leaf by leaf.
    fn merge_by_leaves<P: Probe>(&mut self, batch: &[(K, V)], probe: &mut P) {
        let leaves =
            self.separators.leaves(batch, |entry: (K, V)| entry.0.word(), self.counts.len(), probe);
        let mut overflows = Vec::new();
        let (mut start, mut asked) = (0, 0);
        while start < batch.len() {
            let leaf = leaves[start];
            let end = start + leaves[start..].iter().take_while(|&&other| other == leaf).count();
            while asked < leaves.len().min(end + PREFETCH_KEYS) {
                for line in (0..LEAF_SLOTS).step_by(64 / size_of::<K>()) {
                    prefetch(self.keys.words(), leaves[asked] * LEAF_SLOTS + line);
                }
                asked += 1;
            }
            if self.counts[leaf] as usize + end - start <= LEAF_SLOTS {
                for &(key, value) in &batch[start..end] {
                    self.merge_one(leaf, key, value, probe);
                }
            } else if let Some(overflow) = self.merge_leaf(leaf, &batch[start..end], probe) {
                overflows.push(overflow);
            }
            start = end;
        }
        self.spread_overflows(overflows, probe);
        let windows = self.windows();
        if self.len > windows.most_of_all() {
            self.respread(Windows::leaves_for(self.len), probe);
        }
    }

    /// Sets one value in a leaf that has room.
    fn merge_one<P: Probe>(&mut self, leaf: usize, key: K, value: V, probe: &mut P) {
        let place = self.find_in(leaf, key.word(), probe);
        let slot = leaf * LEAF_SLOTS + place;
        if place < self.counts[leaf] as usize && self.keys.words()[slot].word() == key.word() {
            probe.write(&self.values[slot..=slot]);
            self.values[slot] = value;
        } else {
            self.put(leaf, place, key, value, probe);
        }
    }

    /// Merges part of the batch with its leaf; returns what is too much for the leaf, as which it is counted from now on.
    fn merge_leaf<P: Probe>(
        &mut self,
        leaf: usize,
        batch: &[(K, V)],
        probe: &mut P,
    ) -> Option<Overflow<K, V>> {
        let count = self.counts[leaf] as usize;
        let slots = leaf * LEAF_SLOTS..leaf * LEAF_SLOTS + count;
        probe.read(&self.keys.words()[slots.clone()]);
        probe.read(&self.values[slots.clone()]);
        let old = self.keys.words()[slots.clone()].iter().zip(&self.values[slots]);
        let (mut keys, mut values) = (Vec::new(), Vec::new());
        merge(old.map(|(&key, &value)| (key, value)), batch, &mut keys, &mut values);
        self.len += keys.len() - count;
        self.counts[leaf] = keys.len() as u32;
        if keys.len() > LEAF_SLOTS {
            return Some(Overflow { leaf, keys, values });
        }
        let slots = leaf * LEAF_SLOTS..leaf * LEAF_SLOTS + keys.len();
        self.moves += count as u64;
        self.keys.words_mut()[slots.clone()].copy_from_slice(&keys);
        self.values[slots.clone()].copy_from_slice(&values);
        probe.write(&self.keys.words()[slots.clone()]);
        probe.write(&self.values[slots]);
        None
    }

    /// Spreads the windows around leaves that overflow.
    fn spread_overflows<P: Probe>(&mut self, overflows: Vec<Overflow<K, V>>, probe: &mut P) {
        let windows = self.windows();
        let mut found: Vec<Range<usize>> = Vec::new();
        for overflow in &overflows {
            if found.last().is_some_and(|window| window.contains(&overflow.leaf)) {
                continue;
            }
            let window = (1..=windows.height()).find_map(|level| {
                let window = windows.around(overflow.leaf, level);
                (self.entries(&window) <= windows.most(window.len(), level)).then_some(window)
            });
            let window = window.unwrap_or(0..self.counts.len());
            // Windows are nested or apart.
            while found.last().is_some_and(|inner| inner.start >= window.start) {
                found.pop();
            }
            found.push(window);
        }
        let mut overflows = overflows.into_iter().peekable();
        for window in found {
            let len = self.entries(&window);
            let (mut keys, mut values) = (Vec::with_capacity(len), Vec::with_capacity(len));
            for leaf in window.clone() {
                match overflows.next_if(|overflow| overflow.leaf == leaf) {
                    Some(overflow) => {
                        keys.extend_from_slice(&overflow.keys);
                        values.extend_from_slice(&overflow.values);
                    }
                    None => {
                        let slots =
                            leaf * LEAF_SLOTS..leaf * LEAF_SLOTS + self.counts[leaf] as usize;
                        probe.read(&self.keys.words()[slots.clone()]);
                        probe.read(&self.values[slots.clone()]);
                        keys.extend_from_slice(&self.keys.words()[slots.clone()]);
                        values.extend_from_slice(&self.values[slots]);
                    }
                }
            }
            self.moves += len as u64;
            if window.len() == self.counts.len() && len > windows.most_of_all() {
                self.refill(&keys, &values, probe);
                return;
            }
            self.deal(window, &keys, &values, probe);
        }
    }

    /// Writes entries to a window, evenly.
    fn deal<P: Probe>(&mut self, window: Range<usize>, keys: &[K], values: &[V], probe: &mut P) {
        let mut counts = vec![0; window.len()];
        spread::even(&mut counts, keys.len());
        let mut next = 0;
        for (leaf, &count) in window.clone().zip(&counts) {
            let (from, slots) = (
                next..next + count as usize,
                leaf * LEAF_SLOTS..leaf * LEAF_SLOTS + count as usize,
            );
            self.keys.words_mut()[slots.clone()].copy_from_slice(&keys[from.clone()]);
            self.values[slots.clone()].copy_from_slice(&values[from.clone()]);
            probe.write(&self.keys.words()[slots.clone()]);
            probe.write(&self.values[slots]);
            if leaf > window.start {
                self.separators.set(leaf, keys[from.start].word(), probe);
            }
            next = from.end;
        }
        self.counts[window.clone()].copy_from_slice(&counts);
        probe.write(&self.counts[window]);
    }

    /// Puts all entries, given in order, into fresh memory.
    fn refill<P: Probe>(&mut self, keys: &[K], values: &[V], probe: &mut P) {
        let leaves = Windows::leaves_for(keys.len());
        let mut fresh = Self::with_leaves(leaves);
        fresh.place(probe);
        let mut to = Writer::new(&mut fresh, leaves, keys.len());
        to.extend(keys, values, probe);
        to.finish(probe);
        fresh.moves = self.moves;
        self.lift(probe);
        *self = fresh;
    }
}

/// Appends the entries of a sorted sequence and a sorted batch in order; of equal keys that of the batch.
fn merge<K: Key, V: Copy>(
    old: impl Iterator<Item = (K, V)>,
    batch: &[(K, V)],
    keys: &mut Vec<K>,
    values: &mut Vec<V>,
) {
    let mut next = batch.iter().copied().peekable();
    let mut push = |(key, value)| {
        keys.push(key);
        values.push(value);
    };
    for (key, value) in old {
        while let Some(new) = next.next_if(|new| new.0.word() < key.word()) {
            push(new);
        }
        push(next.next_if(|new| new.0.word() == key.word()).unwrap_or((key, value)));
    }
    next.for_each(push);
}
