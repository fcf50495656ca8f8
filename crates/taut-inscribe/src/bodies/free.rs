//! Bodies whose facets have any direction.
//!
//! *Idea.* Planes around a center keep all triangles out ([`planes`]). The ellipsoid of inertia of the points to cover in the
//! body is the metric of the next body ([`metric`]), and so on; of all these bodies the best stays. Random changes move the
//! center and stretch the metric.

mod disjoint;
mod metric;
mod planes;
mod prove;

use std::sync::Arc;

use taut_points::Monitor;

use super::cloud::Cloud;
use super::grow::ANCHOR_MARGIN;
use super::lines::Line;
use super::pack::{Family, Segment, Start};
use super::polytope::{self, Sides};
use super::tree::{self, Tree};
use super::vectors::{dot, minus};
use crate::Error;
use crate::random::Random;

use self::metric::Metric;
use self::planes::{Blocks, Kept, Obstacle};

pub(super) use self::prove::prove;

/// Rounds in which a new body takes the metric of the body before it.
const ROUNDS: usize = 3;

/// Stretches of a random change, and the logarithm to base 2 of the largest.
const STRETCHES: usize = 2;
const STRETCH_MAX: f64 = 1.0;

/// How far a random change moves the center to a point of the body, at most, as a part of the distance.
const SHIFT_MAX: f64 = 0.9;

/// A body that no triangle enters, and a point of the grid in its interior.
#[derive(Clone, Debug)]
pub(super) struct FreeBody {
    pub(super) sides: Sides,
    pub(super) anchor: [i32; 3],
    /// The ends of a segment that the body has to contain, if there is one.
    pub(super) kept: Option<Segment>,
    stage: Stage,
    /// The points to cover in the body.
    covered: Arc<Vec<[f64; 3]>>,
}

/// How far a body has grown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// The cube around its start, which several facets together keep apart from some triangles.
    Cube,
    /// The box around a segment, of which nothing is known.
    Box,
    /// Each triangle is behind one facet.
    Grown,
}

/// What bodies grow in, and the points to cover.
pub(super) struct Free<'a> {
    tree: Arc<Tree>,
    obstacles: Vec<Obstacle>,
    random: Random,
    /// Planes that were placed or moved so far.
    events: u64,
    points: Cloud,
    /// The lines to hide, if that is the objective.
    lines: Option<Vec<Line>>,
    /// Facets of a body, at most.
    facets_max: usize,
    monitor: Monitor<'a>,
}

impl<'a> Free<'a> {
    pub(super) fn new(
        tree: &Arc<Tree>,
        random: Random,
        facets_max: usize,
        monitor: Monitor<'a>,
    ) -> Self {
        Free {
            tree: Arc::clone(tree),
            obstacles: vec![],
            random,
            events: 0,
            points: Cloud::default(),
            lines: None,
            facets_max,
            monitor,
        }
    }

    /// The body with planes around the center of a metric; `None` where there is none.
    fn around(&mut self, metric: &Metric, body: &FreeBody) -> Option<FreeBody> {
        let blocks = Blocks { tree: &self.tree, obstacles: &self.obstacles };
        let kept = body.kept.map(|ends| Kept {
            ends: ends.map(|end| end.map(f64::from)),
            margin: f64::from(ANCHOR_MARGIN),
        });
        let (sides, events) = planes::around(&blocks, metric, kept, self.facets_max);
        self.events += events;
        let anchor =
            if body.kept.is_some() { body.anchor } else { metric.center.map(|x| x.round() as i32) };
        let sides = sides?;
        if !sides.contains(anchor.map(f64::from)) {
            return None;
        }
        let covered = Arc::new(self.points.inside(&sides));
        Some(FreeBody { sides, anchor, kept: body.kept, stage: Stage::Grown, covered })
    }

    /// The metric in which a body first grows: round around a point, long around a segment.
    fn first_metric(&self, body: &FreeBody) -> Metric {
        let round = Metric::round(body.anchor.map(f64::from));
        let Some(ends) = body.kept else { return round };
        let [from, to] = ends.map(|end| end.map(f64::from));
        let along = minus(to, from);
        let length = dot(along, along).sqrt();
        if length == 0.0 {
            return round;
        }
        let clearance = self.tree.clearance(ends);
        let factor = clearance / (clearance + length / 2.0);
        round.stretched(along.map(|x| x / length), factor)
    }

