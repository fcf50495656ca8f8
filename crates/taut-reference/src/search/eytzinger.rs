//! The Eytzinger layout: the keys as a complete binary tree in breadth-first order.
//!
//! Idea: node k has the children 2k and 2k + 1, so no places are stored and a walk is two instructions a level. The
//! eight descendants of k three levels down share the line 8k, which is asked for as k is read: whatever the walk
//! decides, the line it needs is on its way.
//! Guarantee: ⌊log₂ n⌋ + 1 comparisons; no memory beside the keys.
//! Reference: P.-V. Khuong and P. Morin, Array layouts for comparison-based searching, ACM J. Exp. Algorithmics 22, 2017.

use super::complete::CompleteTree;
use super::{SortedIndex, check_sorted};
use crate::Pages;
use crate::prefetch;
use crate::{Error, Key, Probe, Word};

/// Sorted keys as a complete binary tree in breadth-first order.
pub struct Eytzinger<K: Key> {
    /// Place 0 is not used, so that the children of k start the even place 2k.
    words: Pages<K::Word>,
    tree: CompleteTree,
}

impl<K: Key> SortedIndex<K> for Eytzinger<K> {
    fn new(sorted: &[K]) -> Result<Self, Error> {
        check_sorted(sorted)?;
        let tree = CompleteTree::new(sorted.len());
        let mut words = Pages::zeroed(sorted.len() + 1);
        for (node, word) in words.words_mut().iter_mut().enumerate().skip(1) {
            *word = sorted[tree.rank_of_node(node)].word();
        }
        Ok(Self { words, tree })
    }

    fn len(&self) -> usize {
        self.tree.len()
    }

    fn place<P: Probe>(&self, probe: &mut P) {
        probe.place(self.words.words());
    }

    #[inline]
    fn rank_of_word<P: Probe>(&self, word: K::Word, probe: &mut P) -> (usize, bool) {
        let words = self.words.words();
        let mut node = 1;
        while node < words.len() {
            prefetch(words, node * K::Word::LANES);
            probe.read(&words[node..=node]);
            node = 2 * node + usize::from(words[node] < word);
        }
        let next = CompleteTree::node_above_gap(node);
        (self.tree.rank_of_gap(node), next != 0 && words[next] == word)
    }
}
