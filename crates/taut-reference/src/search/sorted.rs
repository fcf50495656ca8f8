//! The sorted array itself, searched by halving without a branch on the keys.
//!
//! Guarantee: ⌈log₂ (n + 1)⌉ comparisons. A branch that is wrong half of the time costs more than all else while the
//! array is in a near cache; beyond it a mispredicted branch at least guesses which line comes next, and others layouts
//! are better than either.

use std::hint::select_unpredictable;

use super::{SortedIndex, sorted_words};
use crate::Pages;
use crate::{Error, Key, Probe};

/// Sorted keys in one array, searched by halving.
pub struct Sorted<K: Key> {
    words: Pages<K::Word>,
}

impl<K: Key> SortedIndex<K> for Sorted<K> {
    fn new(sorted: &[K]) -> Result<Self, Error> {
        let mut words = Pages::zeroed(sorted.len());
        sorted_words(sorted, words.words_mut())?;
        Ok(Self { words })
    }

    fn len(&self) -> usize {
        self.words.words().len()
    }

    fn place<P: Probe>(&self, probe: &mut P) {
        probe.place(self.words.words());
    }

    #[inline]
    fn rank_of_word<P: Probe>(&self, word: K::Word, probe: &mut P) -> (usize, bool) {
        let words = self.words.words();
        let (mut first, mut left) = (0, words.len());
        // The answer is in first..=first + left.
        while left > 0 {
            let half = left.div_ceil(2);
            let at = first + half - 1;
            probe.read(&words[at..=at]);
            first = select_unpredictable(words[at] < word, first + half, first);
            left -= half;
        }
        (first, words.get(first).is_some_and(|&other| other == word))
    }
}
