//! Decides whether the surface meets itself: empty balls settle nearly all of it, for the rest a tree lists the pairs of triangles that can meet,
//! and [`meet`](super::meet) decides.
//!
//! *Theorem.* Let S and T be triangles that are not flat, with different vertices, all of them sites; let each have an open ball with its
//! three vertices on the sphere and no site inside. If they share a point that is not in the convex hull of their common vertices,
//! then each of them, with all sites on its own sphere, is an affinely dependent set of points.
//!
//! *Proof.* Let c and r be center and radius of the ball of S, f(x) = |x − c|² − r², and g the same for T. Then f ≥ 0 at all sites,
//! f = 0 at the vertices of S, and likewise for g and T. The difference h = f − g is affine, as the squares cancel. At the vertices of
//! S it is −g ≤ 0, at those of T it is f ≥ 0; so h ≤ 0 on S and h ≥ 0 on T, and what they share is where h = 0 on both. An affine
//! function that is nowhere positive on a triangle is 0 on the hull of those vertices where it is 0: let F be the vertices of S with
//! g = 0, which lie on the sphere of T, and G those of T with f = 0, on the sphere of S. Then S ∩ T = conv F ∩ conv G.
//! Now F and G are both among the sites on the sphere of S, the vertices of S included. If these are affinely independent, they are the
//! vertices of a simplex, of which conv F and conv G are faces, and two faces of a simplex share the face of their common
//! vertices: S ∩ T = conv(F ∩ G), a part of the hull of the common vertices of S and T. The same holds with T in place of S. ∎
//!
//! *Facets of the hull.* Let no site be beyond the plane of S, and none in the plane inside its circle. Of the balls with the vertices of S
//! on their spheres take one whose center is far enough beyond the plane: each site below the plane is outside, and one in the
//! plane is inside, on the sphere or outside as it is of the circle. That is an empty ball whose sphere has the sites of the circle and
//! no others.
//! *Use.* A pair has to be looked at only if both triangles are dependent in this sense. [`balls`](super::balls), which proves the balls to
//! be empty, meets every site on a sphere on its way and tells which triangles these are: none of points in general position, however
//! many of them lie in one plane, and all of those on a grid. Where no balls are claimed, all pairs are looked at.
//! *Profile.* Looking at all pairs took 0.26 s of processor time on the 49 200 vertices of a machined part and 0.16 s on 2·10⁴ random
//! points of a solid whose faces are exact planes level with no axis: more than all the rest of the check takes. Neighbors in one plane
//! leave the sign of a determinant in space to whole numbers.

use std::cell::OnceCell;

use taut_points::{Monitor, ReadError};

use super::super::SurfaceDoubt;
use super::meet::{Face, meet};
use super::places::{Places, axes};
use super::tree::{Area, Tree};

/// The triangles in their places.
pub(super) struct Faces<'a> {
    pub(super) triangles: &'a [[u32; 3]],
    pub(super) places: &'a Places,
    tree: OnceCell<Tree>,
}

impl<'a> Faces<'a> {
    pub(super) fn of(triangles: &'a [[u32; 3]], places: &'a Places) -> Self {
        Faces { triangles, places, tree: OnceCell::new() }
    }

    pub(super) fn face(&self, triangle: u32) -> Face {
        let rows = self.triangles[triangle as usize];
        Face { rows, corners: self.places.corners(rows) }
    }

    /// A tree over all of them, built when it is first asked for.
    pub(super) fn tree(&self) -> &Tree {
        self.tree.get_or_init(|| self.tree_of(0..self.triangles.len() as u32))
    }

    fn tree_of(&self, triangles: impl Iterator<Item = u32>) -> Tree {
        let areas: Vec<Area> = triangles.map(|t| Area::of(&self.face(t).corners)).collect();
        Tree::of(&areas)
    }

    /// Some two triangles that share more than their common vertices and edges, or the first flat one. `independent` is what is known
    /// of the triangles by their balls, or empty.
    pub(super) fn crossing(
        &self,
        independent: &[bool],
        monitor: &Monitor<'_>,
    ) -> Result<Option<SurfaceDoubt>, ReadError> {
        let signs = &self.places.signs;
        let numbers = 0..self.triangles.len() as u32;
        // A flat triangle has no ball.
        let is_flat = |&t: &u32| axes(signs, &self.face(t).corners).is_none();
        if independent.is_empty()
            && let Some(triangle) = numbers.clone().find(is_flat)
        {
            return Ok(Some(SurfaceDoubt::Flat { triangle }));
        }
        let is_open = |&t: &u32| !independent.get(t as usize).copied().unwrap_or(false);
        let open: Vec<u32> = numbers.filter(is_open).collect();
        let pair = |one: u32, other: u32| [one, other].map(|item| open[item as usize]);
        let wanted = |one: u32, other: u32| {
            let [one, other] = pair(one, other).map(|t| self.face(t));
            meet(signs, &one, &other)
        };
        let found = self.tree_of(open.iter().copied()).find_pair(|| monitor.check(), wanted)?;
        Ok(found.map(|[one, other]| SurfaceDoubt::Crossing { triangles: pair(one, other) }))
    }
}
