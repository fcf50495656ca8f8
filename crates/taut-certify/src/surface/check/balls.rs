//! That each triangle has the empty ball that it is said to have.
//!
//! *Idea.* A tree of boxes over the points. What is surely outside of the ball is left out, box by box; of each point that remains an
//! exact sign tells on which side of the sphere it is.
//! *Cost.* O(log n) for a ball that touches few points. One that passes a large part of all, as the ball within a sphere of samples
//! does, costs as many: hence the smallest ball as a witness of its own, which is empty for nearly all triangles of a dense sample. Where
//! coordinates differ by so much that products underflow, no box is left out, and the cost is that of all pairs.
//! *Facets of the hull.* A half-space is the limit of balls with the three vertices on their spheres; these lose the points of the
//! plane but those in the circle. So no point may be beyond the plane, and none in the circle, which is where the plane cuts the
//! smallest ball. Where a face of the hull has many points, boxes of them lie in its plane: these are told by their corners, exactly.
//! *Ties.* The same signs tell which sites lie on a sphere without being vertices of its triangle. Triangles whose spheres have no
//! such site, or one beside their plane, cannot meet any other triangle with an empty ball: see [`crossing`](super::crossing). Of a
//! facet of the hull those on the circle count: the balls that tend to the half-space have no other site in common.

use std::cell::LazyCell;
use std::cmp::Ordering;

use taut_points::parallel::ParallelSlice;
use taut_points::{Monitor, ReadError};

use super::super::{Apex, Surface, SurfaceCertificate, SurfaceViolation};
use super::ball::Ball;
use super::places::{Places, axes, side};
use super::sphere::Sphere;
use super::tree::{Area, Tree};
use crate::CheckError;
use crate::triangulation::{Gabriel, Tetrahedra};

/// Triangles in a block of work.
const BLOCK: usize = 1 << 10;

/// Checks the balls, each of them empty of `sites`. For each triangle whether its vertices and the other sites on the sphere of its
/// ball are affinely independent; empty where no balls are claimed.
pub(super) fn check(
    surface: &Surface,
    certificate: &SurfaceCertificate,
    places: &Places,
    sites: Vec<u32>,
    monitor: &Monitor<'_>,
) -> Result<Vec<bool>, CheckError> {
    let apexes = &certificate.apexes;
    if apexes.is_empty() {
        return Ok(vec![]);
    }
    let areas: Vec<Area> = sites.iter().map(|&row| Area::of(&[places.all[row as usize]])).collect();
    let search = Search { places, tree: Tree::of(&areas), sites };
    let blocks = surface.triangles.par_chunks(BLOCK).zip(apexes.par_chunks(BLOCK)).enumerate();
    let judged: Vec<Result<Vec<bool>, CheckError>> = blocks
        .map(|(block, (triangles, apexes))| {
            let numbered = (block * BLOCK..).zip(triangles.iter().zip(apexes));
            let judge = |(number, (&triangle, &apex))| {
                // Where bounds underflow, each triangle takes exact signs of all points.
                monitor.check().map_err(ReadError::from)?;
                Ok(search.judge(number, triangle, apex)?)
            };
            numbered.map(judge).collect::<Result<_, CheckError>>()
        })
        .collect();
    // The first violation by position, whichever thread met it.
    let blocks: Vec<Vec<bool>> = judged.into_iter().collect::<Result<_, CheckError>>()?;
    Ok(blocks.concat())
}

struct Search<'a> {
    places: &'a Places,
    tree: Tree,
    /// The rows of the items of the tree.
    sites: Vec<u32>,
}

/// The sites on a sphere that are neither vertices nor the apex of its triangle.
#[derive(Default)]
struct CosphericalSites {
    count: usize,
    /// The place of one of them.
    last: Option<[f64; 3]>,
}

