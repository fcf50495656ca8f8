//! Whether the surface meets itself: a tree lists the pairs of triangles that can, [`meet`](super::meet) decides.

use taut_points::{Monitor, ReadError};

use super::super::SurfaceDoubt;
use super::meet::{Face, meet};
use super::places::{Places, axes};
use super::tree::{Area, Tree};

/// The triangles in their places, with a tree over them.
pub(super) struct Faces<'a> {
    pub(super) triangles: &'a [[u32; 3]],
    pub(super) places: &'a Places,
    pub(super) tree: Tree,
}

impl<'a> Faces<'a> {
    pub(super) fn of(triangles: &'a [[u32; 3]], places: &'a Places) -> Self {
        let areas: Vec<Area> = triangles.iter().map(|&t| Area::of(&places.corners(t))).collect();
        Faces { triangles, places, tree: Tree::of(&areas) }
    }

    pub(super) fn face(&self, triangle: u32) -> Face {
        let rows = self.triangles[triangle as usize];
        Face { rows, corners: self.places.corners(rows) }
    }

    /// The first triangle that is flat, or some two that share more than their common vertices and edges.
    pub(super) fn crossing(
        &self,
        monitor: &Monitor<'_>,
    ) -> Result<Option<SurfaceDoubt>, ReadError> {
        let signs = &self.places.signs;
        let numbers = 0..self.triangles.len() as u32;
        let is_flat = |&t: &u32| axes(signs, &self.face(t).corners).is_none();
        if let Some(triangle) = numbers.clone().find(is_flat) {
            return Ok(Some(SurfaceDoubt::Flat { triangle }));
        }
        let wanted = |one: u32, other: u32| meet(signs, &self.face(one), &self.face(other));
        let found = self.tree.find_pair(|| monitor.check(), wanted)?;
        Ok(found.map(|triangles| SurfaceDoubt::Crossing { triangles }))
    }
}
