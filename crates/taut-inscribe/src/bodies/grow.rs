//! One body: growth by events, ruin and recreate.

use std::sync::Arc;

use taut_points::Monitor;

use super::clip::{self, Scratch};
use super::directions::{DIRECTIONS_MAX, Directions, Offsets, opposite};
use super::lines::Line;
use super::pack::{Family, Segment, Start};
use super::polytope::{self, Sides};
use super::scores::Scores;
use super::tree::{self, Tree};
use super::vectors::dot;
use crate::Error;
use crate::random::Random;

/// The part of its width by which a body may grow at once in the first rounds of growth; afterwards there is no limit.
const FIRST_STEPS: [f64; 2] = [0.15, 0.3];

/// Rounds in which a redundant facet moves only to where the others end, so that it holds its place beside them.
const BALANCED_ROUNDS: usize = 3;

/// Rounds of growth, at most; a round without change ends the growth. In most runs 6 rounds do.
const ROUNDS_MAX: usize = 16;

/// Facets that are moved inward at once, at most.
const RUINED_FACETS_MAX: usize = 4;

/// The part of the width by which a facet is moved inward, at most.
const RUINED_WIDTH_MAX: f64 = 0.5;

/// Draws of a sample point to keep while facets are moved inward; without success the point of the last time is kept.
const ANCHOR_DRAWS_MAX: usize = 16;

/// Units of the grid between the point of a body and each facet that moves inward, per unit of the sum |uᵢ|₁, at least: the proof
/// moves facets inward by up to 4 units, for disjoint bodies by up to 4 more, and by |uᵢ|₁ where coordinates are rounded. Then
/// the point is still in the body, and so is a given one that differs from its place on the grid by a unit in each coordinate.
pub(super) const ANCHOR_MARGIN: i32 = 12;

/// A body that no triangle enters, and a point of the grid in its interior.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Dop {
    pub(super) h: Offsets,
    pub(super) anchor: [i32; 3],
    /// The ends of a segment that the body has to contain, if there is one.
    pub(super) kept: Option<Segment>,
    /// The triangle that stopped each facet last, by its place in the order of the tree, if one did: a first guess for the next
    /// time.
    pub(super) stops: [Option<u32>; DIRECTIONS_MAX],
}

impl Dop {
    /// A body that has not grown yet.
    pub(super) fn new(h: Offsets, anchor: [i32; 3]) -> Self {
        Dop { h, anchor, kept: None, stops: [None; _] }
    }

    /// The height along direction i that facet i has to leave in the body.
    fn kept_height(&self, directions: &Directions, i: usize) -> i64 {
        let ends = self.kept.unwrap_or([self.anchor; 2]);
        ends.iter().map(|&end| directions.along(i, end)).fold(i64::MIN, i64::max)
    }
}

/// A body that may not be entered: its facets as triangles.
pub(super) struct Obstacle {
    triangles: Vec<[[f64; 3]; 3]>,
    /// The least uⱼ·x of each triangle, rounded down, and of all of them.
    heights: Vec<Offsets>,
    all: Offsets,
}

impl Obstacle {
    /// The obstacle of a body with these facets, for bodies that grow in some directions.
    pub(super) fn of(directions: &Directions, facets: &[Vec<[f64; 3]>]) -> Self {
        let fan = |p: &Vec<[f64; 3]>| {
            (2..p.len()).map(|k| [p[0], p[k - 1], p[k]]).collect::<Vec<[[f64; 3]; 3]>>()
        };
        let triangles: Vec<[[f64; 3]; 3]> = facets.iter().flat_map(fan).collect();
        let least = |triangle: &[[f64; 3]; 3]| {
            let mut heights = [0; _];
            for (j, u) in directions.normals.iter().enumerate() {
                let along = |p: &[f64; 3]| (0..3).map(|c| u[c] as f64 * p[c]).sum::<f64>();
                let height = triangle.iter().map(along).fold(f64::INFINITY, f64::min);
                heights[j] = height.floor() as i32;
            }
            heights
        };
        let heights: Vec<Offsets> = triangles.iter().map(least).collect();
        let all = std::array::from_fn(|j| heights.iter().map(|h| h[j]).min().unwrap_or(i32::MAX));
        Obstacle { triangles, heights, all }
    }

