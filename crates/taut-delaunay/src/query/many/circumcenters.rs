//! Circumcenters, and which simplices have one sphere.
//!
//! Guarantee: that two simplices share a sphere is decided exactly; the coordinates of centers are rounded.

use rayon::prelude::*;
use taut_predicates::Sign;

use super::TriangulationIndex;
use crate::geometry::{Geometry, InPlane, InSpace};
use crate::groups::join;
use crate::simplex::decode;
use crate::vector::{cross, difference, dot, largest, mapped, square};

/// Simplices of one task.
const TASK: usize = 1 << 12;

/// The center of the sphere through the corners, relative to the first, and the volume of the simplex blown up to size 1:
/// the smaller, the fewer digits of the center are right.
pub(super) trait Center<const D: usize, const V: usize> {
    fn center(corners: [[f64; D]; V]) -> ([f64; D], f64);
}

impl Center<2, 3> for InPlane {
    fn center([a, b, c]: [[f64; 2]; 3]) -> ([f64; 2], f64) {
        let edges = [difference(b, a), difference(c, a)];
        let size = largest(&edges);
        let [u, v] = mapped(edges, |p| mapped(p, |x| x / size));
        let area = u[0] * v[1] - u[1] * v[0];
        let (u2, v2) = (square(u), square(v));
        let center = [v[1] * u2 - u[1] * v2, u[0] * v2 - v[0] * u2];
        (mapped(center, |x| size * x / (2.0 * area)), area.abs())
    }
}

impl Center<3, 4> for InSpace {
    fn center([a, b, c, d]: [[f64; 3]; 4]) -> ([f64; 3], f64) {
        let edges = [difference(b, a), difference(c, a), difference(d, a)];
        let size = largest(&edges);
        let [u, v, w] = mapped(edges, |p| mapped(p, |x| x / size));
        let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
        let (u2, v2, w2) = (square(u), square(v), square(w));
        let volume = dot(u, vw);
        let center =
            std::array::from_fn(|i| size * (u2 * vw[i] + v2 * wu[i] + w2 * uv[i]) / (2.0 * volume));
        (center, volume.abs())
    }
}

impl<const D: usize, const V: usize> TriangulationIndex<D, V> {
    fn scaled_corners(&self, number: u32) -> [[f64; D]; V] {
        let coordinates = &self.triangulation.sites.coordinates;
        mapped(self.triangulation.vertices(number), |v| coordinates[v as usize])
    }

    /// The center of each simplex, and how well it is determined.
    pub(super) fn centers_by<G: Center<D, V>>(&self) -> Vec<([f64; D], f64)> {
        let back = self.triangulation.scale().inverse();
        self.slots()
            .into_par_iter()
            .with_min_len(TASK)
            .map(|number| {
                let corners = self.scaled_corners(number);
                let (center, volume) = G::center(corners);
                (std::array::from_fn(|i| back.apply(corners[0][i] + center[i])), volume)
            })
            .collect()
    }

    pub(super) fn groups_by<G: Geometry<D, V>>(&self) -> Vec<u32> {
        let slots = self.triangulation.slots();
        let coordinates = &self.triangulation.sites.coordinates;
        // The neighbors of higher number that have the sphere of a simplex; ghosts, which have none, have still higher numbers.
        let alike: Vec<(u32, u32)> = self
            .slots()
            .into_par_iter()
            .with_min_len(TASK)
            .flat_map_iter(|number| {
                let simplex = &slots[number as usize];
                let corners = mapped(simplex.vertices, |v| coordinates[v as usize]);
                (0..V).filter_map(move |i| {
                    let (other, facet) = decode(simplex.neighbors[i]);
                    let is_next = number < other && other < self.count;
                    let opposite = slots[other as usize].vertices[facet];
                    let is_alike = is_next
                        && G::in_sphere(corners, coordinates[opposite as usize]) == Sign::Zero;
                    is_alike.then_some((number, other))
                })
            })
            .collect();
        let mut groups: Vec<u32> = self.slots().collect();
        for (a, b) in alike {
            join(&mut groups, a, b);
        }
        for number in 0..groups.len() {
            groups[number] = groups[groups[number] as usize];
        }
        groups
    }
}

/// The same in the plane and in space.
macro_rules! circumcenters {
    ($d:literal, $v:literal, $geometry:ty) => {
        impl TriangulationIndex<$d, $v> {
            /// The center of the sphere through the vertices of each simplex; not finite for the flattest.
            pub fn circumcenters(&self) -> Vec<[f64; $d]> {
                self.centers_by::<$geometry>().into_iter().map(|(center, _)| center).collect()
            }

            /// For each simplex the lowest number of those that have its sphere, exactly: simplices of one number fill one
            /// polytope with all its vertices on a sphere, and the perturbation decided how.
            pub fn cospherical_groups(&self) -> Vec<u32> {
                self.groups_by::<$geometry>()
            }
        }
    };
}
circumcenters!(2, 3, InPlane);
circumcenters!(3, 4, InSpace);
