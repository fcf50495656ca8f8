//! A part of a colouring: items of the core-set in k clusters, and what each further item would do to each of them.
//!
//! *State.* The core-set X; clusters 1…used, each with its items, their exact ball, and a column: for every item of X the radius
//! of the ball with it, or ∞ where that is no less than the threshold; which items are left out.
//! *Columns, cheapest first.* An item inside leaves the radius as it is. One too far from the new item, or for which
//! (D² + r²)/2D, a lower bound on the radius of a ball that holds the old one's points and one at distance D > r, is too large,
//! is out of the question for good. For the others the ball is made.
//! *Choice.* The item that fits in the fewest clusters; of equals, the one that makes them grow most. Items that fit in none
//! need an empty cluster each, if no two of them fit in one: a clique.

use super::items::{ItemSet, Position, Shape, distance};
use super::small_ball::{Ball, Workspace};

/// Cliques are sought from every item that fits nowhere if there are at most so many, else from the first so many.
const CLIQUE_STARTS: usize = 24;

/// Items of the core-set that are together.
pub(super) struct Cluster<P> {
    pub(super) members: Vec<u32>,
    pub(super) ball: Ball<P>,
    /// For each item of the core-set the radius with it, ∞ if too large; shorter than the core-set where that has grown.
    column: Vec<f64>,
}

/// What has to be known to take a step back.
pub(super) enum Undo<P> {
    Into { cluster: usize, ball: Ball<P>, column: Vec<f64> },
    Open,
    LeaveOut { item: u32 },
}

/// Where an item may go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    Into(usize),
    /// The first empty cluster.
    Open,
    LeaveOut,
}

/// What is to be done with a state.
pub(super) enum Survey {
    /// Every item is in a ball or left out.
    Covered,
    /// No balls below the threshold hold all items.
    Stuck,
    /// This item has the fewest places.
    Branch(u32),
}

/// The state of a search.
pub(super) struct Clusters<P> {
    pub(super) items: ItemSet<P>,
    pub(super) clusters: Vec<Cluster<P>>,
    /// Balls must stay below this radius.
    pub(super) threshold: f64,
    k: usize,
    /// How many more items may be left out.
    spare: u64,
    pub(super) left_out: Vec<bool>,
    pub(super) work: Workspace<P>,
    /// Items that fit in no cluster.
    homeless: Vec<u32>,
    clique: Vec<u32>,
    columns: Vec<Vec<f64>>,
}

impl<P: Position> Clusters<P> {
    pub(super) fn new(items: ItemSet<P>, k: usize, spare: u64, threshold: f64) -> Self {
        let left_out = vec![false; items.len()];
        let work = Workspace::new(items.dim());
        Clusters {
            items,
            clusters: vec![],
            threshold,
            k,
            spare,
            left_out,
            work,
            homeless: vec![],
            clique: vec![],
            columns: vec![],
        }
    }

    /// Adds an item to the core-set.
    pub(super) fn add(&mut self, position: &[f64], extra: f64) {
        self.items.push(position, extra);
        self.left_out.push(false);
    }

    /// Clusters that are still empty.
    pub(super) fn empty(&self) -> usize {
        self.k - self.clusters.len()
    }

    pub(super) fn spare(&self) -> u64 {
        self.spare
    }

    /// Whether a ball has reached the threshold.
    pub(super) fn is_too_large(&self) -> bool {
        self.clusters.iter().any(|cluster| cluster.ball.radius >= self.threshold)
    }

    /// Puts an item where it may go.
    pub(super) fn put(&mut self, item: u32, place: Place) -> Undo<P> {
        match place {
            Place::Open => {
                let ball = Ball::of_one(&self.items, item);
                let mut column = self.columns.pop().unwrap_or_default();
                column.clear();
                self.clusters.push(Cluster { members: vec![item], ball, column });
                self.fill_columns();
                Undo::Open
            }
            Place::LeaveOut => {
                self.left_out[item as usize] = true;
                self.spare -= 1;
                Undo::LeaveOut { item }
            }
            Place::Into(at) => {
                let (items, work) = (&self.items, &mut self.work);
                let cluster = &mut self.clusters[at];
                let ball = cluster.ball.clone();
                cluster.ball.grow(items, &cluster.members, item, f64::INFINITY, work);
                cluster.members.push(item);
                let mut column = self.columns.pop().unwrap_or_default();
                column.clear();
                column.extend_from_slice(&cluster.column);
                let old = std::mem::replace(&mut cluster.column, column);
                for i in 0..cluster.column.len() {
                    let before = cluster.column[i];
                    if before < self.threshold {
                        cluster.column[i] =
                            cluster.radius_with(items, i as u32, &[item], self.threshold, work);
                    }
                }
                Undo::Into { cluster: at, ball, column: old }
            }
        }
    }