    /// The distance from a point to the body.
    pub(super) fn distance(&self, p: [i32; 3]) -> f64 {
        let p = p.map(f64::from);
        let distances = self.triangles.iter().map(|t| tree::squared_distance(p, t));
        distances.fold(f64::INFINITY, f64::min).sqrt()
    }

    fn event(&self, i: usize, h: &Offsets, most: i32, directions: &Directions) -> i32 {
        let mut limits = *h;
        limits[i] = most;
        let k = directions.len();
        if !tree::reaches(&self.all[..k], &limits) {
            return most;
        }
        let scratch = &mut Scratch::default();
        for (triangle, heights) in self.triangles.iter().zip(&self.heights) {
            if tree::reaches(&heights[..k], &limits)
                && let Some(height) = clip::lowest(triangle, heights, i, h, directions, scratch)
            {
                limits[i] = limits[i].min((height + clip::TOUCH).floor() as i32);
            }
        }
        limits[i].max(h[i])
    }
}

/// What bodies grow in: a mesh, and bodies that may not be entered.
pub(super) struct Space<'a> {
    pub(super) tree: Arc<Tree>,
    pub(super) obstacles: Vec<Obstacle>,
    pub(super) random: Random,
    /// Events so far.
    pub(super) events: u64,
    /// The points to cover.
    pub(super) scores: Scores,
    /// Whether the axes are among the directions, so that bodies around balls are hardly larger than these.
    holds_axes: bool,
    monitor: Monitor<'a>,
}

/// Units of the grid between what a body has to contain and its facet i, at least.
fn margin(directions: &Directions, i: usize) -> i32 {
    let sum: i64 = directions.normals[i].iter().map(|n| n.abs()).sum();
    ANCHOR_MARGIN * sum as i32
}

impl<'a> Space<'a> {
    pub(super) fn new(tree: &Arc<Tree>, random: Random, monitor: Monitor<'a>) -> Self {
        let tree = Arc::clone(tree);
        let holds_axes = tree.directions.hold_axes();
        let (scores, obstacles) = (Scores::default(), vec![]);
        Space { tree, obstacles, random, events: 0, scores, holds_axes, monitor }
    }

    /// Moves facets outward in random order until each meets a triangle or is redundant.
    ///
    /// No facet moves inward meanwhile, so a triangle that stops a facet once stops it to the end; later tries are events that
    /// cost nothing.
    pub(super) fn grow(&mut self, dop: &mut Dop) -> Result<(), Error> {
        self.monitor.check()?;
        let directions = Arc::clone(&self.tree.directions);
        let mut order: Vec<usize> = (0..directions.len()).collect();
        let mut is_stopped = [false; DIRECTIONS_MAX];
        for round in 0..ROUNDS_MAX {
            self.random.shuffle(&mut order);
            let mut changed = false;
            for &i in &order {
                if is_stopped[i] {
                    self.events += 1;
                    continue;
                }
                let h = &dop.h;
                let mut most = self.tree.extent(i);
                if round < BALANCED_ROUNDS {
                    most = directions.redundant_at(i, h, most);
                }
                if let Some(part) = FIRST_STEPS.get(round) {
                    let width = f64::from(h[i] + h[opposite(i)]);
                    most = most.min(h[i] + (part * width).ceil() as i32);
                }
                if most > h[i] {
                    let moved = self.event(i, dop, most);
                    is_stopped[i] = moved < most;
                    changed |= moved > dop.h[i];
                    dop.h[i] = moved;
                }
            }
            if round >= BALANCED_ROUNDS && !changed {
                break;
            }
        }
        directions.tighten(&mut dop.h);
        Ok(())
    }

    /// Returns how far facet i of a body can move outward, at most to `most`.
    pub(super) fn event(&mut self, i: usize, dop: &mut Dop, most: i32) -> i32 {
        self.events += 1;
        let event = self.tree.event(i, &dop.h, most, dop.stops[i]);
        dop.stops[i] = event.stop.or(dop.stops[i]);
        let directions = &self.tree.directions;
        let of_one = |most: i32, obstacle: &Obstacle| obstacle.event(i, &dop.h, most, directions);
        self.obstacles.iter().fold(event.height, of_one)
    }

