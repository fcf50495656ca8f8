//! Fewer bodies that cover almost as much: pairs give way to one body, and needless ones go.
//!
//! *Problem.* Among bodies of a packing, leave out as many as possible, or put one in the place of two, so that at least a given part
//! of what they cover stays covered.
//! *Idea.* A body goes if what it alone covers can be spared, the one with the least first. Then neighbors are taken in pairs, those
//! with the least that the two alone cover first: one body grows from points between them against all that the others leave, and
//! takes their place if enough stays covered. Merging pairs of spheres into one body is section 8.5 of the thesis.
//! *Guarantee.* The part asked for of the points that the search counts stays covered, or of the lines hidden. Nothing is claimed about
//! how few bodies can do that.

use std::collections::BTreeSet;

use taut_points::OrderBy;

use super::pack::{Family, Packing, Reached, distance};
use crate::Error;

/// The part of the events of a search that merging takes in addition.
pub(super) const EVENTS_PART: u64 = 2;

/// Neighbors of a body with which it is tried to be merged.
const NEIGHBORS: usize = 4;

/// Events for a pair, at least: fewer grow no body that is worth two.
const PAIR_EVENTS_MIN: u64 = 200;

impl<F: Family> Packing<'_, F> {
    /// Merges bodies while at most a part of what they cover is lost, with so many events.
    pub(super) fn merge(&mut self, loss: f64, events: u64) -> Result<(), Error> {
        let least = ((1.0 - loss) * self.counted() as f64).ceil() as u64;
        let until = self.family.events() + events;
        let share = (events / (2 * self.bodies.len() as u64 + 1)).max(PAIR_EVENTS_MIN);
        let mut tried = BTreeSet::new();
        self.drop_needless(least);
        while self.family.events() < until {
            let Some(pair) = self.pairs().into_iter().find(|pair| tried.insert(self.names(pair)))
            else {
                break;
            };
            let most = until.min(self.family.events() + share);
            if let Some((body, reached)) = self.one_for(pair, least, most)? {
                let [kept, gone] = pair;
                (self.bodies[kept], self.reaches[kept]) = (body, reached);
                self.remove(gone);
                self.drop_needless(least);
            }
        }
        Ok(())
    }

    /// How many points are covered, or lines hidden, as the objective has it.
    fn counted(&self) -> u64 {
        if self.input.lines.is_some() { self.hidden() } else { self.covered() }
    }

    /// The points, or lines, that a body reaches, ascending.
    fn items<'b>(&self, reached: &'b Reached) -> &'b [u32] {
        if self.input.lines.is_some() { &reached.lines } else { &reached.points }
    }

    fn reach(&self, body: usize) -> &[u32] {
        self.items(&self.reaches[body])
    }

    /// The items that no body but some of them reaches.
    fn open(&self, without: &[usize]) -> Vec<usize> {
        if self.input.lines.is_some() {
            self.open_lines(without)
        } else {
            self.open_points(without)
        }
    }

    fn remove(&mut self, body: usize) {
        self.bodies.remove(body);
        self.reaches.remove(body);
    }

    /// What tells a pair from others, also after bodies before it have gone: interior points of both.
    fn names(&self, pair: &[usize; 2]) -> [[i32; 3]; 2] {
        pair.map(|body| self.family.anchor(&self.bodies[body]))
    }

    /// How many bodies reach each item.
    fn counts(&self) -> Vec<u32> {
        let all = if self.input.lines.is_some() {
            self.input.lines.map_or(0, |sample| sample.lines.len())
        } else {
            self.input.points.len()
        };
        let mut counts = vec![0; all];
        for body in 0..self.bodies.len() {
            self.reach(body).iter().for_each(|&item| counts[item as usize] += 1);
        }
        counts
    }

    /// Leaves out bodies as long as enough stays covered. Those that contain given points stay.
    fn drop_needless(&mut self, least: u64) {
        loop {
            let counts = self.counts();
            let own = |body: usize| {
                self.reach(body).iter().filter(|&&item| counts[item as usize] == 1).count() as u64
            };
            let candidates = self.input.given.len()..self.bodies.len();
            let Some((own, body)) = candidates.map(|body| (own(body), body)).min() else { return };
            if self.bodies.len() == 1 || self.counted() - own < least {
                return;
            }
            self.remove(body);
        }
    }

    /// Pairs of neighbors, those first that alone cover least.
    fn pairs(&self) -> Vec<[usize; 2]> {
        let counts = self.counts();
        let anchors: Vec<_> = self.bodies.iter().map(|body| self.family.anchor(body)).collect();
        let mut pairs = BTreeSet::new();
        for body in self.input.given.len()..self.bodies.len() {
            let mut others: Vec<usize> = (self.input.given.len()..self.bodies.len()).collect();
            others.retain(|&other| other != body);
            let far = |other: usize| distance(anchors[body], anchors[other]);
            others.order_by(&|&a, &b| far(a).total_cmp(&far(b)));
            pairs.extend(
                others.iter().take(NEIGHBORS).map(|&other| [body.min(other), body.max(other)]),
            );
        }
        let mut sorted: Vec<(usize, [usize; 2])> = pairs
            .into_iter()
            .map(|pair| {
                let [a, b] = pair.map(|body| self.reach(body));
                let once = [a, b]
                    .into_iter()
                    .flatten()
                    .filter(|&&item| counts[item as usize] == 1)
                    .count();
                // Both lists ascend.
                let twice = a
                    .iter()
                    .filter(|&&item| counts[item as usize] == 2 && b.binary_search(&item).is_ok());
                (once + twice.count(), pair)
            })
            .collect();
        sorted.order();
        sorted.into_iter().map(|(_, pair)| pair).collect()
    }

    /// One body in the place of two with which enough stays covered, if one is found.
    fn one_for(
        &mut self,
        pair: [usize; 2],
        least: u64,
        until: u64,
    ) -> Result<Option<(F::Body, Reached)>, Error> {
        let (points, lines) = (self.open_points(&pair), self.open_lines(&pair));
        let open: BTreeSet<usize> = self.open(&pair).into_iter().collect();
        let before: BTreeSet<usize> = self.open(&[]).into_iter().collect();
        let own: Vec<usize> = open.difference(&before).copied().collect();
        let without = self.counted() - own.len() as u64;
        self.set_obstacles(&pair);
        self.aim(&points, &lines);
        let Some((_, body)) = self.best_from(&own, until)? else { return Ok(None) };
        // Scores of lines are rounded; what counts in the end is not.
        let reached = self.reached(&body);
        let is_new = |&&item: &&u32| open.contains(&(item as usize));
        let found = self.items(&reached).iter().filter(is_new).count() as u64;
        Ok((without + found >= least).then_some((body, reached)))
    }
}
