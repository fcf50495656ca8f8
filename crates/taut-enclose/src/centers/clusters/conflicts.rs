//! The decisions that a dead end rests on.
//!
//! *Idea.* A decision counts if it has put an item where it keeps another from fitting: the pair in no ball, else the support of the ball
//! that is too large, or members each of whose balls hold an item left out. Where other choices would leave that as it is, the search
//! goes back over them at once ([`crate::centers::conflict`]).

use super::{Cluster, Clusters};
use crate::centers::conflict::Levels;
use crate::centers::items::Position;

impl<P: Position> Clusters<P> {
    /// The levels of decisions on which the dead end that the last call of `examine` found rests.
    pub(in crate::centers) fn conflict(&mut self) -> Levels {
        let mut levels = Levels::default();
        if let Some(at) = self.held_out {
            self.add_cluster(at, &mut levels);
            self.avoided.iter().for_each(|&item| levels.insert(self.levels[item as usize]));
            return levels;
        }
        if self.conflicting.is_empty() {
            let too_large = self.clusters.iter().find(|c| c.ball.radius >= self.threshold);
            for &item in too_large.iter().flat_map(|cluster| &cluster.ball.support) {
                levels.insert(self.levels[item as usize]);
            }
        }
        let conflicting = std::mem::take(&mut self.conflicting);
        for &item in &conflicting {
            self.add_conflicts(item, &[], &mut levels);
        }
        self.conflicting = conflicting;
        self.add_left_out(&mut levels);
        levels
    }

    /// Adds the levels of all members of a cluster.
    fn add_cluster(&self, at: usize, levels: &mut Levels) {
        self.clusters[at].members.iter().for_each(|&m| levels.insert(self.levels[m as usize]));
    }

    /// The levels of all decisions.
    pub(in crate::centers) fn everything(&self) -> Levels {
        let mut levels = Levels::default();
        let members = self.clusters.iter().flat_map(|cluster| &cluster.members);
        members.for_each(|&item| levels.insert(self.levels[item as usize]));
        self.add_left_out(&mut levels);
        levels
    }

    /// Adds the levels on which it rests that an item, or its group, fits in none of the clusters but perhaps those of a list.
    pub(in crate::centers) fn add_conflicts(
        &mut self,
        item: u32,
        but: &[usize],
        levels: &mut Levels,
    ) {
        let clusters = 0..self.clusters.len();
        match self.home(item) {
            Some(home) => {
                levels.insert(home.level);
                if let Some(at) = home.cluster.filter(|at| !but.contains(at)) {
                    self.add_conflict(item, at, levels);
                }
            }
            None => {
                clusters.filter(|at| !but.contains(at)).for_each(|at| match self.misfit(item, at) {
                    Some(misfit) => self.add_conflict(misfit, at, levels),
                    None => self.add_cluster(at, levels),
                })
            }
        }
    }

    /// An item of the group of this one that does not fit into a cluster, if that is known; itself where it stands for itself.
    pub(super) fn misfit(&self, item: u32, cluster: usize) -> Option<u32> {
        let Some(links) = &self.links else { return Some(item) };
        let Cluster { feasible, asked, .. } = &self.clusters[cluster];
        links.linked(item).iter().copied().filter(|&other| (other as usize) < *asked).find(
            |other| {
                let found = feasible.binary_search_by_key(other, |candidate| candidate.item);
                found.map_or(true, |at| feasible[at].radius >= self.threshold)
            },
        )
    }

    /// Adds the levels of members of a cluster with which an item fits in no ball: of one, if there is such a one, and of those the
    /// one that was put there first; else of the support of a ball.
    fn add_conflict(&mut self, item: u32, at: usize, levels: &mut Levels) {
        let (items, cluster) = (&self.items, &self.clusters[at]);
        let far = cluster
            .members
            .iter()
            .filter(|&&m| items.pair_radius(m as usize, item as usize) >= self.threshold)
            .map(|&member| self.levels[member as usize])
            .min();
        if let Some(level) = far {
            levels.insert(level);
            return;
        }
        let mut ball = cluster.ball.clone();
        ball.grow(items, &cluster.members, item, self.threshold, &mut self.work);
        if ball.radius < self.threshold {
            // The items left out are in the way, or were when it was asked.
            self.add_cluster(at, levels);
            self.add_left_out(levels);
            return;
        }
        for &member in ball.support.iter().filter(|&&member| member != item) {
            levels.insert(self.levels[member as usize]);
        }
    }

    /// Adds the levels at which items were left out, as without these more could be.
    pub(in crate::centers) fn add_left_out(&self, levels: &mut Levels) {
        for (is_out, &level) in self.left_out.iter().zip(&self.levels) {
            if *is_out {
                levels.insert(level);
            }
        }
    }
}
