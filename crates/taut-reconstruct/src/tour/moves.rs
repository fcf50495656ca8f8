//! Moves of three edges that shorten a tour.
//!
//! *Problem.* A tour that no sequential exchange of two or three edges shortens, where new edges are candidates but for the last.
//! *Idea.* From each node in a queue, t₁, an edge t₁t₂ is given up for a shorter t₂t₃, an edge t₃t₄ for t₄t₅, and t₆ is joined to
//! t₁: partial sums of the gain stay positive, and neighbors come by distance, so that a search ends early. The best move is
//! made, and its nodes are queued again: don't-look bits. Taking up a run and putting it down elsewhere (Or) is among the moves.
//! *Guarantee.* Each move shortens by more than rounding, so the search ends.
//! *Trap.* If t₄ is ahead of t₃, the two edges leave a cycle and a path: t₅ must be in the cycle.
//! *Reference.* Johnson and McGeoch, The traveling salesman problem: a case study, 1997; Bentley 1992.

use std::collections::VecDeque;

use super::candidates::Candidates;
use super::cycle::Cycle;
use super::metric::Metric;

/// A gain below this share of what is given up may be rounding.
const ROUNDING: f64 = 1e-12;

/// Nodes that may be starts of a shortening.
pub(super) struct Queue {
    nodes: VecDeque<u32>,
    waits: Vec<bool>,
}

impl Queue {
    pub(super) fn of(n: usize) -> Self {
        Self { nodes: VecDeque::new(), waits: vec![false; n] }
    }

    pub(super) fn push(&mut self, node: u32) {
        if !std::mem::replace(&mut self.waits[node as usize], true) {
            self.nodes.push_back(node);
        }
    }

    pub(super) fn pop(&mut self) -> Option<u32> {
        let node = self.nodes.pop_front()?;
        self.waits[node as usize] = false;
        Some(node)
    }
}

/// A move by its nodes t₁ … t₆.
#[derive(Clone, Copy)]
enum Move {
    /// Two edges.
    Two([u32; 4]),
    /// The same, and then two edges of what that gives.
    TwoTwice([u32; 6]),
    /// Two runs change places.
    Exchange([u32; 6]),
    /// Two runs are turned where they are.
    TurnBoth([u32; 6]),
}

impl Move {
    fn make(self, cycle: &mut Cycle) {
        match self {
            Move::Two([t1, t2, t3, t4]) => cycle.swap_edges(t1, t2, t4, t3),
            Move::TwoTwice([t1, t2, t3, t4, t5, t6]) => {
                cycle.swap_edges(t1, t2, t4, t3);
                cycle.swap_edges(t1, t4, t6, t5);
            }
            Move::Exchange([t1, t2, t3, t4, t5, t6]) => {
                cycle.exchange_runs([t1, t2], [t5, t6], [t3, t4]);
            }
            Move::TurnBoth([t1, t2, t3, t4, t5, t6]) => {
                cycle.swap_edges(t1, t2, t6, t5);
                cycle.swap_edges(t2, t5, t3, t4);
            }
        }
    }

    /// Returns how long the runs are that it reverses, at most about.
    fn reach(&self, cycle: &Cycle) -> usize {
        let n = cycle.len();
        let span = |a: u32, b: u32| {
            let steps = cycle.place(a).abs_diff(cycle.place(b)) as usize;
            steps.min(n - steps)
        };
        match *self {
            Move::Two([_, t2, _, t4]) => span(t2, t4),
            Move::TwoTwice([_, t2, _, t4, _, t6]) => span(t2, t4).max(span(t2, t6)),
            Move::Exchange([t1, t2, t3, t4, t5, t6]) => {
                let runs = [span(t2, t5), span(t6, t3), span(t4, t1)];
                runs.iter().sum::<usize>() - runs.into_iter().max().unwrap_or(0)
            }
            Move::TurnBoth([_, t2, t3, _, t5, t6]) => span(t2, t6).max(span(t5, t3)),
        }
    }

    fn nodes(&self) -> &[u32] {
        match self {
            Move::Two(nodes) => nodes,
            Move::TwoTwice(nodes) | Move::Exchange(nodes) | Move::TurnBoth(nodes) => nodes,
        }
    }
}

/// The data for the search of moves.
#[derive(Clone, Copy)]
pub(super) struct Search<'a> {
    pub(super) metric: &'a Metric,
    pub(super) candidates: &'a Candidates,
    /// Moves that reverse longer runs are left out.
    pub(super) reach: usize,
}

