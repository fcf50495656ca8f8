//! Bodies with few facets, in directions that fit each body.
//!
//! *Idea.* A body with free facets shows which directions matter. The directions of its largest facets, each with its opposite,
//! and those of the axes are the directions of a k-dop, which grows by events and is ruined and recreated as any other. The free
//! body itself stays as long as it covers more.

use std::sync::Arc;

use taut_points::Monitor;

use super::directions::{AXES, DIRECTIONS_MAX, Directions, gcd};
use super::free::{self, Free, FreeBody};
use super::grow::{Dop, Space};
use super::mesh::GridMesh;
use super::pack::{Family, Start};
use super::polytope;
use super::proof::{self, Proved, unproved};
use super::random::Random;
use super::tree::Tree;
use super::vectors::dot;
use crate::Error;

/// Entries of a direction, at most: heights of the grid are below 90·2²⁴, and with a step of 30 % of the width below 2³¹.
const ENTRY_MAX: f64 = 30.0;

/// The cosine of the angle between two directions from which on one of them does for both.
const COSINE_MAX: f64 = 0.97;

/// Facets of the free body whose directions are taken: without a limit it would have no large ones.
const FREE_FACETS_MAX: usize = 96;

/// A body with free facets, or with directions that were fitted to one.
#[derive(Clone)]
pub(super) enum FittedBody {
    Free(FreeBody),
    Dop(Arc<Directions>, Dop),
}

/// Grows bodies of both ways.
pub(super) struct Fitted<'a> {
    /// Bodies with as many facets as allowed.
    free: Free<'a>,
    /// Bodies with more facets, to take directions from.
    full: Free<'a>,
    tree: Arc<Tree>,
    /// Where the body that was prepared last grows.
    space: Space<'a>,
    points: Vec<[i32; 3]>,
    facets: usize,
}

impl<'a> Fitted<'a> {
    pub(super) fn new(
        tree: &Arc<Tree>,
        random: Random,
        facets: usize,
        monitor: Monitor<'a>,
    ) -> Self {
        Fitted {
            free: Free::new(tree, random.clone(), facets, monitor),
            full: Free::new(tree, random.clone(), FREE_FACETS_MAX, monitor),
            tree: Arc::clone(tree),
            space: Space::new(tree, random, monitor),
            points: vec![],
            facets: facets.min(DIRECTIONS_MAX),
        }
    }

    /// The directions of the axes and of the largest facets of a body.
    fn directions(&self, body: &FreeBody) -> Directions {
        let polygons = polytope::facets(&body.sides, body.anchor);
        let mut by_area: Vec<(f64, usize)> =
            polygons.iter().map(|polygon| polytope::area(polygon)).zip(0..).collect();
        by_area.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut pairs: Vec<[i64; 3]> = AXES.to_vec();
        for (_, facet) in by_area {
            if pairs.len() == self.facets / 2 {
                break;
            }
            let direction = small(body.sides.normals[facet]);
            let is_new = pairs.iter().all(|&other| cosine(direction, other) < COSINE_MAX);
            if is_new {
                pairs.push(direction);
            }
        }
        Directions::with_axes_and(&pairs[AXES.len()..])
    }

    /// Makes events those of bodies with these directions.
    fn turn(&mut self, directions: &Arc<Directions>) {
        if !Arc::ptr_eq(&self.space.tree.directions, directions) {
            self.space.tree = Arc::new(self.tree.turned(directions));
        }
        self.space.aim(self.points.clone());
    }
}

/// The normal with small whole entries, nearly.
fn small(normal: [f64; 3]) -> [i64; 3] {
    let most = normal.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
    let rounded = normal.map(|x| (x / most * ENTRY_MAX).round() as i64);
    let divisor = rounded.iter().fold(0, |divisor, &n| gcd(divisor, n.abs())).max(1);
    rounded.map(|n| n / divisor)
}

/// The cosine of the angle between two lines.
fn cosine(u: [i64; 3], v: [i64; 3]) -> f64 {
    let [u, v] = [u, v].map(|u| u.map(|n| n as f64));
    dot(u, v).abs() / (dot(u, u) * dot(v, v)).sqrt()
}

