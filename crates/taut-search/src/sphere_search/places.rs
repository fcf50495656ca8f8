//! Searches from places: nearest, k nearest, within a distance, farthest.

use std::collections::BinaryHeap;

use super::batch::{Query, Work};
use super::collect::{Candidate, Farthest, Nearest, NearestHeap, Within};
use super::dim::Dim;
use super::measure::Measure;
use super::nodes::NO_ROW;
use super::traverse::{Frames, Search};
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
    type Kept<M: Measure> = Frames<M>;

    #[inline(always)]
    fn answer<D: Dim, M: Measure>(
        &self,
        tree: &SphereSearch,
        dim: D,
        Query { values: place, home }: Query<'_>,
        frames: &mut Frames<M>,
    ) -> Neighbor {
        let mut found = Nearest { key: M::ABOVE_ALL, row: NO_ROW };
        Search { nodes: &tree.nodes, dim, place }.near(home, frames, &mut found);
        neighbor::<M>(found.key, found.row)
    }
}

/// The k nearest rows to each place.
pub(super) struct FindNearestK(pub(super) usize);

impl Work for FindNearestK {
    type Found = Vec<Neighbor>;
    type Kept<M: Measure> = Frames<M>;

    #[inline(always)]
    fn answer<D: Dim, M: Measure>(
        &self,
        tree: &SphereSearch,
        dim: D,
        Query { values: place, home }: Query<'_>,
        frames: &mut Frames<M>,
    ) -> Vec<Neighbor> {
        let heap = BinaryHeap::with_capacity(self.0);
        let mut found = NearestHeap { heap, k: self.0 };
        Search { nodes: &tree.nodes, dim, place }.near(home, frames, &mut found);
        sorted::<M>(found.heap.into_vec())
    }
}

/// All rows within a distance of each place.
pub(super) struct FindWithin(pub(super) f64);

impl Work for FindWithin {
    type Found = Vec<Neighbor>;
    type Kept<M: Measure> = Frames<M>;

    #[inline(always)]
    fn answer<D: Dim, M: Measure>(
        &self,
        tree: &SphereSearch,
        dim: D,
        Query { values: place, home }: Query<'_>,
        frames: &mut Frames<M>,
    ) -> Vec<Neighbor> {
        let mut found = Within::<M> { limit: M::limit(self.0), found: vec![] };
        Search { nodes: &tree.nodes, dim, place }.near(home, frames, &mut found);
        sorted::<M>(found.found)
    }
}

/// The farthest row from each place, or one that is nearly as far: 1 + ε is given.
pub(super) struct FindFarthest(pub(super) f64);

impl Work for FindFarthest {
    type Found = Neighbor;
    type Kept<M: Measure> = Frames<M>;

    #[inline(always)]
    fn answer<D: Dim, M: Measure>(
        &self,
        tree: &SphereSearch,
        dim: D,
        Query { values: place, .. }: Query<'_>,
        frames: &mut Frames<M>,
    ) -> Neighbor {
        let (factor, distance) = (self.0, M::distance as fn(M::Key) -> f64);
        let mut found = Farthest { key: M::BELOW_ALL, row: NO_ROW, factor, distance };
        Search { nodes: &tree.nodes, dim, place }.far(frames, &mut found);
        neighbor::<M>(found.key, found.row)
    }
}
