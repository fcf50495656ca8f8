//! The advancing front.
//!
//! *Problem.* Choose from the candidates triangles that make a surface.
//! *Idea.* As Prim's algorithm grows a minimum spanning tree: all edges of one triangle only wait in a queue, by the distance of the
//! circumcenters of that triangle and the best candidate; those whose candidate is on slivers come after all others. The first edge
//! gets its candidate, unless that would spoil the surface. What can no longer be added, candidates at an edge with two triangles
//! and at a vertex with a closed fan, is deleted.
//! *Guarantee.* No edge has more than two triangles, and both run along it in opposite directions. No two triangles meet but in common
//! vertices and edges, as all are facets of one triangulation. O((n + r) log n) for r candidates around edges that are looked at.
//! *Trap.* A key may have grown when its edge comes up: keys are computed again, and an edge with a larger one goes back. An edge without a
//! continuation may get one when fans have been joined elsewhere: when the queue is empty, all such edges are tried once more, until
//! nothing changes.
//! *Reference.* Algorithm 7 of the thesis, section 4.3.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use taut_points::Monitor;
use taut_predicates::{Sign, plane};

use super::candidates::Candidates;
use super::fans::Fans;
use super::options::{Extent, ThesisOptions};
use super::ring::{Choice, Ring};
use crate::Error;
use crate::surface::sides::{Side, Sides};

/// Pops between two looks at the monitor.
const BLOCK: u64 = 1 << 14;

/// Events of a front.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Events {
    /// Edges taken from the queue.
    pub(super) pops: u64,
    /// Times that the candidates around an edge were looked at.
    pub(super) examined_edges: u64,
    /// Triangles that a front began with.
    pub(super) seeds: u64,
}

/// The key of the queue: whether slivers are on the candidate, the bits of its measure, the edge.
type Key = (bool, u64, u32);

pub(super) struct Front<'a> {
    sides: &'a Sides,
    candidates: &'a Candidates,
    fans: Fans<'a>,
    ring: Ring,
    alive: Vec<bool>,
    queue: BinaryHeap<Reverse<Key>>,
    /// Edges that had no continuation.
    stuck: Vec<u32>,
    /// The surface, in the order in which it grew.
    pub(super) grown: Vec<Side>,
    pub(super) events: Events,
}

impl<'a> Front<'a> {
    pub(super) fn new(
        sides: &'a Sides,
        candidates: &'a Candidates,
        options: &ThesisOptions,
    ) -> Self {
        Self {
            sides,
            candidates,
            fans: Fans::new(sides, candidates),
            ring: Ring::new(options.forbidden_angle, options.sliver_angle),
            alive: vec![true; candidates.len()],
            queue: BinaryHeap::new(),
            stuck: Vec::new(),
            grown: Vec::new(),
            events: Events::default(),
        }
    }

    /// Grows from the highest candidate, and with restarts from the next one again and again.
    pub(super) fn grow(&mut self, extent: Extent, monitor: &Monitor<'_>) -> Result<(), Error> {
        let mut seeds = self.seeds();
        while let Some((_, Reverse(seed))) = seeds.pop() {
            let sites = self.candidates.sites[seed as usize];
            if !self.alive[seed as usize] || sites.iter().any(|&site| self.fans.is_used(site)) {
                continue;
            }
            self.events.seeds += 1;
            self.add(self.upward(seed));
            self.advance(monitor)?;
            if extent != Extent::Restarts {
                break;
            }
        }
        Ok(())
    }

    /// The sites with several fans, ascending.
    pub(super) fn pinches(&self) -> Vec<u32> {
        (0..self.sides.points.len() as u32).filter(|&site| self.fans.is_pinch(site)).collect()
    }

    /// Candidates by the sum of their last coordinates, highest first; ties by sites.
    fn seeds(&self) -> BinaryHeap<(i64, Reverse<u32>)> {
        let height = |&site: &u32| self.sides.points[site as usize][2];
        let heights = self.candidates.sites.iter().map(|sites| sites.iter().map(height).sum());
        heights.map(in_order).zip((0..).map(Reverse)).collect()
    }