    /// Whether nothing is in a body: facet 0 of the flat body at the opposite facet can move to its place.
    pub(super) fn is_empty(&mut self, h: &Offsets) -> bool {
        let mut flat = Dop::new(*h, [0; 3]);
        flat.h[0] = -h[opposite(0)];
        self.event(0, &mut flat, h[0]) == h[0]
    }

    /// Moves some facets inward, but not beyond a point, and grows the body again.
    fn ruin_and_recreate(&mut self, dop: &Dop) -> Result<Dop, Error> {
        let directions = Arc::clone(&self.tree.directions);
        let mut changed = dop.clone();
        let points = &self.scores.points;
        let draws = if dop.kept.is_some() { 0 } else { ANCHOR_DRAWS_MAX.min(points.len()) };
        for _ in 0..draws {
            let p = points[self.random.below(points.len())];
            if directions.contains(&dop.h, p) {
                changed.anchor = p;
                break;
            }
        }
        let facets = 1 + self.random.below(RUINED_FACETS_MAX);
        for _ in 0..facets {
            let i = self.random.below(directions.len());
            let width = f64::from(changed.h[i] + changed.h[opposite(i)]);
            let inward = (RUINED_WIDTH_MAX * self.random.unit() * width) as i32;
            let least = changed.kept_height(&directions, i) as i32 + margin(&directions, i);
            changed.h[i] = (changed.h[i] - inward).max(least.min(changed.h[i]));
        }
        directions.tighten(&mut changed.h);
        self.grow(&mut changed)?;
        Ok(changed)
    }
}

impl Family for Space<'_> {
    type Body = Dop;

    fn events(&self) -> u64 {
        self.events
    }

    fn count_event(&mut self) {
        self.events += 1;
    }

    fn clearance(&self, p: [i32; 3], distance: f64) -> f64 {
        self.obstacles.iter().map(|obstacle| obstacle.distance(p)).fold(distance, f64::min)
    }

    fn small(&mut self, start: &Start) -> Option<Dop> {
        let directions = Arc::clone(&self.tree.directions);
        let kept = start.is_given.then_some(start.ends);
        let mut dop = Dop { kept, ..Dop::new([0; _], start.point) };
        // A cube around a ball of radius r lies in a ball of radius √3·r, and so do bodies with more directions.
        let mut reach = 0.57 * start.clearance;
        let fits = self.holds_axes && start.is_point();
        loop {
            let mut is_least = true;
            for (j, u) in directions.floats.iter().enumerate() {
                let kept = dop.kept_height(&directions, j);
                let outward = (reach * dot(*u, *u).sqrt()) as i32;
                let least = margin(&directions, j);
                is_least &= outward <= least;
                dop.h[j] = kept as i32 + if fits { outward } else { outward.max(least) };
            }
            if fits || self.is_empty(&dop.h) {
                return Some(dop);
            }
            if is_least {
                return None;
            }
            reach /= 2.0;
        }
    }

    fn aim(&mut self, points: Vec<[i32; 3]>, lines: Option<Vec<Line>>) {
        self.scores = Scores::of(&self.tree.directions, points, lines.as_deref());
    }

    fn set_obstacles(&mut self, bodies: &[&Dop]) {
        let directions = &self.tree.directions;
        let obstacle = |dop: &&Dop| {
            let sides = Sides::of_dop(directions, &dop.h);
            Obstacle::of(directions, &polytope::facets(&sides, dop.anchor))
        };
        self.obstacles = bodies.iter().map(obstacle).collect();
    }

    fn grow(&mut self, dop: &mut Dop) -> Result<(), Error> {
        Space::grow(self, dop)
    }

    fn prepare(&mut self, _dop: &mut Dop) {}

    fn change(&mut self, dop: &Dop) -> Result<Dop, Error> {
        self.ruin_and_recreate(dop)
    }

    fn score(&self, dop: &Dop) -> u64 {
        self.scores.count(&dop.h)
    }

    fn anchor(&self, dop: &Dop) -> [i32; 3] {
        dop.anchor
    }

    fn sides(&self, dop: &Dop) -> Sides {
        Sides::of_dop(&self.tree.directions, &dop.h)
    }

    fn contains(&self, dop: &Dop, p: [i32; 3]) -> bool {
        self.tree.directions.contains(&dop.h, p)
    }
}
