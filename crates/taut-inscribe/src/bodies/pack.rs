//! Several bodies: each is to cover points that no other covers.
//!
//! *Idea.* Greedy: a body starts at uncovered points far from all triangles, the best few starts are improved by random changes,
//! and the best body stays. Afterwards each body in turn is improved against the points that the others leave. Bodies around
//! given points come first; they are to cover as many points as they can, covered or not. Where the objective is occlusion, lines
//! take the place of points: bodies start from the middles of lines that no body hides yet.

use std::cell::OnceCell;
use std::cmp::Reverse;

use taut_points::OrderBy;

use super::BodiesOptions;
use super::lines::{Line, Sample};
use super::mesh::GridMesh;
use super::polytope::{self, Sides};
use super::tree::Tree;
use crate::Error;

/// Points by which the search tells which body is better. With 4,000 it fits the points instead of the mesh, by 2.8 % of a bunny.
pub(super) const SCORED_POINTS: usize = 14_000;

/// The same where each body is around a given point and has to compete with no other for points.
pub(super) const SCORED_POINTS_GIVEN: usize = 3_000;

/// The part of the events that finds bodies; the rest improves them against the others.
const GREEDY_PART: f64 = 0.65;

/// Rounds in which each body is improved.
const IMPROVING_ROUNDS: u64 = 2;

/// Starts of a body that are grown, and how many of them are improved.
const STARTS: usize = 8;
const IMPROVED_STARTS: usize = 2;

/// Units of the grid from a start to the nearest triangle, at least: less leaves no room for a body.
const CLEARANCE_MIN: f64 = 8.0;

/// The number of bodies among which the events are divided where a part to cover or to hide decides how many there are.
const BODIES_EXPECTED: usize = 16;

/// A way in which bodies grow.
pub(super) trait Family {
    type Body: Clone;

    /// Returns the number of events so far.
    fn events(&self) -> u64;

    /// Counts an event of a change that cost none, so that every search ends.
    fn count_event(&mut self);

    /// Returns the distance from a point to the nearest obstacle, at most `distance`.
    fn clearance(&self, p: [i32; 3], distance: f64) -> f64;

    /// Returns a small body around a start; `None` where there is none in these directions.
    fn small(&mut self, start: &Start) -> Option<Self::Body>;

    /// Sets the points that bodies are to cover from now on, and the lines that they are to hide, if these decide.
    fn aim(&mut self, points: Vec<[i32; 3]>, lines: Option<Vec<Line>>);

    /// Sets the bodies that bodies may not enter from now on.
    fn set_obstacles(&mut self, bodies: &[&Self::Body]);

    /// Grows a small body.
    fn grow(&mut self, body: &mut Self::Body) -> Result<(), Error>;

    /// Gets ready for changes of a body.
    fn prepare(&mut self, body: &mut Self::Body);

    /// Returns a random change of the body that was prepared last.
    fn change(&mut self, body: &Self::Body) -> Result<Self::Body, Error>;

    /// Returns how many of the points to cover are in the interior of a body, or how many of the lines to hide meet it.
    fn score(&self, body: &Self::Body) -> u64;

    /// Returns a point in the interior of a body.
    fn anchor(&self, body: &Self::Body) -> [i32; 3];

    /// Returns the half-spaces of a body.
    fn sides(&self, body: &Self::Body) -> Sides;

    /// Returns whether a point is in the interior of a body.
    fn contains(&self, body: &Self::Body, p: [i32; 3]) -> bool;
}

/// The ends of a segment on the grid; of a point twice the same.
pub(super) type Segment = [[i32; 3]; 2];

/// A point, or a segment, from which a body starts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// The point, or the middle of the segment.
    pub(super) point: [i32; 3],
    pub(super) ends: Segment,
    /// The distance to the nearest triangle or obstacle, at most.
    pub(super) clearance: f64,
    /// Whether the user asks for a body that contains the segment.
    pub(super) is_given: bool,
}

impl Start {
    pub(super) fn is_point(&self) -> bool {
        self.ends[0] == self.ends[1]
    }
}

/// What every search gets.
pub(super) struct Input<'a> {
    pub(super) mesh: &'a GridMesh,
    /// The triangles; any directions.
    pub(super) tree: &'a Tree,
    /// The points to cover.
    pub(super) points: &'a [[i32; 3]],
    /// The lines to hide, if that is the objective.
    pub(super) lines: Option<&'a Sample>,
    /// For each line, or else for each point, the distance from its middle, or from it, to the nearest triangle, once a start is
    /// looked for: where all are given they would take most of the time.
    clearances: OnceCell<Vec<f64>>,
    /// The points that the first bodies contain.
    pub(super) given: &'a [Start],
    pub(super) options: &'a BodiesOptions<'a>,
}

