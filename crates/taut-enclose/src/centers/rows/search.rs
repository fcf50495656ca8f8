//! Decides whether k balls of less than a radius hold all items: a tree over X, which grows where X is held and something else is not.
//!
//! *Idea.* Depth first; a node is [`State`]. Where X is held, each cluster takes one of its rows as center, and all
//! items are measured: either the radius is enough, or the farthest item joins X and the node is looked at again. What
//! was refuted stays refuted. When X has grown and the tree as well, it starts again, as the new items may refute it sooner.

use taut_points::{Monitor, ReadError};

use super::start::{Incumbent, radius};
use super::state::{NodeState, State};
use crate::Error;
use crate::centers::depth_first::Path;

/// The way in which a search ended.
#[derive(Debug, PartialEq)]
pub(super) enum End {
    /// No k balls of less than the radius hold X.
    Refuted,
    /// The incumbent has less than the radius.
    StreamingReport,
    /// X has grown, and the nodes for this try are used up.
    Grown,
    /// All nodes are used up.
    Spent,
}

pub(super) struct Search<'a, 's> {
    /// The root.
    pub(super) state: &'a mut State<'s>,
    pub(super) incumbent: &'a mut Incumbent,
    pub(super) nodes: &'a mut u64,
    pub(super) scans: &'a mut u64,
    pub(super) max_nodes: u64,
    pub(super) monitor: &'a Monitor<'a>,
}

impl Search<'_, '_> {
    /// Searches from the root; starts again rather than go on after `patience` nodes when X has grown.
    pub(super) fn run(&mut self, patience: u64) -> Result<End, Error> {
        let (members, restart) = (self.state.core.len(), self.nodes.saturating_add(patience));
        let mut path = Path::new();
        loop {
            self.monitor.check().map_err(ReadError::from)?;
            if *self.nodes >= self.max_nodes {
                return Ok(End::Spent);
            }
            if *self.nodes >= restart && self.state.core.len() > members {
                return Ok(End::Grown);
            }
            *self.nodes += 1;
            let item = loop {
                match self.state.examine() {
                    NodeState::Dead(_) => break None,
                    NodeState::Branch(item) => break Some(item),
                    NodeState::StreamingReport => {
                        let Some(farthest) = self.measure() else {
                            return Ok(End::StreamingReport);
                        };
                        self.state.add(farthest);
                    }
                }
            };
            if let Some(item) = item {
                path.branch(item as u32, self.state.promising(item), vec![]);
            }
            if !path.advance(self.state) {
                return Ok(End::Refuted);
            }
        }
    }

    /// Measures all items from a center for each cluster. The farthest that is not left out, unless the radius is enough.
    fn measure(&mut self) -> Option<usize> {
        let (state, core) = (&*self.state, &*self.state.core);
        let mut counts = vec![true; core.sites.len()];
        for &item in &state.left_out {
            core.sites.linked(core.members[item]).into_iter().for_each(|site| counts[site] = false);
        }
        let mut centers: Vec<usize> = vec![];
        for (cluster, held) in state.clusters.iter().zip(state.held()) {
            let items: Vec<usize> = held.into_iter().map(|item| core.members[item]).collect();
            centers.extend(core.sites.middle(&cluster.words, &items));
        }
        let of_clusters = centers.clone();
        *self.scans += 1;
        let mut reaches = core.sites.reaches(&centers);
        loop {
            let far = (0..reaches.len()).filter(|&site| counts[site]);
            // The first of the farthest.
            let farthest = far.reduce(|a, b| if reaches[b] > reaches[a] { b } else { a });
            let outliers_left = farthest
                .filter(|&far| centers.len() < state.k && reaches[far] > core.sites.own_reach(far));
            if let Some(center) = outliers_left {
                centers.push(center);
                core.sites.lower(&mut reaches, center);
                continue;
            }
            let radius = radius(&reaches, state.outliers);
            if radius < self.incumbent.radius {
                *self.incumbent = Incumbent { centers, radius };
            }
            let farthest = farthest.filter(|_| radius >= core.radius)?;
            return Some(state.witness(farthest, &of_clusters));
        }
    }
}
