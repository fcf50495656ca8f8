//! The truth about surfaces: rows and why they are unused, topology, empty balls, meeting triangles, and which way they face.
//!
//! Everything is exact. Pairs of triangles are told apart by separating planes, points from surfaces by rays along a moment
//! curve of directions, balls point by point. What is found of a triangle, a pair or a ball is kept, as forged answers have
//! most of them in common.

mod balls;
mod claims;
mod convex;
mod lists;
mod scene;
mod shape;
mod sides;
#[cfg(test)]
mod tests;

use std::sync::OnceLock;

use taut::Solution;
use taut::certify::Surface;
use taut::certify::SurfaceVerdict;
use taut::points::{Monitor, Points, PointsHash, hash_points};

use self::scene::Scene;
use super::Truth;

type Point = [f64; 3];

/// All that is true of a point set of space, whatever the surface.
pub(crate) struct SurfaceOracle {
    rows: Vec<Point>,
    points_hash: PointsHash,
    /// The rows as they are given.
    given: Scene,
    /// The places of the first answer with moved vertices: others are told from them by what differs.
    moved: OnceLock<Scene>,
}

/// Nothing, or the lie that was found.
type Judged = Result<(), String>;

/// The lie, unless `is_true`.
fn ensure(is_true: bool, lie: impl FnOnce() -> String) -> Judged {
    if is_true { Ok(()) } else { Err(lie()) }
}

impl SurfaceOracle {
    /// Prepares finite points of space.
    pub(crate) fn new(values: &[f64], columns: usize) -> Self {
        let points = Points::new(values, columns).expect("rows of equal length");
        let points_hash = hash_points(&points, &Monitor::silent()).expect("points in memory");
        let rows: Vec<Point> = values.as_chunks().0.to_vec();
        let given = Scene::of(rows.clone());
        SurfaceOracle { rows, points_hash, given, moved: OnceLock::new() }
    }

    /// Tests whether every claim of an accepted answer and of its verdict is true.
    pub(crate) fn judge(&self, solution: &Solution<Surface>, verdict: &SurfaceVerdict) -> Truth {
        match self.examine(solution, verdict) {
            Ok(()) => Truth::True,
            Err(lie) => Truth::False(lie),
        }
    }

    fn examine(&self, solution: &Solution<Surface>, verdict: &SurfaceVerdict) -> Judged {
        let is_own = solution.certificate.points_hash == self.points_hash;
        ensure(is_own, || "the hash of other points".into())?;
        lists::vertices(solution, verdict, &self.rows)?;
        if solution.answer.vertices.is_empty() {
            return claims::judge(solution, verdict, &self.given);
        }
        let places = &solution.answer.vertices;
        let first = self.moved.get_or_init(|| Scene::of(places.clone()));
        if first.places == *places {
            return claims::judge(solution, verdict, first);
        }
        let moved = first.moved_to(places.clone());
        claims::judge(solution, verdict, &moved)
    }
}
