//! A part of a coloring: items of the core-set in k clusters, and what each further item would do to each of them.
//!
//! *State.* The core-set X; clusters 1…used, each with its items, their exact ball, and its feasible items: those of X that fit into
//! it, with the radius of the ball with each, which is below the threshold; which items are left out.
//! *Feasible items, cheapest first.* An item inside leaves the radius as it is. One too far from the new item, or for which
//! (D² + r²)/2D, a lower bound on the radius of a ball that holds the old one's points and one at distance D > r, is too large,
//! is pruned: it is infeasible for the cluster and for any larger one. For the others the ball is made.
//! *Choice.* The item that fits in the fewest clusters; of equals, the one that makes them grow most. Items that fit in none
//! need an empty cluster each, if no two of them fit in one: a clique.

use std::sync::Arc;

use super::conflict::Levels;
use super::depth_first::{Place, State};
use super::items::{ItemSet, Position, Shape, distance};
use super::proof_tree::{ProofLog, Proving};
use super::small_ball::{Ball, Workspace};

/// Cliques are sought from every item that fits nowhere if there are at most so many, else from the first so many.
const CLIQUE_STARTS: usize = 24;
/// Comparisons of pairs that a search for a large clique may make, about 0.1 s: beyond, it starts from fewer items.
const CLIQUE_PAIRS: usize = 20_000_000;

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

/// The data to take a step back.
#[derive(Clone)]
pub(super) enum Undo<P> {
    Into { cluster: usize, ball: Ball<P>, feasible: Vec<FeasibleItem>, asked: usize },
    Open,
    LeaveOut { item: u32 },
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
    /// Balls must stay below this radius.
    pub(super) threshold: f64,
    k: usize,
    /// The number of further items that may be left out.
    outliers_left: u64,
    left_out: Vec<bool>,
    /// The level at which each item was put where it is.
    levels: Vec<u32>,
    pub(super) work: Workspace<P>,
    /// Items that fit in no cluster.
    unplaced: Vec<u32>,
    clique: Vec<u32>,
    /// In a dead end: items that need more empty clusters than there are, if any.
    conflicting: Vec<u32>,
    fits: Vec<Fit>,
    /// Lists that are not in use.
    lists: Vec<Vec<FeasibleItem>>,
}

impl<P: Position> Clusters<P> {
    pub(super) fn new(
        items: Arc<ItemSet<P>>,
        k: usize,
        outliers_left: u64,
        threshold: f64,
    ) -> Self {
        let (left_out, levels) = (vec![false; items.len()], vec![0; items.len()]);
        let work = Workspace::new(items.dim());
        Clusters {
            items,
            clusters: vec![],
            threshold,
            k,
            outliers_left,
            left_out,
            levels,
            work,
            unplaced: vec![],
            clique: vec![],
            conflicting: vec![],
            fits: vec![],
            lists: vec![],
        }
    }

