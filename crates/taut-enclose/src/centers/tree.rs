//! Free centers to any proved gap: one depth-first tree over a small growing core-set.
//!
//! *Problem.* Items, k and z: k balls of the least equal radius σ* that hold all items but z.
//! *Idea.* Color a core-set X with k colors so that no color needs a ball of radius τ = σ/(1 + ε) or more, σ being the best
//! radius so far. Where that is impossible, τ is a lower bound. Where it succeeds, the balls are looked at from all items: σ may
//! get smaller, and the farthest item joins X. The item with the fewest colors left is colored next ([`super::clusters`]).
//! ε comes down in steps, 0.1, 0.05, …: each step that ends has proved a gap, and leaves a better σ and X to the next.
//! *Restarts.* An early choice on a small X may be a poor one: while X grows, the tree starts again after 200 nodes, then 400, ….
//! *Threads.* A tree that is not small is cut into up to [`SUBSEARCH_COUNT`] subsearches ([`super::subsearch`]), which go on side by side for [`NODES_PER_ROUND`] nodes
//! each, at first for [`FIRST_ROUND_NODES`], knowing nothing of one another; then all learn what each has found, in the order of the subsearches, those that a dead
//! end of another one refutes are dropped, and others are cut in their place. None of this knows how many threads there are.
//! *Nogoods.* Where a tree of points of the plane becomes large, what it has to do again and again is recorded instead ([`super::nogoods`]).
//! *Outliers.* Balls may all have one radius just below τ; then an item is left out only where it lies in none of them. In the plane this
//! rules out most choices of what to leave out ([`super::avoiding_ball`]): on eight sets of 10⁴ to 1.5·10⁴ cities, k = 6 and z = 5, it divides nodes
//! by 2 to 17.
//! *Guarantee.* σ ≤ (1 + ε)·σ*, unless the nodes run out; then the gap of the last step that ended. The same on every run and for
//! any number of threads.
//! *Trap.* A threshold is a bound only when the tree for it has ended; that of a step under way says nothing.
//! *Evidence.* On 15,112 cities: adding all items outside at once makes X twice as large and the tree up to five times;
//! dropping items that did not help for some restarts makes it 1.8 to 3.5 times as large.
//! Steps by a factor of 0.3 take 1.5 to 2 times as long as by 0.5 for 10 to 15 centers of cities, and less for 10 in space.
//! *Reference.* The tree extends Algorithm 2 of the thesis (section 2.5); the choice of items is that of Brélaz, Comm. ACM 22, 1979.

use std::collections::HashSet;

use taut_certify::{PassBounds, Stop};
use taut_points::Monitor;
use taut_points::parallel::ParallelSlice;

use super::cloud::Cloud;
use super::items::Position;
use super::nogoods::{self, NogoodSearch, Refutation};
use super::start::{Incumbent, Start};
use super::subsearch::{End, Subsearch, Task};
use crate::Error;

/// The first gap that is proved on the way to smaller ones, and by how much each is smaller than the one before.
const FIRST_GAP: f64 = 0.1;
const NEXT_GAP: f64 = 0.5;
/// The first gap, however little is known; half of infinity would never end.
const WIDEST_GAP: f64 = 1e6;
/// Once a step below this leaves the centers as they are, the next is the last.
const LAST_BUT_ONE: f64 = 0.03;
/// A gap within this factor of the last one is not worth a step of its own.
const LAST_STEP_MIN: f64 = 1.5;
/// Nodes before the first restart.
const FIRST_RUN: u64 = 200;
/// A tree with more nodes is cut. Of 27 sets of cities and of space, 2000, and rounds of 500 at first, take 0.96 of the nodes of 4000 and 1000
/// in the mean, of 33 others that nothing was tuned on 0.99, and leave less to one thread; 1000 and 500 take 1.0 to 1.06.
const UNCUT_NODES_MAX: u64 = 2000;
/// This many subsearches go side by side, enough to keep the cores of a large machine busy. On 11 to 15 centers of cities 16
/// to 32 of them, and 500 to 1000 nodes of each, serve equally well: a tree has about as many nodes as without cuts,
/// and no fewer with shorter rounds.
const SUBSEARCH_COUNT: usize = 24;
/// A subsearch visits this many nodes in the round after a tree was cut, until all learn from one another.
const FIRST_ROUND_NODES: u64 = 500;
/// The same in each round that follows.
const NODES_PER_ROUND: u64 = 1000;

