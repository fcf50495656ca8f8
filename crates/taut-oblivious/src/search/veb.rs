//! The van Emde Boas layout: the keys as a complete binary tree, cut in half by height again and again.
//!
//! *Problem.* Search with few misses in every level of the memory at once, without knowing the size of any block.
//! *Idea.* Store the upper half of the tree, then the trees below it from left to right, each in the same way. Some cut
//! makes trees that just fit a block, whatever its size, and a walk passes few of them.
//! *Guarantee.* At most 4 log_B n + O(1) blocks a search, 1.5 log_B n + 2 on average over keys; no memory beside the
//! keys, for any n. Any layout that does not know B needs 1.443 log_B n.
//! *Trap.* A single key a node leaves most of a line unused near the leaves: in main memory layouts by lines are faster.
//! *Reference.* H. Prokop, Cache-oblivious algorithms, 1999; Brodal, Fagerberg and Jacob, Cache oblivious search trees via
//! binary trees of small height, SODA 2002 (places by arithmetic); section 5.5 of the thesis.

use super::{SortedIndex, check_sorted};
use crate::layout::VanEmdeBoasOrder;
use crate::pages::Pages;
use crate::{Error, Key, Probe};

/// Sorted keys as a complete binary tree in the van Emde Boas layout.
pub struct VanEmdeBoas<K: Key> {
    words: Pages<K::Word>,
    order: VanEmdeBoasOrder,
}

impl<K: Key> SortedIndex<K> for VanEmdeBoas<K> {
    fn new(sorted: &[K]) -> Result<Self, Error> {
        check_sorted(sorted)?;
        let order = VanEmdeBoasOrder::new(sorted.len());
        let mut pages = Pages::zeroed(sorted.len());
        let words = pages.words_mut();
        order.for_each(|place, node| words[place] = sorted[order.tree().rank_of_node(node)].word());
        Ok(Self { words: pages, order })
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
        let mut walk = self.order.walk();
        let mut next = None;
        while let Some(place) = walk.place() {
            probe.read(&words[place..=place]);
            let right = words[place] < word;
            if !right {
                next = Some(place);
            }
            walk.descend(right);
        }
        let rank = self.order.tree().rank_of_gap(walk.node());
        (rank, next.is_some_and(|place| words[place] == word))
    }
}
