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

use std::collections::HashSet;
use std::sync::Arc;

use taut_certify::{LowerBound, Stop};
use taut_points::{Monitor, ReadError};

use super::cloud::Cloud;
use super::clusters::Clusters;
use super::items::Position;
use super::nogoods::Refutation;
use super::proof_tree::{CORE_SET_MAX, ProofLog, ProofTree};
use super::start::least_pair_radius;
use crate::Error;

/// The amount that rounding may have added to the radius of a ball of a few items, for the solver and for a checker; in parts of it.
const ROUNDING: f64 = 1e-12;
/// In length, what a bound may be off by for items that are off by 1: each end of it, and what the checker adds.
const PLACES: f64 = 3.0;
/// The same for two items, but for what grows with d.
const PAIR_ROUNDING: f64 = 2e-14;
/// Open children stay below the refuted ones by so many times the rounding, so that others, who round otherwise, refute the same.
const REFUTED_MARGIN: f64 = 4.0;
/// At most this many trees are made over what the one before has branched on, or with open children farther from the
/// bound.
const ROUNDS_MAX: usize = 5;
/// A log of at most this many nodes is sought once more among the items that it needs, which may make it shorter. Another time takes as long as
/// the first and rarely helps: 31,135 nodes became 31,124, in a fifth of the time of all.
const SHORTENED_NODES_MAX: u64 = 1000;

/// Items and how they prove the lower bound.
pub(super) struct Proof {
    pub(super) lower: f64,
    /// By their number in the cloud.
    pub(super) core_set: Vec<u32>,
    pub(super) kind: LowerBound,
    pub(super) nodes: u64,
}

impl Proof {
    /// Nothing is claimed.
    pub(super) fn none() -> Self {
        Proof { lower: 0.0, core_set: vec![], kind: LowerBound::Separated, nodes: 0 }
    }

    /// Nogoods as they were recorded: no k balls of this radius hold the core-set.
    pub(super) fn by_nogoods(lower: f64, refutation: &Refutation) -> Self {
        let Refutation { core_set, log } = refutation;
        Proof {
            lower,
            core_set: core_set.clone(),
            kind: LowerBound::Nogoods { nogoods: log.clone() },
            nodes: log.len() as u64,
        }
    }

    /// More than k + z items no two of which fit in a ball of a smaller radius.
    pub(super) fn separated<P: Position>(
        cloud: &Cloud<P>,
        core_set: Vec<u32>,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        if cloud.grouping.is_some() {
            return Self::separated_groups(cloud, &core_set, monitor);
        }
        let rounding = PAIR_ROUNDING + cloud.items.dim() as f64 * f64::EPSILON;
        let lower = least_pair_radius(cloud, &core_set, monitor)? * (1.0 - rounding);
        Ok(Proof { lower, core_set, kind: LowerBound::Separated, nodes: 0 })
    }

    /// The same for the groups of these items: those of their items that hold the smallest ball of one and another.
    fn separated_groups<P: Position>(
        cloud: &Cloud<P>,
        separated: &[u32],
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        let (mut lower, mut core_set) = (f64::INFINITY, vec![]);
        for (at, &a) in separated.iter().enumerate() {
            monitor.check().map_err(ReadError::from)?;
            for &b in &separated[..at] {
                let ball = cloud.ball_of_pair(a, b);
                lower = lower.min(ball.lower_bound(&cloud.items));
                core_set.extend(ball.support);
            }
            // A group of which no ball needs an item is one of those that are told apart.
            core_set.push(a);
        }
        let mut known = HashSet::new();
        core_set.retain(|&item| known.insert(item));
        let lower = if lower.is_finite() { lower * (1.0 - rounding(cloud, lower)) } else { 0.0 };
        Ok(Proof { lower, core_set, kind: LowerBound::Separated, nodes: 0 })
    }

