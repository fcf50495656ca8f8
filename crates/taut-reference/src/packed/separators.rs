//! Which leaf a key belongs to: the least word of each leaf but the first, as a tree of lines.
//!
//! Idea: a static B-tree with room for a fixed number of leaves. Each separator is in one place only, on the level given
//! by how often the fan-out divides the number of its leaf, so changing a leaf's is one write.
//! Guarantee: one line a level; places of leaves that are not in use hold the largest word, which no search counts.
//! Trap: a search counts separators below the successor of its word. The largest word has none: it belongs to the last
//! leaf, and that is known without a search.

use crate::Level;
use crate::Pages;
use crate::search::Tree;
use crate::{Probe, Word};

/// More levels than any array that fits a memory has.
const LEVELS_MAX: usize = 24;

pub(super) struct Separators<W> {
    words: Pages<W>,
    /// The first word of each level, the root's first.
    starts: [usize; LEVELS_MAX],
    levels: usize,
    /// Leaves that there is room for.
    room: usize,
}

impl<W: Word> Separators<W> {
    /// Room for `room` leaves; one is in use.
    pub(super) fn new(room: usize) -> Self {
        let mut counts = vec![room.div_ceil(W::LANES + 1).max(1)];
        while let Some(&count) = counts.last().filter(|&&count| count > 1) {
            counts.push(count.div_ceil(W::LANES + 1));
        }
        counts.reverse();
        let (mut starts, mut end) = ([0; LEVELS_MAX], 0);
        for (start, count) in starts.iter_mut().zip(&counts) {
            *start = end;
            end += count * W::LANES;
        }
        let mut words = Pages::zeroed(end);
        words.words_mut().fill(W::MAX);
        Self { words, starts, levels: counts.len(), room }
    }

    pub(super) fn room(&self) -> usize {
        self.room
    }

    /// The place of the separator of a leaf, not the first.
    fn place(&self, leaf: usize) -> usize {
        let (mut level, mut number) = (self.levels - 1, leaf);
        while number.is_multiple_of(W::LANES + 1) {
            number /= W::LANES + 1;
            level -= 1;
        }
        let line = number / (W::LANES + 1);
        self.starts[level] + line * W::LANES + number % (W::LANES + 1) - 1
    }

    /// The separator of a leaf; none of the first.
    pub(super) fn get(&self, leaf: usize) -> Option<W> {
        (leaf > 0).then(|| self.words.words()[self.place(leaf)])
    }

    /// Changes the separator of a leaf that there is room for; the first has none.
    pub(super) fn set<P: Probe>(&mut self, leaf: usize, word: W, probe: &mut P) {
        assert!(leaf < self.room, "leaf {leaf} of {}", self.room);
        if leaf > 0 {
            let place = self.place(leaf);
            self.words.words_mut()[place] = word;
            probe.write(&self.words.words()[place..=place]);
        }
    }

    #[allow(unsafe_code, reason = "gives the vector kernels what they rely on")]
    fn tree(&self) -> Tree<'_, W> {
        // SAFETY: pages start a line and levels hold whole lines; a separator that is not the largest word was set for a
        // leaf that there is room for, so the nodes on the way to that leaf exist.
        unsafe { Tree::of_inner_levels(self.words.words(), &self.starts[..self.levels]) }
    }

    /// The leaf of the largest separator that is not larger than `word`, the first if there is none, and the last of
    /// `leaves` for the largest word.
    #[inline]
    pub(super) fn leaf<P: Probe>(&self, word: W, leaves: usize, probe: &mut P) -> usize {
        match word.next() {
            Some(next) => self.tree().rank(next, probe),
            None => leaves - 1,
        }
    }

    /// [`Separators::leaf`] of many words.
    pub(super) fn leaves<T: Copy, P: Probe>(
        &self,
        entries: &[T],
        word: impl Fn(T) -> W + Copy,
        leaves: usize,
        probe: &mut P,
    ) -> Vec<usize> {
        let mut found = vec![0; entries.len()];
        let next = |entry| word(entry).next().unwrap_or(W::MAX);
        self.tree().ranks(Level::best(), entries, next, &mut found, probe);
        for (leaf, _) in found.iter_mut().zip(entries).filter(|(_, e)| word(**e) == W::MAX) {
            *leaf = leaves - 1;
        }
        found
    }

    pub(super) fn place_in<P: Probe>(&self, probe: &mut P) {
        probe.place(self.words.words());
    }

    pub(super) fn lift_from<P: Probe>(&self, probe: &mut P) {
        probe.lift(self.words.words());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NoProbe;

    #[test]
    fn every_leaf_is_found_by_its_separator() {
        for room in [1, 2, 9, 10, 81, 82, 800].into_iter().filter(|&room| !cfg!(miri) || room < 80)
        {
            let mut separators = Separators::<u64>::new(room);
            for leaf in 0..room {
                separators.set(leaf, 10 * leaf as u64, &mut NoProbe);
            }
            for leaf in 0..room {
                assert_eq!(separators.get(leaf), (leaf > 0).then_some(10 * leaf as u64));
                for add in [0, 9] {
                    let word = 10 * leaf as u64 + add;
                    assert_eq!(separators.leaf(word, room, &mut NoProbe), leaf, "{room}");
                }
            }
            let words: Vec<u64> = (0..10 * room as u64).chain([u64::MAX - 1, u64::MAX]).collect();
            let leaves = separators.leaves(&words, |word| word, room, &mut NoProbe);
            let want = words.iter().map(|&word| (word as usize / 10).min(room - 1));
            assert!(leaves.iter().copied().eq(want), "{room}");
        }
    }
}