impl Search<'_> {
    /// Tests whether the triangle and all sites on its sphere are affinely independent; the violation if its ball is not empty, or none.
    fn judge(&self, triangle: usize, rows: [u32; 3], apex: Apex) -> Result<bool, SurfaceViolation> {
        let no_ball = |problem| Err(SurfaceViolation::NoBall { triangle, problem });
        let (signs, corners) = (&self.places.signs, self.places.corners(rows));
        if axes(signs, &corners).is_none() {
            return no_ball("it is flat");
        }
        let (ball, found) = match apex {
            Apex::Row(row) => {
                let Some(d) = self.places.all.get(row as usize) else {
                    return no_ball("its apex is no row");
                };
                let [a, b, c] = corners;
                let tetrahedron = match side(signs, &corners, d) {
                    Ordering::Greater => [a, b, c, *d],
                    Ordering::Less => [a, c, b, *d],
                    Ordering::Equal => return no_ball("its apex is in its plane"),
                };
                if self.sites.binary_search(&row).is_err() {
                    return no_ball("its apex is a duplicate or an outlier");
                }
                let own = |other: u32| other == row || rows.contains(&other);
                let place = |q: &[f64; 3]| signs.in_sphere::<Tetrahedra, 3, 4>(&tetrahedron, q);
                let ball = LazyCell::new(|| Ball::around(&tetrahedron));
                let ties = self.ties_of(&Sphere::around(&tetrahedron), &ball, own, place);
                // Any five points of space are dependent.
                ("through its apex", ties.map(|ties| ties.count == 0))
            }
            Apex::Gabriel => {
                let own = |other: u32| rows.contains(&other);
                let place = |q: &[f64; 3]| signs.in_sphere::<Gabriel, 3, 3>(&corners, q);
                let ball = LazyCell::new(|| Ball::smallest(&corners));
                let ties = self.ties_of(&Sphere::smallest(&corners), &ball, own, place);
                let is_independent = |ties: CosphericalSites| match (ties.count, ties.last) {
                    (1, Some(q)) => side(signs, &corners, &q).is_ne(),
                    (count, _) => count == 0,
                };
                ("the smallest", ties.map(is_independent))
            }
            Apex::Hull => return self.hull(triangle, rows),
        };
        found.map_err(|row| SurfaceViolation::Ball { triangle, ball, row })
    }

    /// [`judge`](Self::judge) for a facet of the hull: one side of it, and its circle, are empty.
    fn hull(&self, triangle: usize, rows: [u32; 3]) -> Result<bool, SurfaceViolation> {
        let (signs, [a, b, c]) = (&self.places.signs, self.places.corners(rows));
        let beyond = |corners: [[f64; 3]; 3]| {
            let place = |q: &[f64; 3]| match side(signs, &corners, q) {
                Ordering::Equal => signs.in_sphere::<Gabriel, 3, 3>(&corners, q),
                beside => beside,
            };
            let (half_space, smallest) = (Ball::beyond(&corners), Ball::smallest(&corners));
            let is_beneath = |q: [f64; 3]| side(signs, &corners, &q).is_le();
            let outside = |area: &Area| {
                half_space.misses(area)
                    || smallest.misses(area) && area.corners().into_iter().all(is_beneath)
            };
            self.ties(outside, |_| false, |other| rows.contains(&other), place)
        };
        // A triangle that runs the wrong way round is on the hull all the same: its direction is judged elsewhere.
        let found = beyond([a, b, c]).or_else(|row| {
            beyond([a, c, b])
                .map_err(|other| SurfaceViolation::Hull { triangle, rows: [row, other] })
        });
        // Those on the circle are in the plane of the triangle.
        found.map(|ties| ties.count == 0)
    }

    /// [`ties`](Self::ties) of a ball, whose sphere may tell more boxes to be outside at less cost.
    fn ties_of<F: FnOnce() -> Ball>(
        &self,
        sphere: &Sphere,
        ball: &LazyCell<Ball, F>,
        own: impl Fn(u32) -> bool,
        place: impl Fn(&[f64; 3]) -> Ordering,
    ) -> Result<CosphericalSites, u32> {
        let near = |area: &Area| ball.misses(area);
        match sphere.is_known() {
            true => self.ties(|area| sphere.misses(area), near, own, place),
            false => self.ties(near, |_| false, own, place),
        }
    }

    /// The sites on a sphere but for its own, if none is inside; else the first one inside, in the order of the tree. Boxes that `far`
    /// tells to be outside are left out, and then points that `near` does; of the others `place` tells whether they are inside, on
    /// the sphere or outside.
    fn ties(
        &self,
        far: impl Fn(&Area) -> bool,
        near: impl Fn(&Area) -> bool,
        own: impl Fn(u32) -> bool,
        place: impl Fn(&[f64; 3]) -> Ordering,
    ) -> Result<CosphericalSites, u32> {
        // Bounds hold where nothing over- or underflows by much.
        let is_bounded = self.places.signs.is_filtered;
        let mut ties = CosphericalSites::default();
        let wanted = |item: u32| {
            let row = self.sites[item as usize];
            let q = self.places.all[row as usize];
            if own(row) || is_bounded && near(&Area::of(&[q])) {
                return false;
            }
            let place = place(&q);
            if place.is_eq() {
                ties = CosphericalSites { count: ties.count + 1, last: Some(q) };
            }
            place.is_gt()
        };
        match self.tree.find(|area| !(is_bounded && far(area)), wanted) {
            Some(item) => Err(self.sites[item as usize]),
            None => Ok(ties),
        }
    }
}
