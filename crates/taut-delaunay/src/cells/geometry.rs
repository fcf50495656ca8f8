//! The operations on simplices that the cells need, in the plane and in space.

use std::ops::Index;

use taut_predicates::{Sign, plane, space};

use super::reach::Reach;
use crate::kernel::Kernel;
use crate::simplex::{GHOST, Simplex, decode};

/// The plane or space, for code that serves both.
pub(crate) trait Geometry<const D: usize, const V: usize>: Sized {
    type Mesh: Kernel<D, V> + Send + Sync;

    /// Where a positive simplex conflicts.
    fn reach(corners: [[f64; D]; V]) -> Reach<D>;

    /// Where the ghost beyond a facet conflicts; `corners[apex]` is ignored and stands for infinity.
    fn reach_beyond(corners: [[f64; D]; V], apex: usize) -> Reach<D>;

    /// Tests whether `q` conflicts with a positive simplex, ties decided by the perturbation.
    fn conflict(corners: [[f64; D]; V], q: [f64; D]) -> bool;

    fn orientation(corners: [[f64; D]; V]) -> Sign;
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
    simplices: &(impl Index<usize, Output = Simplex<V>> + ?Sized),
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
