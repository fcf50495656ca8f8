//! Searches from places: nearest, k nearest, within a distance, farthest.
//!
//! *Trap.* Loops, not `map` and `collect`: what these call is compiled without the vectors of the processor.

use std::collections::BinaryHeap;

use super::batch::Work;
use super::collect::{Candidate, Farthest, Nearest, NearestHeap, Within};
use super::dim::Dim;
use super::measure::Measure;
use super::nodes::NO_ROW;
use super::traverse::search;
use super::{Neighbor, SphereSearch};

fn neighbor<M: Measure>(key: M::Key, row: u32) -> Neighbor {
    Neighbor { row: u64::from(row), distance: M::distance(key) }
}

fn sorted<M: Measure>(mut found: Vec<Candidate<M::Key>>) -> Vec<Neighbor> {
    found.sort_unstable();
    found.into_iter().map(|found| neighbor::<M>(found.key, found.row)).collect()
}

/// The nearest row to each place.
pub(super) struct FindNearest;

impl Work for FindNearest {
    type Found = Neighbor;

    #[inline(always)]
    fn run<D: Dim, M: Measure>(
        &self,
        tree: &SphereSearch,
        dim: D,
        queries: &[&[f64]],
    ) -> Vec<Neighbor> {
        let mut stack = vec![];
        let mut all = Vec::with_capacity(queries.len());
        for place in queries {
            let mut found = Nearest { key: M::ABOVE_ALL, row: NO_ROW };
            search::<D, M, false>(&tree.nodes, dim, place, &mut stack, &mut found);
            all.push(neighbor::<M>(found.key, found.row));
        }
        all
    }
}

/// The k nearest rows to each place.
pub(super) struct FindNearestK(pub(super) usize);

impl Work for FindNearestK {
    type Found = Vec<Neighbor>;

    #[inline(always)]
    fn run<D: Dim, M: Measure>(
        &self,
        tree: &SphereSearch,
        dim: D,
        queries: &[&[f64]],
    ) -> Vec<Vec<Neighbor>> {
        let mut stack = vec![];
        let mut all = Vec::with_capacity(queries.len());
        for place in queries {
            let heap = BinaryHeap::with_capacity(self.0);
            let mut found = NearestHeap { heap, k: self.0 };
            search::<D, M, false>(&tree.nodes, dim, place, &mut stack, &mut found);
            all.push(sorted::<M>(found.heap.into_vec()));
        }
        all
    }
}

/// All rows within a distance of each place.
pub(super) struct FindWithin(pub(super) f64);

impl Work for FindWithin {
    type Found = Vec<Neighbor>;

    #[inline(always)]
    fn run<D: Dim, M: Measure>(
        &self,
        tree: &SphereSearch,
        dim: D,
        queries: &[&[f64]],
    ) -> Vec<Vec<Neighbor>> {
        let mut stack = vec![];
        let limit = M::limit(self.0);
        let mut all = Vec::with_capacity(queries.len());
        for place in queries {
            let mut found = Within::<M> { limit, found: vec![] };
            search::<D, M, false>(&tree.nodes, dim, place, &mut stack, &mut found);
            all.push(sorted::<M>(found.found));
        }
        all
    }
}

/// The farthest row from each place, or one that is nearly as far: 1 + ε is given.
pub(super) struct FindFarthest(pub(super) f64);

impl Work for FindFarthest {
    type Found = Neighbor;

    #[inline(always)]
    fn run<D: Dim, M: Measure>(
        &self,
        tree: &SphereSearch,
        dim: D,
        queries: &[&[f64]],
    ) -> Vec<Neighbor> {
        let mut stack = vec![];
        let mut all = Vec::with_capacity(queries.len());
        for place in queries {
            let (factor, distance) = (self.0, M::distance as fn(M::Key) -> f64);
            let mut found = Farthest { key: M::BELOW_ALL, row: NO_ROW, factor, distance };
            search::<D, M, true>(&tree.nodes, dim, place, &mut stack, &mut found);
            all.push(neighbor::<M>(found.key, found.row));
        }
        all
    }
}
