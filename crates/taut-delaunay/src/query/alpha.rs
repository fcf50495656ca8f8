//! Alpha shapes.
//!
//! Idea: eat away all that an empty ball of radius α can reach. What stays of the triangulation are the simplices whose
//! circumsphere is no larger than that, and those facets that a ball of at most that radius touches from both sides.
//! Guarantee: emptiness of the smallest sphere of a facet is decided exactly; radii are compared in `f64`.
//! Reference: Edelsbrunner and Mücke, *Three-dimensional alpha shapes*, ACM Trans. Graphics 13, 1994.

use taut_predicates::{Sign, plane, space};

use crate::simplex::{GHOST, decode};
use crate::triangulation::hull_facet;
use crate::{Plane, Space, Triangulation};

/// The alpha complex of a triangulation, down to facets.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AlphaComplex<const D: usize> {
    /// The simplices with circumradius ≤ α.
    pub simplices: Vec<u32>,
    /// The facets that have such a simplex on one side only, as sites turned outward like those of
    /// [`Triangulation::hull`].
    pub boundary: Vec<[u32; D]>,
    /// The facets that have none on either side, though an empty ball of radius ≤ α has them on its boundary.
    pub singular: Vec<[u32; D]>,
}

/// Squared lengths and determinants that radii come from.
trait Radii<const D: usize, const V: usize> {
    /// The squared circumradius of a simplex.
    fn circumradius_squared(corners: [[f64; D]; V]) -> f64;
    /// The squared radius of the smallest sphere through a facet.
    fn facet_radius_squared(corners: [[f64; D]; D]) -> f64;
    /// Whether `q` lies strictly inside the smallest sphere through a facet.
    fn in_facet_sphere(corners: [[f64; D]; D], q: [f64; D]) -> bool;
}

fn minus<const D: usize>(p: [f64; D], q: [f64; D]) -> [f64; D] {
    std::array::from_fn(|i| p[i] - q[i])
}

fn square<const D: usize>(p: [f64; D]) -> f64 {
    p.iter().map(|x| x * x).sum()
}

/// The squared circumradius of the triangle with these sides, in any dimension.
fn triangle_radius_squared<const D: usize>(u: [f64; D], v: [f64; D]) -> f64 {
    let (u2, v2, w2) = (square(u), square(v), square(minus(u, v)));
    let uv: f64 = (0..D).map(|i| u[i] * v[i]).sum();
    u2 * v2 * w2 / (4.0 * (u2 * v2 - uv * uv))
}

impl Radii<2, 3> for Plane {
    fn circumradius_squared([a, b, c]: [[f64; 2]; 3]) -> f64 {
        let (u, v) = (minus(b, a), minus(c, a));
        let twice_area = u[0] * v[1] - u[1] * v[0];
        square(u) * square(v) * square(minus(u, v)) / (4.0 * twice_area * twice_area)
    }

    fn facet_radius_squared([a, b]: [[f64; 2]; 2]) -> f64 {
        0.25 * square(minus(a, b))
    }

    fn in_facet_sphere([a, b]: [[f64; 2]; 2], q: [f64; 2]) -> bool {
        plane::in_diametral_circle(a, b, q) == Sign::Positive
    }
}