    /// A direction of length 1.
    fn direction(&mut self) -> [f64; 3] {
        loop {
            let p = [0; 3].map(|_: i32| 2.0 * self.random.unit() - 1.0);
            let length = dot(p, p).sqrt();
            if (0.1..=1.0).contains(&length) {
                return p.map(|x| x / length);
            }
        }
    }
}

impl Family for Free<'_> {
    type Body = FreeBody;

    fn events(&self) -> u64 {
        self.events
    }

    fn count_event(&mut self) {
        self.events += 1;
    }

    fn clearance(&self, p: [i32; 3], distance: f64) -> f64 {
        let p = p.map(f64::from);
        let triangles = self.obstacles.iter().flat_map(|obstacle| &obstacle.triangles);
        let squares = triangles.map(|t| tree::squared_distance(p, t));
        squares.fold(distance * distance, f64::min).sqrt()
    }

    fn small(&mut self, start: &Start) -> Option<FreeBody> {
        let (normals, stage) = match start.is_point() {
            true => (self.tree.directions.floats.clone(), Stage::Cube),
            false => (planes::box_normals(start.ends)?, Stage::Box),
        };
        let ends = start.ends.map(|end| end.map(f64::from));
        // A cube in the ball of the clearance, or a box among all such balls around points of the segment.
        let offset = |u: &[f64; 3]| {
            let kept = dot(*u, ends[0]).max(dot(*u, ends[1]));
            (kept + 0.57 * start.clearance * dot(*u, *u).sqrt()).floor()
        };
        let offsets = normals.iter().map(offset).collect();
        let sides = Sides { normals, offsets };
        let kept = start.is_given.then_some(start.ends);
        Some(FreeBody { sides, anchor: start.point, kept, stage, covered: Arc::new(vec![]) })
    }

    fn aim(&mut self, points: Vec<[i32; 3]>, lines: Option<Vec<Line>>) {
        self.points = Cloud::of(&points);
        self.lines = lines;
    }

    fn set_obstacles(&mut self, bodies: &[&FreeBody]) {
        let obstacle = |body: &&FreeBody| {
            let facets = polytope::facets(&body.sides, body.anchor);
            let fan = |p: &Vec<[f64; 3]>| {
                (2..p.len()).map(|k| [p[0], p[k - 1], p[k]]).collect::<Vec<_>>()
            };
            Obstacle { triangles: facets.iter().flat_map(fan).collect(), vertices: facets.concat() }
        };
        self.obstacles = bodies.iter().map(obstacle).collect();
    }

    fn grow(&mut self, body: &mut FreeBody) -> Result<(), Error> {
        self.monitor.check()?;
        self.prepare(body);
        let mut metric = self.first_metric(body);
        for _ in 0..=ROUNDS {
            let Some(found) = self.around(&metric, body) else { break };
            let next = Metric::of_inertia(&found.covered);
            if body.stage == Stage::Box || found.covered.len() >= body.covered.len() {
                *body = found;
            }
            let Some(next) = next else { break };
            metric = next;
        }
        Ok(())
    }

    fn prepare(&mut self, body: &mut FreeBody) {
        body.covered = Arc::new(self.points.inside(&body.sides));
    }

    fn change(&mut self, body: &FreeBody) -> Result<FreeBody, Error> {
        self.monitor.check()?;
        let covered = &body.covered;
        let metric = Metric::of_inertia(covered);
        let mut metric = metric.unwrap_or_else(|| Metric::round(body.anchor.map(f64::from)));
        for _ in 0..STRETCHES {
            let axis = self.direction();
            let stretch = STRETCH_MAX * (2.0 * self.random.unit() - 1.0);
            metric = metric.stretched(axis, stretch.exp2());
        }
        if !covered.is_empty() {
            let to = covered[self.random.below(covered.len())];
            let part = SHIFT_MAX * self.random.unit();
            metric.center = [0, 1, 2].map(|c| (1.0 - part) * metric.center[c] + part * to[c]);
        }
        Ok(self.around(&metric, body).unwrap_or_else(|| body.clone()))
    }

    fn score(&self, body: &FreeBody) -> u64 {
        match &self.lines {
            Some(lines) => lines.iter().filter(|line| line.meets(&body.sides)).count() as u64,
            None => body.covered.len() as u64,
        }
    }

    fn anchor(&self, body: &FreeBody) -> [i32; 3] {
        body.anchor
    }

    fn sides(&self, body: &FreeBody) -> Sides {
        body.sides.clone()
    }

    fn contains(&self, body: &FreeBody, p: [i32; 3]) -> bool {
        body.sides.contains(p.map(f64::from))
    }
}
