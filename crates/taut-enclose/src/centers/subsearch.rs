//! A depth-first search through a tree of decisions over a core-set that grows, and how it is cut into several.
//!
//! *State.* The decisions that stay (the path), those that are to be undone (frames, with what else could be decided there), and
//! the clusters that all of them make ([`super::clusters`]).
//! *Backjumps.* A dead end rests on some of the decisions that led to it: those about the items that leave no room for others.
//! Where one is not among these, its other choices would end the same way and are not tried.
//! *Cut.* At the first frame that has choices left, each becomes a subsearch of its own; what was decided up to there stays for good.
//! *Guarantee.* When a subsearch has ended, no balls below its threshold hold its core-set with the decisions of its path that the
//! dead end rests on. A larger core-set and a smaller threshold do not change that.

use std::collections::HashSet;
use std::sync::Arc;

use taut_points::{Monitor, ReadError};

use super::cloud::Cloud;
use super::clusters::{Clusters, NodeState, Undo};
use super::conflict::Levels;
use super::depth_first::{Place, State};
use super::items::Position;
use super::lloyd::improve;
use super::start::Incumbent;
use crate::Error;

/// Centers whose radius is this near to the best are worth Lloyd's steps, and those within the gap that is sought.
const WORTH_IMPROVING: f64 = 1.01;
/// So many coordinates, of the items beside each cluster, count as a node.
const NODE_COORDINATES: usize = 20_000;
/// The work of this many nodes goes by before it is asked whether to go on.
const NODES_BETWEEN_ASKS: u64 = 256;

/// The data that all subsearches share.
pub(super) struct Task<'c, P> {
    pub(super) cloud: &'c Cloud<P>,
    pub(super) monitor: &'c Monitor<'c>,
    pub(super) k: usize,
    pub(super) z: usize,
}

/// A decision that stays: an item of the cloud and where it is.
type Decision = (u32, Place);

/// A subsearch in progress.
#[derive(Clone)]
pub(super) struct Subsearch<'c, P> {
    task: &'c Task<'c, P>,
    state: Clusters<P>,
    /// Items by their number in the cloud, in the order of the state's.
    pub(super) core_set: Vec<u32>,
    is_known: HashSet<u32>,
    pub(super) best: Incumbent<P>,
    gap: f64,
    path: Vec<Decision>,
    frames: Vec<Frame<P>>,
    pub(super) nodes: u64,
    pub(super) scans: u64,
}

/// A node under way.
#[derive(Clone)]
struct Frame<P> {
    item: u32,
    places: Vec<(f64, Place)>,
    next: usize,
    undo: Option<Undo<P>>,
    /// Clusters that the item was put into.
    tried: Vec<usize>,
    /// The levels that its failed children rest on, but for its own level.
    conflict: Levels,
    /// True if other subsearches have some of its children.
    is_shared: bool,
}

/// The way in which a part of a subsearch ended.
pub(super) enum End {
    /// All that the path leads to is refuted, by decisions at these levels of it.
    Refuted(Levels),
    /// The rest of this subsearch is refuted.
    Done,
    /// There is more to do.
    Open,
    /// The core-set has grown, and it is time to start again.
    Grown,
}

impl<'c, P: Position> Subsearch<'c, P> {
    /// At the root. None where the core-set holds more items that need a ball each than there may be.
    pub(super) fn new(
        task: &'c Task<'c, P>,
        core_set: &[u32],
        best: &Incumbent<P>,
        gap: f64,
    ) -> Result<Option<Self>, Error> {
        let items = Arc::new(task.cloud.items.some(core_set));
        let threshold = best.radius / (1.0 + gap);
        let links = task.cloud.links(core_set);
        let mut state =
            Clusters::new(items, links, task.k, task.z as u64, threshold, task.cloud.can_avoid());
        state.end_early();
        let capacity = task.k.saturating_add(task.z);
        let clique = state.large_clique(capacity);
        if clique.len() > capacity {
            return Ok(None);
        }
        // Where items may be left out, these may be so.
        for item in clique.into_iter().filter(|_| task.z == 0) {
            task.monitor.check().map_err(ReadError::from)?;
            state.put(item, Place::Open);
        }
        Ok(Some(Subsearch {
            task,
            state,
            core_set: core_set.to_vec(),
            is_known: core_set.iter().copied().collect(),
            best: best.clone(),
            gap,
            path: vec![],
            frames: vec![],
            nodes: 0,
            scans: 0,
        }))
    }

