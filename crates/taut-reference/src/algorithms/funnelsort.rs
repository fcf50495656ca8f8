//! Lazy funnelsort: n^(1/3) runs of n^(2/3) elements, merged at once by a tree of two-way mergers.
//!
//! *Problem.* Sort with O((n/B)(1 + log_{M/B}(n/B))) misses without knowing M and B, which no two-way mergesort does.
//! *Idea.* A k-merger is a [tree with buffers](super::buffer_tree) of k^(3/2) elements on its middle edges. FILL(v)
//! fills the buffer above node v: while it is not full, move the smaller head of its two inputs there; an input that
//! ran empty is filled first.
//! *Guarantee.* The optimal number of misses in a tall cache (M ≥ B²); O(n log n) time; stable.
//! *Trap.* Merging into the array one merged from needs a copy per level; two arrays take turns instead.
//! *Reference.* Frigo et al., ACM TALG 8(1), 2012; Brodal and Fagerberg, ICALP 2002 (lazy).

use super::buffer_tree::{BufferTree, Edge, three_halves};
use super::median::insertion_sort;
use super::{get, set};
use crate::{NoProbe, Probe};

/// Up to this many elements are sorted by insertion.
const INSERTION_SORT_MAX: usize = 16;

/// Sorts; equal elements keep their order.
pub fn funnelsort<T: Copy + Ord>(array: &mut [T]) {
    funnelsort_instrumented(array, &mut NoProbe);
}

/// [`funnelsort()`] under a probe.
pub fn funnelsort_instrumented<T: Copy + Ord, P: Probe>(array: &mut [T], probe: &mut P) {
    probe.place(array);
    let mut scratch = array.to_vec();
    probe.place(&scratch);
    sort(array, &mut scratch, true, probe);
    probe.lift(&scratch);
}

/// Sorts what is in `array`, into `array` itself (`stay`) or into `other`; either way both are written to.
fn sort<T: Copy + Ord, P: Probe>(array: &mut [T], other: &mut [T], stay: bool, probe: &mut P) {
    let n = array.len();
    if n <= INSERTION_SORT_MAX {
        insertion_sort(array, probe);
        if !stay {
            for i in 0..n {
                let x = get(array, i, probe);
                set(other, i, x, probe);
            }
        }
        return;
    }
    let height = (n.ilog2() as usize).div_ceil(3);
    let run = n.div_ceil(1 << height);
    for (part, other) in array.chunks_mut(run).zip(other.chunks_mut(run)) {
        sort(part, other, !stay, probe);
    }
    if stay {
        merge(other, array, run, height, probe)
    } else {
        merge(array, other, run, height, probe)
    }
}

/// Merges the runs of `run` elements in `from`, of which there are 2^height at most.
fn merge<T: Copy + Ord, P: Probe>(
    from: &[T],
    to: &mut [T],
    run: usize,
    height: usize,
    probe: &mut P,
) {
    let tree = BufferTree::new(height, three_halves);
    let buffers = vec![from[0]; tree.places()];
    let mut merger = Merger { from, to, tree, buffers };
    probe.place(merger.tree.edges());
    probe.place(&merger.buffers);
    for leaf in 0..1usize << height {
        let (next, end) = ((leaf * run).min(from.len()), ((leaf + 1) * run).min(from.len()));
        let edge = Edge { next, end, done: true, ..Edge::default() };
        merger.tree.set_edge((1 << height) + leaf, edge, probe);
    }
    merger.fill(1, probe);
    probe.lift(&merger.buffers);
    probe.lift(merger.tree.edges());
}

struct Merger<'a, T> {
    from: &'a [T],
    to: &'a mut [T],
    tree: BufferTree,
    buffers: Vec<T>,
}

impl<T: Copy + Ord> Merger<'_, T> {
    /// Fills the buffer above a node, which is empty, or as much of it as there are elements.
    fn fill<P: Probe>(&mut self, node: usize, probe: &mut P) {
        let mut out = self.tree.edge(node, probe);
        if node == 1 {
            out.capacity = self.to.len();
        }
        let mut left = self.tree.edge(2 * node, probe);
        let mut right = self.tree.edge(2 * node + 1, probe);
        (out.next, out.end) = (out.start, out.start);
        while out.len() < out.capacity {
            self.refill(2 * node, &mut left, probe);
            self.refill(2 * node + 1, &mut right, probe);
            let from_left = match (left.is_empty(), right.is_empty()) {
                (true, true) => break,
                (false, false) => {
                    let x = self.head(2 * node, &left, probe);
                    x <= self.head(2 * node + 1, &right, probe)
                }
                (left_is_empty, _) => !left_is_empty,
            };
            let (child, edge) =
                if from_left { (2 * node, &mut left) } else { (2 * node + 1, &mut right) };
            let x = self.head(child, edge, probe);
            edge.next += 1;
            if node == 1 {
                set(self.to, out.end, x, probe);
            } else {
                set(&mut self.buffers, out.end, x, probe);
            }
            out.end += 1;
        }
        out.done = out.len() < out.capacity;
        self.tree.set_edge(2 * node, left, probe);
        self.tree.set_edge(2 * node + 1, right, probe);
        self.tree.set_edge(node, out, probe);
    }

    fn refill<P: Probe>(&mut self, node: usize, edge: &mut Edge, probe: &mut P) {
        if edge.is_empty() && !edge.done {
            self.fill(node, probe);
            *edge = self.tree.edge(node, probe);
        }
    }

    /// The first element that waits above a node.
    fn head<P: Probe>(&self, node: usize, edge: &Edge, probe: &mut P) -> T {
        let leaf = node >> self.tree.height() != 0;
        get(if leaf { self.from } else { &self.buffers }, edge.next, probe)
    }
}
