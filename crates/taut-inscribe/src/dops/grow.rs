//! One body: growth by events, ruin and recreate.

use taut_points::Monitor;

use super::clip;
use super::directions::{Directions, Offsets, opposite};
use super::polytope;
use super::tree::Tree;
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

/// A body that no triangle enters, and a point of the grid in its interior.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Dop {
    pub(super) h: Offsets,
    pub(super) anchor: [i32; 3],
}

/// A body that may not be entered: its facets as triangles.
pub(super) struct Obstacle {
    triangles: Vec<[[f64; 3]; 3]>,
    /// The least uⱼ·x of each triangle, rounded down, and of all of them.
    heights: Vec<Offsets>,
    all: Offsets,
}

impl Obstacle {
    pub(super) fn of(directions: &Directions, dop: &Dop) -> Self {
        let polygons = polytope::facets(directions, &dop.h, dop.anchor);
        let fan = |p: Vec<[f64; 3]>| {
            let triangles = (2..p.len()).map(move |k| [p[0], p[k - 1], p[k]]);
            triangles.collect::<Vec<_>>()
        };
        let triangles: Vec<[[f64; 3]; 3]> = polygons.into_iter().flat_map(fan).collect();
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
    fn distance(&self, p: [i32; 3]) -> f64 {
        let p = p.map(f64::from);
        let distances = self.triangles.iter().map(|t| super::tree::squared_distance(p, t));
        distances.fold(f64::INFINITY, f64::min).sqrt()
    }

    fn event(&self, i: usize, h: &Offsets, most: i32, directions: &Directions) -> i32 {
        let mut limits = *h;
        limits[i] = most;
        let reaches = |heights: &Offsets, limits: &Offsets| {
            heights[..directions.len()].iter().zip(limits).all(|(height, limit)| height < limit)
        };
        if !reaches(&self.all, &limits) {
            return most;
        }
        for (triangle, heights) in self.triangles.iter().zip(&self.heights) {
            if reaches(heights, &limits)
                && let Some(height) = clip::lowest(triangle, i, h, directions)
            {
                limits[i] = limits[i].min((height + clip::TOUCH).floor() as i32);
            }
        }
        limits[i].max(h[i])
    }
}

/// What bodies grow in: a mesh, and bodies that may not be entered.
pub(super) struct Space<'a> {
    pub(super) directions: &'a Directions,
    pub(super) tree: &'a Tree<'a>,
    pub(super) obstacles: Vec<Obstacle>,
    pub(super) random: Random,
    /// Events so far.
    pub(super) events: u64,
    pub(super) monitor: Monitor<'a>,
}

impl Space<'_> {
    /// The distance from a point to the nearest triangle or obstacle, at most `distance`.
    pub(super) fn clearance(&self, p: [i32; 3], distance: f64) -> f64 {
        self.obstacles.iter().map(|obstacle| obstacle.distance(p)).fold(distance, f64::min)
    }

    /// A small body around a point inside with this distance from all triangles and obstacles.
    pub(super) fn start(&self, p: [i32; 3], clearance: f64) -> Dop {
        let mut h = [0; _];
        for (j, u) in self.directions.normals.iter().enumerate() {
            // A cube around a ball of radius r lies in a ball of radius √3·r, and so do bodies with more directions.
            let length = (u.iter().map(|n| n * n).sum::<i64>() as f64).sqrt();
            h[j] = (self.directions.along(j, p) as f64 + 0.57 * clearance * length) as i32;
        }
        Dop { h, anchor: p }
    }

    /// Moves facets outward in random order until each meets a triangle or is redundant.
    pub(super) fn grow(&mut self, dop: &mut Dop) -> Result<(), Error> {
        self.monitor.check()?;
        let mut order: Vec<usize> = (0..self.directions.len()).collect();
        for round in 0..ROUNDS_MAX {
            self.random.shuffle(&mut order);
            let mut changed = false;
            for &i in &order {
                let h = &dop.h;
                let mut most = self.tree.extent(i);
                if round < BALANCED_ROUNDS {
                    most = self.directions.redundant_at(i, h, most);
                }
                if let Some(part) = FIRST_STEPS.get(round) {
                    let width = f64::from(h[i] + h[opposite(i)]);
                    most = most.min(h[i] + (part * width).ceil() as i32);
                }
                if most > h[i] {
                    let moved = self.event(i, h, most);
                    changed |= moved > h[i];
                    dop.h[i] = moved;
                }
            }
            if round >= BALANCED_ROUNDS && !changed {
                break;
            }
        }
        self.tighten(&mut dop.h);
        Ok(())
    }

    fn event(&mut self, i: usize, h: &Offsets, most: i32) -> i32 {
        self.events += 1;
        let most = self.tree.event(i, h, most);
        let of_one = |most: i32, obstacle: &Obstacle| obstacle.event(i, h, most, self.directions);
        self.obstacles.iter().fold(most, of_one)
    }

    /// Moves some facets inward, but not beyond a point, and grows the body again.
    pub(super) fn ruin_and_recreate(
        &mut self,
        dop: &Dop,
        points: &[[i32; 3]],
    ) -> Result<Dop, Error> {
        let mut changed = dop.clone();
        for _ in 0..ANCHOR_DRAWS_MAX.min(points.len()) {
            let p = points[self.random.below(points.len())];
            if self.directions.contains(&dop.h, p) {
                changed.anchor = p;
                break;
            }
        }
        let facets = 1 + self.random.below(RUINED_FACETS_MAX);
        for _ in 0..facets {
            let i = self.random.below(self.directions.len());
            let width = f64::from(changed.h[i] + changed.h[opposite(i)]);
            let inward = (RUINED_WIDTH_MAX * self.random.unit() * width) as i32;
            let least = self.directions.along(i, changed.anchor) as i32 + 1;
            changed.h[i] = (changed.h[i] - inward).max(least);
        }
        self.tighten(&mut changed.h);
        self.grow(&mut changed)?;
        Ok(changed)
    }

    /// Moves redundant facets inward until they touch the body.
    pub(super) fn tighten(&self, h: &mut Offsets) {
        for i in 0..self.directions.len() {
            h[i] = self.directions.redundant_at(i, h, h[i]).min(h[i]);
        }
    }
}