impl<'a> Input<'a> {
    pub(super) fn new(
        mesh: &'a GridMesh,
        tree: &'a Tree,
        points: &'a [[i32; 3]],
        lines: Option<&'a Sample>,
        given: &'a [Start],
        options: &'a BodiesOptions<'a>,
    ) -> Self {
        Input { mesh, tree, points, lines, clearances: OnceCell::new(), given, options }
    }

    fn clearances(&self) -> &[f64] {
        self.clearances.get_or_init(|| {
            let clearance = |&p: &[i32; 3]| self.tree.squared_distance(p).sqrt();
            self.middles().iter().map(clearance).collect()
        })
    }

    /// The points from which bodies start.
    fn middles(&self) -> &'a [[i32; 3]] {
        self.lines.map_or(self.points, |sample| &sample.middles)
    }

    /// The lines to hide.
    fn lines(&self) -> &'a [Line] {
        self.lines.map_or(&[], |sample| &sample.lines)
    }

    /// The most bodies.
    fn count(&self) -> usize {
        self.options.count.max(self.given.len())
    }
}

/// Bodies, and what each of them covers and hides.
pub(super) struct Packing<'a, F: Family> {
    pub(super) input: &'a Input<'a>,
    pub(super) family: F,
    pub(super) bodies: Vec<F::Body>,
    pub(super) reaches: Vec<Reached>,
}

/// The points that a body covers, and the lines that it hides.
pub(super) struct Reached {
    pub(super) points: Vec<u32>,
    pub(super) lines: Vec<u32>,
}

/// The part of the items that no list has.
fn left<'b>(items: usize, lists: impl Iterator<Item = &'b Vec<u32>>) -> Vec<usize> {
    let mut is_left = vec![true; items];
    lists.flatten().for_each(|&item| is_left[item as usize] = false);
    (0..items).filter(|&item| is_left[item]).collect()
}

impl<'a, F: Family> Packing<'a, F> {
    pub(super) fn new(input: &'a Input<'a>, family: F) -> Self {
        Packing { input, family, bodies: vec![], reaches: vec![] }
    }

    /// How many points are covered.
    pub(super) fn covered(&self) -> u64 {
        (self.input.points.len() - self.open_points(&[]).len()) as u64
    }

    /// How many lines are hidden.
    pub(super) fn hidden(&self) -> u64 {
        (self.input.lines().len() - self.open_lines(&[]).len()) as u64
    }

    /// How many points are covered, or lines hidden, as the objective has it; for one body its volume.
    pub(super) fn value(&self) -> u64 {
        match (&self.bodies[..], self.improves_volume()) {
            ([body], true) => volume(&self.family, body),
            _ if self.input.lines.is_some() => self.hidden(),
            _ => self.covered(),
        }
    }

    /// Whether bodies are improved by their volume: one alone is. Its points know the volume to half a percent only.
    fn improves_volume(&self) -> bool {
        self.input.count() == 1 && self.input.lines.is_none()
    }

    /// All bodies but some.
    fn others(&self, without: &[usize]) -> impl Iterator<Item = &Reached> {
        let all = self.reaches.iter().enumerate();
        all.filter(|(body, _)| !without.contains(body)).map(|(_, reached)| reached)
    }

    /// The points that no body but some of them covers.
    pub(super) fn open_points(&self, without: &[usize]) -> Vec<usize> {
        left(self.input.points.len(), self.others(without).map(|reached| &reached.points))
    }

    /// The lines that no body but some of them hides.
    pub(super) fn open_lines(&self, without: &[usize]) -> Vec<usize> {
        left(self.input.lines().len(), self.others(without).map(|reached| &reached.lines))
    }

    /// The points in a body, and the lines that meet it.
    pub(super) fn reached(&self, body: &F::Body) -> Reached {
        let (points, lines) = (self.input.points.iter(), self.input.lines().iter());
        let points = points.zip(0u32..).filter(|&(&p, _)| self.family.contains(body, p));
        let sides = self.family.sides(body);
        let lines = lines.zip(0u32..).filter(|(line, _)| line.meets(&sides));
        Reached { points: points.map(|(_, k)| k).collect(), lines: lines.map(|(_, k)| k).collect() }
    }

