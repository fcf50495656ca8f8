//! The lower bound once more, in the words of the certificate: branches in preorder, over as few items as will do.
//!
//! *Idea.* The same nodes as in the search, but X is fixed, children come in the order that the certificate prescribes, and
//! where a node has no way on for a reason (items apart), the items are branched on one after the other until every
//! child is refuted at once. Items on which no node branches are dropped, and the rest is proved again.

use taut_certify::{LowerBound, Stop};
use taut_points::{Monitor, ReadError};

use super::core_set::CoreSet;
use super::sites::Sites;
use super::state::{Child, Look, State, Undo};
use crate::Error;

/// More items no checker takes.
const ITEMS: usize = 16_000;
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
    let mut core = CoreSet::new(sites, radius, members, monitor)?;
    if let Look::Dead(mut items) = State::new(k, outliers).look(&core) {
        // One item alone that has no ball is not dead with others apart from it.
        let count = k.checked_add(outliers).filter(|&count| items.len() > count && count < ITEMS);
        if let Some(count) = count {
            items.truncate(count + 1);
            let members = items.into_iter().map(|item| core.members[item]).collect();
            return Ok(Ok(Proof { members, by: LowerBound::Apart, nodes: 1 }));
        }
    }
    let mut log = match branches(&core, k, outliers, max_nodes, monitor)? {
        Ok(log) => log,
        Err(why) => return Ok(Err(why)),
    };
    for _ in 0..DROPPING_ROUNDS_MAX {
        let mut used: Vec<u32> = log.clone();
        used.sort_unstable();
        used.dedup();
        if used.len() == core.len() {
            break;
        }
        let members: Vec<usize> = used.iter().map(|&item| core.members[item as usize]).collect();
        let less = CoreSet::new(sites, radius, &members, monitor)?;
        match branches(&less, k, outliers, 2 * log.len() as u64, monitor)? {
            Ok(shorter) => (core, log) = (less, shorter),
            Err(_) => {
                // The log stands as it is, over the items it uses.
                let place = |item: u32| used.partition_point(|&other| other < item) as u32;
                (core, log) = (less, log.into_iter().map(place).collect());
                break;
            }
        }
    }
    if core.len() > ITEMS {
        return Ok(Err(Stop::ProofBudget));
    }
    let nodes = log.len() as u64;
    Ok(Ok(Proof { members: core.members, by: LowerBound::Branches { items: log }, nodes }))
}

/// A node above the present one, with the items to branch on below it.
struct Frame {
    item: usize,
    plan: Vec<usize>,
    children: std::vec::IntoIter<Child>,
    entered: Option<(Child, Undo)>,
}

/// The items on which the nodes branch, in preorder; or why there are none: nodes are used up, or X is held after all.
fn branches(
    core: &CoreSet<'_>,
    k: usize,
    outliers: usize,
    max_nodes: u64,
    monitor: &Monitor<'_>,
) -> Result<Result<Vec<u32>, Stop>, Error> {
    let mut log = vec![];
    let mut state = State::new(k, outliers);
    let mut path: Vec<Frame> = vec![];
    loop {
        monitor.check().map_err(ReadError::from)?;
        if log.len() as u64 >= max_nodes {
            return Ok(Err(Stop::ProofBudget));
        }
        let mut plan = path.last().map_or(vec![], |frame| frame.plan.clone());
        if plan.is_empty() {
            plan = match state.look(core) {
                Look::Covered => return Ok(Err(Stop::Rounding)),
                Look::Branch(item) => vec![item],
                Look::Dead(items) => items,
            };
        }
        let item = plan.remove(0);
        log.push(item as u32);
        let children = state.children(core, item).into_iter();
        path.push(Frame { item, plan, children, entered: None });
        loop {
            let Some(frame) = path.last_mut() else { return Ok(Ok(log)) };
            if let Some((child, undo)) = frame.entered.take() {
                state.leave(frame.item, child, undo);
            }
            if let Some(child) = frame.children.next() {
                frame.entered = Some((child, state.enter(core, frame.item, child)));
                break;
            }
            path.pop();
        }
    }
}