/// After this many nodes for one gap, nogoods are recorded in place of a tree, where that is possible. A tree is asked after its first nodes, before it is cut, or as
/// soon as its core-set has grown. Measured on four sets of cities and 15 centers, gap 1 %: in all 0.6 times as long as with 20,000 and 20,000, and 0.7 to 0.9 times
/// as long as with 5000 or 10,000 and 1000 to 10,000 others.
const NODES_BEFORE_NOGOODS: u64 = 10_000;
/// The same, where nogoods were recorded for a wider gap.
const NODES_BEFORE_MORE_NOGOODS: u64 = 1000;

pub(super) struct SearchResult<P> {
    pub(super) incumbent: Incumbent<P>,
    /// The bounds that finished trees over the core-set have proved, growing.
    pub(super) proved: Vec<ProvedBound>,
    /// The largest bound that nogoods have proved.
    pub(super) refuted: Option<(f64, Refutation)>,
    /// Items, by their number in the cloud.
    pub(super) core_set: Vec<u32>,
    pub(super) stop: Stop,
    pub(super) nodes: u64,
    pub(super) restarts: u64,
    pub(super) scans: u64,
    pub(super) history: Vec<PassBounds>,
}

/// A lower bound that a tree has shown of the first items of the core-set.
#[derive(Clone, Copy)]
pub(super) struct ProvedBound {
    pub(super) threshold: f64,
    pub(super) items: usize,
}

/// Why a tree ended before its end.
enum Halt {
    Restart,
    Budget,
    /// It is time to record nogoods.
    Large,
    Error(Error),
}

impl From<Error> for Halt {
    fn from(error: Error) -> Self {
        Halt::Error(error)
    }
}

pub(super) struct Search<'c, P> {
    task: Task<'c, P>,
    core_set: Vec<u32>,
    best: Incumbent<P>,
    gap: f64,
    nodes: u64,
    max_nodes: u64,
    restarts: u64,
    scans: u64,
    refuted: Option<(f64, Refutation)>,
    /// True if nogoods need more items than they may have.
    is_full: bool,
}

/// Solves to a gap of `epsilon`, from where the traversals have led.
pub(super) fn solve<P: Position>(
    cloud: &Cloud<P>,
    start: Start<P>,
    k: usize,
    z: usize,
    epsilon: f64,
    max_nodes: u64,
    monitor: &Monitor<'_>,
) -> Result<SearchResult<P>, Error> {
    let mut search = Search {
        task: Task { cloud, monitor, k, z },
        core_set: start.traversal,
        best: start.incumbent,
        gap: 0.0,
        nodes: 0,
        max_nodes,
        restarts: 0,
        scans: 0,
        refuted: None,
        is_full: false,
    };
    let mut lower = start.lower;
    let mut proved = vec![];
    let mut history = vec![];
    let mut stop = Stop::Converged;
    // What items apart prove of outliers is poor, and gains most from steps that are quick to end.
    let open = if z > 0 && lower > 0.0 { search.best.radius / lower - 1.0 } else { 0.0 };
    search.gap = epsilon.max(FIRST_GAP).max((0.5 * open).min(WIDEST_GAP));
    loop {
        let before = search.best.radius;
        if before <= (1.0 + epsilon) * lower {
            break;
        }
        // What is proved already needs no tree.
        if before > (1.0 + search.gap) * lower {
            match search.tree() {
                // A tree that finds much better centers ends at a bound that may be known.
                Ok(threshold) if threshold <= lower => {}
                Ok(threshold) => {
                    proved.push(ProvedBound { threshold, items: search.core_set.len() });
                    lower = threshold;
                }
                Err(Halt::Error(error)) => return Err(error),
                Err(_) => {
                    stop = Stop::NodeBudget;
                    history.push(search.bounds(lower));
                    break;
                }
            }
        }
        let upper = search.best.radius;
        history.push(search.bounds(lower));
        if search.gap <= epsilon {
            break;
        }
        let is_settled = upper == before && search.gap <= LAST_BUT_ONE;
        let next = search.gap * NEXT_GAP;
        search.gap = if is_settled || next < LAST_STEP_MIN * epsilon { epsilon } else { next };
    }
    let Search { best, core_set, nodes, restarts, scans, refuted, .. } = search;
    Ok(SearchResult {
        incumbent: best,
        proved,
        refuted,
        core_set,
        stop,
        nodes,
        restarts,
        scans,
        history,
    })
}

