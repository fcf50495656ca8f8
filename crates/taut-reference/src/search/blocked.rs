//! A van Emde Boas layout whose cuts are those of the machine: lines of 64 bytes, pages of 4 KiB, large pages of 2 MiB.
//!
//! *Problem.* Behind a cold cache, in a mapped file above all, the pages that a search accesses cost more than its lines.
//! *Idea.* A static B+-tree of lines, of which a page holds three levels: a root of 7 children, with 8 children each,
//! which is 1 + 7 + 7 · 8 = 64 lines. With 8 keys a line a page has 56 · 9 = 504 pages below it, and 1 + 504 pages are
//! within the 512 of a large page: six levels.
//! *Guarantee.* One page for each factor 504 of n, one large page for each factor 504²; 8/7 of the memory of the keys.
//! *Trap.* Cuts are counted from the leaves up, or the last page of each walk would hold one level.

use super::{SortedIndex, check_sorted};
use crate::Pages;
use crate::{Error, Key, Probe, Word};

/// The first line of a page has this many children.
const FIRST_CHILDREN: usize = 7;
/// Each line of the second level of a page has this many children.
const SECOND_CHILDREN: usize = 8;
/// The third level of a page has this many lines.
const THIRD_LINES: usize = FIRST_CHILDREN * SECOND_CHILDREN;
/// A page has this many lines.
const PAGE_LINES: usize = 1 + FIRST_CHILDREN + THIRD_LINES;
/// More levels of pages than any array that fits a memory has.
const LEVELS_MAX: usize = 9;

/// Sorted keys under a static B+-tree whose lines are grouped to pages, and those to large pages.
pub struct BlockedVanEmdeBoas<K: Key> {
    words: Pages<K::Word>,
    levels: [Level; LEVELS_MAX],
    /// Levels of pages.
    depth: usize,
    len: usize,
}

/// Where the pages of one level are.
#[derive(Clone, Copy, Default)]
struct Level {
    /// The first page of the pair of levels that share large pages.
    first: usize,
    /// True if pages of this level follow the page above them in its group.
    below: bool,
    /// True if the level has a group for each of its pages.
    heads: bool,
}

impl Level {
    /// The number in memory of page `page` of the level, for pages with `exits` pages below them.
    #[inline(always)]
    fn page(self, page: usize, exits: usize) -> usize {
        let group = (1 + exits).next_power_of_two();
        if self.below {
            self.first + page / exits * group + 1 + page % exits
        } else if self.heads {
            self.first + page * group
        } else {
            self.first + page
        }
    }
}

impl<K: Key> BlockedVanEmdeBoas<K> {
    /// Words of a page.
    const PAGE: usize = PAGE_LINES * K::Word::LANES;
    /// Pages below a page.
    const PAGE_CHILDREN: usize = THIRD_LINES * (K::Word::LANES + 1);
}

impl<K: Key> SortedIndex<K> for BlockedVanEmdeBoas<K> {
    /// O(n); memory for 1.17 times the keys, and for a page at least.
    fn new(sorted: &[K]) -> Result<Self, Error> {
        check_sorted(sorted)?;
        let lanes = K::Word::LANES;
        let mut counts = vec![sorted.len().div_ceil(lanes).max(1).div_ceil(THIRD_LINES)];
        while let Some(&count) = counts.last().filter(|&&count| count > 1) {
            counts.push(count.div_ceil(Self::PAGE_CHILDREN));
        }
        counts.reverse();
        let depth = counts.len();
        let (mut levels, mut pages) = ([Level::default(); LEVELS_MAX], 0);
        let mut level = 0;
        while level < depth {
            let pair = (depth - level).is_multiple_of(2);
            levels[level] = Level { first: pages, below: false, heads: pair };
            let mut last = levels[level].page(counts[level] - 1, Self::PAGE_CHILDREN);
            if pair {
                levels[level + 1] = Level { first: pages, below: true, heads: false };
                last = last.max(levels[level + 1].page(counts[level + 1] - 1, Self::PAGE_CHILDREN));
                level += 1;
            }
            pages = last + 1;
            level += 1;
        }
        let mut built =
            Self { words: Pages::zeroed(pages * Self::PAGE), levels, depth, len: sorted.len() };
        // Leaves below one line of the third level.
        let mut span = 1;
        for level in (0..depth).rev() {
            for page in 0..counts[level] {
                built.fill_page(sorted, level, page, span);
            }
            span *= Self::PAGE_CHILDREN;
        }
        Ok(built)
    }