    /// Takes a step back.
    pub(super) fn undo(&mut self, undo: Undo<P>) {
        match undo {
            Undo::Open => {
                let cluster = self.clusters.pop().expect("it was opened");
                self.columns.push(cluster.column);
            }
            Undo::LeaveOut { item } => {
                self.left_out[item as usize] = false;
                self.spare += 1;
            }
            Undo::Into { cluster, ball, column } => {
                let cluster = &mut self.clusters[cluster];
                cluster.members.pop();
                cluster.ball = ball;
                self.columns.push(std::mem::replace(&mut cluster.column, column));
            }
        }
    }

    /// Brings columns to the length of the core-set.
    fn fill_columns(&mut self) {
        for cluster in &mut self.clusters {
            for item in cluster.column.len()..self.items.len() {
                let radius = cluster.radius_with(
                    &self.items,
                    item as u32,
                    &cluster.members,
                    self.threshold,
                    &mut self.work,
                );
                cluster.column.push(radius);
            }
        }
    }

    /// What is to be done. With `chains` dead ends are not told at once but left to be branched on, as a proof must show them.
    pub(super) fn survey(&mut self, chains: bool) -> Survey {
        if self.is_too_large() {
            return Survey::Stuck;
        }
        self.fill_columns();
        let room = self.empty() + self.spare as usize;
        self.homeless.clear();
        let mut best: Option<(usize, f64, u32)> = None;
        for item in 0..self.items.len() {
            if self.left_out[item] {
                continue;
            }
            if self.items.radius(item) >= self.threshold {
                // A ball too large by itself can only be left out.
                let is_stuck = self.spare == 0 && !chains;
                return if is_stuck { Survey::Stuck } else { Survey::Branch(item as u32) };
            }
            let (mut places, mut rise, mut is_covered) = (0, 0.0, false);
            for cluster in &self.clusters {
                let radius = cluster.column[item];
                if radius <= cluster.ball.radius {
                    is_covered = true;
                    break;
                }
                if radius < self.threshold {
                    places += 1;
                    rise += radius - cluster.ball.radius;
                }
            }
            if is_covered {
                continue;
            }
            if places == 0 {
                if room == 0 {
                    return if chains { Survey::Branch(item as u32) } else { Survey::Stuck };
                }
                self.homeless.push(item as u32);
            }
            let is_better = match best {
                Some((fewest, most, _)) => places < fewest || places == fewest && rise > most,
                None => true,
            };
            if is_better {
                best = Some((places, rise, item as u32));
            }
        }
        let Some((_, _, item)) = best else { return Survey::Covered };
        if self.homeless.is_empty() {
            return Survey::Branch(item);
        }
        self.find_clique(room);
        let is_stuck = self.clique.len() > room || self.homeless.len() > room && self.empty() == 0;
        if !chains && (is_stuck || self.empty() == 1 && self.spare == 0 && self.is_last_too_large())
        {
            return Survey::Stuck;
        }
        Survey::Branch(self.clique[0])
    }

    /// A clique of homeless items, the largest of some greedy ones; the search ends with one of more than `room` items.
    fn find_clique(&mut self, room: usize) {
        let mut clique = std::mem::take(&mut self.clique);
        clique.clear();
        let mut trial = vec![];
        for &start in self.homeless.iter().take(CLIQUE_STARTS) {
            greedy_clique(&self.items, start, &self.homeless, self.threshold, room, &mut trial);
            if trial.len() > clique.len() {
                std::mem::swap(&mut clique, &mut trial);
            }
            if clique.len() > room {
                break;
            }
        }
        self.clique = clique;
    }

    /// Whether no ball below the threshold holds all homeless items.
    fn is_last_too_large(&mut self) -> bool {
        let mut ball = Ball::of_one(&self.items, self.homeless[0]);
        for at in 1..self.homeless.len() {
            let (known, more) = (&self.homeless[..at], self.homeless[at]);
            if !ball.holds(&self.items, more) {
                ball.grow(&self.items, known, more, self.threshold, &mut self.work);
            }
            if ball.radius >= self.threshold {
                return true;
            }
        }
        ball.radius >= self.threshold
    }

    /// Where an item may go, by growing radius; empty clusters and outliers last.
    pub(super) fn places(&self, item: u32) -> Vec<(f64, Place)> {
        let mut places: Vec<(f64, Place)> = vec![];
        for (at, cluster) in self.clusters.iter().enumerate() {
            let radius = cluster.column[item as usize];
            if radius < self.threshold {
                places.push((radius, Place::Into(at)));
            }
        }
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        if self.empty() > 0 && self.items.radius(item as usize) < self.threshold {
            places.push((0.0, Place::Open));
        }
        if self.spare > 0 {
            places.push((0.0, Place::LeaveOut));
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
        if items.reach_at(at, d) <= self.ball.radius * (1.0 + super::small_ball::TOLERANCE) {
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

/// Items no two of which fit in one ball below the threshold, taken in order after `start`; ends with more than `enough`.
pub(super) fn greedy_clique<P: Position>(
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