impl Radii<3, 4> for Space {
    fn circumradius_squared([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
        let (u, v, w) = (minus(b, a), minus(c, a), minus(d, a));
        let cross = |p: [f64; 3], q: [f64; 3]| {
            [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
        };
        let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
        let six_fold: f64 = (0..3).map(|i| u[i] * vw[i]).sum();
        let (u2, v2, w2) = (square(u), square(v), square(w));
        let scaled_center: [f64; 3] = std::array::from_fn(|i| u2 * vw[i] + v2 * wu[i] + w2 * uv[i]);
        square(scaled_center) / (4.0 * six_fold * six_fold)
    }

    fn facet_radius_squared([a, b, c]: [[f64; 3]; 3]) -> f64 {
        triangle_radius_squared(minus(b, a), minus(c, a))
    }

    fn in_facet_sphere([a, b, c]: [[f64; 3]; 3], q: [f64; 3]) -> bool {
        space::in_equatorial_sphere(a, b, c, q) == Sign::Positive
    }
}

/// The squared circumradius of a finite simplex, in units of the input squared; infinite for the flattest.
fn radius_squared<R: Radii<D, V>, const D: usize, const V: usize>(
    of: &Triangulation<D, V>,
    simplex: u32,
) -> f64 {
    let squared = R::circumradius_squared(of.vertices(simplex).map(|v| of.site(v)));
    if squared.is_nan() { f64::INFINITY } else { squared }
}

fn alpha_complex<R: Radii<D, V>, const D: usize, const V: usize>(
    of: &Triangulation<D, V>,
    alpha: f64,
) -> AlphaComplex<D> {
    let limit = alpha * alpha;
    let mut complex = AlphaComplex { simplices: vec![], boundary: vec![], singular: vec![] };
    let slots = of.slots();
    let mut inside = vec![false; slots.len()];
    for t in of.simplices() {
        if radius_squared::<R, D, V>(of, t) <= limit {
            inside[t as usize] = true;
            complex.simplices.push(t);
        }
    }
    for t in of.simplices() {
        let vertices = of.vertices(t);
        for i in 0..V {
            let (other, facet) = decode(slots[t as usize].neighbors[i]);
            let mut with_ghost = vertices;
            with_ghost[i] = GHOST;
            match (inside[t as usize], inside[other as usize]) {
                // Seen from the simplex that stays, the ghost in place of vertex i lies within: turn it out.
                (true, false) => complex.boundary.push(turned(hull_facet(with_ghost))),
                (false, false) if t < other || slots[other as usize].is_ghost() => {
                    let corners =
                        hull_facet::<D, V>(with_ghost).map(|v| of.sites.coordinates[v as usize]);
                    let opposite = [vertices[i], slots[other as usize].vertices[facet]];
                    let hit = opposite
                        .iter()
                        .filter(|&&v| v != GHOST)
                        .any(|&v| R::in_facet_sphere(corners, of.sites.coordinates[v as usize]));
                    let sites = hull_facet::<D, V>(with_ghost);
                    if !hit && R::facet_radius_squared(sites.map(|v| of.site(v))) <= limit {
                        complex.singular.push(turned(sites));
                    }
                }
                _ => {}
            }
        }
    }
    complex
}

/// A facet seen from the other side.
fn turned<const D: usize>(mut facet: [u32; D]) -> [u32; D] {
    facet.swap(0, 1);
    facet
}

impl Plane {
    /// The alpha complex: what an eraser of radius `alpha` that spares the sites leaves of the plane, as triangles and
    /// edges. Empty if the sites do not span the plane. O(n).
    pub fn alpha_complex(&self, alpha: f64) -> AlphaComplex<2> {
        alpha_complex::<Self, _, _>(self, alpha)
    }

    /// The circumradius of a triangle.
    ///
    /// # Panics
    /// If there is no such triangle, or it is a ghost.
    pub fn circumradius(&self, triangle: u32) -> f64 {
        radius_squared::<Self, _, _>(self, triangle).sqrt()
    }
}

impl Space {
    /// The alpha complex: what an eraser of radius `alpha` that spares the sites leaves of space, as tetrahedra and
    /// triangles. Empty if the sites do not span space. O(n).
    pub fn alpha_complex(&self, alpha: f64) -> AlphaComplex<3> {
        alpha_complex::<Self, _, _>(self, alpha)
    }

    /// The circumradius of a tetrahedron.
    ///
    /// # Panics
    /// If there is no such tetrahedron, or it is a ghost.
    pub fn circumradius(&self, tetrahedron: u32) -> f64 {
        radius_squared::<Self, _, _>(self, tetrahedron).sqrt()
    }
}
