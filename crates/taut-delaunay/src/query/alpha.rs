//! Alpha shapes.
//!
//! Idea: eat away all that an empty ball of radius α can reach. What stays of the triangulation are the simplices whose
//! circumsphere is no larger than that, and those facets that a ball of at most that radius touches from both sides.
//! Guarantee: emptiness of the smallest sphere of a facet is decided exactly; radii are compared in `f64`.
//! Reference: Edelsbrunner and Mücke, *Three-dimensional alpha shapes*, ACM Trans. Graphics 13, 1994.

use taut_points::OrderBy;
use taut_points::parallel::IntoParallel;
use taut_predicates::{Sign, plane, space};

use crate::simplex::{GHOST, decode};
use crate::triangulation::hull_facet;
use crate::vector::{cross, difference, dot, largest, square};
use crate::{Plane, Space, Triangulation};

/// Simplices one task looks at.
const TASK: usize = 1 << 13;

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

/// The radii that the simplices of the plane and of space give.
///
/// Radii are taken of the simplex blown up to size 1: products of eight coordinates leave the range of `f64` early.
pub(crate) trait Radii<const D: usize, const V: usize> {
    fn circumradius(corners: [[f64; D]; V]) -> f64;
    /// The radius of the smallest sphere through a facet.
    fn facet_radius(corners: [[f64; D]; D]) -> f64;
    /// Tests whether `q` lies strictly inside the smallest sphere through a facet.
    fn in_facet_sphere(corners: [[f64; D]; D], q: [f64; D]) -> bool;
}

/// The circumradius of the triangle 0, u, v in any dimension; infinite for the flattest.
fn triangle_radius<const D: usize>(u: [f64; D], v: [f64; D]) -> f64 {
    let size = largest(&[u, v]);
    let (u, v) = (u.map(|x| x / size), v.map(|x| x / size));
    let (u2, v2, w2, uv) = (square(u), square(v), square(difference(u, v)), dot(u, v));
    finite_or_flat(size * (u2 * v2 * w2 / (4.0 * (u2 * v2 - uv * uv))).sqrt())
}

/// Rounding may take the square of a vanishing area below 0.
fn finite_or_flat(radius: f64) -> f64 {
    if radius.is_nan() { f64::INFINITY } else { radius }
}

impl Radii<2, 3> for Plane {
    fn circumradius([a, b, c]: [[f64; 2]; 3]) -> f64 {
        let (u, v) = (difference(b, a), difference(c, a));
        let size = largest(&[u, v]);
        let (u, v) = (u.map(|x| x / size), v.map(|x| x / size));
        let twice_area = (u[0] * v[1] - u[1] * v[0]).abs();
        finite_or_flat(
            size * (square(u) * square(v) * square(difference(u, v))).sqrt() / (2.0 * twice_area),
        )
    }

    fn facet_radius([a, b]: [[f64; 2]; 2]) -> f64 {
        let [x, y] = difference(a, b);
        0.5 * x.hypot(y)
    }

    fn in_facet_sphere([a, b]: [[f64; 2]; 2], q: [f64; 2]) -> bool {
        plane::in_diametral_circle(a, b, q) == Sign::Positive
    }
}

