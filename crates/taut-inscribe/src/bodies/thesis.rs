//! K-dops by the procedure of the thesis, section 8.5: seeds, growth by doubling, translation and sliding, greedy packing.
//!
//! *Problem.* Find k-dops inside a mesh, no two of which overlap.
//! *Idea.* Of the points of a grid that are inside by votes of the nearest vertices ([`votes`]), the one farthest from all vertices
//! is the next seed. A dop around it doubles its size as long as nothing is in it; then it may move away from what it touched.
//! Its facets slide outward in turn until each meets something or is redundant. The dop, and the points of the grid in it,
//! become obstacles. Where spheres are merged, a dop starts around the centers of the largest sphere and its largest neighbor.
//! *Guarantee.* That of the proof, which the thesis has not: a dop whose seed is outside is left out.
//! *Trap.* The first facet slides as far as it can before the others: that makes needles. Votes follow the orientation of
//! triangles; it is turned if the mesh as a whole is turned inside out, and nothing helps where it changes from part to part.
//! *Departures.* Collisions are found by events of facets, not by two hierarchies of dops. Distances to the vertices are those of a
//! tree without approximation. Normals of vertices are averages by area, as the thesis recommends.

mod votes;

use std::sync::Arc;

use super::directions::Offsets;
use super::grow::{Dop, Space};
use super::pack::{Family, Input, distance};
use super::tree::Tree;
use super::{BodiesThesisOptions, ThesisSeeds};
use crate::Error;
use crate::random::Random;

use self::votes::Votes;

/// Units of the grid from the center of a new dop to its facets.
const FIRST_REACH: f64 = 8.0;

/// Moves of a dop away from what it touches, at most.
const TRANSLATIONS_MAX: usize = 16;

/// Rounds of slides, at most: in most runs 5 leave nothing to slide.
const SLIDING_ROUNDS_MAX: usize = 64;

/// Random points that are tried for a seed, at most.
const DRAWS_MAX: usize = 10_000;

/// Seeds around which no dop was found inside, one after the other, until the search ends.
const FAILURES_MAX: usize = 200;

/// The part of the radius of the smaller of two merged spheres that the first dop around their centers has on all sides.
const MERGED_MARGIN: f64 = 0.125;

/// What the procedure found.
pub(super) struct Packed {
    pub(super) dops: Vec<Dop>,
    pub(super) events: u64,
    /// How many of the points to cover are covered.
    pub(super) covered: u64,
}

/// A point of the grid that may become a seed, with its distance from the nearest vertex or point of a dop.
#[derive(Clone, Copy)]
struct Candidate {
    point: [i32; 3],
    distance: f64,
}

/// Finds k-dops by the procedure of the thesis.
pub(super) fn pack(
    input: &Input<'_>,
    tree: &Arc<Tree>,
    thesis: &BodiesThesisOptions,
) -> Result<Packed, Error> {
    let options = input.options;
    let votes = Votes::of(&input.mesh.corners, thesis.votes);
    let space = Space::new(tree, Random::new(options.seed), options.monitor);
    let mut search = Search { thesis, votes, space, candidates: vec![] };
    search.candidates = search.grid(thesis.cells);
    let (mut dops, mut failures, mut open) = (vec![], 0, input.points.to_vec());
    let wanted = options.coverage.map_or(0.0, |part| (1.0 - part) * open.len() as f64);
    while dops.len() < options.count && failures < FAILURES_MAX && open.len() as f64 > wanted {
        options.monitor.check()?;
        let Some((seed, other)) = search.seed(&dops) else { break };
        let found = search.expand(seed, other);
        search.leave_out(seed, found.as_ref());
        let is_inside = input.tree.is_inside(seed) == Some(true) && input.mesh.sees_mesh(seed);
        let Some(dop) = found.filter(|_| is_inside) else {
            failures += 1;
            continue;
        };
        failures = 0;
        open.retain(|&p| !tree.directions.contains(&dop.h, p));
        dops.push(dop);
        search.space.set_obstacles(&dops.iter().collect::<Vec<_>>());
    }
    let covered = (input.points.len() - open.len()) as u64;
    Ok(Packed { dops, events: search.space.events, covered })
}

