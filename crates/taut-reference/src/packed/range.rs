//! Ranges of a packed map: as runs of the array, and entry by entry.

use std::ops::{Bound, RangeBounds};

use super::density::LEAF_SLOTS;
use super::map::PackedMap;
use crate::{Key, NoProbe, Word};

/// The runs of the array that make up a range of a [`PackedMap`]: for each leaf its keys and its values.
#[derive(Clone)]
pub struct Runs<'a, K: Key, V> {
    map: &'a PackedMap<K, V>,
    /// The next leaf, and the place in it.
    leaf: usize,
    place: usize,
    /// The leaf of the end, and the place in it.
    end: (usize, usize),
}

impl<'a, K: Key, V> Iterator for Runs<'a, K, V> {
    type Item = (&'a [K], &'a [V]);

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let (last, end) = self.end;
            if self.leaf > last || self.leaf >= self.map.counts.len() {
                return None;
            }
            let count = self.map.counts[self.leaf] as usize;
            let stop = if self.leaf == last { count.min(end) } else { count };
            let slots = self.leaf * LEAF_SLOTS + self.place..self.leaf * LEAF_SLOTS + stop;
            let empty = self.place >= stop;
            self.leaf += 1;
            self.place = 0;
            if !empty {
                return Some((&self.map.keys.words()[slots.clone()], &self.map.values[slots]));
            }
        }
    }
}

/// The entries of a range of a [`PackedMap`] in the order of their keys.
#[derive(Clone)]
pub struct Iter<'a, K: Key, V> {
    runs: Runs<'a, K, V>,
    run: std::iter::Zip<std::slice::Iter<'a, K>, std::slice::Iter<'a, V>>,
}

impl<K: Key, V: Copy> Iterator for Iter<'_, K, V> {
    type Item = (K, V);

    #[inline]
    fn next(&mut self) -> Option<(K, V)> {
        loop {
            if let Some((&key, &value)) = self.run.next() {
                return Some((key, value));
            }
            let (keys, values) = self.runs.next()?;
            self.run = keys.iter().zip(values);
        }
    }

    /// Run by run, so that sums and searches of many entries are loops over slices.
    #[inline]
    fn fold<B, F: FnMut(B, (K, V)) -> B>(self, init: B, mut f: F) -> B {
        let mut state = init;
        for (&key, &value) in self.run {
            state = f(state, (key, value));
        }
        for (keys, values) in self.runs {
            for (&key, &value) in keys.iter().zip(values) {
                state = f(state, (key, value));
            }
        }
        state
    }
}

impl<K: Key, V: Copy + Default> PackedMap<K, V> {
    /// All entries in the order of their keys.
    pub fn iter(&self) -> Iter<'_, K, V> {
        self.range(..)
    }

    /// The entries whose keys are in a range, in order; none if the range is empty or its ends are in the wrong order.
    /// O(log n), and the speed of memory from there on.
    pub fn range(&self, range: impl RangeBounds<K>) -> Iter<'_, K, V> {
        Iter { runs: self.runs(range), run: [].iter().zip(&[]) }
    }

    /// [`PackedMap::range`] as it is in memory: a slice of keys and one of values for each leaf, none empty.
    pub fn runs(&self, range: impl RangeBounds<K>) -> Runs<'_, K, V> {
        let start = match range.start_bound() {
            Bound::Unbounded => Some((0, 0)),
            Bound::Included(key) => Some(self.find(key.word(), &mut NoProbe)),
            Bound::Excluded(key) => key.word().next().map(|word| self.find(word, &mut NoProbe)),
        };
        let end = match range.end_bound() {
            Bound::Unbounded => None,
            Bound::Included(key) => key.word().next(),
            Bound::Excluded(key) => Some(key.word()),
        };
        let end = match end {
            Some(word) => self.find(word, &mut NoProbe),
            None => (self.counts.len(), 0),
        };
        match start {
            Some((leaf, place)) => Runs { map: self, leaf, place, end },
            None => Runs { map: self, leaf: self.counts.len(), place: 0, end },
        }
    }

    /// The entry with the smallest key. O(1).
    pub fn first(&self) -> Option<(K, V)> {
        self.iter().next()
    }

    /// The entry with the largest key. O(1).
    pub fn last(&self) -> Option<(K, V)> {
        let leaf = self.counts.len() - 1;
        let slot = leaf * LEAF_SLOTS + (self.counts[leaf] as usize).checked_sub(1)?;
        Some((self.keys.words()[slot], self.values[slot]))
    }
}
