//! A complete binary tree with a buffer on each edge, as mergers and distributors of k ways have it.
//!
//! *Idea.* Cut the tree of k = 2^h leaves at half its height; the edges in the cut get buffers of about k^(3/2) elements,
//! and the parts are cut again. All lies in the order of the recursion: top part, then each buffer with the part below
//! it. So a part that fits a memory is in few blocks of it.
//! *Guarantee.* Θ(k²) elements in all: S(k) = (√k + 1) S(√k) + √k · capacity(k).
//! *Trap.* Edges are accessed as often as elements: five words of each would take a memory of 512 words for k = 64. Only
//! what changes is kept; where a buffer lies and how long it is follow from a table of few numbers per depth, which like
//! that of the index counts as registers.
//! *Trap.* k need not be a square: capacities come from k^(3/2) rounded up, and the top part is the lower one.

use super::veb::VebIndex;
use super::{get, set};
use crate::Probe;

/// The elements waiting on an edge, and where its buffer lies.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Edge {
    /// The first place of the buffer.
    pub(super) start: usize,
    /// Places of the buffer.
    pub(super) capacity: usize,
    /// The first element that waits.
    pub(super) next: usize,
    /// Behind the last one.
    pub(super) end: usize,
    /// True if no more will come.
    pub(super) done: bool,
}

impl Edge {
    pub(super) fn is_empty(&self) -> bool {
        self.next == self.end
    }

    pub(super) fn len(&self) -> usize {
        self.end - self.next
    }
}

/// The change of an edge, as it lies in memory.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Waiting {
    next: usize,
    /// Twice the end, and one more if no more will come.
    end_done: usize,
}

/// Of the edges at a depth, which lie in one cut: where their buffers are.
#[derive(Clone, Copy, Debug, Default)]
struct Cut {
    /// Depth of the root of the tree that is cut here.
    root: usize,
    /// Places of its top part, which come before the first buffer.
    top: usize,
    /// Places of a buffer.
    capacity: usize,
    /// Places of a buffer and of the part below it.
    stride: usize,
}

/// Edges by the number of the node below them in breadth-first order: 1 is the edge above the root, those from 2^h on
/// have leaves below them.
#[derive(Clone, Debug)]
pub(super) struct BufferTree {
    height: usize,
    index: VebIndex,
    /// In the order of the layout.
    edges: Vec<Waiting>,
    /// By depth. The edges above the root and above the leaves have no buffers.
    cuts: Vec<Cut>,
    /// Places of all buffers together.
    places: usize,
}

impl BufferTree {
    /// For 2^height leaves, less than 2^32; `capacity` says how long the buffers in the middle of a tree of that height
    /// are.
    pub(super) fn new(height: usize, capacity: impl Fn(usize) -> usize) -> Self {
        let index = VebIndex::new(height + 1).expect("fewer than 48 levels");
        let mut cuts = vec![Cut::default(); height + 1];
        let places = cut(&mut cuts, 0, height, &capacity);
        let edges = vec![Waiting::default(); (2 << height) - 1];
        let mut tree = Self { height, index, edges, cuts, places };
        for node in 2..1 << height {
            let start = tree.start(node);
            let position = tree.index.position_of(node);
            tree.edges[position] = Waiting { next: start, end_done: 2 * start };
        }
        tree
    }

    /// The first place of the buffer above a node.
    fn start(&self, mut node: usize) -> usize {
        let mut depth = node.ilog2() as usize;
        let mut start = 0;
        while depth > 0 && depth < self.height {
            let Cut { root, top, stride, .. } = self.cuts[depth];
            let ways = 1 << (depth - root);
            start += top + (node & (ways - 1)) * stride;
            node /= ways;
            depth = root;
            // The part below a buffer comes behind it.
            start += self.cuts[depth].capacity;
        }
        start
    }

    pub(super) fn height(&self) -> usize {
        self.height
    }

    pub(super) fn places(&self) -> usize {
        self.places
    }

    pub(super) fn edges(&self) -> &[Waiting] {
        &self.edges
    }

    pub(super) fn edge<P: Probe>(&self, node: usize, probe: &mut P) -> Edge {
        let Waiting { next, end_done } = get(&self.edges, self.index.position_of(node), probe);
        let capacity = self.cuts[node.ilog2() as usize].capacity;
        Edge { start: self.start(node), capacity, next, end: end_done / 2, done: end_done % 2 > 0 }
    }

    /// Keeps what waits on an edge.
    pub(super) fn set_edge<P: Probe>(&mut self, node: usize, edge: Edge, probe: &mut P) {
        let position = self.index.position_of(node);
        let end_done = 2 * edge.end + usize::from(edge.done);
        set(&mut self.edges, position, Waiting { next: edge.next, end_done }, probe);
    }
}

/// Fills in the table for the tree of `height` levels of nodes with its root at depth `root`; returns its places.
fn cut(cuts: &mut [Cut], root: usize, height: usize, capacity: &impl Fn(usize) -> usize) -> usize {
    if height < 2 {
        return 0;
    }
    let half = height / 2;
    let top = cut(cuts, root, half, capacity);
    let here = capacity(height);
    let stride = here + cut(cuts, root + half, height - half, capacity);
    cuts[root + half] = Cut { root, top, capacity: here, stride };
    top + (stride << half)
}

/// k^(3/2) rounded up, for k = 2^height.
pub(super) fn three_halves(height: usize) -> usize {
    let whole = 1usize << (3 * height / 2);
    if (3 * height).is_multiple_of(2) {
        whole
    } else {
        (whole as f64 * std::f64::consts::SQRT_2).ceil() as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The buffers of a tree by the recursion itself: node and start, in the order of memory; and where they end.
    fn by_recursion(
        root: usize,
        height: usize,
        mut end: usize,
        all: &mut Vec<(usize, usize)>,
    ) -> usize {
        if height < 2 {
            return end;
        }
        let top = height / 2;
        end = by_recursion(root, top, end, all);
        for node in root << top..(root + 1) << top {
            all.push((node, end));
            end = by_recursion(node, height - top, end + three_halves(height), all);
        }
        end
    }

    #[test]
    fn buffers_lie_as_the_recursion_lays_them() {
        for height in 0..=12 {
            let tree = BufferTree::new(height, three_halves);
            let mut all = Vec::new();
            let places = by_recursion(1, height, 0, &mut all);
            assert_eq!(tree.places(), places, "height {height}");
            assert_eq!(all.len(), (1usize << height).saturating_sub(2));
            for (k, &(node, start)) in all.iter().enumerate() {
                let edge = tree.edge(node, &mut crate::NoProbe);
                assert_eq!((edge.start, edge.next, edge.end), (start, start, start));
                let after = all.get(k + 1).map_or(places, |next| next.1);
                assert!(start + edge.capacity <= after, "height {height}, node {node}");
            }
        }
    }
}