    fn len(&self) -> usize {
        self.len
    }

    fn place<P: Probe>(&self, probe: &mut P) {
        probe.place(self.words.words());
    }

    #[inline]
    fn rank_of_word<P: Probe>(&self, word: K::Word, probe: &mut P) -> (usize, bool) {
        let lanes = K::Word::LANES;
        let words = self.words.words();
        // The third line that the search reads in page `page` of a level, its number in the level and its count.
        let mut walk = |level: usize, page: usize| {
            let start = self.levels[level].page(page, Self::PAGE_CHILDREN) * Self::PAGE;
            let mut count = |line: usize| {
                let line = &words[start + line * lanes..][..lanes];
                probe.read(line);
                (line, line.iter().map(|&other| usize::from(other < word)).sum::<usize>())
            };
            let first = count(0).1;
            let third = first * SECOND_CHILDREN + count(1 + first).1;
            let (line, smaller) = count(1 + FIRST_CHILDREN + third);
            (line, page * THIRD_LINES + third, smaller)
        };
        let mut page = 0;
        for level in 0..self.depth - 1 {
            let (_, line, smaller) = walk(level, page);
            page = line * (lanes + 1) + smaller;
        }
        let (leaf, line, smaller) = walk(self.depth - 1, page);
        let rank = line * lanes + smaller;
        (rank, rank < self.len && leaf.get(smaller).is_some_and(|&other| other == word))
    }
}

impl<K: Key> BlockedVanEmdeBoas<K> {
    /// Writes the lines of one page; `span` leaves are below each line of its third level.
    fn fill_page(&mut self, sorted: &[K], level: usize, page: usize, span: usize) {
        let lanes = K::Word::LANES;
        let leaves = sorted.len().div_ceil(lanes);
        // The largest key before leaf `end`, or the largest word if there is no such leaf.
        let before = |end: usize| match sorted.get((end * lanes).wrapping_sub(1)) {
            Some(key) if end < leaves => key.word(),
            _ => K::Word::MAX,
        };
        let start = self.levels[level].page(page, Self::PAGE_CHILDREN) * Self::PAGE;
        let words = &mut self.words.words_mut()[start..][..Self::PAGE];
        words.fill(K::Word::MAX);
        let (first, rest) = words.split_at_mut(lanes);
        let (second, third) = rest.split_at_mut(FIRST_CHILDREN * lanes);
        let line = page * THIRD_LINES;
        for (j, key) in first.iter_mut().enumerate().take(FIRST_CHILDREN - 1) {
            *key = before((line + (j + 1) * SECOND_CHILDREN) * span);
        }
        for (i, keys) in second.chunks_exact_mut(lanes).enumerate() {
            for (j, key) in keys.iter_mut().enumerate().take(SECOND_CHILDREN - 1) {
                *key = before((line + i * SECOND_CHILDREN + j + 1) * span);
            }
        }
        for (i, keys) in third.chunks_exact_mut(lanes).enumerate() {
            if level + 1 == self.depth {
                let leaf = sorted.get((line + i) * lanes..).unwrap_or_default();
                for (key, from) in keys.iter_mut().zip(leaf) {
                    *key = from.word();
                }
            } else {
                let child = span / (lanes + 1);
                for (j, key) in keys.iter_mut().enumerate() {
                    *key = before((line + i) * span + (j + 1) * child);
                }
            }
        }
    }
}
