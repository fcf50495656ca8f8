//! A part of a coloring: items of the core-set in k clusters, and what each further item would do to each of them.
//!
//! *State.* The core-set X; clusters 1…used, each with its items, their exact ball, and its feasible items: those of X that fit into
//! it, with the radius of the ball with each, which is below the threshold; which items are left out.
//! *Feasible items, cheapest first.* An item inside leaves the radius as it is. One too far from the new item, or for which
//! (D² + r²)/2D, a lower bound on the radius of a ball that holds the old one's points and one at distance D > r, is too large,
//! is pruned: it is infeasible for the cluster and for any larger one. For the others the ball is made.
//! *Groups.* Items of one group go where the first of them was put ([`super::links`]). Before that, a group fits into a cluster if each
//! of its items does.
//! *Points left out* lie in no ball. In the plane an item is also infeasible where each ball with it would hold one of these
//! ([`super::avoiding_ball`]), and a cluster each of whose balls does so is a dead end.
//! *Counts.* Into how many clusters each item fits is kept from one decision to the next ([`fit_counts`]). In a search, a decision that takes the
//! last place of an item is a dead end at once, and the rest of that cluster's items is not asked. A proof does not do so: there the exact
//! ball has the last word, and may leave open what a search has refuted.
//! *Choice.* The item that fits in the fewest clusters; of equals, the one that makes them grow most. Items that fit in none
//! need an empty cluster each, if no two of them fit in one: a clique.

mod apart_pairs;
mod cliques;
mod conflicts;
mod fit_counts;
mod proving;
mod radius;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use self::fit_counts::FitCounts;
use super::avoiding_ball::AvoidingBall;
use super::cloud::Cloud;
use super::depth_first::{Place, State};
use super::items::{ItemSet, Position, Shape};
use super::links::{Home, Links, cluster_of};
use super::small_ball::{Ball, Workspace};

/// Items of the core-set that are together.
#[derive(Clone)]
pub(super) struct Cluster<P> {
    pub(super) members: Vec<u32>,
    pub(super) ball: Ball<P>,
    /// In the order of the core-set.
    feasible: Vec<FeasibleItem>,
    /// Items of the core-set that were asked; fewer than all where that has grown.
    asked: usize,
}

/// An item that fits into a cluster, and the radius of its ball with it.
#[derive(Clone, Copy)]
pub(super) struct FeasibleItem {
    item: u32,
    radius: f64,
}

/// The fit of an item into the clusters.
#[derive(Clone, Copy, Default)]
struct Fit {
    /// Clusters that it fits into.
    places: u32,
    is_covered: bool,
    /// By how much it would make these grow, in all.
    rise: f64,
}

impl Fit {
    /// Counts a cluster of one radius, and another with the item.
    #[inline(always)]
    fn count(&mut self, with: f64, without: f64, threshold: f64) {
        if with <= without {
            self.is_covered = true;
        } else if with < threshold {
            self.places += 1;
            self.rise += with - without;
        }
    }
}

/// The data to take a step back.
#[derive(Clone)]
pub(super) enum Undo<P> {
    Into {
        cluster: usize,
        ball: Ball<P>,
        feasible: Vec<FeasibleItem>,
        asked: usize,
    },
    Open,
    /// With the feasible items of each cluster and how many were asked.
    LeaveOut {
        item: u32,
        before: Vec<(Vec<FeasibleItem>, usize)>,
    },
}

/// The next step at a state.
pub(super) enum NodeState {
    /// Every item is in a ball or left out.
    StreamingReport,
    /// No balls below the threshold hold all items; [`Clusters::conflict`] says why.
    Stuck,
    /// This item has the fewest places.
    Branch(u32),
}

