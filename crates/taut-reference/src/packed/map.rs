//! The packed-memory array as an ordered map.
//!
//! *Problem.* Keep entries in order under insertion and deletion, and still in memory as a sorted array has them, so that
//! ranges are read at the speed of memory.
//! *Idea.* An array with gaps, in leaves of 64 slots whose entries are packed to the left. A leaf that is full, or too
//! empty, is spread together with its neighbors: over the smallest window around it that is within the bounds of its
//! level (see `density`). Leaves are found by their least keys (see `separators`).
//! *Guarantee.* Order always; all leaves but the last hold 8 to 64 of 64 entries, the whole array is 3/8 to 3/4 full, up to
//! one leaf; O(log² n) moves an insertion or deletion on average and O(1 + log² n / B) blocks wherever windows are spread
//! evenly. Windows around a hammered place are not, and there the argument does not hold: that moves stay below 1.5 log² n is
//! measured, for all patterns of `tests` and mixtures of insertion and deletion.
//! *Trap.* The window of all leaves is spread before it is over-full, not when a leaf next overflows, or memory would not be
//! bounded. Ascending keys never spread: they open a new leaf at the end.
//! *Reference.* Itai, Konheim and Rodeh, ICALP 1981; Bender, Demaine and Farach-Colton, Cache-oblivious B-trees, SIAM J.
//! Comput. 35(2), 2005; Wheatman, Burns, Buluç and Xu, PPoPP 2024 (leaves without gaps); section 5.2.3 of the thesis.

use std::ops::Range;

use super::density::{LEAF_MIN, LEAF_SLOTS, SEQUENTIAL_ENTRIES, Windows};
use super::separators::Separators;
use super::spread;
use crate::Pages;
use crate::prefetch;
use crate::{Key, NoProbe, Probe, Word};

/// A leaf counts as hammered after this many insertions into it, one after the other.
const HAMMERED_MIN: u32 = 32;

/// An ordered map in one array with gaps: ranges at the speed of memory, insertion and deletion in O(log² n) moves.
///
/// Keys are in the order of [`Key`]. Values are plain data, as they are moved about.
///
/// ```
/// use taut_reference::packed::PackedMap;
/// let mut map = PackedMap::new();
/// map.insert_batch(&[(3.5, 'b'), (1.0, 'a')]);
/// assert_eq!(map.insert(3.5, 'c'), Some('b'));
/// assert_eq!(map.get(1.0), Some(&'a'));
/// assert_eq!(map.range(1.0..3.5).collect::<Vec<_>>(), [(1.0, 'a')]);
/// assert_eq!(map.remove(1.0), Some('a'));
/// assert_eq!(map.len(), 1);
/// ```
pub struct PackedMap<K: Key, V> {
    pub(super) keys: Pages<K>,
    pub(super) values: Vec<V>,
    /// Entries of each leaf in use.
    pub(super) counts: Vec<u32>,
    pub(super) separators: Separators<K::Word>,
    pub(super) len: usize,
    pub(super) moves: u64,
    /// Where the last insertion went, and how many before it went to the same leaf.
    hot: (usize, u32),
}

impl<K: Key, V: Copy + Default> Default for PackedMap<K, V> {
    fn default() -> Self {
        Self::new()
    }
}

impl<K: Key, V: Copy + Default> PackedMap<K, V> {
    /// An empty map.
    pub fn new() -> Self {
        Self::with_leaves(1)
    }

    /// An empty map with memory for a number of leaves, one of which is in use.
    pub(super) fn with_leaves(room: usize) -> Self {
        let mut counts = Vec::with_capacity(room);
        counts.push(0);
        Self {
            keys: Pages::zeroed(room * LEAF_SLOTS),
            values: vec![V::default(); room * LEAF_SLOTS],
            counts,
            separators: Separators::new(room),
            len: 0,
            moves: 0,
            hot: (0, 0),
        }
    }

    /// Entries.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Returns true if there is no entry.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Entries moved from slot to slot by all insertions and deletions so far, the new ones not counted; nor are copies to
    /// larger memory, in which entries keep their slots: two for each entry at most, as memory grows by half.
    pub fn moves(&self) -> u64 {
        self.moves
    }

    /// Slots in use, full and empty.
    pub fn slots(&self) -> usize {
        self.counts.len() * LEAF_SLOTS
    }

    /// Tells a probe of the arrays; once, ahead of the first instrumented call.
    pub fn place<P: Probe>(&self, probe: &mut P) {
        probe.place(self.keys.words());
        probe.place(&self.values);
        if P::IS_RECORDING {
            // With the leaves that are still to be opened, for which there is room.
            let bytes = self.counts.capacity() * size_of::<u32>();
            probe.place_at(self.counts.as_ptr() as usize, bytes);
        }
        self.separators.place_in(probe);
    }

