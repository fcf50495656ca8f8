//! Several bodies: each is to cover points that no other covers.
//!
//! *Idea.* Greedy: a body starts at uncovered points far from all triangles, the best few starts are improved by ruin and
//! recreate, and the best body stays. Afterwards each body in turn is improved against the points that the others leave.
//! *Guarantee.* More directions never cover fewer of the points: the bodies of a smaller set of directions are improved in the
//! larger set, and the better result counts.

use super::DopsOptions;
use super::directions::{self, DIRECTIONS_MAX, Directions, Offsets};
use super::grow::{Dop, Obstacle, Space};
use super::mesh::GridMesh;
use super::tree::Tree;
use crate::Error;
use crate::random::Random;

/// Points by which the search tells which body is better. With 4,000 it fits the points instead of the mesh, by 2.8 % of a bunny.
pub(super) const SCORED_POINTS: usize = 14_000;

/// The part of the events that finds bodies; the rest improves them against the others.
const GREEDY_PART: f64 = 0.65;

/// Rounds in which each body is improved.
const IMPROVING_ROUNDS: u64 = 2;

/// Starts of a body that are grown, and how many of them are improved by ruin and recreate.
const STARTS: usize = 8;
const IMPROVED_STARTS: usize = 2;

/// Units of the grid from a start to the nearest triangle, at least: less leaves no room for a body.
const CLEARANCE_MIN: f64 = 8.0;

/// What a search found.
pub(super) struct Packed {
    pub(super) bodies: Vec<Dop>,
    /// Events of this search and of those in smaller sets of directions.
    pub(super) events: u64,
    /// Points that at least one body covers.
    pub(super) covered: u64,
}

/// Finds bodies with the directions asked for.
pub(super) fn pack(
    mesh: &GridMesh,
    directions: &Directions,
    tree: &Tree<'_>,
    points: &[[i32; 3]],
    options: &DopsOptions<'_>,
) -> Result<Packed, Error> {
    let clearances: Vec<f64> = points.iter().map(|&p| tree.squared_distance(p).sqrt()).collect();
    let input = Input { mesh, points, clearances: &clearances, options };
    let mut found: Vec<(usize, Packed)> = vec![];
    for kind in directions::KINDS.into_iter().filter(|&kind| is_part(kind, directions.len())) {
        if kind == directions.len() {
            break;
        }
        let (smaller, smaller_tree);
        smaller = Directions::of(kind);
        smaller_tree = Tree::new(&mesh.corners, &smaller);
        let packed = input.search(&smaller, &smaller_tree, &found)?;
        found.push((kind, packed));
    }
    input.search(directions, tree, &found)
}

/// Whether one set of directions is part of another.
fn is_part(kind: usize, of: usize) -> bool {
    kind == of || kind == 6 || of == 26
}

struct Input<'a> {
    mesh: &'a GridMesh,
    points: &'a [[i32; 3]],
    clearances: &'a [f64],
    options: &'a DopsOptions<'a>,
}

impl Input<'_> {
    /// Searches with one set of directions, after the sets that are part of it.
    fn search(
        &self,
        directions: &Directions,
        tree: &Tree<'_>,
        smaller: &[(usize, Packed)],
    ) -> Result<Packed, Error> {
        debug_assert_eq!(tree.corners.len(), self.mesh.corners.len());
        let options = self.options;
        let mut packing = Packing {
            input: self,
            space: Space {
                directions,
                tree,
                obstacles: vec![],
                random: Random::new(options.seed ^ directions.len() as u64),
                events: 0,
                monitor: options.monitor,
            },
            bodies: vec![],
            covers: vec![],
        };
        packing.fill(options.events)?;
        let parts = smaller.iter().filter(|(kind, _)| is_part(*kind, directions.len()));
        let mut events = smaller.last().map_or(0, |(_, packed)| packed.events);
        let (mut bodies, mut covered) = (packing.bodies.clone(), packing.covered());
        if let Some((kind, packed)) = parts.max_by_key(|(_, packed)| packed.covered) {
            let mut warm = Packing { bodies: vec![], covers: vec![], ..packing };
            warm.take(*kind, &packed.bodies);
            let budget = warm.space.events + options.events / 4;
            warm.improve(budget)?;
            if warm.covered() > covered {
                (bodies, covered) = (warm.bodies.clone(), warm.covered());
            }
            events += warm.space.events;
        } else {
            events += packing.space.events;
        }
        Ok(Packed { bodies, events, covered })
    }
}