/// The state of a search.
#[derive(Clone)]
pub(super) struct Clusters<P> {
    /// The core-set, which states share until one of them adds to it.
    pub(super) items: Arc<ItemSet<P>>,
    pub(super) clusters: Vec<Cluster<P>>,
    /// None where each item stands for itself.
    pub(super) links: Option<Links>,
    /// Balls must stay below this radius.
    pub(super) threshold: f64,
    k: usize,
    /// The number of further items that may be left out.
    outliers_left: u64,
    left_out: Vec<bool>,
    /// Whether an item is in a cluster or left out. It is not asked for again: of nearly equal points, a fit may tell that a ball with one of
    /// them is too large, by rounding of the center, and the ball itself that it is not.
    is_decided: Vec<bool>,
    /// The items left out, in the order of decisions, where balls can be asked to avoid them; else none.
    avoided: Vec<u32>,
    /// True if balls are asked to avoid the items left out.
    can_avoid: bool,
    /// A cluster each of whose balls holds an item left out, in a dead end.
    held_out: Option<usize>,
    avoiding: AvoidingBall,
    /// The level at which each item was put where it is.
    levels: Vec<u32>,
    pub(super) work: Workspace<P>,
    /// Items that fit in no cluster.
    unplaced: Vec<u32>,
    clique: Vec<u32>,
    /// In a dead end: items that need more empty clusters than there are, if any.
    conflicting: Vec<u32>,
    /// True if a decision that takes the last place of an item ends its branch at once.
    ends_early: bool,
    /// An item that fits into no cluster since the last decision. The list of the cluster that this changed then stops before that item, and
    /// the counts are still those of the state before.
    placeless: Option<u32>,
    /// How items fit that each stand for themselves; of no meaning where there are groups.
    fit_counts: FitCounts,
    /// By how much items make clusters grow.
    rises: Vec<f64>,
    /// How each item of a group fits.
    fits: Vec<Fit>,
    /// The fits of groups, and for each the number of items that the cluster at hand has room for and holds.
    group_fits: Vec<Fit>,
    counts: Vec<[u32; 2]>,
    /// Lists that are not in use.
    lists: Vec<Vec<FeasibleItem>>,
    /// Balls that are not in use.
    balls: Vec<Ball<P>>,
}

impl<P: Position> Clusters<P> {
    pub(super) fn new(
        items: Arc<ItemSet<P>>,
        links: Option<Links>,
        k: usize,
        outliers_left: u64,
        threshold: f64,
        can_avoid: bool,
    ) -> Self {
        let (left_out, levels) = (vec![false; items.len()], vec![0; items.len()]);
        let work = Workspace::new(items.dim());
        let fit_counts = FitCounts::new(items.len(), threshold);
        Clusters {
            items,
            clusters: vec![],
            links,
            threshold,
            k,
            outliers_left,
            is_decided: left_out.clone(),
            left_out,
            avoided: vec![],
            can_avoid,
            held_out: None,
            avoiding: AvoidingBall::default(),
            levels,
            work,
            unplaced: vec![],
            clique: vec![],
            conflicting: vec![],
            ends_early: false,
            placeless: None,
            fit_counts,
            rises: vec![],
            fits: vec![],
            group_fits: vec![],
            counts: vec![],
            lists: vec![],
            balls: vec![],
        }
    }

    /// From now on a decision that takes the last place of an item ends its branch at once.
    ///
    /// What is below such a decision must not be asked for: the next step is to take it back.
    pub(super) fn end_early(&mut self) {
        self.ends_early = true;
    }

    /// Adds an item to the core-set, of this group if items are in groups.
    pub(super) fn add(&mut self, position: &[f64], extra: f64, group: Option<u32>) {
        Arc::make_mut(&mut self.items).push(position, extra);
        if let (Some(links), Some(group)) = (&mut self.links, group) {
            links.add(group);
        }
        self.left_out.push(false);
        self.is_decided.push(false);
        self.levels.push(0);
        self.fit_counts.push();
    }

    /// Clusters that are still empty.
    pub(super) fn empty(&self) -> usize {
        self.k - self.clusters.len()
    }

    pub(super) fn outliers_left(&self) -> u64 {
        self.outliers_left
    }

    /// Returns true if a ball has reached the threshold.
    pub(super) fn is_too_large(&self) -> bool {
        self.clusters.iter().any(|cluster| cluster.ball.radius >= self.threshold)
    }