    /// Tells a probe that the arrays are gone.
    pub(super) fn lift<P: Probe>(&self, probe: &mut P) {
        probe.lift(self.keys.words());
        probe.lift(&self.values);
        probe.lift(&self.counts);
        self.separators.lift_from(probe);
    }

    pub(super) fn windows(&self) -> Windows {
        Windows::new(self.counts.len())
    }

    /// The leaf a word belongs to, and the first place there that is not before it.
    #[inline]
    pub(super) fn find<P: Probe>(&self, word: K::Word, probe: &mut P) -> (usize, usize) {
        let leaf = self.separators.leaf(word, self.counts.len(), probe);
        (leaf, self.find_in(leaf, word, probe))
    }

    #[inline]
    pub(super) fn find_in<P: Probe>(&self, leaf: usize, word: K::Word, probe: &mut P) -> usize {
        // All lines of the leaf at once, instead of one after the other as the search halves it.
        for line in 0..LEAF_SLOTS / K::Word::LANES {
            prefetch(self.keys.words(), leaf * LEAF_SLOTS + line * K::Word::LANES);
        }
        probe.read(&self.counts[leaf..=leaf]);
        let keys = &self.keys.words()[leaf * LEAF_SLOTS..][..self.counts[leaf] as usize];
        let (mut first, mut left) = (0, keys.len());
        while left > 0 {
            let half = left.div_ceil(2);
            probe.read(&keys[first + half - 1..first + half]);
            let smaller = keys[first + half - 1].word() < word;
            first = std::hint::select_unpredictable(smaller, first + half, first);
            left -= half;
        }
        first
    }

    /// The slot of a key; none if it is not there.
    #[inline]
    fn slot<P: Probe>(&self, key: K, probe: &mut P) -> Option<usize> {
        let (leaf, place) = self.find(key.word(), probe);
        let slot = leaf * LEAF_SLOTS + place;
        let there =
            place < self.counts[leaf] as usize && self.keys.words()[slot].word() == key.word();
        there.then_some(slot)
    }

    /// The value of a key. O(log n).
    #[inline]
    pub fn get(&self, key: K) -> Option<&V> {
        self.get_instrumented(key, &mut NoProbe)
    }

    /// [`PackedMap::get`], recorded by a probe.
    #[inline]
    pub fn get_instrumented<P: Probe>(&self, key: K, probe: &mut P) -> Option<&V> {
        let slot = self.slot(key, probe)?;
        probe.read(&self.values[slot..=slot]);
        Some(&self.values[slot])
    }

    /// The value of a key, to be changed. O(log n).
    pub fn get_mut(&mut self, key: K) -> Option<&mut V> {
        let slot = self.slot(key, &mut NoProbe)?;
        Some(&mut self.values[slot])
    }

    /// Returns true if a key is there. O(log n).
    #[inline]
    pub fn contains_key(&self, key: K) -> bool {
        self.slot(key, &mut NoProbe).is_some()
    }

    /// Sets the value of a key and returns the one it had. O(log² n) moves on average.
    pub fn insert(&mut self, key: K, value: V) -> Option<V> {
        self.insert_instrumented(key, value, &mut NoProbe)
    }

    /// [`PackedMap::insert`], recorded by a probe.
    pub fn insert_instrumented<P: Probe>(&mut self, key: K, value: V, probe: &mut P) -> Option<V> {
        let word = key.word();
        let last = self.counts.len() - 1;
        let filled = self.counts[last] as usize;
        let end = last * LEAF_SLOTS + filled;
        if filled > 0 && self.keys.words()[end - 1].word() < word {
            probe.read(&self.keys.words()[end - 1..end]);
            if filled >= SEQUENTIAL_ENTRIES {
                self.open_leaf(word, probe);
                self.put(last + 1, 0, key, value, probe);
                return None;
            }
            if self.len < self.windows().most_of_all() {
                self.put(last, filled, key, value, probe);
                return None;
            }
        }
        let (mut leaf, mut place) = self.find(word, probe);
        let slot = leaf * LEAF_SLOTS + place;
        if place < self.counts[leaf] as usize && self.keys.words()[slot].word() == word {
            probe.write(&self.values[slot..=slot]);
            return Some(std::mem::replace(&mut self.values[slot], value));
        }
        self.hot =
            if leaf == self.hot.0 { (leaf, self.hot.1.saturating_add(1)) } else { (leaf, 0) };
        if self.counts[leaf] as usize == LEAF_SLOTS || self.len >= self.windows().most_of_all() {
            self.make_room(leaf, place, probe);
            (leaf, place) = self.find(word, probe);
            // Still the same place, wherever its leaf is now.
            self.hot.0 = leaf;
        }
        self.put(leaf, place, key, value, probe);
        None
    }

