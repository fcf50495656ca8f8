//! The surface as far as it has grown, and what may be added to it.
//!
//! *Problem.* No edge is to have more than two triangles, both running along it in opposite directions, and no vertex a second fan
//! beside a closed one.
//! *Idea.* Edges know their triangles. A triangle added at a vertex begins a fan, extends one, joins two or closes one, as none, one or
//! both of its edges there have a triangle; the last two cases differ in whether both edges end the same fan, which a walk along the
//! fan tells.
//! *Trap.* Read strictly, the vertex condition of the thesis allows one fan at all times. Then two fronts that meet could never be
//! joined, as each triangle between them touches the other front in a vertex first: several open fans are allowed here, and closing
//! one of them while there is another is not. Where they are not joined in the end, a pinch remains.
//! *Reference.* Condition 3 of the thesis, section 4.2.

use super::candidates::Candidates;
use crate::surface::sides::{Side, Sides};

/// Stands for no side.
const NONE: Side = Side::MAX;

/// The change of the fans of a corner when a triangle is added.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FanChange {
    Begins,
    Extends,
    Joins,
    Closes,
}

/// The triangles of the surface by edge, and the fans by site.
pub(super) struct Fans<'a> {
    sides: &'a Sides,
    candidates: &'a Candidates,
    /// The sides at each edge, [`NONE`] last.
    at_edge: Vec<[Side; 2]>,
    /// The open fans of each site.
    open: Vec<u32>,
    /// States whether a site has a closed fan.
    closed: Vec<bool>,
}

impl<'a> Fans<'a> {
    pub(super) fn new(sides: &'a Sides, candidates: &'a Candidates) -> Self {
        Self {
            sides,
            candidates,
            at_edge: vec![[NONE; 2]; candidates.ends.len()],
            open: vec![0; sides.points.len()],
            closed: vec![false; sides.points.len()],
        }
    }

    /// The only triangle of an edge, if there is one.
    pub(super) fn only(&self, edge: u32) -> Option<Side> {
        match self.at_edge[edge as usize] {
            [side, NONE] if side != NONE => Some(side),
            _ => None,
        }
    }

    /// Returns true if an edge has two triangles.
    pub(super) fn is_full(&self, edge: u32) -> bool {
        self.at_edge[edge as usize][1] != NONE
    }

    pub(super) fn is_closed(&self, site: u32) -> bool {
        self.closed[site as usize]
    }

    pub(super) fn is_used(&self, site: u32) -> bool {
        self.closed[site as usize] || self.open[site as usize] > 0
    }

    /// Returns true if a site has several fans; a closed one has no other beside it.
    pub(super) fn is_pinch(&self, site: u32) -> bool {
        self.open[site as usize] > 1
    }

    /// Returns true if the surface stays one.
    pub(super) fn may_add(&self, side: Side) -> bool {
        let corners = self.sides.triangle(side);
        let (_, edges) = self.edges(side);
        let runs_on = |i: usize| match self.at_edge[edges[i] as usize] {
            [NONE, _] => true,
            [other, NONE] => runs(self.sides.triangle(other), corners[(i + 1) % 3], corners[i]),
            _ => false,
        };
        let allowed = |i: usize| {
            let site = corners[i] as usize;
            !self.closed[site]
                && (self.open[site] < 2 || self.turn(corners, edges, i) != FanChange::Closes)
        };
        (0..3).all(runs_on) && (0..3).all(allowed)
    }

    pub(super) fn add(&mut self, side: Side) {
        let corners = self.sides.triangle(side);
        let (_, edges) = self.edges(side);
        let turns = [0, 1, 2].map(|i| self.turn(corners, edges, i));
        for (corner, turn) in corners.into_iter().zip(turns) {
            let open = &mut self.open[corner as usize];
            match turn {
                FanChange::Begins => *open += 1,
                FanChange::Extends => {}
                FanChange::Joins => *open -= 1,
                FanChange::Closes => {
                    *open -= 1;
                    self.closed[corner as usize] = true;
                }
            }
        }
        for edge in edges {
            let at = &mut self.at_edge[edge as usize];
            at[usize::from(at[0] != NONE)] = side;
        }
    }

    /// The candidate of a side, and its edges from corner i to the next.
    pub(super) fn edges(&self, side: Side) -> (u32, [u32; 3]) {
        let [a, b, c] = self.sides.triangle(side);
        let candidate = self.candidates.of_side(side);
        let edge = |u, v| self.candidates.edge(candidate, u, v);
        (candidate, [edge(a, b), edge(b, c), edge(c, a)])
    }

    /// Returns what a triangle does at its corner i.
    fn turn(&self, corners: [u32; 3], edges: [u32; 3], i: usize) -> FanChange {
        let (one, other) = (edges[i], edges[(i + 2) % 3]);
        match (self.only(one), self.only(other)) {
            (None, None) => FanChange::Begins,
            (Some(side), Some(_)) => {
                if self.end_of_fan(corners[i], one, side) == other {
                    FanChange::Closes
                } else {
                    FanChange::Joins
                }
            }
            _ => FanChange::Extends,
        }
    }

    /// The edge at the other end of the fan of a site that begins with a side at an edge.
    fn end_of_fan(&self, site: u32, mut edge: u32, mut side: Side) -> u32 {
        loop {
            let (_, edges) = self.edges(side);
            let corners = self.sides.triangle(side);
            let at = corners.iter().position(|&corner| corner == site).unwrap_or(0);
            let (one, other) = (edges[at], edges[(at + 2) % 3]);
            edge = if one == edge { other } else { one };
            side = match self.at_edge[edge as usize] {
                [_, NONE] => return edge,
                [one, other] if one == side => other,
                [one, _] => one,
            };
        }
    }
}

/// Tests whether a triangle runs from u to v.
fn runs([a, b, c]: [u32; 3], u: u32, v: u32) -> bool {
    [(a, b), (b, c), (c, a)].contains(&(u, v))
}
