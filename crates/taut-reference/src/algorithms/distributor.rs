//! The k-distributor: k³ elements in, k buckets out, and O((k³/B) log_M k + k) misses.
//!
//! *Problem.* Deal elements to k intervals with few misses, without knowing M and B and with k too large for one block of
//! each bucket to fit.
//! *Idea.* A [tree with buffers](super::buffer_tree) on its edges, a merger run backwards: a top √k-distributor, middle
//! buffers, and √k bottom √k-distributors. Two ways to run it ([`DistributorForm`]).
//! *Guarantee.* At most 4k² + O(k) words; stable: a bucket holds its elements in the order of the input; O(k³ log k) time.
//! *Trap.* In the end buffers are partly full: they must be emptied from the top down, which the thesis says in one sentence. The
//! recursive form does so after each call, so that a buffer that was at most half full never overflows.
//! *Trap.* A bottom distributor takes all its buffer has, so that buffers need not be circular.
//! *Trap.* How long buckets become is not known before: they are chains of pieces of n/k elements.
//! *Reference.* The thesis, 6.1, lemma 6.1.1; Brodal and Fagerberg, ICALP 2002 (the unfolded form, of mergers).

use super::buckets::Buckets;
use super::buffer_tree::{BufferTree, Edge, Waiting, three_halves};
use super::get;
use super::set;
use super::veb::VebIndex;
use crate::{Error, NoProbe, Probe};

/// k for n = 2⁴² elements, whose buffers have some 10⁹ words.
const BUCKETS_MAX: usize = 1 << 14;

/// The way in which elements flow down a [`Distributor`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DistributorForm {
    /// By the definition: k^(3/2) elements go through the top distributor at a time into middle buffers of twice that
    /// length; then each bottom distributor whose buffer is more than half full is run.
    Recursive,
    /// Each node deals what waits above it until an edge below is full; then the node below that edge is run. Middle
    /// buffers have k^(3/2) elements.
    Unfolded,
}

/// Deals elements to the intervals between splitters.
#[derive(Clone, Debug)]
pub struct Distributor<T> {
    form: DistributorForm,
    /// Where the left of a node ends, in the order of the layout; nobody asks nodes beyond the last bound.
    bounds: Vec<T>,
    /// States whether elements that equal the bound of a node belong to the left.
    up_to: Vec<bool>,
    index: VebIndex,
    tree: BufferTree,
    buckets: usize,
}

impl<T: Copy + Ord> Distributor<T> {
    /// For k − 1 splitters in ascending order: bucket j gets the elements that are at least splitter j − 1 and smaller
    /// than splitter j.
    ///
    /// # Errors
    /// [`Error::Option`] if the splitters do not ascend, or are 2¹⁴ or more: buffers grow with their square.
    pub fn new(splitters: &[T], form: DistributorForm) -> Result<Self, Error> {
        if splitters.len() >= BUCKETS_MAX {
            return Err(Error::Option {
                name: "splitters",
                value: format!("{} splitters", splitters.len()),
                expected: "fewer than 16384, as buffers grow with their square",
            });
        }
        if let Some(place) = splitters.windows(2).position(|pair| pair[0] > pair[1]) {
            return Err(Error::Option {
                name: "splitters",
                value: format!("descending from splitter {place} to splitter {}", place + 1),
                expected: "splitters in ascending order",
            });
        }
        Ok(Self::between(splitters, |_| false, form))
    }

    /// For ascending bounds; `up_to` says of which one equal elements lie before it.
    pub(super) fn between(
        sorted: &[T],
        up_to: impl Fn(usize) -> bool,
        form: DistributorForm,
    ) -> Self {
        let buckets = sorted.len() + 1;
        let height = buckets.next_power_of_two().ilog2() as usize;
        let index = VebIndex::new(height).expect("fewer splitters than memory has bytes");
        let nodes = sorted.first().map_or(0, |_| (1 << height) - 1);
        let mut bounds: Vec<T> = sorted.iter().copied().cycle().take(nodes).collect();
        let mut are_up_to = vec![false; nodes];
        for node in 1..1usize << height {
            let k = in_order(node, height);
            if let Some(&bound) = sorted.get(k) {
                let position = index.position_of(node);
                (bounds[position], are_up_to[position]) = (bound, up_to(k));
            }
        }
        let tree = match form {
            DistributorForm::Recursive => BufferTree::new(height, |h| 2 * three_halves(h)),
            DistributorForm::Unfolded => BufferTree::new(height, three_halves),
        };
        Self { form, bounds, up_to: are_up_to, index, tree, buckets }
    }

    /// k, the number of buckets.
    pub fn buckets(&self) -> usize {
        self.buckets
    }

    /// Words of all its arrays, an element counted as one.
    pub fn words(&self) -> usize {
        let edge = size_of::<Waiting>() / size_of::<usize>();
        let flags = self.up_to.len().div_ceil(size_of::<usize>());
        self.tree.places() + edge * self.tree.edges().len() + self.bounds.len() + flags
    }

    /// Deals the elements of `input` to the buckets.
    pub fn distribute(&self, input: &[T]) -> Buckets<T> {
        self.distribute_instrumented(input, &mut NoProbe)
    }