/// Bodies, and the points that each covers.
struct Packing<'a> {
    input: &'a Input<'a>,
    space: Space<'a>,
    bodies: Vec<Dop>,
    covers: Vec<Vec<u32>>,
}

impl Packing<'_> {
    /// How many points are covered.
    fn covered(&self) -> u64 {
        self.counts(None).iter().filter(|&&count| count > 0).count() as u64
    }

    /// By how many bodies each point is covered, without one of them.
    fn counts(&self, without: Option<usize>) -> Vec<u16> {
        let mut counts = vec![0; self.input.points.len()];
        for (_, cover) in self.covers.iter().enumerate().filter(|&(b, _)| Some(b) != without) {
            cover.iter().for_each(|&point| counts[point as usize] += 1);
        }
        counts
    }

    /// The points in a body.
    fn cover(&self, dop: &Dop) -> Vec<u32> {
        let points = self.input.points.iter().enumerate();
        let directions = self.space.directions;
        points.filter(|&(_, &p)| directions.contains(&dop.h, p)).map(|(k, _)| k as u32).collect()
    }

    /// Greedy packing, then improvement, with a number of events.
    fn fill(&mut self, events: u64) -> Result<(), Error> {
        let count = self.input.options.count;
        let greedy = events as f64 * GREEDY_PART / count as f64;
        for body in 0..count {
            let until = ((body + 1) as f64 * greedy) as u64;
            let Some(dop) = self.next(until)? else { break };
            let cover = self.cover(&dop);
            self.bodies.push(dop);
            self.covers.push(cover);
        }
        self.improve(events)
    }

    /// The next body, which covers points that no other covers; `None` where there is no room.
    fn next(&mut self, until: u64) -> Result<Option<Dop>, Error> {
        let counts = self.counts(None);
        let open: Vec<usize> = (0..counts.len()).filter(|&k| counts[k] == 0).collect();
        self.set_obstacles(None);
        let scores = Scores::of(&self.space, open.iter().map(|&k| self.input.points[k]).collect());
        let mut grown: Vec<(u64, Dop)> = vec![];
        for (p, clearance) in self.starts(&open) {
            let mut dop = self.space.start(p, clearance);
            self.space.grow(&mut dop)?;
            grown.push((scores.count(&dop.h), dop));
        }
        grown.sort_by_key(|(score, _)| std::cmp::Reverse(*score));
        grown.truncate(IMPROVED_STARTS);
        let left = until.saturating_sub(self.space.events) / grown.len().max(1) as u64;
        for (score, dop) in &mut grown {
            let until = self.space.events + left;
            *score = self.recreate(dop, &scores, until)?;
        }
        // Of equal ones the first.
        grown.sort_by_key(|(score, _)| std::cmp::Reverse(*score));
        Ok(grown.into_iter().next().filter(|(score, _)| *score > 0).map(|(_, dop)| dop))
    }

    /// Points among those open that are far from all triangles, the farthest first, each outside the balls around the others.
    fn starts(&self, open: &[usize]) -> Vec<([i32; 3], f64)> {
        let input = self.input;
        let mut by_clearance = open.to_vec();
        by_clearance.sort_by(|&a, &b| input.clearances[b].total_cmp(&input.clearances[a]));
        let mut starts: Vec<([i32; 3], f64)> = vec![];
        for k in by_clearance {
            let p = input.points[k];
            let is_far = starts.iter().all(|(q, radius)| {
                let squares = (0..3).map(|c| (f64::from(p[c]) - f64::from(q[c])).powi(2));
                squares.sum::<f64>() > radius * radius
            });
            if !is_far {
                continue;
            }
            let clearance = self.space.clearance(p, input.clearances[k]);
            if clearance >= CLEARANCE_MIN && self.space.tree.is_inside(p) == Some(true) {
                starts.push((p, clearance));
            }
            if starts.len() == STARTS {
                break;
            }
        }
        starts
    }

    /// Improves a body by ruin and recreate until so many events are spent; returns its score.
    fn recreate(&mut self, dop: &mut Dop, scores: &Scores, until: u64) -> Result<u64, Error> {
        let mut score = scores.count(&dop.h);
        while self.space.events < until {
            let before = self.space.events;
            let changed = self.space.ruin_and_recreate(dop, &scores.points)?;
            let found = scores.count(&changed.h);
            if found >= score {
                (*dop, score) = (changed, found);
            }
            // A change that costs no event still counts, so that the search ends.
            self.space.events = self.space.events.max(before + 1);
        }
        Ok(score)
    }

    /// Improves the bodies in turn against the points that the others leave.
    fn improve(&mut self, events: u64) -> Result<(), Error> {
        let turns = IMPROVING_ROUNDS * self.bodies.len() as u64;
        for turn in 0..turns {
            let body = (turn % self.bodies.len() as u64) as usize;
            let left = events.saturating_sub(self.space.events) / (turns - turn);
            let counts = self.counts(Some(body));
            let open = (0..counts.len()).filter(|&k| counts[k] == 0);
            let open = open.map(|k| self.input.points[k]).collect();
            self.set_obstacles(Some(body));
            let scores = Scores::of(&self.space, open);
            let mut dop = self.bodies[body].clone();
            let until = self.space.events + left;
            self.recreate(&mut dop, &scores, until)?;
            self.covers[body] = self.cover(&dop);
            self.bodies[body] = dop;
        }
        Ok(())
    }

    /// Makes all bodies but one obstacles, if bodies are to be disjoint.
    fn set_obstacles(&mut self, without: Option<usize>) {
        if self.input.options.disjoint {
            let directions = self.space.directions;
            let others = self.bodies.iter().enumerate().filter(|&(b, _)| Some(b) != without);
            self.space.obstacles = others.map(|(_, dop)| Obstacle::of(directions, dop)).collect();
        }
    }

    /// Takes over bodies of a smaller set of directions; their new facets are redundant.
    fn take(&mut self, kind: usize, bodies: &[Dop]) {
        let directions = self.space.directions;
        let smaller = Directions::of(kind);
        for dop in bodies {
            let mut h: Offsets = [0; DIRECTIONS_MAX];
            for (j, u) in directions.normals.iter().enumerate() {
                let old = smaller.normals.iter().position(|v| v == u);
                h[j] = old.map_or_else(|| self.space.tree.extent(j), |old| dop.h[old]);
            }
            self.space.tighten(&mut h);
            let dop = Dop { h, anchor: dop.anchor };
            self.covers.push(self.cover(&dop));
            self.bodies.push(dop);
        }
    }
}

/// Points to cover, with their heights along the directions.
struct Scores {
    points: Vec<[i32; 3]>,
    /// The heights along every second direction, direction by direction.
    heights: Vec<Vec<i32>>,
}

impl Scores {
    fn of(space: &Space<'_>, points: Vec<[i32; 3]>) -> Self {
        let along =
            |j: usize| points.iter().map(|&p| space.directions.along(j, p) as i32).collect();
        let heights = (0..space.directions.len()).step_by(2).map(along).collect();
        Scores { points, heights }
    }

    /// How many of the points are in the interior of a body.
    fn count(&self, h: &Offsets) -> u64 {
        let mut is_in = vec![1u8; self.points.len()];
        for (pair, heights) in self.heights.iter().enumerate() {
            let (low, high) = (-h[2 * pair + 1], h[2 * pair]);
            for (is_in, &height) in is_in.iter_mut().zip(heights) {
                *is_in &= u8::from(low < height) & u8::from(height < high);
            }
        }
        is_in.iter().map(|&one| u64::from(one)).sum()
    }
}
