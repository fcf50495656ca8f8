//! The proof log: the tree over a core-set that proves a radius too small, written down node by node.
//!
//! *Idea.* The radius and the items stay as they are: each item is given to each cluster in turn, to a new one, and to those left
//! out, and each of these children has a tree of its own or is refuted at once by a ball that is too large.
//! A node can also be refuted by the items left out above it ([`super::avoiding_ball`]).
//! *Threads.* What is below a node depends on nothing beside it. After [`PART_NODES_MAX`] nodes a part of the tree leaves what it has
//! not come to, subtrees from the deepest to the one nearest to its root, as parts of their own. The first [`PARTS_AT_ONCE`] parts in
//! the order of the log are made side by side, then the first of what is left.
//! *Guarantee.* One set of options has one log, or one reason to have none: it does not end in dead ends alone, or it is longer than the
//! budget, whichever the parts made at once show first. Neither depends on threads.

use std::collections::VecDeque;

use taut_certify::{HeldOut, Stop};
use taut_points::parallel::IntoParallel;
use taut_points::{Monitor, ReadError};

use super::depth_first::{Path, Place, State};
use crate::Error;

/// A part has this many nodes. On cities some twenty parts are left then, each with a copy of its state, which takes as long as a node.
const PART_NODES_MAX: u64 = 256;
/// This many parts are made at once: more than there are cores, and few enough copies of states.
const PARTS_AT_ONCE: usize = 64;
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

    /// The number of nodes.
    fn nodes(&self) -> u64 {
        (self.items.len() + self.held_out.len()) as u64
    }

    fn empty() -> Self {
        ProofLog { items: vec![], held_out: vec![], lower: f64::INFINITY, open: 0.0 }
    }
}

pub(super) struct ProofTree<'a, S> {
    /// The state before any decision.
    root: S,
    /// Most nodes.
    budget: u64,
    monitor: &'a Monitor<'a>,
}

/// A part of a log, or the tree that is to make it.
enum Part<S> {
    Made(ProofLog),
    /// All from the node in this state on, and the chain it is in.
    Below(S, Vec<u32>),
}

impl<'a, S: Proving> ProofTree<'a, S> {
    pub(super) fn new(root: S, budget: u64, monitor: &'a Monitor<'a>) -> Self {
        ProofTree { root, budget, monitor }
    }

    /// The whole tree, or why there is none: [`Stop::ProofBudget`], or [`Stop::Rounding`] where balls below the threshold hold the
    /// core-set.
    pub(super) fn log(self) -> Result<Result<ProofLog, Stop>, Error> {
        let mut log = ProofLog::empty();
        let mut parts = VecDeque::from([Part::Below(self.root, vec![])]);
        while !parts.is_empty() {
            let made: Vec<Option<Vec<Part<S>>>> = first_parts(&mut parts)
                .into_par_iter()
                .map(|part| match part {
                    Part::Made(log) => Ok(Some(vec![Part::Made(log)])),
                    Part::Below(state, chain) => below(state, chain, self.monitor),
                })
                .collect::<Result<_, Error>>()?;
            let Some(made) = made.into_iter().collect::<Option<Vec<_>>>() else {
                return Ok(Err(Stop::Rounding));
            };
            made.into_iter().flatten().rev().for_each(|part| parts.push_front(part));
            while let Some(Part::Made(made)) = parts.pop_front_if(|part| part.is_made()) {
                log.append(made);
            }
            if log.nodes() + parts.iter().map(Part::nodes).sum::<u64>() > self.budget {
                return Ok(Err(Stop::ProofBudget));
            }
        }
        Ok(Ok(log))
    }
}

impl<S> Part<S> {
    fn is_made(&self) -> bool {
        matches!(self, Part::Made(_))
    }

    /// The number of nodes that it has made, or one, as it will have at least that.
    fn nodes(&self) -> u64 {
        match self {
            Part::Made(log) => log.nodes(),
            Part::Below(..) => 1,
        }
    }
}

/// Takes the parts up to the last that are to be made next.
fn first_parts<S>(parts: &mut VecDeque<Part<S>>) -> Vec<Part<S>> {
    let open = parts.iter().enumerate().filter(|(_, part)| !part.is_made());
    let last = open.map(|(at, _)| at).take(PARTS_AT_ONCE).last();
    parts.drain(..last.map_or(0, |last| last + 1)).collect()
}

/// A tree as far as a part goes, and what is left of it; none where balls below the threshold hold the core-set.
fn below<S: Proving>(
    mut state: S,
    chain: Vec<u32>,
    monitor: &Monitor<'_>,
) -> Result<Option<Vec<Part<S>>>, Error> {
    let mut log = ProofLog::empty();
    let mut path = Path::new();
    loop {
        // One load of a flag, which any node outweighs; with centers at rows a node can take milliseconds.
        monitor.check().map_err(ReadError::from)?;
        let chain = path.chain().unwrap_or(&chain);
        if log.nodes() >= PART_NODES_MAX {
            let here = Part::Below(state.clone(), chain.to_vec());
            let left = path.left(state).into_iter();
            let left = left.map(|(state, chain)| Part::Below(state, chain));
            return Ok(Some([Part::Made(log), here].into_iter().chain(left).collect()));
        }
        match next(&mut state, chain) {
            Next::Branch(item, rest) => {
                log.items.push(item);
                let places = state.open_places(item, &mut log);
                path.branch(item, places, rest);
            }
            Next::HeldOut(cluster) => log.held_out(cluster),
            Next::Open => return Ok(None),
        }
        if !path.advance(&mut state) {
            return Ok(Some(vec![Part::Made(log)]));
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