    /// Goes on for so many nodes; after `run` of them, only until the core-set has more than `known` items.
    pub(super) fn go_on(&mut self, nodes: u64, run: u64, known: usize) -> Result<End, Error> {
        let first = self.nodes;
        while self.nodes - first < nodes {
            let before = self.nodes;
            self.nodes += self.size();
            if before / NODES_BETWEEN_ASKS != self.nodes / NODES_BETWEEN_ASKS {
                self.task.monitor.check().map_err(ReadError::from)?;
            }
            let failed = match self.examine()? {
                Ok(item) => {
                    let places = self.state.places(item);
                    self.frames.push(Frame {
                        item,
                        places,
                        next: 0,
                        undo: None,
                        tried: vec![],
                        conflict: Levels::default(),
                        is_shared: false,
                    });
                    None
                }
                Err(conflict) => Some(conflict),
            };
            if self.core_set.len() > known && self.nodes - first >= run {
                return Ok(End::Grown);
            }
            if let Some(end) = self.advance(failed) {
                return Ok(end);
            }
        }
        Ok(End::Open)
    }

    /// As how many nodes the present one counts.
    fn size(&self) -> u64 {
        let items = self.state.clusters.len() * self.core_set.len();
        1 + (items.saturating_mul(self.state.items.dim()) / NODE_COORDINATES) as u64
    }

    /// On to the next child of the deepest node that has one; where none has, how that ends.
    fn advance(&mut self, mut failed: Option<Levels>) -> Option<End> {
        loop {
            let level = (self.path.len() + self.frames.len()) as u32;
            let Some(frame) = self.frames.last_mut() else {
                return Some(End::Refuted(failed.unwrap_or_default()));
            };
            if let Some(undo) = frame.undo.take() {
                self.state.undo(undo);
            }
            if let Some(mut conflict) = failed.take() {
                if !conflict.contains(level) {
                    self.frames.pop();
                    failed = Some(conflict);
                    continue;
                }
                conflict.remove(level);
                frame.conflict.add_all(&conflict);
            }
            let Some(&(radius, place)) = frame.places.get(frame.next) else {
                let frame = self.frames.pop().expect("it was there");
                if frame.is_shared {
                    return Some(End::Done);
                }
                failed = Some(self.add_untried(frame));
                continue;
            };
            frame.next += 1;
            // The threshold may have come down since the places were listed.
            if radius < self.state.threshold {
                if let Place::Into(cluster) = place {
                    frame.tried.push(cluster);
                }
                frame.undo = Some(self.state.put_at(frame.item, place, level));
                return None;
            }
        }
    }

    /// Returns what a node rests on whose children are all refuted: also why its item fits in none of the clusters that were not tried.
    fn add_untried(&mut self, frame: Frame<P>) -> Levels {
        let Frame { item, tried, mut conflict, .. } = frame;
        self.state.add_conflicts(item, &tried, &mut conflict);
        self.state.add_left_out(&mut conflict);
        conflict
    }

    /// The item to branch on, after as many looks at all items as it takes; in a dead end, what that rests on.
    fn examine(&mut self) -> Result<Result<u32, Levels>, Error> {
        loop {
            match self.state.examine(false) {
                NodeState::Stuck => return Ok(Err(self.state.conflict())),
                NodeState::Branch(item) => return Ok(Ok(item)),
                NodeState::StreamingReport => {
                    if !self.read_all_items()? {
                        return Ok(Err(self.state.everything()));
                    }
                }
            }
        }
    }