impl Search<'_> {
    /// Makes moves until the queue is empty or `go_on` says no, and returns by how much they shortened the tour.
    pub(super) fn improve(
        &self,
        cycle: &mut Cycle,
        queue: &mut Queue,
        mut go_on: impl FnMut() -> bool,
    ) -> f64 {
        let mut gained = 0.0;
        while let Some(t1) = queue.pop() {
            if let Some((gain, best)) = self.best(cycle, t1) {
                best.make(cycle);
                gained += gain;
                best.nodes().iter().for_each(|&node| queue.push(node));
                queue.push(t1);
                if !go_on() {
                    break;
                }
            }
        }
        gained
    }

    /// The best move that gives up an edge of t₁.
    fn best(&self, cycle: &Cycle, t1: u32) -> Option<(f64, Move)> {
        let mut best: Option<(f64, Move)> = None;
        let mut offer = |gain: f64, found: Move| {
            if best.is_none_or(|(most, _)| gain > most) && found.reach(cycle) <= self.reach {
                best = Some((gain, found));
            }
        };
        for forward in [true, false] {
            let t2 = cycle.ahead(t1, forward);
            let given = self.metric.between(t1, t2);
            let least = ROUNDING * given;
            for (t3, added) in self.tried(t2) {
                let g1 = given - added;
                if g1 <= least {
                    break;
                }
                if t3 == t1 || t3 == cycle.ahead(t2, forward) {
                    continue;
                }
                self.before(cycle, forward, g1, least, [t1, t2, t3], &mut offer);
                self.behind(cycle, forward, g1, least, [t1, t2, t3], &mut offer);
            }
        }
        best
    }

    /// With t₄ before t₃, which closes at once, or goes on from the path t₄ … t₂t₃ … t₁.
    #[inline(always)]
    fn before(
        &self,
        cycle: &Cycle,
        forward: bool,
        g1: f64,
        least: f64,
        [t1, t2, t3]: [u32; 3],
        offer: &mut impl FnMut(f64, Move),
    ) {
        let metric = self.metric;
        let t4 = cycle.ahead(t3, !forward);
        let second = metric.between(t3, t4);
        let (sum, least) = (g1 + second, least + ROUNDING * second);
        let gain = sum - metric.between(t4, t1);
        if gain > least {
            offer(gain, Move::Two([t1, t2, t3, t4]));
        }
        let i = cycle.steps(t2, t3, forward);
        for (t5, added) in self.tried(t4) {
            let g2 = sum - added;
            if g2 <= least {
                break;
            }
            if t5 == t3 || t5 == t1 || t5 == cycle.ahead(t4, !forward) {
                continue;
            }
            let turned = cycle.steps(t2, t5, forward) < i;
            let t6 = cycle.ahead(t5, forward == turned);
            let third = metric.between(t5, t6);
            let gain = g2 + third - metric.between(t6, t1);
            if gain > least + ROUNDING * third {
                offer(gain, Move::TwoTwice([t1, t2, t3, t4, t5, t6]));
            }
        }
    }

    /// With t₄ behind t₃, which leaves a cycle from t₂ to t₃, to be opened at t₅.
    #[inline(always)]
    fn behind(
        &self,
        cycle: &Cycle,
        forward: bool,
        g1: f64,
        least: f64,
        [t1, t2, t3]: [u32; 3],
        offer: &mut impl FnMut(f64, Move),
    ) {
        let metric = self.metric;
        let t4 = cycle.ahead(t3, forward);
        let second = metric.between(t3, t4);
        let (sum, least) = (g1 + second, least + ROUNDING * second);
        let i = cycle.steps(t2, t3, forward);
        for (t5, added) in self.tried(t4) {
            let g2 = sum - added;
            if g2 <= least {
                break;
            }
            if t5 == t3 || cycle.steps(t2, t5, forward) > i {
                continue;
            }
            let t6 = cycle.ahead(t5, forward);
            let third = metric.between(t5, t6);
            let gain = g2 + third - metric.between(t6, t1);
            if gain > least + ROUNDING * third {
                offer(gain, Move::Exchange([t1, t2, t3, t4, t5, t6]));
            }
            if t5 != t2 {
                let t6 = cycle.ahead(t5, !forward);
                let third = metric.between(t5, t6);
                let gain = g2 + third - metric.between(t6, t1);
                if gain > least + ROUNDING * third {
                    offer(gain, Move::TurnBoth([t1, t2, t3, t4, t5, t6]));
                }
            }
        }
    }

    /// Candidates of a node; the one at distance 0 from all has none.
    #[inline(always)]
    fn tried(&self, node: u32) -> impl Iterator<Item = (u32, f64)> {
        let known = (node as usize) < self.metric.sites();
        known.then(|| self.candidates.tried(node)).into_iter().flatten()
    }
}
