//! The S+ tree: sorted keys under a static B+-tree whose nodes are lines of memory, searched in batches.
//!
//! *Problem.* Of n sorted keys, how many are smaller than q, for many q, at the rate at which memory delivers lines.
//! *Idea.* The keys, filled up to whole lines, are the leaves; a node above has B keys in one line and B + 1 children;
//! key j is the largest of child j, so that the leaf reached holds the answer. Levels are arrays, children are found by
//! counting. In a batch, groups of four walk the cached levels together, and wait some groups before each of the last
//! two levels, whose lines are on their way meanwhile.
//! *Guarantee.* One line of memory a level, ⌈log₉ ⌈n/8⌉⌉ + 1 levels of 64-bit keys, 1/8 more memory than the keys.
//! *Trap.* The largest word fills up, and is a key like any other: it is never smaller than q, so filling is not counted,
//! and no walk leaves the tree. Prefetches belong into the second cache, see `lanes`.
//! *Reference.* R. Groot Koerkamp, Static search trees: 40× faster than binary search, 2024; after S. Slotin, 2021.

use super::lanes::{Count, Portable};
use super::{SortedIndex, sorted_words};
use crate::{Error, Key, Level, Pages, Probe, Word, prefetch};

/// This many searches walk together.
const GROUP_SIZE: usize = 4;
/// Groups between the prefetch of a line and its use.
///
/// In batches among 2²⁴ words, with 1, 2, 4, 16 and 32 of them a search took 3.2, 1.6, 1.1, 1 and 1.1 times as long as with 8
/// (AVX-512, EPYC).
const PREFETCH_GROUPS: usize = 8;
/// The lines of this many levels above the leaves are waited for, as they are outside the near caches.
const WAITED_LEVELS: usize = 2;
/// More levels than any array that fits a memory has.
const LEVELS_MAX: usize = 24;

/// Sorted keys under a static B+-tree of lines: the fastest index, above all for batches.
pub struct SPlusTree<K: Key> {
    words: Pages<K::Word>,
    /// The first word of each level, the root's first.
    starts: [usize; LEVELS_MAX],
    /// Levels, the leaves counted.
    levels: usize,
    len: usize,
}

impl<K: Key> SortedIndex<K> for SPlusTree<K> {
    /// O(n); memory for 9/8 of the keys of 64 bits, 17/16 of those of 32.
    fn new(sorted: &[K]) -> Result<Self, Error> {
        let lanes = K::Word::LANES;
        let mut counts = vec![sorted.len().div_ceil(lanes).max(1)];
        while let Some(&count) = counts.last().filter(|&&count| count > 1) {
            counts.push(count.div_ceil(lanes + 1));
        }
        counts.reverse();
        let levels = counts.len();
        let mut starts = [0; LEVELS_MAX];
        for level in 1..levels {
            starts[level] = starts[level - 1] + counts[level - 1] * lanes;
        }
        let leaves = starts[levels - 1];
        let mut pages = Pages::zeroed(leaves + counts[levels - 1] * lanes);
        let (inner, leaf) = pages.words_mut().split_at_mut(leaves);
        sorted_words(sorted, leaf)?;
        leaf[sorted.len()..].fill(K::Word::MAX);
        // Keys below one child of a node of the level at hand.
        let mut span = lanes;
        for level in (0..levels - 1).rev() {
            let nodes = &mut inner[starts[level]..][..counts[level] * lanes];
            for (node, line) in nodes.chunks_exact_mut(lanes).enumerate() {
                for (j, key) in line.iter_mut().enumerate() {
                    let child = node * (lanes + 1) + j;
                    let last_child = child + 1 >= counts[level + 1];
                    *key = if last_child { K::Word::MAX } else { leaf[(child + 1) * span - 1] };
                }
            }
            span *= lanes + 1;
        }
        Ok(Self { words: pages, starts, levels, len: sorted.len() })
    }

    fn len(&self) -> usize {
        self.len
    }

    fn place<P: Probe>(&self, probe: &mut P) {
        probe.place(self.words.words());
    }

    #[inline]
    fn rank_of_word<P: Probe>(&self, word: K::Word, probe: &mut P) -> (usize, bool) {
        let rank = self.tree().rank(word, probe);
        let leaf = &self.words.words()[self.starts[self.levels - 1]..];
        (rank, rank < self.len && leaf[rank] == word)
    }

    fn ranks_of_words<P: Probe>(
        &self,
        keys: &[K],
        word: impl Fn(K) -> K::Word + Copy,
        ranks: &mut [usize],
        probe: &mut P,
    ) {
        self.tree().ranks(Level::best(), keys, word, ranks, probe);
    }
}

