//! Where the nodes of a binary tree are put in memory: kd-trees, trees of bounding volumes, search trees.
//!
//! *Problem.* A tree is two arrays of children. Its nodes are to be stored so that walks from the root access few blocks.
//! *Idea.* The van Emde Boas order, cut by the heights of the subtrees at hand, so that trees that are not balanced are
//! cut in half too; or blocks of a given number of nodes, each a subtree grown by breadth from its root.
//! *Guarantee.* A permutation of the nodes, the root first; O(n) time, and no deeper recursion than log₂ of the height,
//! so a tree that is one long path is no danger.
//! *Trap.* Arrays of children can hold anything: a node with two parents or none, a circle. All nodes are checked to hang
//! under one root before anything is moved.

use crate::Error;

/// Stands in an array of children for no child.
pub const NONE: u32 = u32::MAX;

/// An order of the nodes of a binary tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TreeOrder {
    /// A node, all below its left child, all below its right child.
    PreOrder,
    /// By depth, then from left to right.
    BreadthFirst,
    /// The upper half of the levels, then the trees below from left to right, each in this order.
    VanEmdeBoas,
    /// Connected blocks, each filled by breadth from its root; a block comes before those below it, these from left to
    /// right.
    Blocked {
        /// Nodes of a block, at least 1.
        nodes: usize,
    },
}

/// A tree in its new order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Permuted {
    /// The former number of each node; the root is first.
    pub order: Vec<u32>,
    /// The new number of the left child of each node, or [`NONE`].
    pub left: Vec<u32>,
    /// The new number of the right child of each node, or [`NONE`].
    pub right: Vec<u32>,
}

/// Puts a binary tree in another order.
///
/// Node i has the children `left[i]` and `right[i]`, or [`NONE`]; the one node that is nobody's child is the root. What
/// else belongs to node `order[k]` goes to place k. O(n).
///
/// ```
/// use taut_oblivious::layout::{NONE, TreeOrder, permute};
/// //      2
/// //    0   3
/// //  1
/// let laid = permute(&[1, NONE, 0, NONE], &[NONE, NONE, 3, NONE], TreeOrder::BreadthFirst)?;
/// assert_eq!(laid.order, [2, 0, 3, 1]);
/// assert_eq!(laid.left, [1, 3, NONE, NONE]);
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
///
/// # Errors
/// [`Error::Tree`] if the arrays are not those of one tree; [`Error::Option`] if a block is to have no nodes.
pub fn permute(left: &[u32], right: &[u32], order: TreeOrder) -> Result<Permuted, Error> {
    let preorder = preorder_checked(left, right)?;
    let order = match order {
        TreeOrder::PreOrder => preorder,
        TreeOrder::BreadthFirst => breadth_first(left, right, preorder.first().copied()),
        TreeOrder::VanEmdeBoas => van_emde_boas(left, right, &preorder),
        TreeOrder::Blocked { nodes: 0 } => {
            return Err(Error::Option {
                name: "nodes",
                value: "0".to_owned(),
                expected: "at least one node in a block",
            });
        }
        TreeOrder::Blocked { nodes } => blocked(left, right, preorder.first().copied(), nodes),
    };
    let mut number = vec![NONE; order.len()];
    for (new, &old) in (0u32..).zip(&order) {
        number[old as usize] = new;
    }
    let renumbered = |children: &[u32]| {
        let child = |&old: &u32| match children[old as usize] {
            NONE => NONE,
            child => number[child as usize],
        };
        order.iter().map(child).collect()
    };
    let (left, right) = (renumbered(left), renumbered(right));
    Ok(Permuted { order, left, right })
}

fn children(left: &[u32], right: &[u32], node: u32) -> impl DoubleEndedIterator<Item = u32> {
    [left[node as usize], right[node as usize]].into_iter().filter(|&child| child != NONE)
}

