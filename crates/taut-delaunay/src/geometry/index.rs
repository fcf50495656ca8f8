//! Boxes over runs of sites along the Hilbert curve: which sites lie where, without a search structure of its own.
//!
//! Idea: sites are in Hilbert order, so any run of them is compact; boxes over 64 sites, over 8 such boxes, and so on,
//! are an implicit tree.
//! Guarantee: a query visits every run whose box it does not rule out. O(n) to build, about a byte per site.

use std::ops::Range;

use taut_points::OrderBy;
use taut_points::parallel::ParallelSlice;

/// This many sites lie under one leaf: one bit each in a word.
pub(crate) const LEAF_SIZE: usize = 64;
const FAN_OUT_BITS: u32 = 3;
/// Leaves one task measures.
const TASK: usize = 256;

/// A closed box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds<const D: usize> {
    pub(crate) low: [f64; D],
    pub(crate) high: [f64; D],
}

impl<const D: usize> Bounds<D> {
    pub(crate) const EMPTY: Self = Self { low: [f64::INFINITY; D], high: [f64::NEG_INFINITY; D] };

    pub(crate) fn of(points: impl IntoIterator<Item = [f64; D]>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.union(&Self { low: p, high: p }))
    }

    pub(crate) fn union(&self, other: &Self) -> Self {
        Self {
            low: std::array::from_fn(|i| self.low[i].min(other.low[i])),
            high: std::array::from_fn(|i| self.high[i].max(other.high[i])),
        }
    }

    /// Tests whether a point is in the box.
    #[cfg(test)]
    pub(crate) fn holds(&self, p: [f64; D]) -> bool {
        (0..D).all(|i| self.low[i] <= p[i] && p[i] <= self.high[i])
    }

    /// The squared distance of the two boxes; 0 if they meet.
    pub(crate) fn distance_squared(&self, other: &Self) -> f64 {
        (0..D)
            .map(|i| {
                (self.low[i] - other.high[i]).max(other.low[i] - self.high[i]).max(0.0).powi(2)
            })
            .sum()
    }

    /// The squared distance of a point; 0 inside.
    pub(crate) fn distance_squared_to(&self, p: [f64; D]) -> f64 {
        self.distance_squared(&Self { low: p, high: p })
    }
}

/// The boxes, leaves first.
#[derive(Clone)]
pub(crate) struct Index<const D: usize> {
    levels: Vec<Vec<Bounds<D>>>,
    sites: usize,
}

/// A run of sites in the index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Node {
    pub(crate) level: usize,
    pub(crate) place: usize,
}

impl<const D: usize> Index<D> {
    /// The index over sites in Hilbert order.
    pub(crate) fn build(sites: &[[f64; D]]) -> Self {
        let leaves: Vec<Bounds<D>> = sites
            .par_chunks(LEAF_SIZE)
            .with_min_len(TASK)
            .map(|run| Bounds::of(run.iter().copied()))
            .collect();
        let mut levels = vec![leaves];
        while let Some(below) = levels.last().filter(|level| level.len() > 1) {
            let union = |run: &[Bounds<D>]| run.iter().fold(Bounds::EMPTY, |b, c| b.union(c));
            let above = below.chunks(1 << FAN_OUT_BITS).map(union).collect();
            levels.push(above);
        }
        Self { levels, sites: sites.len() }
    }

    pub(crate) fn root(&self) -> Node {
        Node { level: self.levels.len() - 1, place: 0 }
    }

    pub(crate) fn bounds(&self, node: Node) -> &Bounds<D> {
        &self.levels[node.level][node.place]
    }

    /// The sites under a node.
    pub(crate) fn run(&self, node: Node) -> Range<u32> {
        let shift = node.level as u32 * FAN_OUT_BITS;
        let begin = (node.place << shift) * LEAF_SIZE;
        let end = (((node.place + 1) << shift) * LEAF_SIZE).min(self.sites);
        begin as u32..end as u32
    }

    /// The nodes right below; none below a leaf.
    pub(crate) fn children(&self, node: Node) -> impl Iterator<Item = Node> + use<D> {
        let level = node.level.wrapping_sub(1);
        let count = if node.level == 0 { 0 } else { self.levels[level].len() };
        let begin = node.place << FAN_OUT_BITS;
        (begin..count.min(begin + (1 << FAN_OUT_BITS))).map(move |place| Node { level, place })
    }

    /// Visits leaves from about the nearest to `q` to the farthest, as long as `open` does not rule them out.
    pub(crate) fn visit_nearest(
        &self,
        q: [f64; D],
        open: impl Fn(&Self, Node) -> bool,
        mut leaf: impl FnMut(Node),
    ) {
        let mut stack = vec![self.root()];
        while let Some(node) = stack.pop() {
            if !open(self, node) {
                continue;
            }
            if node.level == 0 {
                leaf(node);
                continue;
            }
            let first = stack.len();
            stack.extend(self.children(node));
            let distance = |node: &Node| self.bounds(*node).distance_squared_to(q);
            stack[first..].order_by(&|a, b| distance(b).total_cmp(&distance(a)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_and_boxes_nest_and_cover() {
        let sites: Vec<[f64; 2]> = (0..5000).map(|i| [f64::from(i), f64::from(i % 7)]).collect();
        let index = Index::build(&sites);
        let mut open = vec![index.root()];
        let mut leaves = 0;
        while let Some(node) = open.pop() {
            let run = index.run(node);
            let b = index.bounds(node);
            for i in run.clone() {
                assert_eq!(b.distance_squared_to(sites[i as usize]), 0.0);
            }
            let below: Vec<Node> = index.children(node).collect();
            if below.is_empty() {
                leaves += run.len();
            } else {
                assert_eq!(below.iter().map(|&c| index.run(c).len()).sum::<usize>(), run.len());
            }
            open.extend(below);
        }
        assert_eq!(leaves, 5000);
    }
}