impl<P: Position> Search<'_, P> {
    /// Returns what is known, with this lower bound.
    fn bounds(&self, lower: f64) -> PassBounds {
        PassBounds { lower, upper: self.best.radius, working_set: self.core_set.len() as u64 }
    }

    /// Trees until one ends; the radius below which no balls were found.
    fn tree(&mut self) -> Result<f64, Halt> {
        let (mut run, first_node) = (FIRST_RUN, self.nodes);
        loop {
            match self.descend(run, first_node) {
                Err(Halt::Restart) => {
                    self.restarts += 1;
                    run *= 2;
                }
                Err(Halt::Large) => {
                    let Some(search) = P::in_plane(self) else {
                        self.is_full = true;
                        continue;
                    };
                    if let Some(threshold) = search.record_nogoods()? {
                        return Ok(threshold);
                    }
                }
                Err(halt) => return Err(halt),
                Ok(()) => return Ok(self.best.radius / (1.0 + self.gap)),
            }
        }
    }

    /// One tree, from its root to its end; `first_node` is the number of nodes before the first tree for this gap.
    fn descend(&mut self, run: u64, first_node: u64) -> Result<(), Halt> {
        let (root, known) = (self.nodes, self.core_set.len());
        let task = Task { ..self.task };
        let Some(subsearch) = Subsearch::new(&task, &self.core_set, &self.best, self.gap)? else {
            return Ok(());
        };
        let nodes_before_nogoods = match self.refuted {
            None => NODES_BEFORE_NOGOODS,
            Some(_) => NODES_BEFORE_MORE_NOGOODS,
        };
        let mut subsearches = vec![subsearch];
        let mut nodes = UNCUT_NODES_MAX;
        loop {
            let left = self.max_nodes.saturating_sub(self.nodes) / subsearches.len() as u64;
            if left == 0 {
                return Err(Halt::Budget);
            }
            let nodes_each = nodes.min(left);
            // Only a tree that is not cut can tell at each node that it is time to start again.
            let run_each = if subsearches.len() == 1 { run } else { u64::MAX };
            let ends: Vec<End> = subsearches
                .par_iter_mut()
                .map(|subsearch| subsearch.go_on(nodes_each, run_each, known))
                .collect::<Result<_, Error>>()?;
            self.learn_from(&mut subsearches);
            let has_grown = self.core_set.len() > known;
            let mut refuted = vec![];
            let mut open = Vec::with_capacity(SUBSEARCH_COUNT);
            for (subsearch, end) in subsearches.into_iter().zip(ends) {
                match end {
                    End::Open | End::Grown => open.push(subsearch),
                    End::Refuted(conflict) => refuted.push(subsearch.first_decisions(&conflict)),
                    End::Done => {}
                }
            }
            subsearches = open;
            subsearches.retain(|subsearch| {
                !refuted.iter().any(|decisions| subsearch.begins_with(decisions))
            });
            if subsearches.is_empty() {
                return Ok(());
            }
            // The core-set has grown since the tree began.
            if self.nodes - first_node >= nodes_before_nogoods
                && !self.is_full
                && nogoods::applies(&self.task, self.core_set.len(), self.gap)
            {
                return Err(Halt::Large);
            }
            if has_grown && self.nodes - root >= run {
                return Err(Halt::Restart);
            }
            let was_uncut = subsearches.len() == 1;
            cut(&mut subsearches);
            nodes = if was_uncut { FIRST_ROUND_NODES } else { NODES_PER_ROUND };
        }
    }

    /// Shares what each subsearch has found with all.
    fn learn_from(&mut self, subsearches: &mut [Subsearch<'_, P>]) {
        let mut union: HashSet<u32> = self.core_set.iter().copied().collect();
        for subsearch in &mut *subsearches {
            if subsearch.best.radius < self.best.radius {
                self.best = subsearch.best.clone();
            }
            self.core_set
                .extend(subsearch.core_set.iter().copied().filter(|&item| union.insert(item)));
            self.nodes += std::mem::take(&mut subsearch.nodes);
            self.scans += std::mem::take(&mut subsearch.scans);
        }
        for subsearch in subsearches {
            subsearch.learn(&self.core_set);
            subsearch.offer(&self.best);
        }
    }
}

