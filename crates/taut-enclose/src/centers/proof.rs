//! From what a search has shown to a proof that somebody else can follow.
//!
//! *Idea.* A search has its threshold from many trees, with looks at all items between. What it has shown is about its core-set
//! alone, and so one plain tree over that proves it again, mostly with far fewer nodes: the radius is fixed, nothing is looked
//! at, dead ends are branched to their end. Items on which this tree never branches are not needed; without them it is tried
//! again as long as it gets smaller.
//! *Guarantee.* Each child that is refuted has its own lower bound, from the multipliers of its ball; the least of them is what
//! is proved, mostly a little more than was asked, and the only thing that is claimed.
//! *Trap.* A plain tree may be larger than the search that found it. It is given up after a number of nodes, and the bound of a
//! step before is tried.

use taut_certify::{LowerBound, Stop};
use taut_points::{Monitor, ReadError};

use super::cloud::Cloud;
use super::clusters::{Clusters, Place, Survey, Undo, large_clique};
use super::items::{ItemSet, Position};
use super::start::least_pair_radius;
use crate::Error;

/// What rounding may have added to the radius of a ball of a few items, for the solver and for a checker; in parts of it.
const ROUNDING: f64 = 1e-12;
/// The same for two items, but for what grows with d.
const PAIR_ROUNDING: f64 = 2e-14;
/// Trees of up to so many nodes, and up to so many centres, are left to a checker to find; larger ones are written down.
const SEARCH_NODES: u64 = 2000;
const SEARCH_CENTERS: usize = 8;
/// Core-sets of more items are not given to a search, and of still more to no checker at all.
const SEARCH_ITEMS: usize = 1000;
const BRANCH_ITEMS: usize = 16_000;
/// Trees over what the one before has branched on.
const ROUNDS: usize = 4;

/// Items and how they prove the lower bound.
pub(super) struct Proof {
    pub(super) lower: f64,
    /// By their number in the cloud.
    pub(super) core_set: Vec<u32>,
    pub(super) kind: LowerBound,
    pub(super) nodes: u64,
}

/// A tree written down.
struct Log {
    /// The item of each node, in preorder.
    items: Vec<u32>,
    /// The least of the bounds by which children were refuted.
    lower: f64,
    /// The largest radius of a child that was not.
    open: f64,
}

impl Log {
    /// Whether rounding may let a checker refute what the log goes on from.
    fn is_close(&self) -> bool {
        self.open * (1.0 + 2.0 * ROUNDING) >= self.lower * (1.0 - ROUNDING)
    }
}

impl Proof {
    /// Nothing is claimed.
    pub(super) fn none() -> Self {
        Proof { lower: 0.0, core_set: vec![], kind: LowerBound::Apart, nodes: 0 }
    }

    /// More than k + z items no two of which fit in a ball of a smaller radius.
    pub(super) fn apart<P: Position>(cloud: &Cloud<P>, core_set: Vec<u32>) -> Self {
        let rounding = PAIR_ROUNDING + cloud.items.dim() as f64 * f64::EPSILON;
        let lower = least_pair_radius(cloud, &core_set) * (1.0 - rounding);
        Proof { lower, core_set, kind: LowerBound::Apart, nodes: 0 }
    }