    /// Puts an entry in its place in a leaf that has room.
    #[inline]
    pub(super) fn put<P: Probe>(
        &mut self,
        leaf: usize,
        place: usize,
        key: K,
        value: V,
        probe: &mut P,
    ) {
        let count = self.counts[leaf] as usize;
        let (slot, end) = (leaf * LEAF_SLOTS + place, leaf * LEAF_SLOTS + count);
        let keys = self.keys.words_mut();
        keys.copy_within(slot..end, slot + 1);
        keys[slot] = key;
        self.values.copy_within(slot..end, slot + 1);
        self.values[slot] = value;
        probe.write(&self.keys.words()[slot..=end]);
        probe.write(&self.values[slot..=end]);
        probe.write(&self.counts[leaf..=leaf]);
        self.counts[leaf] += 1;
        self.moves += (count - place) as u64;
        self.len += 1;
    }

    /// Opens a leaf at the end, for `word` and what is larger.
    fn open_leaf<P: Probe>(&mut self, word: K::Word, probe: &mut P) {
        let leaves = self.counts.len();
        if leaves == self.separators.room() {
            self.enlarge(probe);
        }
        self.counts.push(0);
        self.separators.set(leaves, word, probe);
    }

    /// Memory for half as many leaves again; entries keep their slots.
    fn enlarge<P: Probe>(&mut self, probe: &mut P) {
        self.lift(probe);
        let leaves = self.counts.len();
        let room = leaves + leaves / 2 + 1;
        let mut keys = Pages::zeroed(room * LEAF_SLOTS);
        keys.words_mut()[..leaves * LEAF_SLOTS]
            .copy_from_slice(&self.keys.words()[..leaves * LEAF_SLOTS]);
        self.keys = keys;
        self.values.resize(room * LEAF_SLOTS, V::default());
        self.counts.reserve_exact(room - leaves);
        let mut separators = Separators::new(room);
        for leaf in 1..leaves {
            if let Some(word) = self.separators.get(leaf) {
                separators.set(leaf, word, &mut NoProbe);
            }
        }
        self.separators = separators;
        self.place(probe);
    }

    /// Makes room for one more entry at a place of a leaf.
    fn make_room<P: Probe>(&mut self, leaf: usize, place: usize, probe: &mut P) {
        let windows = self.windows();
        let hammered = self.hot.1 >= HAMMERED_MIN;
        let level = if self.len < windows.most_of_all() {
            (1..=windows.height()).find_map(|level| {
                let window = windows.around(leaf, level);
                let len = self.entries(&window);
                (len < windows.most(window.len(), level)).then_some((level, window, len))
            })
        } else {
            None
        };
        let Some((level, window, len)) = level else {
            self.respread(Windows::leaves_for(self.len + 1), probe);
            return;
        };
        let mut counts = vec![0; window.len()];
        if hammered {
            let before = self.entries(&(window.start..leaf)) + place;
            spread::around(&mut counts, len, before, windows, level);
        } else {
            spread::even(&mut counts, len);
        }
        self.spread(window, &counts, probe);
    }

    pub(super) fn entries(&self, leaves: &Range<usize>) -> usize {
        self.counts[leaves.clone()].iter().map(|&count| count as usize).sum()
    }

    /// Spreads the entries of some leaves: packs them to the left, then deals them out from the right.
    pub(super) fn spread<P: Probe>(&mut self, window: Range<usize>, counts: &[u32], probe: &mut P) {
        let first = window.start * LEAF_SLOTS;
        let keys = self.keys.words_mut();
        let mut packed = first;
        for leaf in window.clone() {
            let (slot, count) = (leaf * LEAF_SLOTS, self.counts[leaf] as usize);
            keys.copy_within(slot..slot + count, packed);
            self.values.copy_within(slot..slot + count, packed);
            packed += count;
        }
        self.moves += (packed - first) as u64;
        for (leaf, &count) in window.clone().zip(counts).rev() {
            let (slot, count) = (leaf * LEAF_SLOTS, count as usize);
            packed -= count;
            keys.copy_within(packed..packed + count, slot);
            self.values.copy_within(packed..packed + count, slot);
        }
        self.counts[window.clone()].copy_from_slice(counts);
        if P::IS_RECORDING {
            for slots in [first..window.end * LEAF_SLOTS, first..window.end * LEAF_SLOTS] {
                probe.read(&self.keys.words()[slots.clone()]);
                probe.write(&self.keys.words()[slots.clone()]);
                probe.read(&self.values[slots.clone()]);
                probe.write(&self.values[slots]);
            }
            probe.write(&self.counts[window.clone()]);
        }
        for leaf in window.skip(1) {
            self.separators.set(leaf, self.keys.words()[leaf * LEAF_SLOTS].word(), probe);
        }
    }