    /// Adds an item to the core-set.
    pub(super) fn add(&mut self, position: &[f64], extra: f64) {
        Arc::make_mut(&mut self.items).push(position, extra);
        self.left_out.push(false);
        self.levels.push(0);
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
                Undo::LeaveOut { item }
            }
            Place::Into(at) => {
                let (items, work) = (&self.items, &mut self.work);
                let cluster = &mut self.clusters[at];
                let ball = cluster.ball.clone();
                cluster.ball.grow(items, &cluster.members, item, f64::INFINITY, work);
                cluster.members.push(item);
                let mut feasible = self.lists.pop().unwrap_or_default();
                feasible.clear();
                let old = std::mem::take(&mut cluster.feasible);
                for candidate in old.iter().filter(|candidate| candidate.radius < self.threshold) {
                    let radius =
                        cluster.radius_with(items, candidate.item, &[item], self.threshold, work);
                    if radius < self.threshold {
                        feasible.push(FeasibleItem { radius, ..*candidate });
                    }
                }
                cluster.feasible = feasible;
                Undo::Into { cluster: at, ball, feasible: old, asked: cluster.asked }
            }
        }
    }

    /// Asks each cluster of the items that the core-set has won.
    fn ask_new_items(&mut self) {
        for cluster in &mut self.clusters {
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
        }
    }

    /// Determines how each item fits into the clusters.
    fn update_fits(&mut self) {
        self.fits.clear();
        self.fits.resize(self.items.len(), Fit::default());
        for cluster in &self.clusters {
            let radius = cluster.ball.radius;
            for candidate in &cluster.feasible {
                let fit = &mut self.fits[candidate.item as usize];
                if candidate.radius <= radius {
                    fit.is_covered = true;
                } else if candidate.radius < self.threshold {
                    fit.places += 1;
                    fit.rise += candidate.radius - radius;
                }
            }
        }
    }

    /// Returns what is to be done next. With `chains` dead ends are not reported at once but left to be branched on, as a proof must show them.
    pub(super) fn examine(&mut self, chains: bool) -> NodeState {
        self.conflicting.clear();
        if self.is_too_large() {
            return NodeState::Stuck;
        }
        self.ask_new_items();
        self.update_fits();
        let capacity = self.empty() + self.outliers_left as usize;
        self.unplaced.clear();
        let mut best: Option<(u32, f64, u32)> = None;
        for item in 0..self.items.len() {
            if self.left_out[item] {
                continue;
            }
            if self.items.radius(item) >= self.threshold {
                // A ball too large by itself can only be left out.
                let is_stuck = self.outliers_left == 0 && !chains;
                return if is_stuck { NodeState::Stuck } else { NodeState::Branch(item as u32) };
            }
            let Fit { places, is_covered, rise } = self.fits[item];
            if is_covered {
                continue;
            }
            if places == 0 {
                if capacity == 0 {
                    self.conflicting.push(item as u32);
                    return if chains { NodeState::Branch(item as u32) } else { NodeState::Stuck };
                }
                self.unplaced.push(item as u32);
            }
            let is_better = match best {
                Some((fewest, most, _)) => places < fewest || places == fewest && rise > most,
                None => true,
            };
            if is_better {
                best = Some((places, rise, item as u32));
            }
        }
        let Some((_, _, item)) = best else { return NodeState::StreamingReport };
        if self.unplaced.is_empty() {
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

    /// A clique of items that fit in no cluster, the largest of some greedy ones; the search ends with one of more than `capacity` items.
    fn find_clique(&mut self, capacity: usize) {
        let mut clique = std::mem::take(&mut self.clique);
        clique.clear();
        let mut trial = vec![];
        for &start in self.unplaced.iter().take(CLIQUE_STARTS) {
            greedy_clique(&self.items, start, &self.unplaced, self.threshold, capacity, &mut trial);
            if trial.len() > clique.len() {
                std::mem::swap(&mut clique, &mut trial);
            }
            if clique.len() > capacity {
                break;
            }
        }
        self.clique = clique;
    }

    /// Where no ball below the threshold holds all items that fit in no cluster, adds some of which that is true to the conflict.
    fn refute_last_cluster(&mut self) {
        let mut ball = Ball::of_one(&self.items, self.unplaced[0]);
        for at in 1..self.unplaced.len() {
            let (known, more) = (&self.unplaced[..at], self.unplaced[at]);
            if !ball.holds(&self.items, more) {
                ball.grow(&self.items, known, more, self.threshold, &mut self.work);
            }
            if ball.radius >= self.threshold {
                self.conflicting.extend_from_slice(&ball.support);
                return;
            }
        }
    }

    /// The levels of decisions on which the dead end that the last call of `examine` found rests.
    pub(super) fn conflict(&mut self) -> Levels {
        let mut levels = Levels::default();
        if self.conflicting.is_empty() {
            let too_large = self.clusters.iter().find(|c| c.ball.radius >= self.threshold);
            for &item in too_large.iter().flat_map(|cluster| &cluster.ball.support) {
                levels.insert(self.levels[item as usize]);
            }
        }
        let conflicting = std::mem::take(&mut self.conflicting);
        for &item in &conflicting {
            for at in 0..self.clusters.len() {
                self.add_conflict(item, at, &mut levels);
            }
        }
        self.conflicting = conflicting;
        self.add_left_out(&mut levels);
        levels
    }

    /// The levels of all decisions.
    pub(super) fn everything(&self) -> Levels {
        let mut levels = Levels::default();
        let members = self.clusters.iter().flat_map(|cluster| &cluster.members);
        members.for_each(|&item| levels.insert(self.levels[item as usize]));
        self.add_left_out(&mut levels);
        levels
    }

    /// Adds the levels of members of a cluster with which an item fits in no ball: of one, if there is such a one, and of those the
    /// one that was put there first; else of the support of a ball.
    pub(super) fn add_conflict(&mut self, item: u32, cluster: usize, levels: &mut Levels) {
        let (items, cluster) = (&self.items, &self.clusters[cluster]);
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
        for &member in ball.support.iter().filter(|&&member| member != item) {
            levels.insert(self.levels[member as usize]);
        }
    }

    /// Adds the levels at which items were left out, as without these more could be.
    pub(super) fn add_left_out(&self, levels: &mut Levels) {
        for (is_out, &level) in self.left_out.iter().zip(&self.levels) {
            if *is_out {
                levels.insert(level);
            }
        }
    }

    /// Where an item may go, by growing radius; empty clusters and outliers last.
    pub(super) fn places(&self, item: u32) -> Vec<(f64, Place)> {
        let mut places: Vec<(f64, Place)> = vec![];
        for (at, cluster) in self.clusters.iter().enumerate() {
            let found = cluster.feasible.binary_search_by_key(&item, |candidate| candidate.item);
            if let Ok(found) = found
                && cluster.feasible[found].radius < self.threshold
            {
                places.push((cluster.feasible[found].radius, Place::Into(at)));
            }
        }
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
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
        match undo {
            Undo::Open => {
                let cluster = self.clusters.pop().expect("it was opened");
                self.lists.push(cluster.feasible);
            }
            Undo::LeaveOut { item } => {
                self.left_out[item as usize] = false;
                self.outliers_left += 1;
            }
            Undo::Into { cluster, ball, feasible, asked } => {
                let cluster = &mut self.clusters[cluster];
                cluster.members.pop();
                cluster.ball = ball;
                cluster.asked = asked;
                self.lists.push(std::mem::replace(&mut cluster.feasible, feasible));
            }
        }
    }
}

impl<P: Position> Proving for Clusters<P> {
    fn chain(&mut self) -> Vec<u32> {
        match self.examine(true) {
            NodeState::Branch(item) => vec![item],
            NodeState::StreamingReport | NodeState::Stuck => vec![],
        }
    }

    fn open_places(&mut self, item: u32, bounds: &mut ProofLog) -> Vec<Place> {
        let mut places = vec![];
        let mut child = |radius: f64, refuted_by: &dyn Fn() -> f64, place| {
            if radius >= self.threshold {
                bounds.lower = bounds.lower.min(refuted_by());
            } else {
                bounds.open = bounds.open.max(radius);
                places.push(place);
            }
        };
        for (at, cluster) in self.clusters.iter().enumerate() {
            let mut ball = cluster.ball.clone();
            ball.grow(&self.items, &cluster.members, item, f64::INFINITY, &mut self.work);
            child(ball.radius, &|| ball.lower_bound(&self.items), Place::Into(at));
        }
        if self.clusters.len() < self.k {
            let alone = self.items.radius(item as usize);
            child(alone, &|| alone, Place::Open);
        }
        if self.outliers_left > 0 {
            places.push(Place::LeaveOut);
        }
        places
    }
}

impl<P: Position> Cluster<P> {
    /// The radius with one item more, ∞ if it is not below the threshold; `others` are the members to which the item may be too far
    /// for any ball.
    #[inline(always)]
    fn radius_with(
        &self,
        items: &ItemSet<P>,
        item: u32,
        others: &[u32],
        threshold: f64,
        work: &mut Workspace<P>,
    ) -> f64 {
        let at = item as usize;
        let d = distance(items.at(at), self.ball.center.as_ref());
        if items.reach_at(at, d) <= self.ball.radius * (1.0 + super::small_ball::REACH_TOLERANCE) {
            return self.ball.radius;
        }
        let r = self.ball.radius;
        if items.shape() == Shape::Points && d * d + r * r >= 2.0 * d * threshold {
            return f64::INFINITY;
        }
        for &other in others {
            if items.pair_radius(other as usize, at) >= threshold {
                return f64::INFINITY;
            }
        }
        match self.members[..] {
            [only] => items.pair_radius(only as usize, at),
            _ => work.radius_with(items, &self.ball, &self.members, item, threshold),
        }
    }
}

/// The largest of greedy cliques from all candidates in turn; the search ends with one of more than `enough`.
pub(super) fn large_clique<P: Position>(
    items: &ItemSet<P>,
    candidates: &[u32],
    threshold: f64,
    enough: usize,
) -> Vec<u32> {
    let pairs = candidates.len().saturating_mul(enough.min(candidates.len()));
    let starts = (CLIQUE_PAIRS / pairs.max(1)).max(1);
    let (mut clique, mut trial) = (vec![], vec![]);
    for &start in candidates.iter().take(starts) {
        greedy_clique(items, start, candidates, threshold, enough, &mut trial);
        if trial.len() > clique.len() {
            std::mem::swap(&mut clique, &mut trial);
        }
        if clique.len() > enough {
            break;
        }
    }
    clique
}

/// Items no two of which fit in one ball below the threshold, taken in order after `start`; ends with more than `enough`.
fn greedy_clique<P: Position>(
    items: &ItemSet<P>,
    start: u32,
    candidates: &[u32],
    threshold: f64,
    enough: usize,
    clique: &mut Vec<u32>,
) {
    clique.clear();
    clique.push(start);
    for &candidate in candidates {
        if clique.len() > enough {
            return;
        }
        let is_apart =
            |&member: &u32| items.pair_radius(member as usize, candidate as usize) >= threshold;
        if candidate != start && clique.iter().all(is_apart) {
            clique.push(candidate);
        }
    }
}
