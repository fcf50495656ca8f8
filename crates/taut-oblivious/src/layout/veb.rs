//! The van Emde Boas order of a complete binary tree: by its recursion, and by arithmetic along a walk.
//!
//! *Recursion.* A tree of height h > 1 is its upper ⌊h/2⌋ levels, then the trees of ⌈h/2⌉ levels below those from left to
//! right, each in this order.
//! *Arithmetic.* Each depth d > 0 is the top of the lower trees of exactly one cut, namely one in trees whose roots have a
//! depth D(d) < d. If T(d) nodes are above the cut and B(d) in each tree below, the i-th of these starts T(d) + i·B(d)
//! places after the root of the tree that is cut, which the walk has passed.
//! *Trap.* Where the last level is not full, the trees below a cut differ in size: the nodes of the last level before a
//! tree are counted by themselves. So any n is stored without gaps.
//! *Reference.* Brodal, Fagerberg and Jacob, SODA 2002; section 5.5 of the thesis, figure 44.

use super::CompleteTree;

/// More levels than any tree that fits a memory has.
const HEIGHT_MAX: usize = 48;

/// The cut whose lower trees have their roots at some depth.
#[derive(Clone, Copy, Debug, Default)]
struct Cut {
    /// The depth of the root of the tree that is cut, D.
    root: usize,
    /// Nodes above the cut, T, one less than a power of two.
    top: usize,
    /// Nodes of a tree below, B, without those on the last level of the whole tree if that level may not be full.
    bottom: usize,
    /// Whether trees below have nodes on that level.
    last: bool,
}

/// The van Emde Boas order of the complete binary tree of n nodes.
#[derive(Clone, Debug)]
pub struct VanEmdeBoasOrder {
    tree: CompleteTree,
    cuts: [Cut; HEIGHT_MAX],
}

impl VanEmdeBoasOrder {
    /// The order of the tree of `len` nodes. O(log n).
    ///
    /// # Panics
    /// If `len` is 2⁴⁸ or more.
    pub fn new(len: usize) -> Self {
        let tree = CompleteTree::new(len);
        let height = tree.height() as usize;
        assert!(height <= HEIGHT_MAX, "{len} nodes are more than any memory holds");
        let mut cuts = [Cut::default(); HEIGHT_MAX];
        // Trees still to be cut: the depth of their roots, and their height.
        let mut open = vec![(0, height)];
        while let Some((root, levels)) = open.pop() {
            if levels < 2 {
                continue;
            }
            let top = levels / 2;
            let last = root + levels == height;
            cuts[root + top] = Cut {
                root,
                top: (1 << top) - 1,
                bottom: (1 << (levels - top - usize::from(last))) - 1,
                last,
            };
            open.extend([(root, top), (root + top, levels - top)]);
        }
        Self { tree, cuts }
    }

    /// The tree that is ordered.
    pub fn tree(&self) -> CompleteTree {
        self.tree
    }

    /// Calls `visit(place, node)` for all places in their order, by the recursion. O(n).
    pub fn for_each(&self, mut visit: impl FnMut(usize, usize)) {
        let mut place = 0;
        self.lay(1, self.tree.height(), &mut |node| {
            visit(place, node);
            place += 1;
        });
    }

    /// Visits the tree of height `levels` under `root`.
    fn lay(&self, root: usize, levels: u32, visit: &mut impl FnMut(usize)) {
        if root > self.tree.len() || levels == 0 {
            return;
        }
        if levels == 1 {
            visit(root);
            return;
        }
        let top = levels / 2;
        self.lay(root, top, visit);
        for below in root << top..(root + 1) << top {
            self.lay(below, levels - top, visit);
        }
    }

    /// A walk from the root down.
    #[inline]
    pub fn walk(&self) -> Walk<'_> {
        Walk { order: self, node: 1, depth: 0, places: [0; HEIGHT_MAX + 1] }
    }

    /// The place of a node; none if there is no such node. O(log n).
    pub fn place_of_node(&self, node: usize) -> Option<usize> {
        let depth = node.checked_ilog2()?;
        let mut walk = self.walk();
        for level in (0..depth).rev() {
            walk.place()?;
            walk.descend(node >> level & 1 == 1);
        }
        walk.place()
    }
}

