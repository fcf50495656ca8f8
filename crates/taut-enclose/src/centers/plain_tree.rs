//! The plain tree over a core-set that proves a radius too small, written down node by node.
//!
//! *Idea.* The radius and the items stay as they are: each item is given to each cluster in turn, to a new one, and to those left
//! out, and each of these children has a tree of its own or is refuted at once by a ball that is too large.
//! *Threads.* What is below a node depends on nothing beside it. A tree that is not small is opened from its root until there are
//! [`UNKNOWN_PARTS_MAX`] nodes whose trees are unknown, or [`OPENED_NODES_MAX`] in all; these are made side by side, and their logs put where they belong.
//! *Guarantee.* One set of options has one log, or one reason to have none: it is longer than the budget, else it does not end in
//! dead ends alone. So a part that does not, stops no other.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use taut_certify::Stop;
use taut_points::{Monitor, ReadError};

use super::cloud::Cloud;
use super::clusters::{Clusters, Place, Survey, Undo};
use super::items::{ItemSet, Position};
use crate::Error;

/// A tree with more nodes is made in parts.
const WHOLE_TREE_NODES_MAX: u64 = 1000;
/// A tree is opened until the trees of this many nodes are unknown: far more than there are cores, as some are a
/// hundred times as large as others.
const UNKNOWN_PARTS_MAX: usize = 256;
/// A tree that this many nodes have not made so wide is left as it is.
const OPENED_NODES_MAX: usize = 4 * UNKNOWN_PARTS_MAX;
/// Nodes are counted, and it is asked whether to go on, each time this many have gone by.
const NODES_BETWEEN_ASKS: u64 = 64;

/// A tree written down.
#[derive(Debug, PartialEq)]
pub(super) struct Log {
    /// The item of each node, in preorder.
    pub(super) items: Vec<u32>,
    /// The least of the bounds by which children were refuted.
    pub(super) lower: f64,
    /// The largest radius of a ball of a child that was not.
    pub(super) open: f64,
}

impl Log {
    fn empty() -> Self {
        Log { items: vec![], lower: f64::INFINITY, open: 0.0 }
    }
}

/// A part of a log.
struct Piece {
    log: Log,
    /// Whether it goes on to the end of the last dead end.
    is_whole: bool,
    /// Whether balls below the threshold hold the core-set.
    holds: bool,
}

impl Piece {
    fn node(item: u32) -> Self {
        let log = Log { items: vec![item], ..Log::empty() };
        Piece { log, is_whole: true, holds: false }
    }
}

/// The tree that is asked for.
pub(super) struct PlainTree<'a, P> {
    items: Arc<ItemSet<P>>,
    threshold: f64,
    k: usize,
    z: usize,
    /// Most nodes.
    budget: u64,
    monitor: &'a Monitor<'a>,
    /// Nodes so far, but for the last few of each part.
    nodes: AtomicU64,
}

/// A piece of a log that is not complete.
enum Part<P> {
    Node(u32),
    /// All from the node on to which so many decisions led.
    Below {
        state: Box<Clusters<P>>,
        depth: usize,
    },
}

/// A node under way: the children that are not refuted at once.
struct Frame<P> {
    item: u32,
    places: Vec<Place>,
    next: usize,
    undo: Option<Undo<P>>,
}

impl<'a, P: Position> PlainTree<'a, P> {
    pub(super) fn new(
        cloud: &Cloud<P>,
        core_set: &[u32],
        threshold: f64,
        k: usize,
        z: usize,
        budget: u64,
        monitor: &'a Monitor<'a>,
    ) -> Self {
        let items = Arc::new(cloud.items.some(core_set));
        PlainTree { items, threshold, k, z, budget, monitor, nodes: AtomicU64::new(0) }
    }

    /// The whole tree, or why there is none: [`Stop::ProofBudget`], or [`Stop::Rounding`] where balls below the threshold hold the
    /// core-set.
    pub(super) fn log(&self) -> Result<Result<Log, Stop>, Error> {
        let small = self.below(self.root(), WHOLE_TREE_NODES_MAX.min(self.budget))?;
        if !small.holds && (small.is_whole || self.budget <= WHOLE_TREE_NODES_MAX) {
            return Ok(if small.is_whole { Ok(small.log) } else { Err(Stop::ProofBudget) });
        }
        if small.holds {
            return Ok(Err(Stop::Rounding));
        }
        self.nodes.store(0, Ordering::Relaxed);
        let mut log = Log::empty();
        let Some(parts) = self.open(&mut log)? else { return Ok(Err(Stop::Rounding)) };
        let pieces: Vec<Piece> = parts
            .into_par_iter()
            .map(|part| match part {
                Part::Node(item) => Ok(Piece::node(item)),
                Part::Below { state, .. } => self.below(*state, self.budget),
            })
            .collect::<Result<_, Error>>()?;
        let nodes: u64 = pieces.iter().map(|piece| piece.log.items.len() as u64).sum();
        let is_cut_short = |piece: &Piece| !piece.is_whole && !piece.holds;
        if nodes > self.budget || pieces.iter().any(is_cut_short) {
            return Ok(Err(Stop::ProofBudget));
        }
        if pieces.iter().any(|piece| piece.holds) {
            return Ok(Err(Stop::Rounding));
        }
        for Piece { log: piece, .. } in pieces {
            log.items.extend(piece.items);
            log.lower = log.lower.min(piece.lower);
            log.open = log.open.max(piece.open);
        }
        Ok(Ok(log))
    }