    /// Puts an item where it may go, as the decision of this level.
    pub(super) fn put_at(&mut self, item: u32, place: Place, level: u32) -> Undo<P> {
        self.levels[item as usize] = level;
        self.is_decided[item as usize] = true;
        let cluster = cluster_of(place, self.clusters.len());
        if let Some(links) = &mut self.links {
            links.decide(item, cluster, level);
        }
        match place {
            Place::Open => {
                let ball = Ball::of_one(&self.items, item);
                let mut feasible = self.lists.pop().unwrap_or_default();
                feasible.clear();
                self.clusters.push(Cluster { members: vec![item], ball, feasible, asked: 0 });
                self.ask_new_items();
                Undo::Open
            }
            Place::LeaveOut => {
                self.left_out[item as usize] = true;
                self.outliers_left -= 1;
                let mut before = vec![];
                if self.can_avoid {
                    self.avoided.push(item);
                    let all = self.clusters.iter();
                    before.extend(all.map(|cluster| (cluster.feasible.clone(), cluster.asked)));
                    for at in 0..self.clusters.len() {
                        self.uncount(at);
                        self.avoid_left_out(at);
                        self.count(at);
                    }
                }
                Undo::LeaveOut { item, before }
            }
            Place::Into(at) => {
                let asked_by_all = self.asked_by_all();
                let spare = self.balls.pop();
                let (items, work) = (&self.items, &mut self.work);
                let cluster = &mut self.clusters[at];
                let ball = cluster.ball.copied_into(spare);
                cluster.ball.grow(items, &cluster.members, item, f64::INFINITY, work);
                cluster.members.push(item);
                let mut feasible = self.lists.pop().unwrap_or_default();
                feasible.clear();
                let old = std::mem::take(&mut cluster.feasible);
                feasible.reserve(old.len());
                for candidate in old.iter().filter(|candidate| candidate.radius < self.threshold) {
                    let other = candidate.item;
                    let radius = cluster.radius_with(items, other, &[item], self.threshold, work);
                    if radius < self.threshold {
                        feasible.push(FeasibleItem { item: other, radius });
                    } else if other < asked_by_all
                        && self.fit_counts.is_only_place(candidate, ball.radius)
                        && !self.is_decided[other as usize]
                    {
                        self.placeless = Some(other);
                        break;
                    }
                }
                let asked = cluster.asked;
                cluster.feasible = feasible;
                if self.placeless.is_none() {
                    self.avoid_left_out(at);
                    if self.links.is_none() {
                        self.fit_counts.remove(&old, ball.radius);
                        self.count(at);
                    }
                }
                Undo::Into { cluster: at, ball, feasible: old, asked }
            }
        }
    }

    /// Returns n such that a search is at a dead end once an item below n loses its last cluster: no cluster is empty, no outlier is left, and
    /// every cluster was asked about it. Returns 0 where that cannot be told, or is not wanted.
    fn asked_by_all(&self) -> u32 {
        let has_room = self.empty() > 0 || self.outliers_left > 0;
        let is_plain = self.ends_early
            && self.links.is_none()
            && self.avoided.is_empty()
            && self.items.shape() != Shape::Balls
            && self.fit_counts.threshold == self.threshold;
        if has_room || !is_plain {
            return 0;
        }
        self.clusters.iter().map(|cluster| cluster.asked as u32).min().unwrap_or(0)
    }

    /// Counts how items fit into a cluster.
    fn count(&mut self, at: usize) {
        if self.links.is_none() {
            let cluster = &self.clusters[at];
            self.fit_counts.add(&cluster.feasible, cluster.ball.radius);
        }
    }

    /// Takes back what was counted of a cluster, before it changes.
    fn uncount(&mut self, at: usize) {
        if self.links.is_none() {
            let cluster = &self.clusters[at];
            self.fit_counts.remove(&cluster.feasible, cluster.ball.radius);
        }
    }