    /// All items, seen from the centers of clusters that hold the core-set. False where that ends the branch.
    fn read_all_items(&mut self) -> Result<bool, Error> {
        let Task { cloud, monitor, k, z } = *self.task;
        monitor.check().map_err(ReadError::from)?;
        let centers: Vec<P> =
            self.state.clusters.iter().map(|cluster| cluster.ball.center.clone()).collect();
        // Of the farthest, z may be left out already, and z more may be yet.
        let count = z.saturating_mul(2).saturating_add(1);
        let far = cloud.farthest(&centers, count);
        self.scans += 1;
        let radius = far.get(z).map_or(0.0, |far| far.reach);
        let is_near = radius <= self.best.radius * WORTH_IMPROVING.max(1.0 + self.gap);
        let seen = Incumbent { centers, radius };
        self.offer(&if is_near { improve(cloud, seen, k, z, monitor)? } else { seen });
        if self.state.is_too_large() {
            // The next call of `examine` decides.
            return Ok(true);
        }
        let wanted = self.state.outliers_left().saturating_add(1) as usize;
        let far = far.iter().filter_map(|far| self.state.witness(cloud, far.item));
        let new: Vec<u32> = far.filter(|item| !self.is_known.contains(item)).take(wanted).collect();
        self.learn(&new);
        // Where there is none, the balls hold everything to rounding, and are as small as the threshold asks.
        Ok(!new.is_empty())
    }

    /// Takes items into the core-set that are not in it.
    pub(super) fn learn(&mut self, items: &[u32]) {
        for &item in items {
            if self.is_known.insert(item) {
                let at = item as usize;
                let cloud = self.task.cloud;
                let (position, extra) = (cloud.items.at(at), cloud.items.extra(at));
                self.state.add(position, extra, cloud.group_of(item));
                self.core_set.push(item);
            }
        }
    }

    /// Takes centers that are better than its own.
    pub(super) fn offer(&mut self, found: &Incumbent<P>) {
        if found.radius < self.best.radius {
            self.best = found.clone();
            self.state.threshold = self.threshold();
        }
    }

    /// Returns the radius below which balls have to stay.
    pub(super) fn threshold(&self) -> f64 {
        self.best.radius / (1.0 + self.gap)
    }

    /// Returns true if the first decisions of this subsearch are these.
    pub(super) fn begins_with(&self, decisions: &[Decision]) -> bool {
        self.path.starts_with(decisions)
    }

    /// The decisions on which a refutation rests, and those between them.
    pub(super) fn first_decisions(&self, conflict: &Levels) -> Vec<Decision> {
        self.path[..conflict.last() as usize].to_vec()
    }

    /// The level of the first decision that has choices left, if any.
    pub(super) fn first_choice(&self) -> Option<usize> {
        let has_choices = |frame: &Frame<P>| {
            frame.places[frame.next..].iter().any(|&(radius, _)| radius < self.state.threshold)
        };
        Some(self.path.len() + self.frames.iter().position(has_choices)?)
    }

    /// Gives up the choices left at the first decision that has any, to a subsearch of its own.
    pub(super) fn cut(&mut self) -> Option<Self> {
        let above = self.first_choice()? - self.path.len();
        let mut other = self.clone();
        for frame in other.frames.drain(above + 1..).rev() {
            frame.undo.into_iter().for_each(|undo| other.state.undo(undo));
        }
        debug_assert!(self.frames[..=above].iter().all(|frame| frame.next > 0), "all have a child");
        let decided = |frame: Frame<P>| {
            let (_, place) = frame.places[frame.next - 1];
            (self.core_set[frame.item as usize], place)
        };
        other.frames[above].is_shared = true;
        other.path.extend(other.frames.drain(..above).map(decided));
        self.path.extend(self.frames.drain(..=above).map(decided));
        // What it has decided there itself is left to this one.
        let nothing_left = other.advance(None);
        debug_assert!(nothing_left.is_none(), "there was a choice");
        Some(other)
    }
}