    /// The tree opened from its root on, nodes nearest to it first; `bounds` takes what its children are refuted by.
    fn open(&self, bounds: &mut Log) -> Result<Option<Vec<Part<P>>>, Error> {
        let mut parts = vec![Part::Below { state: Box::new(self.root()), depth: 0 }];
        let mut unknown = 1;
        while (1..UNKNOWN_PARTS_MAX).contains(&unknown) && parts.len() < OPENED_NODES_MAX {
            self.monitor.check().map_err(ReadError::from)?;
            let unknowns = parts.iter_mut().enumerate().filter_map(|(at, part)| match part {
                Part::Node(_) => None,
                Part::Below { state, depth } => Some((*depth, at, state)),
            });
            let first = unknowns.min_by_key(|&(depth, at, _)| (depth, at));
            let (depth, at, state) = first.expect("some are unknown");
            let Survey::Branch(item) = state.survey(true) else { return Ok(None) };
            let places = open_places(state, item, bounds);
            unknown = unknown - 1 + places.len();
            let child = |place| {
                let mut state = state.clone();
                state.put(item, place, 0);
                Part::Below { state, depth: depth + 1 }
            };
            let children: Vec<Part<P>> = places.into_iter().map(child).collect();
            parts.splice(at..=at, std::iter::once(Part::Node(item)).chain(children));
        }
        Ok(Some(parts))
    }

    /// The state before any decision.
    fn root(&self) -> Clusters<P> {
        Clusters::new(self.items.clone(), self.k, self.z as u64, self.threshold)
    }

    /// All from the node in this state on, but no more than `most` nodes, and no more once all parts together exceed the budget.
    fn below(&self, mut state: Clusters<P>, most: u64) -> Result<Piece, Error> {
        let mut piece = Piece { log: Log::empty(), is_whole: false, holds: false };
        let log = &mut piece.log;
        let mut frames: Vec<Frame<P>> = vec![];
        loop {
            if (log.items.len() as u64).is_multiple_of(NODES_BETWEEN_ASKS) {
                self.monitor.check().map_err(ReadError::from)?;
                let counted = if log.items.is_empty() { 0 } else { NODES_BETWEEN_ASKS };
                let nodes = self.nodes.fetch_add(counted, Ordering::Relaxed) + counted;
                if nodes > self.budget {
                    return Ok(piece);
                }
            }
            if log.items.len() as u64 >= most {
                return Ok(piece);
            }
            let Survey::Branch(item) = state.survey(true) else {
                piece.holds = true;
                return Ok(piece);
            };
            log.items.push(item);
            let places = open_places(&mut state, item, log);
            frames.push(Frame { item, places, next: 0, undo: None });
            loop {
                let Some(frame) = frames.last_mut() else {
                    piece.is_whole = true;
                    return Ok(piece);
                };
                if let Some(undo) = frame.undo.take() {
                    state.undo(undo);
                }
                let Some(&place) = frame.places.get(frame.next) else {
                    frames.pop();
                    continue;
                };
                frame.next += 1;
                frame.undo = Some(state.put(frame.item, place, 0));
                break;
            }
        }
    }
}

/// The places of an item whose ball stays below the threshold, in the order of the log; `bounds` takes what refutes the others.
fn open_places<P: Position>(state: &mut Clusters<P>, item: u32, bounds: &mut Log) -> Vec<Place> {
    let mut places = vec![];
    let Clusters { items, clusters, threshold, work, .. } = state;
    for (at, cluster) in clusters.iter().enumerate() {
        let mut ball = cluster.ball.clone();
        ball.grow(items, &cluster.members, item, f64::INFINITY, work);
        if ball.radius >= *threshold {
            bounds.lower = bounds.lower.min(ball.lower_bound(items));
        } else {
            bounds.open = bounds.open.max(ball.radius);
            places.push(Place::Into(at));
        }
    }
    if state.empty() > 0 {
        let alone = state.items.radius(item as usize);
        if alone >= state.threshold {
            bounds.lower = bounds.lower.min(alone);
        } else {
            bounds.open = bounds.open.max(alone);
            places.push(Place::Open);
        }
    }
    if state.spare() > 0 {
        places.push(Place::LeaveOut);
    }
    places
}