impl Family for Fitted<'_> {
    type Body = FittedBody;

    fn events(&self) -> u64 {
        self.free.events() + self.full.events() + self.space.events()
    }

    fn count_event(&mut self) {
        self.free.count_event();
    }

    fn clearance(&self, _p: [i32; 3], distance: f64) -> f64 {
        distance
    }

    fn small(&self, start: &Start) -> FittedBody {
        FittedBody::Free(self.free.small(start))
    }

    fn aim(&mut self, points: Vec<[i32; 3]>) {
        self.free.aim(points.clone());
        self.full.aim(points.clone());
        self.points = points;
    }

    fn set_obstacles(&mut self, _bodies: &[&FittedBody]) {}

    fn grow(&mut self, body: &mut FittedBody) -> Result<(), Error> {
        match body {
            FittedBody::Free(free) => self.free.grow(free),
            FittedBody::Dop(..) => Ok(()),
        }
    }

    fn variants(&mut self, body: &FittedBody) -> Result<Vec<FittedBody>, Error> {
        let FittedBody::Free(free) = body else { return Ok(vec![body.clone()]) };
        // From the same start, with more facets.
        let mut full = free.clone();
        self.full.grow(&mut full)?;
        let directions = Arc::new(self.directions(&full));
        self.turn(&directions);
        let clearance = self.tree.squared_distance(free.anchor).sqrt();
        let start = Start { point: free.anchor, clearance, is_given: free.is_given };
        let mut dop = self.space.small(&start);
        self.space.grow(&mut dop)?;
        Ok(vec![body.clone(), FittedBody::Dop(directions, dop)])
    }

    fn prepare(&mut self, body: &mut FittedBody) -> Result<(), Error> {
        match body {
            FittedBody::Dop(directions, _) => {
                let directions = Arc::clone(directions);
                self.turn(&directions);
                Ok(())
            }
            FittedBody::Free(free) => self.free.prepare(free),
        }
    }

    fn change(&mut self, body: &FittedBody) -> Result<FittedBody, Error> {
        Ok(match body {
            FittedBody::Free(free) => FittedBody::Free(self.free.change(free)?),
            FittedBody::Dop(directions, dop) => {
                FittedBody::Dop(Arc::clone(directions), self.space.change(dop)?)
            }
        })
    }

    fn score(&self, body: &FittedBody) -> u64 {
        match body {
            FittedBody::Free(free) => self.free.score(free),
            FittedBody::Dop(directions, dop) => {
                match Arc::ptr_eq(directions, &self.space.tree.directions) {
                    true => self.space.score(dop),
                    false => {
                        self.points.iter().filter(|&&p| directions.contains(&dop.h, p)).count()
                            as u64
                    }
                }
            }
        }
    }

    fn contains(&self, body: &FittedBody, p: [i32; 3]) -> bool {
        match body {
            FittedBody::Free(free) => self.free.contains(free, p),
            FittedBody::Dop(directions, dop) => directions.contains(&dop.h, p),
        }
    }
}

/// Proves bodies one by one and leaves out those without proof, which rounding may cause for bodies of a few units.
pub(super) fn prove(
    mesh: &GridMesh,
    tree: &Tree,
    bodies: Vec<FittedBody>,
) -> Result<Proved, Error> {
    let mut proved = Proved::default();
    for (at, body) in bodies.into_iter().enumerate() {
        match body {
            FittedBody::Free(body) => {
                let mut found =
                    free::prove(mesh, tree, vec![body], false).map_err(|_| unproved(at))?;
                proved.bodies.append(&mut found.bodies);
                proved.proofs.append(&mut found.proofs);
            }
            FittedBody::Dop(directions, dop) => {
                match proof::prove_dop(mesh, &tree.turned(&directions), &dop, &[]) {
                    Some((_, body, proof)) => {
                        proved.bodies.push(body);
                        proved.proofs.push(proof);
                    }
                    None if dop.is_given => return Err(unproved(at)),
                    None => {}
                }
            }
        }
    }
    Ok(proved)
}