    /// The side whose normal points up: along the last coordinate, or the one before if that is 0.
    fn upward(&self, candidate: u32) -> Side {
        let side = self.candidates.sides[candidate as usize];
        let corners = self.sides.triangle(side).map(|site| self.sides.points[site as usize]);
        let along = |[i, j]: [usize; 2]| {
            let [a, b, c] = corners.map(|p| [p[i], p[j]]);
            plane::orient(a, b, c)
        };
        match [[0, 1], [2, 0], [1, 2]].into_iter().map(along).find(|sign| !sign.is_zero()) {
            Some(Sign::Negative) => self.sides.mirror(side),
            _ => side,
        }
    }

    /// Adds triangles until no edge has a continuation.
    fn advance(&mut self, monitor: &Monitor<'_>) -> Result<(), Error> {
        loop {
            let before = self.grown.len();
            while let Some(Reverse(entry)) = self.queue.pop() {
                if self.events.pops.is_multiple_of(BLOCK) {
                    monitor.check()?;
                }
                self.events.pops += 1;
                let edge = entry.2;
                match self.examine(edge) {
                    Some(choice) if key(choice, edge) > entry => {
                        self.queue.push(Reverse(key(choice, edge)));
                    }
                    Some(choice) => self.add(choice.side),
                    None => self.stuck.push(edge),
                }
            }
            if self.grown.len() == before {
                // Another front tries from its own side: to keep these would cost the product of fronts and borders.
                self.stuck.clear();
                return Ok(());
            }
            std::mem::take(&mut self.stuck).into_iter().for_each(|edge| self.enqueue(edge));
        }
    }

    /// The best continuation of an edge with one triangle.
    fn examine(&mut self, edge: u32) -> Option<Choice> {
        let side = self.fans.only(edge)?;
        self.events.examined_edges += 1;
        let [from, to] = self.candidates.ends[edge as usize];
        let [a, b, c] = self.sides.triangle(side);
        let rotations = [[a, b, c], [b, c, a], [c, a, b]];
        let along = |&[_, _, w]: &[u32; 3]| w != from && w != to;
        let corners = rotations.into_iter().find(along)?;
        let Self { sides, candidates, fans, ring, alive, .. } = self;
        ring.choose(
            sides,
            candidates,
            (side, corners),
            |candidate| alive[candidate as usize],
            |side| fans.may_add(side),
        )
    }

    fn enqueue(&mut self, edge: u32) {
        match self.examine(edge) {
            Some(choice) => self.queue.push(Reverse(key(choice, edge))),
            None => self.stuck.push(edge),
        }
    }

    /// Adds a triangle, deletes what it rules out, and queues its edges.
    fn add(&mut self, side: Side) {
        self.fans.add(side);
        self.grown.push(side);
        let (candidate, edges) = self.fans.edges(side);
        self.alive[candidate as usize] = false;
        let Self { candidates, fans, alive, .. } = self;
        let mut delete = |all: &[u32]| all.iter().for_each(|&other| alive[other as usize] = false);
        for edge in edges.into_iter().filter(|&edge| fans.is_full(edge)) {
            delete(candidates.at_edge(edge));
        }
        for corner in self.sides.triangle(side).into_iter().filter(|&site| fans.is_closed(site)) {
            delete(candidates.at_site(corner));
        }
        edges.into_iter().for_each(|edge| self.enqueue(edge));
    }
}

fn key(choice: Choice, edge: u32) -> Key {
    // Measures are not negative: their bits are in their order.
    (choice.key.0, choice.key.1.to_bits(), edge)
}

/// Numbers in the order of these.
fn in_order(x: f64) -> i64 {
    let bits = x.to_bits() as i64;
    bits ^ ((bits >> 63) as u64 >> 1) as i64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_order() {
        let all = [f64::NEG_INFINITY, -2.5, -1e-300, 0.0, 1e-300, 2.5, f64::INFINITY];
        assert!(all.map(in_order).is_sorted());
    }
}