impl<K: Key> SPlusTree<K> {
    fn tree(&self) -> Tree<'_, K::Word> {
        Tree {
            words: self.words.words(),
            starts: &self.starts[..self.levels],
            last: K::Word::LANES,
        }
    }
}

/// The arrays that a search reads.
///
/// The kernels rely on this: `words` starts a line, each level holds whole lines, and child `node * (LANES + 1) + count`
/// of a node exists for any count of smaller keys, as keys from the last child on are the largest word.
#[derive(Clone, Copy)]
pub(crate) struct Tree<'a, W> {
    words: &'a [W],
    /// The first word of each level, the root's first.
    starts: &'a [usize],
    /// The stride between the nodes of the last level: words of a line where these are ranks, one more
    /// where they are children.
    last: usize,
}

impl<'a, W: Word> Tree<'a, W> {
    /// A tree whose last level leads to children that are elsewhere.
    ///
    /// # Safety
    /// As [`Tree`] says; there is one level at least.
    #[allow(unsafe_code, reason = "the invariants that the vector kernels rely on")]
    pub(crate) unsafe fn of_inner_levels(words: &'a [W], starts: &'a [usize]) -> Self {
        Self { words, starts, last: W::LANES + 1 }
    }

    /// One search.
    #[inline]
    #[allow(unsafe_code, reason = "dispatch of a vector kernel")]
    pub(crate) fn rank<P: Probe>(self, word: W, probe: &mut P) -> usize {
        match Level::best() {
            #[cfg(target_arch = "x86_64")]
            Level::Avx512(_) => {
                // SAFETY: the value proves that the processor has AVX-512F and POPCNT.
                unsafe { self.rank_avx512(word, probe) }
            }
            #[cfg(target_arch = "x86_64")]
            Level::Avx2(_) => {
                // SAFETY: the value proves that the processor has AVX2 and POPCNT.
                unsafe { self.rank_avx2(word, probe) }
            }
            _ => self.rank_by::<Portable, P>(word, probe),
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,popcnt")]
    fn rank_avx512<P: Probe>(self, word: W, probe: &mut P) -> usize {
        self.rank_by::<super::lanes::Avx512, P>(word, probe)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,popcnt")]
    fn rank_avx2<P: Probe>(self, word: W, probe: &mut P) -> usize {
        self.rank_by::<super::lanes::Avx2, P>(word, probe)
    }

    #[inline(always)]
    fn rank_by<C: Count<W>, P: Probe>(self, word: W, probe: &mut P) -> usize {
        let mut node = 0;
        for &start in &self.starts[..self.starts.len() - 1] {
            node = node * (W::LANES + 1) + self.count::<C, P>(start, node, word, probe);
        }
        let leaves = self.starts[self.starts.len() - 1];
        node * self.last + self.count::<C, P>(leaves, node, word, probe)
    }

    /// Keys of a node that are smaller than `word`; the level of the node starts at `start`.
    #[inline(always)]
    #[allow(unsafe_code, reason = "a vector kernel")]
    fn count<C: Count<W>, P: Probe>(
        self,
        start: usize,
        node: usize,
        word: W,
        probe: &mut P,
    ) -> usize {
        let first = start + node * W::LANES;
        if P::IS_RECORDING {
            probe.read(&self.words[first..first + W::LANES]);
        }
        debug_assert!(first + W::LANES <= self.words.len());
        // SAFETY: the node exists (see `Tree`); `C` is `Portable`, or is named in a function alone that has its instructions
        // enabled and is entered with their proof.
        unsafe { C::below(self.words, first, word) }
    }

    /// Many searches.
    #[allow(unsafe_code, reason = "dispatch of a vector kernel")]
    pub(crate) fn ranks<K: Copy, P: Probe>(
        self,
        level: Level,
        keys: &[K],
        word: impl Fn(K) -> W + Copy,
        ranks: &mut [usize],
        probe: &mut P,
    ) {
        match level {
            #[cfg(target_arch = "x86_64")]
            Level::Avx512(_) => {
                // SAFETY: the value proves that the processor has AVX-512F and POPCNT.
                unsafe { self.ranks_avx512(keys, word, ranks, probe) }
            }
            #[cfg(target_arch = "x86_64")]
            Level::Avx2(_) => {
                // SAFETY: the value proves that the processor has AVX2 and POPCNT.
                unsafe { self.ranks_avx2(keys, word, ranks, probe) }
            }
            _ => self.ranks_by::<Portable, K, P>(keys, word, ranks, probe),
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f,popcnt")]
    fn ranks_avx512<K: Copy, P: Probe>(
        self,
        keys: &[K],
        word: impl Fn(K) -> W + Copy,
        ranks: &mut [usize],
        probe: &mut P,
    ) {
        self.ranks_by::<super::lanes::Avx512, K, P>(keys, word, ranks, probe);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2,popcnt")]
    fn ranks_avx2<K: Copy, P: Probe>(
        self,
        keys: &[K],
        word: impl Fn(K) -> W + Copy,
        ranks: &mut [usize],
        probe: &mut P,
    ) {
        self.ranks_by::<super::lanes::Avx2, K, P>(keys, word, ranks, probe);
    }

    /// Group g enters the tree in step g and takes each of the last levels PREFETCH_GROUPS steps later; between its steps its nodes
    /// are kept where its ranks will be.
    #[inline(always)]
    fn ranks_by<C: Count<W>, K: Copy, P: Probe>(
        self,
        keys: &[K],
        word: impl Fn(K) -> W + Copy,
        ranks: &mut [usize],
        probe: &mut P,
    ) {
        // Keys and ranks of one place, also where one of the slices is longer.
        let answered = keys.len().min(ranks.len());
        let (keys, ranks) = (&keys[..answered], &mut ranks[..answered]);
        let (groups, rest) = keys.as_chunks::<GROUP_SIZE>();
        let (rank_groups, rank_rest) = ranks.as_chunks_mut::<GROUP_SIZE>();
        let inner = self.starts.len() - 1;
        let (near, waited) = self.starts.split_at(inner - WAITED_LEVELS.min(inner));
        for step in 0..groups.len() + PREFETCH_GROUPS * waited.len() {
            // The group farthest down first: its lines have been waited for longest.
            for (i, &start) in waited.iter().enumerate().rev() {
                let Some(group) = step.checked_sub(PREFETCH_GROUPS * (i + 1)) else { continue };
                let (Some(keys), Some(nodes)) = (groups.get(group), rank_groups.get_mut(group))
                else {
                    continue;
                };
                match waited.get(i + 1) {
                    Some(&next) => {
                        for k in 0..GROUP_SIZE {
                            let count = self.count::<C, P>(start, nodes[k], word(keys[k]), probe);
                            nodes[k] = nodes[k] * (W::LANES + 1) + count;
                            prefetch(self.words, next + nodes[k] * W::LANES);
                        }
                    }
                    None => {
                        for k in 0..GROUP_SIZE {
                            let count = self.count::<C, P>(start, nodes[k], word(keys[k]), probe);
                            nodes[k] = nodes[k] * self.last + count;
                        }
                    }
                }
            }
            let (Some(keys), Some(nodes)) = (groups.get(step), rank_groups.get_mut(step)) else {
                continue;
            };
            let mut walk = [0; GROUP_SIZE];
            for &start in near {
                for k in 0..GROUP_SIZE {
                    let count = self.count::<C, P>(start, walk[k], word(keys[k]), probe);
                    walk[k] = walk[k] * (W::LANES + 1) + count;
                }
            }
            for k in 0..GROUP_SIZE {
                prefetch(self.words, waited[0] + walk[k] * W::LANES);
            }
            *nodes = walk;
        }
        for (&key, rank) in rest.iter().zip(rank_rest) {
            *rank = self.rank_by::<C, P>(word(key), probe);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NoProbe;

    #[test]
    fn batches_are_the_same_with_all_instructions() {
        for n in
            [0usize, 1, 9, 73, 8, 72, 5000, 60_000].into_iter().take(if cfg!(miri) { 4 } else { 8 })
        {
            let sorted: Vec<u64> = (0..n as u64).map(|i| i / 3 * 7).collect();
            let tree = SPlusTree::new(&sorted).unwrap();
            let keys: Vec<u64> = (0..if cfg!(miri) { 99 } else { 999u64 })
                .map(|i| i * 7919 % (3 * n as u64 + 9))
                .chain([u64::MAX])
                .collect();
            let want: Vec<usize> =
                keys.iter().map(|&key| sorted.partition_point(|&other| other < key)).collect();
            for level in Level::all() {
                let mut ranks = vec![0; keys.len()];
                tree.tree().ranks(level, &keys, |key| key, &mut ranks, &mut NoProbe);
                assert_eq!(ranks, want, "{level:?} {n}");
            }
        }
    }
}
