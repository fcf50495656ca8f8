//! The proof log: the tree over a core-set that proves a radius too small, written down node by node.
//!
//! *Idea.* The radius and the items stay as they are: each item is given to each cluster in turn, to a new one, and to those left
//! out, and each of these children has a tree of its own or is refuted at once by a ball that is too large.
//! A node can also be refuted by the items left out above it ([`super::avoiding_ball`]).
//! *Threads.* What is below a node depends on nothing beside it. A tree that is not small is opened from its root until there are
//! [`UNKNOWN_PARTS_MAX`] nodes whose trees are unknown, or [`OPENED_NODES_MAX`] in all; these are made side by side, and their logs put where they belong.
//! *Guarantee.* One set of options has one log, or one reason to have none: it is longer than the budget, else it does not end in
//! dead ends alone. A part that fails does not stop the others, so the reason does not depend on threads.

use std::sync::atomic::{AtomicU64, Ordering};

use taut_certify::{HeldOut, Stop};
use taut_points::parallel::IntoParallel;
use taut_points::{Monitor, ReadError};

use super::depth_first::{Path, Place, State};
use crate::Error;

/// A tree with more nodes is made in parts.
const WHOLE_TREE_NODES_MAX: u64 = 1000;
/// A tree is opened until the trees of this many nodes are unknown: far more than there are cores, as some are a
/// hundred times as large as others.
const UNKNOWN_PARTS_MAX: usize = 256;
/// A tree that this many nodes have not made so wide is left as it is.
const OPENED_NODES_MAX: usize = 4 * UNKNOWN_PARTS_MAX;
/// Each part adds to the common count of nodes after this many of its own.
const NODES_BETWEEN_COUNTS: u64 = 64;
/// Most items of a core-set with a log: below the checker's limit of 16384.
pub(super) const CORE_SET_MAX: usize = 16_000;

/// A state whose tree can be written down.
pub(super) trait Proving: State + Clone + Send + Sync {
    /// What comes next in the log.
    fn step(&mut self) -> Step;

    /// The places of an item that are not refuted at once, in the order of the log; `bounds` takes what refutes the others.
    fn open_places(&mut self, item: u32, bounds: &mut ProofLog) -> Vec<Place>;
}

/// What a node is in the log.
pub(super) enum Step {
    /// These items are branched on, one below the other until each child is refuted.
    Branch(Vec<u32>),
    /// The node is refuted: each ball that holds this cluster holds an item left out, too.
    HeldOut(usize),
    /// Balls below the threshold hold the core-set.
    Open,
}

/// A tree written down.
#[derive(Debug, PartialEq)]
pub(super) struct ProofLog {
    /// The item of each node, in preorder.
    pub(super) items: Vec<u32>,
    /// The nodes in which each ball that holds a cluster holds an item left out.
    pub(super) held_out: Vec<HeldOut>,
    /// The least of the bounds by which children were refuted.
    pub(super) lower: f64,
    /// The largest radius of a ball of a child that was not.
    pub(super) open: f64,
}

impl ProofLog {
    fn held_out(&mut self, cluster: usize) {
        self.held_out.push(HeldOut { at: self.items.len() as u64, cluster: cluster as u32 });
    }

    /// Adds what comes next in preorder.
    fn append(&mut self, next: ProofLog) {
        let before = self.items.len() as u64;
        self.held_out
            .extend(next.held_out.into_iter().map(|end| HeldOut { at: before + end.at, ..end }));
        self.items.extend(next.items);
        self.lower = self.lower.min(next.lower);
        self.open = self.open.max(next.open);
    }

    fn empty() -> Self {
        ProofLog { items: vec![], held_out: vec![], lower: f64::INFINITY, open: 0.0 }
    }
}

/// A part of a log.
struct Piece {
    log: ProofLog,
    /// `Ok` if the part is complete; else why it stopped.
    end: Result<(), Stop>,
}

impl Piece {
    fn node(item: u32) -> Self {
        let log = ProofLog { items: vec![item], ..ProofLog::empty() };
        Piece { log, end: Ok(()) }
    }

    fn held_out(cluster: usize) -> Self {
        let mut log = ProofLog::empty();
        log.held_out(cluster);
        Piece { log, end: Ok(()) }
    }
}

pub(super) struct ProofTree<'a, S> {
    /// The state before any decision.
    root: S,
    /// Most nodes.
    budget: u64,
    monitor: &'a Monitor<'a>,
    /// Nodes so far, but for the last few of each part.
    nodes: AtomicU64,
}

/// A piece of a log that is not complete.
enum Part<S> {
    Node(u32),
    HeldOut(usize),
    /// All from the node on to which so many decisions led, and the chain it is in.
    Below {
        state: Box<S>,
        depth: usize,
        chain: Vec<u32>,
    },
}

impl<'a, S: Proving> ProofTree<'a, S> {
    pub(super) fn new(root: S, budget: u64, monitor: &'a Monitor<'a>) -> Self {
        ProofTree { root, budget, monitor, nodes: AtomicU64::new(0) }
    }