/// The nodes in pre-order, if the arrays are those of one tree.
fn preorder_checked(left: &[u32], right: &[u32]) -> Result<Vec<u32>, Error> {
    let wrong = |node: usize, reason| Err(Error::Tree { node: node as u64, reason });
    let len = left.len();
    if right.len() != len {
        return wrong(len.min(right.len()), "has one of two children arrays only");
    }
    if u32::try_from(len).is_err() {
        return wrong(u32::MAX as usize, "is one more than 32 bits can number");
    }
    let mut is_child = vec![false; len];
    for node in 0..len {
        for child in children(left, right, node as u32) {
            match is_child.get_mut(child as usize) {
                None => return wrong(node, "has a child that does not exist"),
                Some(seen) if *seen => return wrong(child as usize, "is a child twice"),
                Some(seen) => *seen = true,
            }
        }
    }
    let Some(root) = is_child.iter().position(|&child| !child) else {
        return if len == 0 { Ok(Vec::new()) } else { wrong(0, "is on a circle") };
    };
    let (mut order, mut open) = (Vec::with_capacity(len), vec![root as u32]);
    while let Some(node) = open.pop() {
        order.push(node);
        open.extend(children(left, right, node).rev());
    }
    if order.len() < len {
        // No node is a child twice, so what the root does not reach has another root or is a circle.
        is_child.fill(false);
        for &node in &order {
            is_child[node as usize] = true;
        }
        let other = is_child.iter().position(|&reached| !reached).unwrap_or(len);
        return wrong(other, "cannot be reached from the first root");
    }
    Ok(order)
}

fn breadth_first(left: &[u32], right: &[u32], root: Option<u32>) -> Vec<u32> {
    let mut order: Vec<u32> = root.into_iter().collect();
    let mut next = 0;
    while let Some(&node) = order.get(next) {
        order.extend(children(left, right, node));
        next += 1;
    }
    order
}

fn van_emde_boas(left: &[u32], right: &[u32], preorder: &[u32]) -> Vec<u32> {
    let mut height = vec![1u32; left.len()];
    for &node in preorder.iter().rev() {
        let below = children(left, right, node).map(|child| height[child as usize]).max();
        height[node as usize] = 1 + below.unwrap_or(0);
    }
    let mut tree = Cut { left, right, height: &height, order: Vec::with_capacity(left.len()) };
    if let Some(&root) = preorder.first() {
        tree.lay(root, u32::MAX, &mut Vec::new());
    }
    tree.order
}

/// A tree that is being cut.
struct Cut<'a> {
    left: &'a [u32],
    right: &'a [u32],
    /// Levels of the tree under each node.
    height: &'a [u32],
    order: Vec<u32>,
}

impl Cut<'_> {
    /// Lays the first `levels` levels under `root`, and adds the nodes right below them to `below`.
    fn lay(&mut self, root: u32, levels: u32, below: &mut Vec<u32>) {
        let levels = levels.min(self.height[root as usize]);
        if levels == 1 {
            self.order.push(root);
            below.extend(children(self.left, self.right, root));
            return;
        }
        let mut middle = Vec::new();
        self.lay(root, levels / 2, &mut middle);
        for node in middle {
            self.lay(node, levels - levels / 2, below);
        }
    }
}