    /// Drops the feasible items of a cluster with which each of its balls holds an item left out.
    fn avoid_left_out(&mut self, at: usize) {
        let Clusters { items, clusters, avoided, avoiding, threshold, .. } = self;
        if avoided.is_empty() {
            return;
        }
        let Cluster { members, feasible, ball, .. } = &mut clusters[at];
        feasible.retain(|candidate| {
            // One inside the ball of the others changes nothing that is asked of centers but by rounding, mostly.
            if candidate.radius <= ball.radius {
                return true;
            }
            let with = members.iter().copied().chain([candidate.item]);
            avoiding.set(items, with, avoided, *threshold);
            avoiding.may_exist(*threshold)
        });
    }

    /// A cluster each of whose balls holds an item left out.
    fn find_held_out(&mut self) -> Option<usize> {
        let Clusters { items, clusters, avoided, avoiding, threshold, .. } = self;
        if avoided.is_empty() {
            return None;
        }
        clusters.iter().position(|cluster| {
            avoiding.set(items, cluster.members.iter().copied(), avoided, *threshold);
            !avoiding.may_exist(*threshold)
        })
    }

    /// Asks each cluster of the items that the core-set has won.
    fn ask_new_items(&mut self) {
        for cluster in &mut self.clusters {
            let known = cluster.feasible.len();
            for item in cluster.asked as u32..self.items.len() as u32 {
                let radius = cluster.radius_with(
                    &self.items,
                    item,
                    &cluster.members,
                    self.threshold,
                    &mut self.work,
                );
                if radius < self.threshold {
                    cluster.feasible.push(FeasibleItem { item, radius });
                }
            }
            cluster.asked = self.items.len();
            if self.links.is_none() {
                self.fit_counts.add(&cluster.feasible[known..], cluster.ball.radius);
            }
        }
    }

    /// Determines how each item fits into the clusters; one whose group has a cluster, into that alone.
    fn update_fits(&mut self) {
        if self.links.is_none() {
            if self.fit_counts.threshold != self.threshold {
                self.fit_counts.clear(self.threshold);
                (0..self.clusters.len()).for_each(|at| self.count(at));
            }
            return;
        }
        self.fits.clear();
        self.fits.resize(self.items.len(), Fit::default());
        for (at, cluster) in self.clusters.iter().enumerate() {
            let radius = cluster.ball.radius;
            for candidate in &cluster.feasible {
                if let Some(links) = &self.links
                    && links.home(candidate.item).is_some_and(|home| home.cluster != Some(at))
                {
                    continue;
                }
                self.fits[candidate.item as usize].count(candidate.radius, radius, self.threshold);
            }
        }
        self.update_group_fits();
    }

    /// Determines how groups without a cluster fit: where all of their items do.
    fn update_group_fits(&mut self) {
        let Some(links) = &self.links else { return };
        self.group_fits.clear();
        self.group_fits.resize(links.len(), Fit::default());
        for cluster in &self.clusters {
            self.counts.clear();
            self.counts.resize(links.len(), [0, 0]);
            let radius = cluster.ball.radius;
            for candidate in cluster.feasible.iter().filter(|c| c.radius < self.threshold) {
                let group = links.group(candidate.item);
                let [fitting, covered] = &mut self.counts[group];
                *fitting += 1;
                *covered += u32::from(candidate.radius <= radius);
                let count = links.members(group).len() as u32;
                let fit = &mut self.group_fits[group];
                if *covered == count {
                    fit.is_covered = true;
                } else if *fitting == count {
                    fit.places += 1;
                    fit.rise += candidate.radius - radius;
                }
            }
        }
    }

    /// How an item fits that no ball holds. Where each item stands for itself, its rise is left at 0, as [`FitCounts::steepest`] finds it for
    /// few. Returns `None` if another item of the group stands for it: of a group without a cluster, the item that fits in the fewest clusters
    /// does.
    fn fit(&self, item: u32) -> Option<Fit> {
        let Some(links) = &self.links else {
            let places = self.fit_counts.places(item as usize);
            return Some(Fit { places, ..Fit::default() });
        };
        if links.home(item).is_some() {
            return Some(self.fits[item as usize]);
        }
        let linked = links.linked(item);
        let first = linked.iter().copied().min_by_key(|&other| self.fits[other as usize].places);
        (first == Some(item)).then(|| self.group_fits[links.group(item)])
    }

