//! That each triangle has the empty ball that it is said to have.
//!
//! *Idea.* A tree of boxes over the points. What is surely outside of the ball is left out, box by box; of each point that remains an
//! exact sign tells on which side of the sphere it is.
//! *Cost.* O(log n) for a ball that touches few points. One that passes a large part of all, as the ball within a sphere of samples
//! does, costs as many: hence the smallest ball as a witness of its own, which is empty for nearly all triangles of a dense sample.
//! *Facets of the hull.* A half-space is the limit of balls with the three vertices on their spheres; these lose the points of the
//! plane but those in the circle. So no point may be beyond the plane, and none in the circle, which is where the plane cuts the
//! smallest ball. Where a face of the hull has many points, boxes of them lie in its plane: these are told by their corners, exactly.

use std::cmp::Ordering;

use rayon::prelude::*;
use taut_points::{Monitor, ReadError};

use super::super::{Apex, Surface, SurfaceCertificate, SurfaceViolation};
use super::ball::Ball;
use super::places::{Places, axes, side};
use super::tree::{Area, Tree};
use crate::CheckError;
use crate::triangulation::{Gabriel, Tetrahedra};

/// Triangles in a block of work.
const BLOCK: usize = 1 << 10;

/// Checks the balls, each of them empty of `sites`.
pub(super) fn check(
    surface: &Surface,
    certificate: &SurfaceCertificate,
    places: &Places,
    sites: Vec<u32>,
    monitor: &Monitor<'_>,
) -> Result<(), CheckError> {
    let apexes = &certificate.apexes;
    if apexes.is_empty() {
        return Ok(());
    }
    let areas: Vec<Area> = sites.iter().map(|&row| Area::of(&[places.all[row as usize]])).collect();
    let search = Search { places, tree: Tree::of(&areas), sites };
    let blocks = surface.triangles.par_chunks(BLOCK).zip(apexes.par_chunks(BLOCK)).enumerate();
    let judged: Vec<Result<(), CheckError>> = blocks
        .map(|(block, (triangles, apexes))| {
            monitor.check().map_err(ReadError::from)?;
            for (number, (&triangle, &apex)) in (block * BLOCK..).zip(triangles.iter().zip(apexes))
            {
                search.judge(number, triangle, apex)?;
            }
            Ok(())
        })
        .collect();
    // The first violation by position, whichever thread met it.
    judged.into_iter().collect()
}

struct Search<'a> {
    places: &'a Places,
    tree: Tree,
    /// The rows of the items of the tree.
    sites: Vec<u32>,
}

impl Search<'_> {
    fn judge(&self, triangle: usize, rows: [u32; 3], apex: Apex) -> Result<(), SurfaceViolation> {
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
                let inside =
                    |q: &[f64; 3]| signs.in_sphere::<Tetrahedra, 3, 4>(&tetrahedron, q).is_gt();
                ("through its apex", self.first(Ball::around(&tetrahedron).outside(), own, inside))
            }
            Apex::Gabriel => {
                let own = |other: u32| rows.contains(&other);
                let inside = |q: &[f64; 3]| signs.in_sphere::<Gabriel, 3, 3>(&corners, q).is_gt();
                ("the smallest", self.first(Ball::smallest(&corners).outside(), own, inside))
            }
            Apex::Hull => return self.hull(triangle, rows),
        };
        match found {
            Some(row) => Err(SurfaceViolation::Ball { triangle, ball, row }),
            None => Ok(()),
        }
    }

    /// Whether one side of a triangle, and its circle, are empty.
    fn hull(&self, triangle: usize, rows: [u32; 3]) -> Result<(), SurfaceViolation> {
        let (signs, [a, b, c]) = (&self.places.signs, self.places.corners(rows));
        let beyond = |corners: [[f64; 3]; 3]| {
            let inside = |q: &[f64; 3]| match side(signs, &corners, q) {
                Ordering::Greater => true,
                Ordering::Less => false,
                Ordering::Equal => signs.in_sphere::<Gabriel, 3, 3>(&corners, q).is_gt(),
            };
            let (half_space, smallest) = (Ball::beyond(&corners), Ball::smallest(&corners));
            let is_beneath = |q: [f64; 3]| side(signs, &corners, &q).is_le();
            let outside = |area: &Area| {
                half_space.misses(area)
                    || smallest.misses(area) && area.corners().into_iter().all(is_beneath)
            };
            self.first(outside, |other| rows.contains(&other), inside)
        };
        // A triangle that runs the wrong way round is on the hull all the same: its direction is judged elsewhere.
        match beyond([a, b, c]).map(|row| (row, beyond([a, c, b]))) {
            Some((row, Some(other))) => {
                Err(SurfaceViolation::Hull { triangle, rows: [row, other] })
            }
            _ => Ok(()),
        }
    }

    /// The first site, in the order of the tree, that is inside and not one of the ball's own, for boxes surely outside.
    fn first(
        &self,
        outside: impl Fn(&Area) -> bool,
        own: impl Fn(u32) -> bool,
        inside: impl Fn(&[f64; 3]) -> bool,
    ) -> Option<u32> {
        // Bounds hold where nothing over- or underflows by much.
        let is_bounded = self.places.signs.is_filtered;
        let wanted = |item: u32| {
            let row = self.sites[item as usize];
            !own(row) && inside(&self.places.all[row as usize])
        };
        let found = self.tree.find(|area| !(is_bounded && outside(area)), wanted);
        found.map(|item| self.sites[item as usize])
    }
}
