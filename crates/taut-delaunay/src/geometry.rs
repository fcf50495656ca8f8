//! Where simplices conflict, in the plane and in space: with a point exactly, and with a box on the safe side. For what asks
//! a finished mesh: the tree merge of `outofcore`, and locators.

mod index;
mod reach;

use std::ops::Index as At;

use taut_predicates::{Sign, plane, space};

pub(crate) use index::{Bounds, Index};
use reach::Reach;

use crate::affine::{Span, span_of_plane, span_of_space};
use crate::simplex::{GHOST, Simplex, decode};
use crate::threads::SharedMesh;

/// The plane or space, for code that serves both.
pub(crate) trait Geometry<const D: usize, const V: usize>: Sized {
    type Mesh: SharedMesh<D, V> + Send + Sync;

    /// Where a positive simplex conflicts.
    fn reach(corners: [[f64; D]; V]) -> Reach<D>;

    /// Where the ghost beyond a facet conflicts; `corners[apex]` is ignored and stands for infinity.
    fn reach_beyond(corners: [[f64; D]; V], apex: usize) -> Reach<D>;

    /// Tests whether `q` conflicts with a positive simplex, ties decided by the perturbation.
    fn conflict(corners: [[f64; D]; V], q: [f64; D]) -> bool;

    fn orientation(corners: [[f64; D]; V]) -> Sign;

    /// Tests whether `q` lies inside (positive), on (zero) or outside the sphere of a positive simplex.
    fn in_sphere(corners: [[f64; D]; V], q: [f64; D]) -> Sign;

    /// The affine hull of distinct sites.
    fn span(sites: &[[f64; D]]) -> Span<V>;
}

pub(crate) struct InPlane;

impl Geometry<2, 3> for InPlane {
    type Mesh = crate::plane::Mesh;

    #[inline(always)]
    fn reach(corners: [[f64; 2]; 3]) -> Reach<2> {
        Reach::of_triangle(corners)
    }

    fn reach_beyond(corners: [[f64; 2]; 3], apex: usize) -> Reach<2> {
        Reach::of_edge([corners[(apex + 1) % 3], corners[(apex + 2) % 3]])
    }

    fn conflict([a, b, c]: [[f64; 2]; 3], q: [f64; 2]) -> bool {
        plane::conflict(a, b, c, q)
    }

    fn orientation([a, b, c]: [[f64; 2]; 3]) -> Sign {
        plane::orient(a, b, c)
    }

    fn in_sphere([a, b, c]: [[f64; 2]; 3], q: [f64; 2]) -> Sign {
        plane::in_circle(a, b, c, q)
    }

    fn span(sites: &[[f64; 2]]) -> Span<3> {
        span_of_plane(sites)
    }
}

pub(crate) struct InSpace;

impl Geometry<3, 4> for InSpace {
    type Mesh = crate::space::Mesh;

    #[inline(always)]
    fn reach(corners: [[f64; 3]; 4]) -> Reach<3> {
        Reach::of_tetrahedron(corners)
    }

    fn reach_beyond(corners: [[f64; 3]; 4], apex: usize) -> Reach<3> {
        // The other three, in the order that sees the apex on their positive side.
        let [a, b, c] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]][apex];
        Reach::of_facet([corners[a], corners[b], corners[c]])
    }

    fn conflict([a, b, c, d]: [[f64; 3]; 4], q: [f64; 3]) -> bool {
        space::conflict(a, b, c, d, q)
    }

    fn orientation([a, b, c, d]: [[f64; 3]; 4]) -> Sign {
        space::orient(a, b, c, d)
    }

    fn in_sphere([a, b, c, d]: [[f64; 3]; 4], q: [f64; 3]) -> Sign {
        space::in_sphere(a, b, c, d, q)
    }

    fn span(sites: &[[f64; 3]]) -> Span<4> {
        span_of_space(sites)
    }
}

/// The corners of a simplex; those of a ghost have `fill` at infinity's place.
pub(crate) fn corners<const D: usize, const V: usize>(
    vertices: [u32; V],
    site: impl Fn(u32) -> [f64; D],
    fill: [f64; D],
) -> [[f64; D]; V] {
    vertices.map(|v| if v == GHOST { fill } else { site(v) })
}

/// Tests whether `q` conflicts with simplex `t` of a mesh, ghosts included: beyond the hull, or on a hull facet's plane and in
/// conflict with the finite simplex behind it.
pub(crate) fn conflicts<const D: usize, const V: usize, G: Geometry<D, V>>(
    simplices: &(impl At<usize, Output = Simplex<V>> + ?Sized),
    t: u32,
    site: impl Fn(u32) -> [f64; D] + Copy,
    q: [f64; D],
) -> bool {
    let simplex = simplices[t as usize];
    let with_q = corners(simplex.vertices, site, q);
    let Some(apex) = simplex.vertices.iter().position(|&v| v == GHOST) else {
        return G::conflict(with_q, q);
    };
    match G::orientation(with_q) {
        Sign::Positive => true,
        Sign::Negative => false,
        Sign::Zero => {
            let (behind, _) = decode(simplex.neighbors[apex]);
            G::conflict(corners(simplices[behind as usize].vertices, site, q), q)
        }
    }
}

/// Where a simplex of a mesh conflicts, ghosts included, as boxes are judged by it.
pub(crate) struct ConflictZone<const D: usize, const V: usize> {
    pub(crate) reach: Reach<D>,
    corners: [[f64; D]; V],
    /// Of a ghost, the place of infinity and where the finite simplex behind conflicts. What lies on the plane of a hull
    /// facet is up to that simplex. Without it, each facet of the hull of a grid would conflict with all of its side.
    behind: Option<(usize, Reach<D>)>,
}

impl<const D: usize, const V: usize> ConflictZone<D, V> {
    /// The zone of the simplex with these vertices; `behind` gives the vertices of the simplex across a facet.
    pub(crate) fn of<G: Geometry<D, V>>(
        vertices: [u32; V],
        behind: impl FnOnce(usize) -> [u32; V],
        site: impl Fn(u32) -> [f64; D] + Copy,
    ) -> Self {
        let corners = corners(vertices, site, [0.0; D]);
        match vertices.iter().position(|&v| v == GHOST) {
            None => Self { reach: G::reach(corners), corners, behind: None },
            Some(apex) => {
                let behind = Some((apex, G::reach(behind(apex).map(site))));
                Self { reach: G::reach_beyond(corners, apex), corners, behind }
            }
        }
    }

    /// Returns false if certainly no point of the box conflicts.
    pub(crate) fn may_meet<G: Geometry<D, V>>(&self, bounds: &Bounds<D>) -> bool {
        if self.reach.most(bounds.low, bounds.high) < 0.0 {
            return false;
        }
        let Some((apex, behind)) = &self.behind else { return true };
        let mut with_corner = self.corners;
        let mut on_plane = false;
        for corner in self.reach.foremost(bounds.low, bounds.high) {
            with_corner[*apex] = corner;
            match G::orientation(with_corner) {
                Sign::Positive => return true,
                Sign::Negative => {}
                Sign::Zero => on_plane = true,
            }
        }
        on_plane && behind.most(bounds.low, bounds.high) >= 0.0
    }
}
