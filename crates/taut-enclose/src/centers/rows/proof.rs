//! Proves the lower bound and writes the proof log: branches in preorder, over as few items as possible.
//!
//! *Idea.* The same nodes as in the search, but X is fixed, children come in the order that the certificate prescribes, and
//! where a node has no way on for a reason (items apart), the items are branched on one after the other until every
//! child is refuted at once. Items on which no node branches are dropped, and the rest is proved again.

use std::sync::Arc;

use taut_certify::{LowerBound, Stop};
use taut_points::Monitor;

use super::core_set::CoreSet;
use super::sites::Sites;
use super::state::{NodeState, State};
use crate::Error;
use crate::centers::proof_tree::{CORE_SET_MAX, ProofTree};

/// Items that no node branches on are dropped in at most this many rounds.
const DROPPING_ROUNDS_MAX: usize = 4;

/// Items that prove a bound, and how.
pub(super) struct Proof {
    pub(super) members: Vec<usize>,
    pub(super) by: LowerBound,
    pub(super) nodes: u64,
}

/// Proves that no k balls of less than `radius` hold all but `outliers` of the members; or why not: it takes more than
/// `max_nodes`, or is not so, which can only be by rounding.
pub(super) fn prove(
    sites: &Sites,
    members: &[usize],
    radius: f64,
    k: usize,
    outliers: usize,
    max_nodes: u64,
    monitor: &Monitor<'_>,
) -> Result<Result<Proof, Stop>, Error> {
    let root = |members: &[usize]| {
        let core = Arc::new(CoreSet::new(sites, radius, members, monitor)?);
        Ok::<_, Error>(State::new(core, k, outliers))
    };
    let state = root(members)?;
    if let NodeState::Dead(mut items) = state.clone().examine() {
        // One item alone that has no ball is not dead with others apart from it.
        let count =
            k.checked_add(outliers).filter(|&count| items.len() > count && count < CORE_SET_MAX);
        if let Some(count) = count {
            items.truncate(count + 1);
            let members = items.into_iter().map(|item| members[item]).collect();
            return Ok(Ok(Proof { members, by: LowerBound::Separated, nodes: 1 }));
        }
    }
    let mut log = match ProofTree::new(state, max_nodes, monitor).log()? {
        Ok(log) => log.items,
        Err(why) => return Ok(Err(why)),
    };
    let mut members = members.to_vec();
    for _ in 0..DROPPING_ROUNDS_MAX {
        let mut used: Vec<u32> = log.clone();
        used.sort_unstable();
        used.dedup();
        if used.len() == members.len() {
            break;
        }
        members = used.iter().map(|&item| members[item as usize]).collect();
        match ProofTree::new(root(&members)?, 2 * log.len() as u64, monitor).log()? {
            Ok(shorter) => log = shorter.items,
            Err(_) => {
                // The log stands as it is, over the items it uses.
                let place = |item: u32| used.partition_point(|&other| other < item) as u32;
                log = log.into_iter().map(place).collect();
                break;
            }
        }
    }
    if members.len() > CORE_SET_MAX {
        return Ok(Err(Stop::ProofBudget));
    }
    let nodes = log.len() as u64;
    Ok(Ok(Proof { members, by: LowerBound::Branches { items: log }, nodes }))
}