    /// The whole tree, or why there is none: [`Stop::ProofBudget`], or [`Stop::Rounding`] where balls below the threshold hold the
    /// core-set.
    pub(super) fn log(&self) -> Result<Result<ProofLog, Stop>, Error> {
        let small = self.below(self.root.clone(), vec![], WHOLE_TREE_NODES_MAX.min(self.budget))?;
        if small.end != Err(Stop::ProofBudget) || self.budget <= WHOLE_TREE_NODES_MAX {
            return Ok(small.end.map(|()| small.log));
        }
        self.nodes.store(0, Ordering::Relaxed);
        let mut log = ProofLog::empty();
        let Some(parts) = self.open(&mut log)? else { return Ok(Err(Stop::Rounding)) };
        let pieces: Vec<Piece> = parts
            .into_par_iter()
            .map(|part| match part {
                Part::Node(item) => Ok(Piece::node(item)),
                Part::HeldOut(cluster) => Ok(Piece::held_out(cluster)),
                Part::Below { state, chain, .. } => self.below(*state, chain, self.budget),
            })
            .collect::<Result<_, Error>>()?;
        let steps = |log: &ProofLog| (log.items.len() + log.held_out.len()) as u64;
        let nodes: u64 = pieces.iter().map(|piece| steps(&piece.log)).sum();
        let ends_by = |why| pieces.iter().any(|piece| piece.end == Err(why));
        if nodes > self.budget || ends_by(Stop::ProofBudget) {
            return Ok(Err(Stop::ProofBudget));
        }
        if ends_by(Stop::Rounding) {
            return Ok(Err(Stop::Rounding));
        }
        pieces.into_iter().for_each(|piece| log.append(piece.log));
        Ok(Ok(log))
    }

    /// The tree opened from its root on, nodes nearest to it first; `bounds` takes what its children are refuted by.
    fn open(&self, bounds: &mut ProofLog) -> Result<Option<Vec<Part<S>>>, Error> {
        let mut parts =
            vec![Part::Below { state: Box::new(self.root.clone()), depth: 0, chain: vec![] }];
        let mut unknown = 1;
        while (1..UNKNOWN_PARTS_MAX).contains(&unknown) && parts.len() < OPENED_NODES_MAX {
            self.monitor.check().map_err(ReadError::from)?;
            let unknowns = parts.iter_mut().enumerate().filter_map(|(at, part)| match part {
                Part::Node(_) | Part::HeldOut(_) => None,
                Part::Below { state, depth, chain } => Some((*depth, at, state, chain)),
            });
            let first = unknowns.min_by_key(|&(depth, at, ..)| (depth, at));
            let (depth, at, state, chain) = first.expect("some are unknown");
            let (item, rest) = match next(&mut **state, chain) {
                Next::Branch(item, rest) => (item, rest),
                Next::HeldOut(cluster) => {
                    parts[at] = Part::HeldOut(cluster);
                    unknown -= 1;
                    continue;
                }
                Next::Open => return Ok(None),
            };
            let places = state.open_places(item, bounds);
            unknown = unknown - 1 + places.len();
            let child = |place| {
                let mut state = state.clone();
                state.put(item, place);
                Part::Below { state, depth: depth + 1, chain: rest.clone() }
            };
            let children: Vec<Part<S>> = places.into_iter().map(child).collect();
            parts.splice(at..=at, std::iter::once(Part::Node(item)).chain(children));
        }
        Ok(Some(parts))
    }

    /// All from the node in this state on, but no more than `most` nodes, and no more once all parts together exceed the budget.
    fn below(&self, mut state: S, chain: Vec<u32>, most: u64) -> Result<Piece, Error> {
        let mut piece = Piece { log: ProofLog::empty(), end: Err(Stop::ProofBudget) };
        let log = &mut piece.log;
        let mut path = Path::new();
        loop {
            // One load of a flag, which any node outweighs; with centers at rows a node can take milliseconds.
            self.monitor.check().map_err(ReadError::from)?;
            let steps = (log.items.len() + log.held_out.len()) as u64;
            if steps.is_multiple_of(NODES_BETWEEN_COUNTS) {
                let counted = if steps == 0 { 0 } else { NODES_BETWEEN_COUNTS };
                let nodes = self.nodes.fetch_add(counted, Ordering::Relaxed) + counted;
                if nodes > self.budget {
                    return Ok(piece);
                }
            }
            if steps >= most {
                return Ok(piece);
            }
            match next(&mut state, path.chain().unwrap_or(&chain)) {
                Next::Branch(item, rest) => {
                    log.items.push(item);
                    let places = state.open_places(item, log);
                    path.branch(item, places, rest);
                }
                Next::HeldOut(cluster) => log.held_out(cluster),
                Next::Open => {
                    piece.end = Err(Stop::Rounding);
                    return Ok(piece);
                }
            }
            if !path.advance(&mut state) {
                piece.end = Ok(());
                return Ok(piece);
            }
        }
    }
}

/// What a node is in the log, if it is in a chain.
enum Next {
    /// The item to branch on and the rest of its chain.
    Branch(u32, Vec<u32>),
    HeldOut(usize),
    Open,
}

/// Goes on with a chain, and asks for a step where it has ended.
fn next<S: Proving>(state: &mut S, chain: &[u32]) -> Next {
    let mut chain = match chain {
        [] => match state.step() {
            Step::Branch(chain) => chain,
            Step::HeldOut(cluster) => return Next::HeldOut(cluster),
            Step::Open => return Next::Open,
        },
        rest => rest.to_vec(),
    };
    match chain.is_empty() {
        true => Next::Open,
        false => Next::Branch(chain.remove(0), chain),
    }
}