    /// For an item of the cloud that reaches too far, the one to be added to the core-set: itself, or where its group has items in the
    /// core-set that are all in one of the balls, the item of the group that is farthest from the center of that, which is not among
    /// them. None if the group is left out.
    pub(super) fn witness(&self, cloud: &Cloud<P>, far: u32) -> Option<u32> {
        let (Some(links), Some(grouping)) = (&self.links, &cloud.grouping) else {
            return Some(far);
        };
        let group = grouping.of[far as usize];
        let known = links.known(group);
        let Some(&first) = known.first() else { return Some(far) };
        if self.is_left_out(first) {
            return None;
        }
        let holds = |at: &usize| {
            let ball = &self.clusters[*at].ball;
            known.iter().all(|&item| ball.holds(&self.items, item))
        };
        let home = links.home(first).and_then(|home| home.cluster);
        let holding = home.or_else(|| (0..self.clusters.len()).find(holds));
        let Some(at) = holding else { return Some(far) };
        let center = &self.clusters[at].ball.center;
        Some(grouping.farthest_in(&cloud.items, group as usize, center, f64::INFINITY).0)
    }

    /// The first item from this on that may be in no ball and, where each item stands for itself, fits into at most so many clusters.
    fn next_uncovered(&self, from: usize, places: u32) -> Option<usize> {
        if self.links.is_some() {
            return (from < self.items.len()).then_some(from);
        }
        // A ball too large for any cluster fits into none, so its count is 0 and it is not passed over.
        self.fit_counts.next_uncovered(from, places)
    }

    /// Returns true if it is decided that an item is in no cluster.
    fn is_left_out(&self, item: u32) -> bool {
        self.left_out[item as usize] || self.home(item).is_some_and(|home| home.cluster.is_none())
    }

    /// Where the group of an item is, if it has one and that is decided.
    fn home(&self, item: u32) -> Option<Home> {
        self.links.as_ref().and_then(|links| links.home(item))
    }

    /// Returns what is to be done next. With `chains` dead ends are not reported at once but left to be branched on, as a proof must show them.
    pub(super) fn examine(&mut self, chains: bool) -> NodeState {
        self.conflicting.clear();
        self.held_out = None;
        if self.is_too_large() {
            return NodeState::Stuck;
        }
        self.held_out = self.find_held_out();
        if self.held_out.is_some() {
            return NodeState::Stuck;
        }
        if let Some(item) = self.placeless {
            debug_assert!(!chains, "a proof is asked what is below each decision");
            self.conflicting.push(item);
            return NodeState::Stuck;
        }
        self.ask_new_items();
        self.update_fits();
        let capacity = self.empty() + self.outliers_left as usize;
        self.unplaced.clear();
        // The fewest places, the number of items that have so many, and the one of these that makes clusters grow most.
        let (mut fewest, mut ties, mut most, mut best) = (u32::MAX, 0, f64::NEG_INFINITY, None);
        let mut next = 0;
        while let Some(item) = self.next_uncovered(next, fewest) {
            next = item + 1;
            if self.is_decided[item] || self.is_left_out(item as u32) {
                continue;
            }
            let is_settled = self.home(item as u32).is_some();
            if self.items.radius(item) >= self.threshold {
                // A ball too large by itself can only be left out.
                if is_settled {
                    self.conflicting.push(item as u32);
                }
                let is_stuck = (self.outliers_left == 0 || is_settled) && !chains;
                return if is_stuck { NodeState::Stuck } else { NodeState::Branch(item as u32) };
            }
            let Some(Fit { places, is_covered, rise }) = self.fit(item as u32) else { continue };
            if is_covered {
                continue;
            }
            if places == 0 {
                if capacity == 0 || is_settled {
                    self.conflicting.push(item as u32);
                    return if chains { NodeState::Branch(item as u32) } else { NodeState::Stuck };
                }
                self.unplaced.push(item as u32);
            }
            if places < fewest {
                (fewest, ties, most, best) = (places, 1, rise, Some(item as u32));
            } else if places == fewest {
                ties += 1;
                if rise > most {
                    (most, best) = (rise, Some(item as u32));
                }
            }
        }
        let Some(mut item) = best else { return NodeState::StreamingReport };
        if self.unplaced.is_empty() {
            if self.links.is_none() && ties > 1 {
                let (counts, rises) = (&self.fit_counts, &mut self.rises);
                let first = item as usize;
                let clusters = &self.clusters;
                item = counts.steepest(clusters, fewest, first, &self.is_decided, rises) as u32;
            }
            return NodeState::Branch(item);
        }
        self.find_clique(capacity);
        if chains {
            return NodeState::Branch(self.clique[0]);
        }
        if self.clique.len() > capacity {
            self.conflicting.extend_from_slice(&self.clique);
        } else if self.unplaced.len() > capacity && self.empty() == 0 {
            self.conflicting.extend_from_slice(&self.unplaced[..=capacity]);
        } else if self.empty() == 1 && self.outliers_left == 0 {
            self.refute_last_cluster();
        }
        if self.conflicting.is_empty() {
            NodeState::Branch(self.clique[0])
        } else {
            NodeState::Stuck
        }
    }

