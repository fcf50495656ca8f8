//! A complete search tree in the layout of van Emde Boas, by the recursion itself and by index arithmetic.
//!
//! *Problem.* Find a key among n with few misses, whatever B is.
//! *Idea.* Cut the tree of height h at half its height: the top tree of height ⌊h/2⌋ comes first, then its 2^⌊h/2⌋ bottom
//! trees of height ⌈h/2⌉, each laid out in the same way. At some depth of that recursion trees fit a block.
//! *Guarantee.* At most 4 log_B n + 2 misses for any key, and at most 1.5 log_B n + 2 in the mean over all paths, for
//! every height up to 26 and every B from 8 to 4096 (measured); 1.443 log_B n is the least that a layout without B can
//! promise.
//! *Trap.* A position follows from those of its ancestors at one depth only; without the three tables per depth one
//! would walk the recursion for each node.
//! *Reference.* Prokop, *Cache-oblivious algorithms*, MIT 1999; Brodal, Fagerberg, Jacob, SODA 2002 (the arithmetic);
//! Bender et al., *The cost of cache-oblivious searching*, Algorithmica 61, 2011 (the constant).

use super::get;
use crate::{Error, NoProbe, Probe};

/// Where a node of a complete tree lies, from tables of three numbers per depth.
#[derive(Clone, Debug)]
pub struct VebIndex {
    depths: Vec<Depth>,
}

/// Of the recursion step whose bottom trees have their roots at this depth.
#[derive(Clone, Copy, Debug, Default)]
struct Depth {
    /// Nodes of the top tree, 2^t − 1.
    top: usize,
    /// Nodes of one bottom tree.
    bottom: usize,
    /// Depth of the root of the top tree.
    root: usize,
}

impl VebIndex {
    /// For trees of `height` levels, at most 48.
    ///
    /// # Errors
    /// [`Error::Option`] for higher ones.
    pub fn new(height: usize) -> Result<Self, Error> {
        if height > 48 {
            return Err(Error::Option {
                name: "height",
                value: height.to_string(),
                expected: "at most 48 levels",
            });
        }
        let mut depths = vec![Depth::default(); height];
        split(&mut depths, 0, height);
        Ok(Self { depths })
    }

    /// Levels of the tree.
    pub fn height(&self) -> usize {
        self.depths.len()
    }

    /// The position of the child at `depth` whose number in breadth-first order is `node` (1 for the root, 2i and 2i + 1
    /// for the children of i), given the positions of its ancestors by depth.
    ///
    /// # Panics
    /// If `depth` is not that of a node, or fewer positions than that are given.
    #[inline]
    pub fn position(&self, node: usize, depth: usize, ancestors: &[usize]) -> usize {
        if depth == 0 {
            return 0;
        }
        let Depth { top, bottom, root } = self.depths[depth];
        ancestors[root] + top + (node & top) * bottom
    }

    /// The same from the number alone, in O(log height) steps.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn position_of(&self, node: usize) -> usize {
        let mut depth = node.ilog2() as usize;
        let mut node = node;
        let mut position = 0;
        while depth > 0 {
            let Depth { top, bottom, root } = self.depths[depth];
            position += top + (node & top) * bottom;
            node >>= depth - root;
            depth = root;
        }
        position
    }
}

/// Fills in the tables for the tree of `height` levels with its root at depth `root`.
fn split(depths: &mut [Depth], root: usize, height: usize) {
    if height < 2 {
        return;
    }
    let (top, bottom) = (height / 2, height.div_ceil(2));
    depths[root + top] = Depth { top: (1 << top) - 1, bottom: (1 << bottom) - 1, root };
    split(depths, root, top);
    split(depths, root + top, bottom);
}

/// The positions of all nodes by the recursion of the definition; entry 0 is not used, the root has number 1.
#[cfg(test)]
fn by_recursion(height: usize) -> Vec<usize> {
    fn lay(order: &mut [usize], root: usize, height: usize, next: &mut usize) {
        if height == 1 {
            order[root] = *next;
            *next += 1;
        } else if height > 1 {
            let top = height / 2;
            lay(order, root, top, next);
            for leaf in 0..1 << top {
                lay(order, (root << top) + leaf, height - top, next);
            }
        }
    }
    let mut order = vec![0; 1 << height];
    lay(&mut order, 1, height, &mut 0);
    order
}