/// What the steps share.
struct Search<'a> {
    thesis: &'a BodiesThesisOptions,
    votes: Votes,
    space: Space<'a>,
    candidates: Vec<Candidate>,
}

impl Search<'_> {
    /// The points of a grid over the bounding box that are inside by votes.
    fn grid(&self, cells: usize) -> Vec<Candidate> {
        let [center, half] = self.space.tree.mesh_bounds();
        let step = 2.0 * half.into_iter().fold(0.0, f64::max) / cells as f64;
        let along = |c: usize| {
            let count = (2.0 * half[c] / step).ceil() as usize;
            (0..count).map(move |k| (center[c] - half[c] + (k as f64 + 0.5) * step) as i32)
        };
        let points = along(0)
            .flat_map(|x| along(1).map(move |y| (x, y)))
            .flat_map(|(x, y)| along(2).map(move |z| [x, y, z]));
        let inside = points.filter_map(|point| {
            let (is_inside, distance) = self.votes.of_point(point);
            is_inside.then_some(Candidate { point, distance })
        });
        inside.collect()
    }

    /// The next seed, and the center of the sphere to merge with, if there is one; `None` where no seed is left.
    fn seed(&mut self, dops: &[Dop]) -> Option<([i32; 3], Option<Candidate>)> {
        if self.thesis.seeds == ThesisSeeds::Grid {
            let largest = *self.candidates.iter().rev().max_by(by_distance)?;
            let other = self.thesis.merge.then(|| self.neighbor(largest)).flatten();
            return Some((largest.point, other));
        }
        let [center, half] = self.space.tree.mesh_bounds();
        let middle = center.map(|x| x.round() as i32);
        if self.thesis.seeds == ThesisSeeds::Center && self.is_free(middle, dops) {
            return Some((middle, None));
        }
        for _ in 0..DRAWS_MAX {
            let off = half.map(|half| half * (2.0 * self.space.random.unit() - 1.0));
            let point = [0, 1, 2].map(|c| (center[c] + off[c]).round() as i32);
            if self.is_free(point, dops) {
                return Some((point, None));
            }
        }
        None
    }

    /// Whether a point is inside by votes, and in no dop.
    fn is_free(&self, point: [i32; 3], dops: &[Dop]) -> bool {
        let directions = &self.space.tree.directions;
        dops.iter().all(|dop| !directions.contains(&dop.h, point)) && self.votes.of_point(point).0
    }

    /// The largest sphere that touches a sphere, nearly: of those around points of the grid, without points of the first.
    fn neighbor(&self, first: Candidate) -> Option<Candidate> {
        let outside =
            self.candidates.iter().filter_map(|&Candidate { point, distance: radius }| {
                let between = distance(point, first.point);
                let radius = radius.min(between - first.distance);
                // The grid has points that are a cell away from the place where spheres touch.
                let touches = radius > 0.0 && between <= 1.5 * (first.distance + radius);
                touches.then_some(Candidate { point, distance: radius })
            });
        outside.max_by(by_distance)
    }

    /// Grows a dop around a seed: doubling, translation, sliding; `None` where there is no room.
    fn expand(&mut self, seed: [i32; 3], other: Option<Candidate>) -> Option<Dop> {
        let merged = other.and_then(|other| self.around_both(seed, other));
        let mut dop = merged.or_else(|| self.double(seed))?;
        self.slide(&mut dop);
        Some(dop)
    }

    /// A dop around two centers, if nothing is in it.
    fn around_both(&mut self, seed: [i32; 3], other: Candidate) -> Option<Dop> {
        let margin = MERGED_MARGIN * other.distance;
        let (one, two) = (self.scaled(seed, margin), self.scaled(other.point, margin));
        let h = std::array::from_fn(|j| one[j].max(two[j]));
        self.space.is_empty(&h).then(|| Dop::new(h, seed))
    }

    /// The dop around a point with facets at this distance.
    fn scaled(&self, center: [i32; 3], reach: f64) -> Offsets {
        let directions = &self.space.tree.directions;
        let mut h = [0; _];
        for (j, u) in directions.floats.iter().enumerate() {
            let length = u.iter().map(|n| n * n).sum::<f64>().sqrt();
            h[j] = (directions.along(j, center) as f64 + reach * length) as i32;
        }
        h
    }

    /// Whether nothing is in the dop around a point.
    fn is_empty(&mut self, center: [i32; 3], reach: f64) -> bool {
        let h = self.scaled(center, reach);
        self.space.is_empty(&h)
    }

    /// Doubles the size of a dop as long as nothing is in it and it is not larger than the mesh.
    fn double(&mut self, seed: [i32; 3]) -> Option<Dop> {
        let [_, half] = self.space.tree.mesh_bounds();
        let most = half.into_iter().fold(0.0, f64::max);
        let (mut center, mut reach) = (seed, FIRST_REACH);
        if !self.is_empty(center, reach) {
            return None;
        }
        for _ in 0..=TRANSLATIONS_MAX {
            while reach < most && self.is_empty(center, 2.0 * reach) {
                reach *= 2.0;
            }
            let moved = if self.thesis.translate { self.away(center, reach) } else { None };
            let Some(moved) = moved else { break };
            center = moved;
        }
        Some(Dop::new(self.scaled(center, reach), center))
    }

    /// The center of a dop moved away from what would stop facets within its size; `None` where it has no room to move.
    fn away(&mut self, center: [i32; 3], reach: f64) -> Option<[i32; 3]> {
        let directions = Arc::clone(&self.space.tree.directions);
        let (h, doubled) = (self.scaled(center, reach), self.scaled(center, 2.0 * reach));
        let mut off = [0.0; 3];
        for (i, u) in directions.floats.iter().enumerate() {
            let stopped = self.space.event(i, &mut Dop::new(h, center), doubled[i]);
            let part = f64::from(doubled[i] - stopped) / f64::from(doubled[i] - h[i]).max(1.0);
            let length = u.iter().map(|n| n * n).sum::<f64>().sqrt();
            off = [0, 1, 2].map(|c| off[c] - part * u[c] / length);
        }
        let length = off.iter().map(|x| x * x).sum::<f64>().sqrt();
        let moved = [0, 1, 2].map(|c| center[c] + (0.5 * reach * off[c] / length).round() as i32);
        let has_room = length > 0.0 && moved != center && self.is_empty(moved, reach);
        has_room.then_some(moved)
    }

    /// Slides facets outward in turn until nothing moves.
    fn slide(&mut self, dop: &mut Dop) {
        let directions = Arc::clone(&self.space.tree.directions);
        for _ in 0..SLIDING_ROUNDS_MAX {
            let before = dop.h;
            for i in 0..directions.len() {
                let extent = self.space.tree.extent(i);
                let most = directions.redundant_at(i, &dop.h, extent);
                if most > dop.h[i] {
                    dop.h[i] = self.space.event(i, dop, most);
                }
            }
            if dop.h == before {
                break;
            }
        }
        directions.tighten(&mut dop.h);
    }

    /// Takes a seed and the points of a dop out of the candidates; the points become obstacles of the others.
    fn leave_out(&mut self, seed: [i32; 3], dop: Option<&Dop>) {
        let directions = &self.space.tree.directions;
        let is_taken = |candidate: &Candidate| {
            candidate.point == seed
                || dop.is_some_and(|dop| directions.contains(&dop.h, candidate.point))
        };
        let taken: Vec<Candidate> = self.candidates.extract_if(.., |c| is_taken(c)).collect();
        for candidate in &mut self.candidates {
            let near = taken.iter().map(|taken| distance(taken.point, candidate.point));
            candidate.distance = near.fold(candidate.distance, f64::min);
        }
    }
}

fn by_distance<C: std::borrow::Borrow<Candidate>>(one: &C, other: &C) -> std::cmp::Ordering {
    one.borrow().distance.total_cmp(&other.borrow().distance)
}
