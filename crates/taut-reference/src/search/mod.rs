//! Static indices over sorted keys: how many keys are smaller, in four layouts behind one trait.
//!
//! | layout | memory accessed by one search of n keys of 64 bits | good for |
//! |---|---|---|
//! | [`Sorted`] | a line a halving, log₂ n in all, but for the last three | few keys; no copy beside it |
//! | [`Eytzinger`] | the same lines, but asked for three halvings ahead | simple code, 10³ to 10⁵ keys |
//! | [`BlockedVanEmdeBoas`] | a line for 8 keys, a page for 56 · 8, a large page for its square | mapped files, cold caches |
//! | [`SPlusTree`] | a line for 8 keys, many searches at once | everything else |
//!
//! All give the same answers: ranks among the sorted keys, for all kinds of [`Key`], with duplicates, with the largest
//! integer and with NaN as keys. Memory is asked for in large pages. The layout of van Emde Boas, which knows no size of a block,
//! is [`VebTree`](crate::algorithms::VebTree).

mod blocked;
mod complete;
mod eytzinger;
mod lanes;
mod sorted;
mod splus;
#[cfg(test)]
mod tests;

use std::ops::Range;

pub use blocked::BlockedVanEmdeBoas;
pub use eytzinger::Eytzinger;
pub use sorted::Sorted;
pub use splus::SPlusTree;
pub(crate) use splus::Tree;

use crate::{Error, Key, NoProbe, Probe, Word};

/// An index over sorted keys, built once, asked often.
///
/// ```
/// use taut_reference::search::{SPlusTree, SortedIndex};
/// let index = SPlusTree::new(&[2.0, 3.5, 3.5, 7.0])?;
/// assert_eq!(index.lower_bound(3.5), 1);                    // one key is smaller
/// assert_eq!(index.upper_bound(3.5), 3);
/// assert_eq!(index.equal_range(3.5), 1..3);
/// assert!(!index.contains(4.0));
/// let mut ranks = Vec::new();
/// index.lower_bounds(&[0.0, 7.0, 9.0], &mut ranks);         // many at once, the fast way
/// assert_eq!(ranks, [0, 3, 4]);
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
pub trait SortedIndex<K: Key>: Sized {
    /// Builds the index. O(n).
    ///
    /// # Errors
    /// [`Error::Option`] if a key is smaller than the one before it, in the order of [`Key`].
    fn new(sorted: &[K]) -> Result<Self, Error>;

    /// Returns how many keys there are.
    fn len(&self) -> usize;

    /// Tells a probe of the arrays that searches read; once, ahead of the first instrumented search.
    fn place<P: Probe>(&self, probe: &mut P);

    /// Returns how many keys have a smaller word, and whether the next key has this word. The search that all others are made
    /// of: O(log n).
    fn rank_of_word<P: Probe>(&self, word: K::Word, probe: &mut P) -> (usize, bool);

    /// For each key the number of those in the index that have a smaller word than `word(key)`. The batch that the
    /// others are made of; as many are answered as both slices have places for.
    fn ranks_of_words<P: Probe>(
        &self,
        keys: &[K],
        word: impl Fn(K) -> K::Word + Copy,
        ranks: &mut [usize],
        probe: &mut P,
    ) {
        for (&key, rank) in keys.iter().zip(ranks) {
            *rank = self.rank_of_word(word(key), probe).0;
        }
    }

    /// Returns true if there are no keys.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns how many keys are smaller: the first place where `key` is, or could be put in. O(log n).
    #[inline]
    fn lower_bound(&self, key: K) -> usize {
        self.lower_bound_instrumented(key, &mut NoProbe)
    }

    /// [`SortedIndex::lower_bound`], recorded by a probe.
    #[inline]
    fn lower_bound_instrumented<P: Probe>(&self, key: K, probe: &mut P) -> usize {
        self.rank_of_word(key.word(), probe).0
    }

    /// Returns how many keys are smaller or equal: the last place where `key` could be put in. O(log n).
    #[inline]
    fn upper_bound(&self, key: K) -> usize {
        self.upper_bound_instrumented(key, &mut NoProbe)
    }

    /// [`SortedIndex::upper_bound`], recorded by a probe.
    #[inline]
    fn upper_bound_instrumented<P: Probe>(&self, key: K, probe: &mut P) -> usize {
        match key.word().next() {
            Some(next) => self.rank_of_word(next, probe).0,
            None => self.len(),
        }
    }

    /// The places of all keys equal to `key`; empty where it could be put in, if there are none. O(log n).
    fn equal_range(&self, key: K) -> Range<usize> {
        self.lower_bound(key)..self.upper_bound(key)
    }

    /// Returns true if `key` is there. O(log n).
    #[inline]
    fn contains(&self, key: K) -> bool {
        self.contains_instrumented(key, &mut NoProbe)
    }

    /// [`SortedIndex::contains`], recorded by a probe.
    #[inline]
    fn contains_instrumented<P: Probe>(&self, key: K, probe: &mut P) -> bool {
        self.rank_of_word(key.word(), probe).1
    }

    /// [`SortedIndex::lower_bound`] of many keys; `ranks` is emptied first.
    fn lower_bounds(&self, keys: &[K], ranks: &mut Vec<usize>) {
        self.lower_bounds_instrumented(keys, ranks, &mut NoProbe);
    }

    /// [`SortedIndex::lower_bounds`], recorded by a probe.
    fn lower_bounds_instrumented<P: Probe>(
        &self,
        keys: &[K],
        ranks: &mut Vec<usize>,
        probe: &mut P,
    ) {
        ranks.clear();
        ranks.resize(keys.len(), 0);
        self.ranks_of_words(keys, K::word, ranks, probe);
    }

    /// [`SortedIndex::upper_bound`] of many keys; `ranks` is emptied first.
    fn upper_bounds(&self, keys: &[K], ranks: &mut Vec<usize>) {
        self.upper_bounds_instrumented(keys, ranks, &mut NoProbe);
    }

    /// [`SortedIndex::upper_bounds`], recorded by a probe.
    fn upper_bounds_instrumented<P: Probe>(
        &self,
        keys: &[K],
        ranks: &mut Vec<usize>,
        probe: &mut P,
    ) {
        ranks.clear();
        ranks.resize(keys.len(), 0);
        self.ranks_of_words(keys, |key| key.word().next().unwrap_or(K::Word::MAX), ranks, probe);
        for (rank, _) in ranks.iter_mut().zip(keys).filter(|(_, key)| key.word() == K::Word::MAX) {
            *rank = self.len();
        }
    }
}

/// Writes the words of sorted keys to the first places of `words`, which has room for them.
fn sorted_words<K: Key>(sorted: &[K], words: &mut [K::Word]) -> Result<(), Error> {
    check_sorted(sorted)?;
    for (word, key) in words.iter_mut().zip(sorted) {
        *word = key.word();
    }
    Ok(())
}

/// Says where keys are out of order.
pub(crate) fn check_sorted<K: Key>(keys: &[K]) -> Result<(), Error> {
    match keys.windows(2).position(|side| side[0].word() > side[1].word()) {
        Some(before) => Err(Error::Option {
            name: "sorted",
            value: format!("descending from key {before} to key {}", before + 1),
            expected: "keys in ascending order",
        }),
        None => Ok(()),
    }
}