/// Sorted keys as a complete search tree in this layout.
#[derive(Clone, Debug)]
pub struct VebTree<K> {
    index: VebIndex,
    nodes: Vec<K>,
    keys: usize,
}

impl<K: Copy + Ord> VebTree<K> {
    /// Takes keys in ascending order; the last is repeated until the tree is complete.
    ///
    /// # Errors
    /// [`Error::Option`] if the keys do not ascend.
    pub fn new(sorted: &[K]) -> Result<Self, Error> {
        if let Some(place) = sorted.windows(2).position(|pair| pair[0] > pair[1]) {
            return Err(Error::Option {
                name: "sorted",
                value: format!("descending from key {place} to key {}", place + 1),
                expected: "keys in ascending order",
            });
        }
        let height = (usize::BITS - sorted.len().leading_zeros()) as usize;
        let index = VebIndex::new(height)?;
        let mut nodes = vec![None; (1 << height) - 1];
        for node in 1..1usize << height {
            let depth = node.ilog2();
            let in_order = (2 * (node - (1 << depth)) + 1) << (height - 1 - depth as usize);
            nodes[index.position_of(node)] = sorted.get(in_order - 1).or(sorted.last()).copied();
        }
        Ok(Self { index, nodes: nodes.into_iter().flatten().collect(), keys: sorted.len() })
    }

    /// Returns how many keys are smaller than `key`.
    pub fn lower_bound(&self, key: K) -> usize {
        self.lower_bound_instrumented(key, &mut NoProbe)
    }

    /// [`Self::lower_bound`] under a probe, to which [`Self::nodes`] should be announced before the first search. The
    /// tables of the index are not told: they are of the size of a stack frame.
    pub fn lower_bound_instrumented<P: Probe>(&self, key: K, probe: &mut P) -> usize {
        let mut positions = [0; usize::BITS as usize];
        let mut node = 1;
        for depth in 0..self.index.height() {
            positions[depth] = self.index.position(node, depth, &positions);
            node = 2 * node + usize::from(get(&self.nodes, positions[depth], probe) < key);
        }
        (node - (1 << self.index.height())).min(self.keys)
    }

    /// The keys in the order of the layout.
    pub fn nodes(&self) -> &[K] {
        &self.nodes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn arithmetic_equals_the_recursion() {
        for height in 0..=if cfg!(miri) { 7 } else { 16 } {
            let order = by_recursion(height);
            let index = VebIndex::new(height).expect("not too high");
            let mut positions = [0; 16];
            let mut seen = vec![false; order.len()];
            for node in 1..order.len() {
                let depth = node.ilog2() as usize;
                for above in 0..depth {
                    positions[above] = order[node >> (depth - above)];
                }
                assert_eq!(index.position(node, depth, &positions), order[node]);
                assert_eq!(index.position_of(node), order[node]);
                assert!(!std::mem::replace(&mut seen[order[node]], true));
            }
        }
        assert!(VebIndex::new(49).is_err());
    }

    #[test]
    fn the_layout_of_height_four_is_that_of_the_book() {
        assert_eq!(by_recursion(4)[1..], [0, 1, 2, 3, 6, 9, 12, 4, 5, 7, 8, 10, 11, 13, 14]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 4 } else { 256 }))]
        #[test]
        fn search_equals_that_in_the_sorted_array(
            mut keys in prop::collection::vec(0u32..60, 0..140),
            wanted in 0u32..62,
        ) {
            keys.sort_unstable();
            let tree = VebTree::new(&keys).expect("sorted");
            prop_assert_eq!(tree.lower_bound(wanted), keys.partition_point(|&k| k < wanted));
        }
    }

    #[test]
    fn keys_out_of_order_are_refused() {
        assert!(VebTree::new(&[1, 3, 2]).is_err());
        assert_eq!(VebTree::<u8>::new(&[]).expect("sorted").lower_bound(3), 0);
    }
}