    /// Where an item may go, by growing radius; empty clusters and outliers last.
    pub(super) fn places(&self, item: u32) -> Vec<(f64, Place)> {
        let mut places: Vec<(f64, Place)> = vec![];
        let home = self.home(item);
        for (at, cluster) in self.clusters.iter().enumerate() {
            if home.is_some_and(|home| home.cluster != Some(at)) {
                continue;
            }
            if home.is_none() && self.links.is_some() && self.misfit(item, at).is_some() {
                continue;
            }
            let found = cluster.feasible.binary_search_by_key(&item, |candidate| candidate.item);
            if let Ok(found) = found
                && cluster.feasible[found].radius < self.threshold
            {
                places.push((cluster.feasible[found].radius, Place::Into(at)));
            }
        }
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        if home.is_some() {
            return places;
        }
        if self.empty() > 0 && self.items.radius(item as usize) < self.threshold {
            places.push((0.0, Place::Open));
        }
        if self.outliers_left > 0 {
            places.push((0.0, Place::LeaveOut));
        }
        places
    }
}

impl<P: Position> State for Clusters<P> {
    type Undo = Undo<P>;

    fn put(&mut self, item: u32, place: Place) -> Undo<P> {
        self.put_at(item, place, 0)
    }

    fn undo(&mut self, undo: Undo<P>) {
        if let Some(links) = &mut self.links {
            links.undo();
        }
        match undo {
            Undo::Open => {
                self.uncount(self.clusters.len() - 1);
                let cluster = self.clusters.pop().expect("it was opened");
                self.is_decided[cluster.members[0] as usize] = false;
                self.lists.push(cluster.feasible);
            }
            Undo::LeaveOut { item, before } => {
                self.left_out[item as usize] = false;
                self.is_decided[item as usize] = false;
                self.outliers_left += 1;
                if self.avoided.last() == Some(&item) {
                    self.avoided.pop();
                }
                for (at, (feasible, asked)) in before.into_iter().enumerate() {
                    self.uncount(at);
                    let cluster = &mut self.clusters[at];
                    cluster.asked = asked;
                    self.lists.push(std::mem::replace(&mut cluster.feasible, feasible));
                    self.count(at);
                }
            }
            Undo::Into { cluster: at, ball, feasible, asked } => {
                let was_counted = self.placeless.take().is_none();
                if was_counted {
                    self.uncount(at);
                }
                let cluster = &mut self.clusters[at];
                let item = cluster.members.pop().expect("it was put into");
                self.is_decided[item as usize] = false;
                self.balls.push(std::mem::replace(&mut cluster.ball, ball));
                cluster.asked = asked;
                self.lists.push(std::mem::replace(&mut cluster.feasible, feasible));
                if was_counted {
                    self.count(at);
                }
            }
        }
    }
}
