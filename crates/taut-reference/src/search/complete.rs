//! The complete binary tree over n sorted keys: levels full but the last, which is filled from the left.

/// The shape of a complete binary tree, nodes numbered from 1 by breadth: node k has the children 2k and 2k + 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct CompleteTree {
    len: usize,
    /// Levels.
    height: u32,
    /// Nodes of the last level.
    last: usize,
}

impl CompleteTree {
    /// The tree of `len` nodes.
    pub(super) fn new(len: usize) -> Self {
        let height = usize::BITS - len.leading_zeros();
        let above = (1usize << height.saturating_sub(1)) - 1;
        Self { len, height, last: len - above.min(len) }
    }

    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Returns how many nodes come before `node` in the order of keys.
    ///
    /// # Panics
    /// If the tree has no such node: they are numbered from 1.
    pub(super) fn rank_of_node(&self, node: usize) -> usize {
        assert!((1..=self.len).contains(&node), "there is no node {node} of {}", self.len);
        let depth = node.ilog2();
        // Among the nodes of a tree with a full last level, every other of which is on that level.
        let full = ((2 * (node - (1 << depth)) + 1) << (self.height - 1 - depth)) - 1;
        full - full.div_ceil(2).saturating_sub(self.last)
    }

    /// Returns how many keys are before the gap at which a walk ends that left the tree at `node`, a missing child.
    #[inline(always)]
    pub(super) fn rank_of_gap(&self, node: usize) -> usize {
        let below = 1 << self.height;
        // A gap on the last level itself is to the right of all nodes there.
        if node >= below { node - below } else { node - below / 2 + self.last }
    }

    /// The node whose key follows the gap at which a walk ends that left the tree at `node`; 0 if none does.
    #[inline(always)]
    pub(super) fn node_above_gap(node: usize) -> usize {
        node >> (node.trailing_ones() + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes in the order of their keys.
    fn in_order(len: usize, node: usize, out: &mut Vec<usize>) {
        if node <= len {
            in_order(len, 2 * node, out);
            out.push(node);
            in_order(len, 2 * node + 1, out);
        }
    }

    #[test]
    fn ranks_are_those_of_a_walk_through_the_tree() {
        for len in 0..=if cfg!(miri) { 20 } else { 130 } {
            let tree = CompleteTree::new(len);
            let mut order = Vec::new();
            in_order(len, 1, &mut order);
            for (rank, &node) in order.iter().enumerate() {
                assert_eq!(tree.rank_of_node(node), rank, "{len} {node}");
            }
            for gap in 0..=len {
                let mut node = 1;
                while node <= len {
                    node = 2 * node + usize::from(tree.rank_of_node(node) < gap);
                }
                assert_eq!(tree.rank_of_gap(node), gap, "{len}");
                let above = CompleteTree::node_above_gap(node);
                assert_eq!(above, order.get(gap).copied().unwrap_or(0), "{len}");
            }
        }
    }
}