    /// Sets what bodies are to cover and hide: what is left.
    pub(super) fn aim(&mut self, points: &[usize], lines: &[usize]) {
        let input = self.input;
        let points = points.iter().map(|&k| input.points[k]).collect();
        let of = |sample: &Sample| lines.iter().map(|&k| sample.lines[k]).collect();
        self.family.aim(points, input.lines.map(of));
    }

    /// Adds a body.
    pub(super) fn push(&mut self, body: F::Body) {
        self.reaches.push(self.reached(&body));
        self.bodies.push(body);
    }

    /// Whether the bodies cover, or hide, the part that was asked for.
    fn is_enough(&self) -> bool {
        let options = self.input.options;
        let reaches = |part: Option<f64>, found: u64, all: usize| {
            part.is_some_and(|part| found as f64 >= part * all as f64)
        };
        reaches(options.coverage, self.covered(), self.input.points.len())
            || reaches(options.hidden, self.hidden(), self.input.lines().len())
    }

    /// Greedy packing, then improvement, with a number of events.
    pub(super) fn fill(&mut self, events: u64) -> Result<(), Error> {
        let count = self.input.count();
        let greedy = (events as f64 * GREEDY_PART) as u64;
        let options = self.input.options;
        let is_open = options.coverage.is_some() || options.hidden.is_some();
        let expected = if is_open { BODIES_EXPECTED } else { count };
        let until = |spent: u64, body: usize| {
            spent + greedy.saturating_sub(spent) / (count - body).min(expected) as u64
        };
        for (at, start) in self.input.given.iter().enumerate() {
            self.set_obstacles(&[]);
            let Some(body) = self.family.small(start) else {
                let problem = "has no body around it that was found with facets in these directions: take more directions, or free facets";
                return Err(Error::At { at, problem });
            };
            self.push(body);
        }
        for body in 0..self.bodies.len() {
            self.aim_around(body);
            let mut grown = self.bodies[body].clone();
            self.family.grow(&mut grown)?;
            let until = until(self.family.events(), body);
            if let Some((_, grown)) = self.best(vec![grown], until)? {
                self.reaches[body] = self.reached(&grown);
                self.bodies[body] = grown;
            }
        }
        for body in self.bodies.len()..count {
            if self.is_enough() {
                break;
            }
            let until = until(self.family.events(), body);
            let Some(body) = self.next(until)? else { break };
            self.push(body);
        }
        self.improve(events)
    }

    /// The next body, which covers points or hides lines that no other does; `None` where there is no room.
    fn next(&mut self, until: u64) -> Result<Option<F::Body>, Error> {
        let (points, lines) = (self.open_points(&[]), self.open_lines(&[]));
        self.set_obstacles(&[]);
        self.aim(&points, &lines);
        let open = if self.input.lines.is_some() { lines } else { points };
        let best = self.best_from(&open, until)?;
        Ok(best.filter(|(score, _)| *score > 0).map(|(_, body)| body))
    }

    /// The best body that grows from one of the open points, or from the middle of one of the lines, with its score.
    pub(super) fn best_from(
        &mut self,
        open: &[usize],
        until: u64,
    ) -> Result<Option<(u64, F::Body)>, Error> {
        let mut grown: Vec<(u64, F::Body)> = vec![];
        for start in self.starts(open) {
            let Some(mut body) = self.family.small(&start) else { continue };
            self.family.grow(&mut body)?;
            grown.push((self.family.score(&body), body));
        }
        grown.order_by_key(|(score, _)| Reverse(*score));
        grown.truncate(if self.improves_volume() { STARTS } else { IMPROVED_STARTS });
        self.best(grown.into_iter().map(|(_, body)| body).collect(), until)
    }

    /// Improves bodies that have grown and returns the best of them with its score. For one body all of them are improved for a
    /// while, then the better half of them, and so on: one basin in many is worth it, and does not starve the last ones.
    fn best(&mut self, grown: Vec<F::Body>, until: u64) -> Result<Option<(u64, F::Body)>, Error> {
        let score_of = self.score_of();
        let halvings = if self.improves_volume() { grown.len().max(1).ilog2() } else { 0 };
        let mut rounds = u64::from(halvings) + 1;
        let mut scored: Vec<(u64, F::Body)> = grown.into_iter().map(|body| (0, body)).collect();
        loop {
            let left = until.saturating_sub(self.family.events());
            let share = left / (rounds * scored.len().max(1) as u64);
            for (score, body) in &mut scored {
                self.family.prepare(body);
                let until = self.family.events() + share;
                *score = self.recreate(body, until, score_of)?;
            }
            // Of equal ones the first.
            scored.order_by_key(|(score, _)| Reverse(*score));
            rounds -= 1;
            if rounds == 0 {
                return Ok(scored.into_iter().next());
            }
            scored.truncate(scored.len() / 2);
        }
    }