/// A walk from the root of a tree down, which knows the place of the node it is at.
#[derive(Clone, Debug)]
pub struct Walk<'a> {
    order: &'a VanEmdeBoasOrder,
    node: usize,
    depth: usize,
    /// The places of the nodes passed, by depth.
    places: [usize; HEIGHT_MAX + 1],
}

impl Walk<'_> {
    /// The number of the node, by breadth from 1.
    #[inline(always)]
    pub fn node(&self) -> usize {
        self.node
    }

    /// The place of the node in memory; none once the walk has left the tree.
    #[inline(always)]
    pub fn place(&self) -> Option<usize> {
        (self.node <= self.order.tree.len()).then(|| self.places[self.depth])
    }

    /// Steps to a child; stays where it is once it has left the tree.
    #[inline(always)]
    pub fn descend(&mut self, right: bool) {
        let tree = &self.order.tree;
        if self.node > tree.len() {
            return;
        }
        self.node = 2 * self.node + usize::from(right);
        self.depth += 1;
        if self.node > tree.len() {
            return;
        }
        let cut = &self.order.cuts[self.depth];
        let in_level = self.node - (1 << self.depth);
        let tree_below = in_level & cut.top;
        let mut place = self.places[cut.root] + cut.top + tree_below * cut.bottom;
        if cut.last {
            // Nodes of the last level before this tree, from the first tree of the cut on.
            let levels_below = tree.height() as usize - 1 - self.depth;
            let before = |below: usize| (below << levels_below).min(tree.last());
            place += before(in_level) - before(in_level - tree_below);
        }
        self.places[self.depth] = place;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arithmetic_is_the_recursion_for_any_number_of_nodes() {
        for len in (0..=600).chain([1023, 1024, 1025, 5000]).filter(|&len| !cfg!(miri) || len < 34)
        {
            let order = VanEmdeBoasOrder::new(len);
            let mut next = 0;
            order.for_each(|place, node| {
                assert_eq!(place, next);
                assert_eq!(order.place_of_node(node), Some(place), "{len} {node}");
                next += 1;
            });
            assert_eq!(next, len);
            assert_eq!(order.place_of_node(0), None);
            assert_eq!(order.place_of_node(len + 1), None);
        }
    }

    #[test]
    fn four_levels_are_those_of_the_thesis() {
        let mut nodes = Vec::new();
        VanEmdeBoasOrder::new(15).for_each(|_, node| nodes.push(node));
        assert_eq!(nodes, [1, 2, 3, 4, 8, 9, 5, 10, 11, 6, 12, 13, 7, 14, 15]);
    }

    /// Blocks of `block` places that walks to random leaves of a tree of height h pass, on average.
    fn blocks_passed(order: &VanEmdeBoasOrder, block: usize) -> f64 {
        let height = order.tree().height();
        let mut state = 1u64;
        let (walks, mut passed) = (if cfg!(miri) { 5 } else { 300 }, 0);
        for _ in 0..walks {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let (mut walk, mut seen) = (order.walk(), Vec::new());
            for level in 0..height {
                let block = walk.place().unwrap() / block;
                if !seen.contains(&block) {
                    seen.push(block);
                }
                walk.descend(state >> (63 - level) & 1 == 1);
            }
            passed += seen.len();
        }
        passed as f64 / f64::from(walks)
    }

    /// Stated in the head of `search::veb`; the trees need no memory, as places are arithmetic.
    #[test]
    fn walks_pass_few_blocks_of_any_size() {
        for height in (1..=26).step_by(if cfg!(miri) { 5 } else { 1 }) {
            let order = VanEmdeBoasOrder::new((1 << height) - 1);
            for log_block in (3..=12).step_by(if cfg!(miri) { 4 } else { 1 }) {
                let passed = blocks_passed(&order, 1 << log_block);
                let bound = 1.5 * f64::from(height) / f64::from(log_block) + 2.0;
                assert!(passed <= bound, "height {height}, B = 2^{log_block}: {passed} > {bound}");
            }
        }
    }
}
