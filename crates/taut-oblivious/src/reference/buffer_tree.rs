//! A complete binary tree with a buffer on each edge, as mergers and distributors of k ways have it.
//!
//! *Idea.* Cut the tree of k = 2^h leaves at half its height; the edges in the cut get buffers of about k^(3/2) elements,
//! and the parts are cut again. All lies in the order of the recursion: top part, then each buffer with the part below
//! it. So a part that fits a memory is in few blocks of it.
//! *Guarantee.* Θ(k²) elements in all: S(k) = (√k + 1) S(√k) + √k · capacity(k).
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
    /// Whether no more will come.
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

/// Edges by the number of the node below them in breadth-first order: 1 is the edge above the root, those from 2^h on
/// have leaves below them.
#[derive(Clone, Debug)]
pub(super) struct BufferTree {
    height: usize,
    index: VebIndex,
    /// In the order of the layout.
    edges: Vec<Edge>,
    /// Places of all buffers together.
    places: usize,
}

impl BufferTree {
    /// For 2^height leaves, less than 2^32; `capacity` says how long the buffers in the middle of a tree of that height
    /// are. The edges above the root and above the leaves have none.
    pub(super) fn new(height: usize, capacity: impl Fn(usize) -> usize) -> Self {
        let index = VebIndex::new(height + 1).expect("fewer than 48 levels");
        let edges = vec![Edge::default(); (2 << height) - 1];
        let mut tree = Self { height, index, edges, places: 0 };
        tree.lay(1, height, &capacity);
        tree
    }

    fn lay(&mut self, root: usize, height: usize, capacity: &impl Fn(usize) -> usize) {
        if height < 2 {
            return;
        }
        let top = height / 2;
        self.lay(root, top, capacity);
        for node in root << top..(root + 1) << top {
            let (start, capacity_here) = (self.places, capacity(height));
            self.places += capacity_here;
            let edge = &mut self.edges[self.index.position_of(node)];
            *edge = Edge { start, capacity: capacity_here, next: start, end: start, done: false };
            self.lay(node, height - top, capacity);
        }
    }

    pub(super) fn height(&self) -> usize {
        self.height
    }

    pub(super) fn places(&self) -> usize {
        self.places
    }

    pub(super) fn edges(&self) -> &[Edge] {
        &self.edges
    }

    pub(super) fn edge<P: Probe>(&self, node: usize, probe: &mut P) -> Edge {
        get(&self.edges, self.index.position_of(node), probe)
    }

    pub(super) fn set_edge<P: Probe>(&mut self, node: usize, edge: Edge, probe: &mut P) {
        let position = self.index.position_of(node);
        set(&mut self.edges, position, edge, probe);
    }
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
