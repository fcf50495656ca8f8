//! Nodes of the proof log: what comes next, and which children are not refuted at once.

use super::{Clusters, NodeState};
use crate::centers::depth_first::Place;
use crate::centers::items::Position;
use crate::centers::proof_tree::{ProofLog, Proving, Step};

impl<P: Position> Proving for Clusters<P> {
    fn step(&mut self) -> Step {
        match (self.examine(true), self.held_out) {
            (NodeState::Branch(item), _) => Step::Branch(vec![item]),
            (_, Some(cluster)) => Step::HeldOut(cluster),
            (NodeState::StreamingReport | NodeState::Stuck, None) => Step::Open,
        }
    }

    fn open_places(&mut self, item: u32, bounds: &mut ProofLog) -> Vec<Place> {
        let mut places = vec![];
        let threshold = self.threshold;
        let mut child =
            |bounds: &mut ProofLog, radius: f64, refuted_by: &dyn Fn() -> f64, place| {
                if radius >= threshold {
                    bounds.lower = bounds.lower.min(refuted_by());
                } else {
                    bounds.open = bounds.open.max(radius);
                    places.push(place);
                }
            };
        let home = self.links.as_ref().and_then(|links| links.home(item));
        for (at, cluster) in self.clusters.iter().enumerate() {
            if home.is_some_and(|home| home.cluster != Some(at)) {
                continue;
            }
            // The child is refuted by a larger bound than one noted before, so that its exact ball would not change `lower`.
            if cluster.radius_at_least(&self.items, item) >= threshold.max(bounds.lower) {
                continue;
            }
            let mut ball = cluster.ball.clone();
            ball.grow(&self.items, &cluster.members, item, f64::INFINITY, &mut self.work);
            child(bounds, ball.radius, &|| ball.lower_bound(&self.items), Place::Into(at));
        }
        if home.is_some() {
            return places;
        }
        if self.clusters.len() < self.k {
            let alone = self.items.radius(item as usize);
            child(bounds, alone, &|| alone, Place::Open);
        }
        if self.outliers_left > 0 {
            places.push(Place::LeaveOut);
        }
        places
    }
}