    /// Spreads all entries over a number of leaves, in fresh memory.
    pub(super) fn respread<P: Probe>(&mut self, leaves: usize, probe: &mut P) {
        let mut fresh = Self::with_leaves(leaves);
        fresh.place(probe);
        let mut to = Writer::new(&mut fresh, leaves, self.len);
        for leaf in 0..self.counts.len() {
            let slots = leaf * LEAF_SLOTS..leaf * LEAF_SLOTS + self.counts[leaf] as usize;
            probe.read(&self.keys.words()[slots.clone()]);
            probe.read(&self.values[slots.clone()]);
            to.extend(&self.keys.words()[slots.clone()], &self.values[slots], probe);
        }
        to.finish(probe);
        fresh.moves = self.moves + self.len as u64;
        fresh.hot = self.hot;
        self.lift(probe);
        *self = fresh;
    }

    /// Takes a key out and returns its value. O(log² n) moves on average.
    pub fn remove(&mut self, key: K) -> Option<V> {
        self.remove_instrumented(key, &mut NoProbe)
    }

    /// [`PackedMap::remove`], recorded by a probe.
    pub fn remove_instrumented<P: Probe>(&mut self, key: K, probe: &mut P) -> Option<V> {
        let slot = self.slot(key, probe)?;
        let leaf = slot / LEAF_SLOTS;
        let end = leaf * LEAF_SLOTS + self.counts[leaf] as usize;
        let value = self.values[slot];
        self.keys.words_mut().copy_within(slot + 1..end, slot);
        self.values.copy_within(slot + 1..end, slot);
        probe.write(&self.keys.words()[slot..end]);
        probe.write(&self.values[slot..end]);
        probe.write(&self.counts[leaf..=leaf]);
        self.counts[leaf] -= 1;
        self.len -= 1;
        self.moves += (end - slot - 1) as u64;
        self.settle(leaf, probe);
        Some(value)
    }

    /// Restores the bounds around a leaf that has lost an entry.
    fn settle<P: Probe>(&mut self, leaf: usize, probe: &mut P) {
        let last = self.counts.len() - 1;
        if last > 0 && self.counts[last] == 0 {
            self.separators.set(last, K::Word::MAX, probe);
            self.counts.pop();
        }
        let windows = self.windows();
        // Too many also: the leaf that went may have been what let the others be fuller.
        if self.len < windows.fewest_of_all() || self.len > windows.most_of_all() {
            self.respread(Windows::leaves_for(self.len), probe);
            return;
        }
        if leaf + 1 >= self.counts.len() || self.counts[leaf] as usize >= LEAF_MIN {
            return;
        }
        let found = (1..=windows.height()).find_map(|level| {
            let window = windows.around(leaf, level);
            let len = self.entries(&window);
            (len >= windows.fewest(window.len(), level)).then_some((window, len))
        });
        match found {
            Some((window, len)) => {
                let mut counts = vec![0; window.len()];
                spread::even(&mut counts, len);
                self.spread(window, &counts, probe);
            }
            None => self.respread(Windows::leaves_for(self.len), probe),
        }
    }
}

/// Fills the leaves of an empty map in order.
pub(super) struct Writer<'a, K: Key, V> {
    map: &'a mut PackedMap<K, V>,
    counts: Vec<u32>,
    leaf: usize,
}

impl<'a, K: Key, V: Copy + Default> Writer<'a, K, V> {
    /// Will write `len` entries to `leaves` leaves of an empty map that has room for them.
    pub(super) fn new(map: &'a mut PackedMap<K, V>, leaves: usize, len: usize) -> Self {
        let mut counts = vec![0; leaves];
        spread::even(&mut counts, len);
        map.counts.resize(leaves, 0);
        Self { map, counts, leaf: 0 }
    }

    /// Writes the next entries.
    pub(super) fn extend<P: Probe>(&mut self, mut keys: &[K], mut values: &[V], probe: &mut P) {
        while !keys.is_empty() {
            let filled = self.map.counts[self.leaf] as usize;
            let take = keys.len().min(self.counts[self.leaf] as usize - filled);
            if take == 0 {
                self.leaf += 1;
                continue;
            }
            if filled == 0 {
                self.map.separators.set(self.leaf, keys[0].word(), probe);
            }
            let slot = self.leaf * LEAF_SLOTS + filled;
            self.map.keys.words_mut()[slot..slot + take].copy_from_slice(&keys[..take]);
            self.map.values[slot..slot + take].copy_from_slice(&values[..take]);
            probe.write(&self.map.keys.words()[slot..slot + take]);
            probe.write(&self.map.values[slot..slot + take]);
            self.map.counts[self.leaf] += take as u32;
            self.map.len += take;
            (keys, values) = (&keys[take..], &values[take..]);
        }
    }

    pub(super) fn finish<P: Probe>(self, probe: &mut P) {
        debug_assert_eq!(self.map.counts, self.counts);
        probe.write(&self.map.counts);
    }
}