impl Search<'_, [f64; 2]> {
    /// Searches for balls by nogoods; the radius below which none were found, or `None` where that takes too many items.
    fn record_nogoods(&mut self) -> Result<Option<f64>, Halt> {
        // Wide sets take longer to compare, and a search that turns out to need wider ones starts again.
        for words in [8, 16, 24, 32] {
            if self.core_set.len() as f64 * nogoods::CORE_SET_GROWTH > 64.0 * words as f64 {
                continue;
            }
            let threshold = match words {
                8 => self.record_nogoods_in::<8>()?,
                16 => self.record_nogoods_in::<16>()?,
                24 => self.record_nogoods_in::<24>()?,
                _ => self.record_nogoods_in::<32>()?,
            };
            if threshold.is_some() {
                return Ok(threshold);
            }
            if self.is_full {
                break;
            }
        }
        self.is_full = true;
        Ok(None)
    }

    /// The same with sets of so many words; `None` where these are too short, or nogoods cannot be checked.
    fn record_nogoods_in<const WORDS: usize>(&mut self) -> Result<Option<f64>, Halt> {
        let task = Task { ..self.task };
        let nodes_left = self.max_nodes.saturating_sub(self.nodes);
        let mut search =
            NogoodSearch::<WORDS>::new(&task, &self.core_set, &self.best, self.gap, nodes_left);
        let end = search.go_on()?;
        self.nodes += search.nodes;
        self.scans += search.scans;
        self.best = search.best;
        self.core_set = search.core_set;
        match end {
            nogoods::End::Budget => Err(Halt::Budget),
            nogoods::End::ManyItems => Ok(None),
            nogoods::End::Full => {
                self.is_full = true;
                Ok(None)
            }
            nogoods::End::Refuted(refutation) => {
                let threshold = self.best.radius / (1.0 + self.gap);
                self.refuted = Some((threshold, refutation));
                Ok(Some(threshold))
            }
        }
    }
}

/// Cuts subsearches where they have choices nearest to the root, until there are enough.
fn cut<P: Position>(subsearches: &mut Vec<Subsearch<'_, P>>) {
    while subsearches.len() < SUBSEARCH_COUNT {
        let choices = subsearches.iter().enumerate();
        let first =
            choices.filter_map(|(at, subsearch)| Some((subsearch.first_choice()?, at))).min();
        let Some((_, at)) = first else { break };
        let Some(other) = subsearches[at].cut() else { break };
        // It comes next, as it would have without the cut.
        subsearches.insert(at + 1, other);
    }
}