fn blocked(left: &[u32], right: &[u32], root: Option<u32>, nodes: usize) -> Vec<u32> {
    let mut order = Vec::with_capacity(left.len());
    let mut roots: Vec<u32> = root.into_iter().collect();
    while let Some(root) = roots.pop() {
        // The block is filled like a queue; what is in the queue when it is full are the roots of others.
        let start = order.len();
        order.push(root);
        let (mut next, mut full) = (start, Vec::new());
        while next < order.len() {
            for child in children(left, right, order[next]) {
                if order.len() - start < nodes { order.push(child) } else { full.push(child) }
            }
            next += 1;
        }
        full.reverse();
        roots.append(&mut full);
    }
    order
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const ORDERS: [TreeOrder; 6] = [
        TreeOrder::PreOrder,
        TreeOrder::BreadthFirst,
        TreeOrder::VanEmdeBoas,
        TreeOrder::Blocked { nodes: 1 },
        TreeOrder::Blocked { nodes: 3 },
        TreeOrder::Blocked { nodes: 1000 },
    ];

    /// A random tree: each node hangs at a free place of an earlier one; numbers are shuffled by `turn`.
    fn grown(picks: &[(usize, bool)], turn: usize) -> (Vec<u32>, Vec<u32>) {
        let len = picks.len() + 1;
        let number = |node: usize| ((node + turn) % len) as u32;
        let (mut left, mut right) = (vec![NONE; len], vec![NONE; len]);
        for (node, &(pick, to_right)) in (1..).zip(picks) {
            let mut parent = pick % node;
            let mut to_right = to_right;
            loop {
                let side = if to_right { &mut right } else { &mut left };
                let place = &mut side[number(parent) as usize];
                if *place == NONE {
                    *place = number(node);
                    break;
                }
                // Occupied: go down there.
                parent = (*place as usize + len - turn % len) % len;
                to_right = !to_right;
            }
        }
        (left, right)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 3 } else { 256 }))]
        #[test]
        fn every_order_is_the_same_tree(
            picks in prop::collection::vec((0usize..1000, any::<bool>()), 0..60),
            turn in 0usize..60,
        ) {
            let (left, right) = grown(&picks, turn);
            for order in ORDERS {
                let laid = permute(&left, &right, order).unwrap();
                let mut sorted = laid.order.clone();
                sorted.sort_unstable();
                prop_assert!(sorted.iter().copied().eq(0..left.len() as u32), "{order:?}");
                for (new, &old) in laid.order.iter().enumerate() {
                    for (ours, theirs) in [(&laid.left, &left), (&laid.right, &right)] {
                        let child = ours[new];
                        let back = if child == NONE { NONE } else { laid.order[child as usize] };
                        prop_assert_eq!(back, theirs[old as usize]);
                    }
                }
            }
        }
    }

    /// Children of the complete tree of n nodes, numbered by breadth from 0.
    fn complete(len: u32) -> (Vec<u32>, Vec<u32>) {
        let child = |child: u32| if child < len { child } else { NONE };
        ((0..len).map(|i| child(2 * i + 1)).collect(), (0..len).map(|i| child(2 * i + 2)).collect())
    }

    /// Lays out the complete tree of `height` levels under `root`, numbered by breadth from 1.
    fn by_definition(root: u32, height: u32, nodes: &mut Vec<u32>) {
        if height == 1 {
            nodes.push(root - 1);
            return;
        }
        let top = height / 2;
        by_definition(root, top, nodes);
        for below in root << top..(root + 1) << top {
            by_definition(below, height - top, nodes);
        }
    }

    #[test]
    fn full_trees_are_laid_as_by_the_definition() {
        for len in [1, 3, 7, 15, 127, 1023].into_iter().filter(|&len| !cfg!(miri) || len < 100) {
            let (left, right) = complete(len);
            let laid = permute(&left, &right, TreeOrder::VanEmdeBoas).unwrap();
            let mut nodes = Vec::new();
            by_definition(1, (len + 1).ilog2(), &mut nodes);
            assert_eq!(laid.order, nodes);
        }
        let (left, right) = complete(15);
        let laid = permute(&left, &right, TreeOrder::Blocked { nodes: 3 }).unwrap();
        assert_eq!(laid.order, [0, 1, 2, 3, 7, 8, 4, 9, 10, 5, 11, 12, 6, 13, 14]);
    }

    #[test]
    fn a_long_path_and_no_tree_at_all() {
        let len = if cfg!(miri) { 200 } else { 100_000 };
        let left: Vec<u32> = (1..len).chain([NONE]).collect();
        for order in ORDERS {
            let laid = permute(&left, &vec![NONE; len as usize], order).unwrap();
            assert!(laid.order.iter().copied().eq(0..len), "{order:?}");
            assert!(permute(&[], &[], order).unwrap().order.is_empty());
        }
    }

    #[test]
    fn what_is_not_a_tree_is_named() {
        let node = |left: &[u32], right: &[u32]| match permute(left, right, TreeOrder::PreOrder) {
            Err(Error::Tree { node, .. }) => node,
            other => panic!("{other:?}"),
        };
        assert_eq!(node(&[NONE, NONE], &[NONE]), 1);
        assert_eq!(node(&[5], &[NONE]), 0);
        assert_eq!(node(&[1, NONE], &[1, NONE]), 1);
        assert_eq!(node(&[0], &[NONE]), 0);
        assert_eq!(node(&[1, 0], &[NONE, NONE]), 0);
        assert_eq!(node(&[NONE, NONE], &[NONE, NONE]), 1);
        assert_eq!(node(&[NONE, 2, 1], &[NONE; 3]), 1);
        let none = TreeOrder::Blocked { nodes: 0 };
        assert!(matches!(permute(&[NONE], &[NONE], none), Err(Error::Option { .. })));
    }
}