    /// Points among those open that are far from all triangles, the farthest first, each outside the balls around the others. Of
    /// the middles of lines half come in random order instead: a plate hides more than a ball of its volume.
    fn starts(&self, open: &[usize]) -> Vec<Start> {
        let input = self.input;
        let mut by_clearance = open.to_vec();
        let clearances = input.clearances();
        by_clearance.order_by(&|&a, &b| clearances[b].total_cmp(&clearances[a]));
        let (farthest, any) =
            if input.lines.is_some() { (STARTS / 2, STARTS) } else { (STARTS, 0) };
        let mut starts: Vec<Start> = vec![];
        // Lines come in random order.
        for (list, most) in [(&by_clearance[..], farthest), (open, any)] {
            for &k in list {
                if starts.len() >= most {
                    break;
                }
                starts.extend(self.start(k, &starts));
            }
        }
        starts
    }

    /// A start that is outside the balls around others, if there is room around it.
    fn start(&self, k: usize, others: &[Start]) -> Option<Start> {
        let input = self.input;
        let point = input.middles()[k];
        let is_far = others.iter().all(|start| distance(point, start.point) > start.clearance);
        if !is_far {
            return None;
        }
        let clearance = self.family.clearance(point, input.clearances()[k]);
        let is_start = clearance >= CLEARANCE_MIN
            && input.tree.is_inside(point) == Some(true)
            && input.mesh.sees_mesh(point);
        is_start.then_some(Start { point, ends: [point; 2], clearance, is_given: false })
    }

    /// What says which of two bodies is better.
    fn score_of(&self) -> fn(&F, &F::Body) -> u64 {
        if self.improves_volume() { volume } else { F::score }
    }

    /// Improves a body by random changes until so many events are spent; returns its score.
    fn recreate(
        &mut self,
        body: &mut F::Body,
        until: u64,
        score_of: fn(&F, &F::Body) -> u64,
    ) -> Result<u64, Error> {
        let mut score = score_of(&self.family, body);
        while self.family.events() < until {
            let before = self.family.events();
            let changed = self.family.change(body)?;
            let found = score_of(&self.family, &changed);
            if found >= score {
                (*body, score) = (changed, found);
            }
            if self.family.events() == before {
                self.family.count_event();
            }
        }
        Ok(score)
    }

    /// Improves the bodies in turn against the points that the others leave.
    pub(super) fn improve(&mut self, events: u64) -> Result<(), Error> {
        let turns = IMPROVING_ROUNDS * self.bodies.len() as u64;
        let score_of = self.score_of();
        for turn in 0..turns {
            let body = (turn % self.bodies.len() as u64) as usize;
            let left = events.saturating_sub(self.family.events()) / (turns - turn);
            self.aim_around(body);
            let mut changed = self.bodies[body].clone();
            let until = self.family.events() + left;
            self.family.prepare(&mut changed);
            self.recreate(&mut changed, until, score_of)?;
            self.reaches[body] = self.reached(&changed);
            self.bodies[body] = changed;
        }
        Ok(())
    }

    /// Sets what a body is to cover, and which bodies it may not enter.
    fn aim_around(&mut self, body: usize) {
        let (points, lines) = match body < self.input.given.len() {
            true => {
                ((0..self.input.points.len()).collect(), (0..self.input.lines().len()).collect())
            }
            false => (self.open_points(&[body]), self.open_lines(&[body])),
        };
        self.aim(&points, &lines);
        self.set_obstacles(&[body]);
    }

    /// Makes all bodies but some obstacles, if bodies are to be disjoint.
    pub(super) fn set_obstacles(&mut self, without: &[usize]) {
        if self.input.options.disjoint {
            let others = self.bodies.iter().enumerate().filter(|(b, _)| !without.contains(b));
            let others: Vec<&F::Body> = others.map(|(_, body)| body).collect();
            self.family.set_obstacles(&others);
        }
    }
}

/// The volume of a body in cubes of 32 units, rounded down: a whole number, as other scores are.
fn volume<F: Family>(family: &F, body: &F::Body) -> u64 {
    let cube = f64::from(1 << 15);
    (polytope::volume(&family.sides(body), family.anchor(body)) / cube) as u64
}

/// The distance between two points of the grid.
pub(super) fn distance(p: [i32; 3], q: [i32; 3]) -> f64 {
    let squares = (0..3).map(|c| (f64::from(p[c]) - f64::from(q[c])).powi(2));
    squares.sum::<f64>().sqrt()
}
