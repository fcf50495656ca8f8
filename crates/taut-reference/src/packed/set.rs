//! The packed-memory array as an ordered set.

use std::ops::RangeBounds;

use super::check::{Density, Violation};
use super::map::PackedMap;
use super::range::{Iter, Runs};
use crate::{Key, NoProbe, Probe};

/// An ordered set in one array with gaps: a [`PackedMap`] without values.
///
/// ```
/// use taut_reference::packed::PackedSet;
/// let mut set: PackedSet<u64> = (0..1000).map(|i| i * 7919 % 1000).collect();
/// assert!(set.remove(500) && !set.insert(501));
/// assert_eq!(set.range(499..503).collect::<Vec<_>>(), [499, 501, 502]);
/// assert_eq!(set.insert_batch(&[500, 2000, 2000]), 2);
/// ```
pub struct PackedSet<K: Key> {
    map: PackedMap<K, ()>,
}

impl<K: Key> Default for PackedSet<K> {
    fn default() -> Self {
        Self::new()
    }
}

impl<K: Key> PackedSet<K> {
    /// An empty set.
    pub fn new() -> Self {
        Self { map: PackedMap::new() }
    }

    /// Keys.
    pub fn len(&self) -> usize {
        self.map.len()
    }

    /// Returns true if there is no key.
    pub fn is_empty(&self) -> bool {
        self.map.is_empty()
    }

    /// Keys moved from slot to slot so far; see [`PackedMap::moves`].
    pub fn moves(&self) -> u64 {
        self.map.moves()
    }

    /// Slots in use, full and empty.
    pub fn slots(&self) -> usize {
        self.map.slots()
    }

    /// Tells a probe of the arrays; once, ahead of the first instrumented call.
    pub fn place<P: Probe>(&self, probe: &mut P) {
        self.map.place(probe);
    }

    /// Returns true if a key is there. O(log n).
    #[inline]
    pub fn contains(&self, key: K) -> bool {
        self.map.contains_key(key)
    }

    /// [`PackedSet::contains`], recorded by a probe.
    pub fn contains_instrumented<P: Probe>(&self, key: K, probe: &mut P) -> bool {
        self.map.get_instrumented(key, probe).is_some()
    }

    /// Puts a key in, and says whether it is new. O(log² n) moves on average.
    #[inline]
    pub fn insert(&mut self, key: K) -> bool {
        self.insert_instrumented(key, &mut NoProbe)
    }

    /// [`PackedSet::insert`], recorded by a probe.
    #[inline]
    pub fn insert_instrumented<P: Probe>(&mut self, key: K, probe: &mut P) -> bool {
        self.map.insert_instrumented(key, (), probe).is_none()
    }

    /// Puts many keys in, in any order, and returns how many are new; see [`PackedMap::insert_batch`].
    pub fn insert_batch(&mut self, keys: &[K]) -> usize {
        let entries: Vec<(K, ())> = keys.iter().map(|&key| (key, ())).collect();
        self.map.insert_batch(&entries)
    }

    /// Takes a key out, and says whether it was there. O(log² n) moves on average.
    pub fn remove(&mut self, key: K) -> bool {
        self.remove_instrumented(key, &mut NoProbe)
    }

    /// [`PackedSet::remove`], recorded by a probe.
    pub fn remove_instrumented<P: Probe>(&mut self, key: K, probe: &mut P) -> bool {
        self.map.remove_instrumented(key, probe).is_some()
    }

    /// All keys in order.
    pub fn iter(&self) -> Keys<'_, K> {
        Keys(self.map.iter())
    }

    /// The keys in a range, in order; see [`PackedMap::range`].
    pub fn range(&self, range: impl RangeBounds<K>) -> Keys<'_, K> {
        Keys(self.map.range(range))
    }

    /// The keys in a range as slices of the array, one for each leaf.
    pub fn runs(&self, range: impl RangeBounds<K>) -> KeyRuns<'_, K> {
        KeyRuns(self.map.runs(range))
    }

    /// The smallest key. O(1).
    pub fn first(&self) -> Option<K> {
        self.map.first().map(|entry| entry.0)
    }

    /// The largest key. O(1).
    pub fn last(&self) -> Option<K> {
        self.map.last().map(|entry| entry.0)
    }

    /// Checks all that is promised; see [`PackedMap::check`].
    ///
    /// # Errors
    /// The first leaf where any of it is not so.
    pub fn check(&self) -> Result<Vec<Density>, Violation> {
        self.map.check()
    }
}

impl<K: Key> FromIterator<K> for PackedSet<K> {
    fn from_iter<I: IntoIterator<Item = K>>(keys: I) -> Self {
        let mut set = Self::new();
        set.insert_batch(&keys.into_iter().collect::<Vec<_>>());
        set
    }
}

/// The keys of a range of a [`PackedSet`] in order.
#[derive(Clone)]
pub struct Keys<'a, K: Key>(Iter<'a, K, ()>);

impl<K: Key> Iterator for Keys<'_, K> {
    type Item = K;

    #[inline]
    fn next(&mut self) -> Option<K> {
        self.0.next().map(|entry| entry.0)
    }

    #[inline]
    fn fold<B, F: FnMut(B, K) -> B>(self, init: B, mut f: F) -> B {
        self.0.fold(init, |state, (key, ())| f(state, key))
    }
}

/// The slices of the array that make up a range of a [`PackedSet`].
#[derive(Clone)]
pub struct KeyRuns<'a, K: Key>(Runs<'a, K, ()>);

impl<'a, K: Key> Iterator for KeyRuns<'a, K> {
    type Item = &'a [K];

    #[inline]
    fn next(&mut self) -> Option<&'a [K]> {
        self.0.next().map(|run| run.0)
    }
}