    /// That no k balls of a radius less than `threshold` hold all of the core-set but z; or why not: it takes more than `budget`
    /// nodes or more items than a checker takes, or is not so, which can only be by rounding. `claim(bound, items)`
    /// rounds a bound to the units of the rows and returns it in search units. It is much smaller only for subnormal numbers.
    pub(super) fn by_tree<P: Position>(
        cloud: &Cloud<P>,
        core_set: &[u32],
        threshold: f64,
        k: usize,
        z: usize,
        budget: u64,
        claim: &dyn Fn(f64, &[u32]) -> f64,
        monitor: &Monitor<'_>,
    ) -> Result<Result<Self, Stop>, Error> {
        let capacity = k.saturating_add(z);
        let root = |core_set: &[u32], threshold| {
            let items = Arc::new(cloud.items.some(core_set));
            let links = cloud.links(core_set);
            Clusters::new(items, links, k, z as u64, threshold, cloud.can_avoid())
        };
        let separated = root(core_set, threshold).large_clique(capacity);
        if separated.len() > capacity {
            let separated = separated.into_iter().map(|item| core_set[item as usize]).collect();
            return Ok(Ok(Self::separated(cloud, separated, monitor)?));
        }
        let mut best: Option<(Vec<u32>, ProofLog)> = None;
        let (mut budget, mut threshold) = (budget, threshold);
        let rounding = rounding(cloud, threshold);
        let margin = REFUTED_MARGIN * rounding;
        for _ in 0..ROUNDS_MAX {
            let core_set = best.as_ref().map_or(core_set, |(core_set, _)| core_set);
            let mut log = match ProofTree::new(root(core_set, threshold), budget, monitor).log()? {
                Ok(log) => log,
                Err(why) if best.is_none() => return Ok(Err(why)),
                Err(_) => break,
            };
            if !log.held_out.is_empty() {
                // Larger balls may avoid what all smaller ones hold.
                log.lower = log.lower.min(threshold);
            }
            if log.open > log.lower * (1.0 - margin) {
                // A child that is open here may be refuted there: both have to be on the same side of the bound.
                threshold = log.open * (1.0 - margin);
                continue;
            }
            let claimed = claim(log.lower * (1.0 - rounding), core_set);
            if claimed > 0.0 && log.open > claimed * (1.0 - rounding) {
                // The checker refutes what reaches the bound that is claimed, and the log has to do the same.
                threshold = claimed * (1.0 + 2.0 * rounding);
                continue;
            }
            let nodes = log.items.len() as u64;
            budget = nodes.saturating_sub(1);
            let (needed, log) = renumbered(core_set, log);
            let is_last = needed.len() == core_set.len() || nodes > SHORTENED_NODES_MAX;
            best = Some((needed, log));
            if is_last {
                break;
            }
        }
        // Only logs that are not clear have led here without one.
        let Some((core_set, log)) = best else { return Ok(Err(Stop::Rounding)) };
        if core_set.len() > CORE_SET_MAX {
            return Ok(Err(Stop::ProofBudget));
        }
        let nodes = log.items.len() as u64;
        let lower = log.lower * (1.0 - rounding);
        let ProofLog { items, held_out, .. } = log;
        let kind = match held_out.is_empty() {
            true => LowerBound::Branches { items },
            false => LowerBound::Avoiding { items, held_out },
        };
        Ok(Ok(Proof { lower, core_set, kind, nodes }))
    }
}

/// What a bound of about this radius may be off by, relatively; 1 where it may be nothing.
pub(super) fn rounding<P>(cloud: &Cloud<P>, radius: f64) -> f64 {
    match cloud.place_error {
        0.0 => ROUNDING,
        error => (ROUNDING + PLACES * error / radius).min(1.0),
    }
}

/// The core-set without the items on which no node branches, in the order in which nodes do, and the log in these numbers.
fn renumbered(core_set: &[u32], log: ProofLog) -> (Vec<u32>, ProofLog) {
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
    (needed, ProofLog { items, ..log })
}