impl Radii<3, 4> for Space {
    fn circumradius([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
        let corners = [difference(b, a), difference(c, a), difference(d, a)];
        let size = largest(&corners);
        let [u, v, w] = corners.map(|p| p.map(|x| x / size));
        let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
        let (u2, v2, w2) = (square(u), square(v), square(w));
        let scaled_center: [f64; 3] = std::array::from_fn(|i| u2 * vw[i] + v2 * wu[i] + w2 * uv[i]);
        finite_or_flat(size * square(scaled_center).sqrt() / (2.0 * dot(u, vw).abs()))
    }

    fn facet_radius([a, b, c]: [[f64; 3]; 3]) -> f64 {
        triangle_radius(difference(b, a), difference(c, a))
    }

    fn in_facet_sphere([a, b, c]: [[f64; 3]; 3], q: [f64; 3]) -> bool {
        space::in_equatorial_sphere(a, b, c, q) == Sign::Positive
    }
}

/// Points in the order of their coordinates: radii are rounded, and each must have one value.
pub(crate) fn ascending<const D: usize, const N: usize>(
    mut corners: [[f64; D]; N],
) -> [[f64; D]; N] {
    corners.order_by(&|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    corners
}

/// The circumradius of a finite simplex in the scale of the sites.
fn radius<R: Radii<D, V>, const D: usize, const V: usize>(
    of: &Triangulation<D, V>,
    simplex: u32,
) -> f64 {
    R::circumradius(ascending(of.vertices(simplex).map(|v| of.sites.coordinates[v as usize])))
}

fn alpha_complex<R: Radii<D, V>, const D: usize, const V: usize>(
    of: &Triangulation<D, V>,
    alpha: f64,
) -> AlphaComplex<D> {
    let limit = of.scale().apply(alpha);
    let slots = of.slots();
    let count = slots.len() as u32;
    let is_finite = |&t: &u32| {
        let slot = &slots[t as usize];
        slot.is_live() && !slot.is_ghost()
    };
    let is_inside = |t: u32| is_finite(&t) && radius::<R, D, V>(of, t) <= limit;
    let inside: Vec<bool> = (0..count).into_par_iter().with_min_len(TASK).map(is_inside).collect();
    let simplices = (0..count).filter(|&t| inside[t as usize]).collect();
    let facets = |begin: u32| {
        let mut found = Facets::default();
        for t in (begin..count.min(begin + TASK as u32)).filter(is_finite) {
            found.add_those_of::<R, V>(of, &inside, limit, t);
        }
        found
    };
    let begins: Vec<u32> = (0..count).step_by(TASK).collect();
    let parts: Vec<Facets<D>> = begins.into_par_iter().map(facets).collect();
    let mut all = Facets::default();
    for part in parts {
        all.boundary.extend(part.boundary);
        all.singular.extend(part.singular);
    }
    AlphaComplex { simplices, boundary: all.boundary, singular: all.singular }
}

/// Facets of an alpha complex that are no facets between two of its simplices.
#[derive(Default)]
struct Facets<const D: usize> {
    boundary: Vec<[u32; D]>,
    singular: Vec<[u32; D]>,
}

impl<const D: usize> Facets<D> {
    /// Adds those between the simplex `t` and others that it comes before.
    fn add_those_of<R: Radii<D, V>, const V: usize>(
        &mut self,
        of: &Triangulation<D, V>,
        inside: &[bool],
        limit: f64,
        t: u32,
    ) {
        let slots = of.slots();
        let vertices = of.vertices(t);
        for i in 0..V {
            let (other, facet) = decode(slots[t as usize].neighbors[i]);
            let mut with_ghost = vertices;
            with_ghost[i] = GHOST;
            match (inside[t as usize], inside[other as usize]) {
                // Seen from the simplex that stays, the ghost in place of vertex i lies within: turn it out.
                (true, false) => self.boundary.push(turned(hull_facet(with_ghost))),
                (false, false) if t < other || slots[other as usize].is_ghost() => {
                    let sites = turned(hull_facet::<D, V>(with_ghost));
                    let at = |v: u32| of.sites.coordinates[v as usize];
                    let opposite = [vertices[i], slots[other as usize].vertices[facet]];
                    let opposite = opposite.into_iter().filter(|&v| v != GHOST).map(at);
                    if is_singular::<R, D, V>(sites.map(at), opposite, limit) {
                        self.singular.push(sites);
                    }
                }
                _ => {}
            }
        }
    }
}

/// Tests whether a facet of no simplex of the complex belongs to it by itself: whether its smallest sphere has at most the
/// radius `limit`, and none of the vertices opposite inside.
pub(crate) fn is_singular<R: Radii<D, V>, const D: usize, const V: usize>(
    facet: [[f64; D]; D],
    opposite: impl IntoIterator<Item = [f64; D]>,
    limit: f64,
) -> bool {
    let is_hit = opposite.into_iter().any(|q| R::in_facet_sphere(facet, q));
    !is_hit && R::facet_radius(ascending(facet)) <= limit
}

/// A facet seen from the other side.
pub(crate) fn turned<const D: usize>(mut facet: [u32; D]) -> [u32; D] {
    facet.swap(0, 1);
    facet
}

impl Plane {
    /// The alpha complex: what an eraser of radius `alpha` that spares the sites leaves of the plane, as triangles and
    /// edges. Empty if the sites do not span the plane. O(simplices).
    pub fn alpha_complex(&self, alpha: f64) -> AlphaComplex<2> {
        alpha_complex::<Self, _, _>(self, alpha)
    }

    /// The circumradius of a triangle.
    ///
    /// # Panics
    /// If there is no such triangle, or it is a ghost.
    pub fn circumradius(&self, triangle: u32) -> f64 {
        self.scale().inverse().apply(radius::<Self, _, _>(self, triangle))
    }
}

impl Space {
    /// The alpha complex: what an eraser of radius `alpha` that spares the sites leaves of space, as tetrahedra and
    /// triangles. Empty if the sites do not span space. O(simplices).
    pub fn alpha_complex(&self, alpha: f64) -> AlphaComplex<3> {
        alpha_complex::<Self, _, _>(self, alpha)
    }

    /// The circumradius of a tetrahedron.
    ///
    /// # Panics
    /// If there is no such tetrahedron, or it is a ghost.
    pub fn circumradius(&self, tetrahedron: u32) -> f64 {
        self.scale().inverse().apply(radius::<Self, _, _>(self, tetrahedron))
    }
}