    /// [`Self::distribute`] under a probe. The arrays of the answer stay announced, for those who read it; its drop is
    /// theirs to tell, by [`Buckets::lift`].
    pub fn distribute_instrumented<P: Probe>(&self, input: &[T], probe: &mut P) -> Buckets<T> {
        let height = self.tree.height();
        let mut flow = Flow {
            distributor: self,
            input,
            tree: self.tree.clone(),
            buffers: input.first().map_or_else(Vec::new, |&x| vec![x; self.tree.places()]),
            buckets: Buckets::new(input, 1 << height),
        };
        probe.place(input);
        probe.place(&self.bounds);
        probe.place(&self.up_to);
        probe.place(flow.tree.edges());
        probe.write(flow.tree.edges());
        probe.place(&flow.buffers);
        flow.buckets.place(probe);
        flow.tree.set_edge(1, Edge { end: input.len(), ..Edge::default() }, probe);
        if height == 0 {
            for i in 0..input.len() {
                let x = get(input, i, probe);
                flow.buckets.push(0, x, probe);
            }
        } else {
            match self.form {
                DistributorForm::Recursive => flow.invoke(1, height, input.len(), probe),
                DistributorForm::Unfolded => flow.flush(1, probe),
            }
        }
        probe.lift(&flow.buffers);
        probe.lift(flow.tree.edges());
        probe.lift(&self.up_to);
        probe.lift(&self.bounds);
        flow.buckets.truncate(self.buckets);
        flow.buckets
    }
}

/// Returns how many bounds of a tree of 2^height leaves lie before that of a node.
fn in_order(node: usize, height: usize) -> usize {
    let depth = node.ilog2() as usize;
    ((2 * (node - (1 << depth)) + 1) << (height - 1 - depth)) - 1
}

/// A distributor at work.
struct Flow<'a, T> {
    distributor: &'a Distributor<T>,
    input: &'a [T],
    tree: BufferTree,
    buffers: Vec<T>,
    buckets: Buckets<T>,
}

impl<T: Copy + Ord> Flow<'_, T> {
    /// Runs the part of 2^height ways below `root` on the next `count` elements that wait above it. Those all leave it,
    /// and nothing stays within.
    fn invoke<P: Probe>(&mut self, root: usize, height: usize, mut count: usize, probe: &mut P) {
        if height == 1 {
            self.deal(root, count, probe);
            return;
        }
        let (top, half) = (height / 2, three_halves(height));
        let middle = root << top..(root + 1) << top;
        while count > 0 {
            let batch = count.min(half);
            self.invoke(root, top, batch, probe);
            count -= batch;
            for node in middle.clone() {
                let waiting = self.tree.edge(node, probe).len();
                if waiting > half {
                    self.invoke(node, height - top, waiting, probe);
                }
            }
        }
        for node in middle {
            let waiting = self.tree.edge(node, probe).len();
            if waiting > 0 {
                self.invoke(node, height - top, waiting, probe);
            }
        }
    }

    /// Empties the edge above a node and all below, from the top down.
    fn flush<P: Probe>(&mut self, node: usize, probe: &mut P) {
        if self.is_leaf(node) {
            return;
        }
        self.deal(node, usize::MAX, probe);
        self.flush(2 * node, probe);
        self.flush(2 * node + 1, probe);
    }

    fn is_leaf(&self, node: usize) -> bool {
        node >> self.tree.height() != 0
    }

    /// The basic distributor: deals the next `count` elements above a node, or as many as there are, to the two edges
    /// below; an edge that is full is emptied by the node below it.
    fn deal<P: Probe>(&mut self, node: usize, count: usize, probe: &mut P) {
        let Distributor { index, bounds, up_to, buckets, .. } = self.distributor;
        // Of a number of buckets that is no power of two, the last nodes have nothing on their right.
        let position = index.position_of(node);
        let is_idle = in_order(node, self.tree.height()) + 1 >= *buckets;
        let bound = if is_idle { None } else { Some(get(bounds, position, probe)) };
        let mut above = self.tree.edge(node, probe);
        let leaves = self.is_leaf(2 * node);
        let mut below = [Edge::default(); 2];
        if !leaves {
            below = [self.tree.edge(2 * node, probe), self.tree.edge(2 * node + 1, probe)];
        }
        for _ in 0..count.min(above.len()) {
            let source = if node == 1 { self.input } else { &self.buffers };
            let x = get(source, above.next, probe);
            above.next += 1;
            let is_right =
                bound.is_some_and(|bound| x > bound || x == bound && !get(up_to, position, probe));
            let side = usize::from(is_right);
            let (child, edge) = (2 * node + side, &mut below[side]);
            if leaves {
                self.buckets.push(child - (1 << self.tree.height()), x, probe);
                continue;
            }
            set(&mut self.buffers, edge.end, x, probe);
            edge.end += 1;
            if edge.end == edge.start + edge.capacity
                && self.distributor.form == DistributorForm::Unfolded
            {
                self.tree.set_edge(child, *edge, probe);
                self.deal(child, usize::MAX, probe);
                *edge = self.tree.edge(child, probe);
            }
        }
        if above.is_empty() {
            (above.next, above.end) = (above.start, above.start);
        }
        self.tree.set_edge(node, above, probe);
        if !leaves {
            self.tree.set_edge(2 * node, below[0], probe);
            self.tree.set_edge(2 * node + 1, below[1], probe);
        }
    }
}