    /// That no k balls of a radius less than `threshold` hold all of the core-set but z; or why not: it takes more than `budget`
    /// nodes or more items than a checker takes, or is not so, which can only be by rounding.
    pub(super) fn by_tree<P: Position>(
        cloud: &Cloud<P>,
        core_set: &[u32],
        threshold: f64,
        k: usize,
        z: usize,
        budget: u64,
        monitor: &Monitor<'_>,
    ) -> Result<Result<Self, Stop>, Error> {
        let room = k.saturating_add(z);
        let apart = large_clique(&cloud.items, core_set, threshold, room);
        if apart.len() > room {
            return Ok(Ok(Self::apart(cloud, apart)));
        }
        let mut best: Option<(Vec<u32>, Log)> = None;
        let mut budget = budget;
        for _ in 0..ROUNDS {
            let core_set = best.as_ref().map_or(core_set, |(core_set, _)| core_set);
            let log = match tree(cloud, core_set, threshold, k, z, budget, monitor)? {
                Ok(log) => log,
                Err(why) if best.is_none() => return Ok(Err(why)),
                Err(_) => break,
            };
            budget = (log.items.len() as u64).saturating_sub(1);
            let (needed, log) = renumbered(core_set, log);
            let is_last = needed.len() == core_set.len();
            best = Some((needed, log));
            if is_last {
                break;
            }
        }
        let best = best.filter(|(core_set, _)| core_set.len() <= BRANCH_ITEMS);
        let Some((core_set, log)) = best else { return Ok(Err(Stop::ProofBudget)) };
        let nodes = log.items.len() as u64;
        let is_small = nodes <= SEARCH_NODES && core_set.len() <= SEARCH_ITEMS;
        let lower = log.lower * (1.0 - ROUNDING);
        let kind = match is_small && k <= SEARCH_CENTERS {
            true => LowerBound::Search,
            false if log.is_close() => return Ok(Err(Stop::Rounding)),
            false => LowerBound::Branches { items: log.items },
        };
        Ok(Ok(Proof { lower, core_set, kind, nodes }))
    }
}

/// The core-set without the items on which no node branches, in the order in which nodes do, and the log in these numbers.
fn renumbered(core_set: &[u32], log: Log) -> (Vec<u32>, Log) {
    let mut numbers = vec![u32::MAX; core_set.len()];
    let mut needed = vec![];
    let mut items = log.items;
    for item in &mut items {
        let number = &mut numbers[*item as usize];
        if *number == u32::MAX {
            *number = needed.len() as u32;
            needed.push(core_set[*item as usize]);
        }
        *item = *number;
    }
    (needed, Log { items, ..log })
}

/// A node under way: the children that are not refuted at once.
struct Frame<P> {
    item: u32,
    places: Vec<Place>,
    next: usize,
    undo: Option<Undo<P>>,
}

/// The plain tree, or why there is none: it is too large, or the core-set does fit.
fn tree<P: Position>(
    cloud: &Cloud<P>,
    core_set: &[u32],
    threshold: f64,
    k: usize,
    z: usize,
    budget: u64,
    monitor: &Monitor<'_>,
) -> Result<Result<Log, Stop>, Error> {
    let mut items = ItemSet::new(cloud.items.shape(), cloud.items.dim());
    for &item in core_set {
        items.push(cloud.items.at(item as usize), cloud.items.extra(item as usize));
    }
    let mut state = Clusters::new(items, k, z as u64, threshold);
    let mut log = Log { items: vec![], lower: f64::INFINITY, open: 0.0 };
    let mut frames: Vec<Frame<P>> = vec![];
    loop {
        if log.items.len() as u64 >= budget {
            return Ok(Err(Stop::ProofBudget));
        }
        if log.items.len() % 256 == 255 {
            monitor.check().map_err(ReadError::from)?;
        }
        let Survey::Branch(item) = state.survey(true) else {
            return Ok(Err(Stop::Rounding));
        };
        log.items.push(item);
        let places = open_places(&mut state, item, &mut log);
        frames.push(Frame { item, places, next: 0, undo: None });
        loop {
            let Some(frame) = frames.last_mut() else { return Ok(Ok(log)) };
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

/// The places of an item whose ball stays below the threshold, in the order of the log, which is told by what the others are refuted.
fn open_places<P: Position>(state: &mut Clusters<P>, item: u32, log: &mut Log) -> Vec<Place> {
    let mut places = vec![];
    let Clusters { items, clusters, threshold, work, .. } = state;
    for (at, cluster) in clusters.iter().enumerate() {
        let mut ball = cluster.ball.clone();
        ball.grow(items, &cluster.members, item, f64::INFINITY, work);
        if ball.radius >= *threshold {
            log.lower = log.lower.min(ball.lower_bound(items));
        } else {
            log.open = log.open.max(ball.radius);
            places.push(Place::Into(at));
        }
    }
    if state.empty() > 0 {
        let alone = state.items.radius(item as usize);
        if alone >= state.threshold {
            log.lower = log.lower.min(alone);
        } else {
            log.open = log.open.max(alone);
            places.push(Place::Open);
        }
    }
    if state.spare() > 0 {
        places.push(Place::LeaveOut);
    }
    places
}
