//! Into how many clusters each item fits, and how many balls hold it, kept up to date as clusters change.
//!
//! *Idea.* A decision changes one cluster, and most decisions lead to a dead end, which an item that fits into no cluster shows. So what
//! the cluster was before is taken out of the counts and what it is now is added, where to count all again would read the feasible items of
//! all clusters. By how much an item makes balls grow is asked of few
//! ([`FitCounts::steepest`]).
//! *Invariant.* A count is the sum, over the clusters, of the codes of their feasible items under one threshold.

use super::{Cluster, FeasibleItem};

/// A ball that holds an item, in its count.
const HOLDING: u64 = 1 << 32;

/// The counts of all items.
#[derive(Clone, Debug)]
pub(super) struct FitCounts {
    /// Of each item the number of clusters into which it fits and whose ball does not hold it, and [`HOLDING`] times the number of balls
    /// that do.
    counts: Vec<u64>,
    /// The radius below which an item with its cluster fits.
    pub(super) threshold: f64,
}

impl FitCounts {
    /// No cluster has been counted.
    pub(super) fn new(items: usize, threshold: f64) -> Self {
        FitCounts { counts: vec![0; items], threshold }
    }

    /// The core-set has one item more.
    pub(super) fn push(&mut self) {
        self.counts.push(0);
    }

    /// Forgets all clusters; what is counted next has this threshold.
    pub(super) fn clear(&mut self, threshold: f64) {
        self.counts.fill(0);
        self.threshold = threshold;
    }

    /// What an item adds to its count by a cluster of one radius with it and another without it.
    #[inline(always)]
    fn code(&self, with: f64, without: f64) -> u64 {
        let is_held = with <= without;
        u64::from(is_held) * HOLDING + u64::from(!is_held & (with < self.threshold))
    }

    /// Counts feasible items of a cluster whose ball has this radius.
    pub(super) fn add(&mut self, feasible: &[FeasibleItem], radius: f64) {
        for candidate in feasible {
            let code = self.code(candidate.radius, radius);
            self.counts[candidate.item as usize] += code;
        }
    }

    /// Takes out what [`Self::add`] has counted.
    pub(super) fn remove(&mut self, feasible: &[FeasibleItem], radius: f64) {
        for candidate in feasible {
            let code = self.code(candidate.radius, radius);
            self.counts[candidate.item as usize] -= code;
        }
    }

    /// The first item from this on that no ball holds and that fits into at most so many clusters.
    pub(super) fn next_uncovered(&self, from: usize, places: u32) -> Option<usize> {
        let most = u64::from(places);
        let step = self.counts[from..].iter().position(|&count| count <= most)?;
        Some(from + step)
    }

    /// Returns true if an item that fits into a cluster whose ball has this radius has no other place, and is counted there.
    pub(super) fn is_only_place(&self, candidate: &FeasibleItem, radius: f64) -> bool {
        let count = self.counts[candidate.item as usize];
        count > 0 && count == self.code(candidate.radius, radius)
    }

    /// The number of clusters into which an item fits that no ball holds.
    pub(super) fn places(&self, item: usize) -> u32 {
        self.counts[item] as u32
    }

    /// Returns the item that makes the clusters into which it fits grow most in all, the first of several. Asked are those items that no ball
    /// holds, that fit into so many clusters and are not decided; `first` is the first of them.
    pub(super) fn steepest<P>(
        &self,
        clusters: &[Cluster<P>],
        places: u32,
        first: usize,
        is_decided: &[bool],
        rises: &mut Vec<f64>,
    ) -> usize {
        rises.clear();
        rises.resize(self.counts.len(), 0.0);
        let count = u64::from(places);
        for cluster in clusters {
            for candidate in &cluster.feasible {
                let item = candidate.item as usize;
                if self.counts[item] == count && candidate.radius < self.threshold {
                    rises[item] += candidate.radius - cluster.ball.radius;
                }
            }
        }
        let mut steepest = first;
        for item in first + 1..self.counts.len() {
            let is_one = self.counts[item] == count && !is_decided[item];
            if is_one && rises[item] > rises[steepest] {
                steepest = item;
            }
        }
        steepest
    }
}
