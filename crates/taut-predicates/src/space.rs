//! Predicates of space.

mod balls;
mod circumcenter;
pub(crate) mod exact;
mod filter;
mod polynomials;
mod radii;

use std::cmp::Ordering;

use crate::mul_add::Separate;
use crate::sign::Sign;
use crate::stages::Exact;

pub use balls::{EquatorialSphere, in_diametral_sphere, in_equatorial_sphere, shrunk_sphere};
pub use circumcenter::{circumcenter_nearer, circumcenter_side};
pub use exact::{conflict_exact, in_sphere_exact, orient_exact};
pub use filter::{IN_SPHERE_ERROR, ORIENT_ERROR, UNDERFLOW_ERROR, in_sphere_filter, orient_filter};
pub use radii::{equatorial_radius, sphere_radius};

/// A point of space.
pub type Point = [f64; 3];

/// Greatest magnitude for which the filters are proved.
const FILTER_MAX: f64 = (1u64 << 40) as f64;

fn within_filter(points: &[Point]) -> bool {
    points.as_flattened().iter().all(|x| x.abs() <= FILTER_MAX)
}

/// The sign of det(b − a, c − a, d − a): positive if b, c, d turn counter-clockwise as seen from the side of their plane
/// where a is not; so it is for the origin and the three unit vectors in their order.
#[must_use]
pub fn orient(a: Point, b: Point, c: Point, d: Point) -> Sign {
    if within_filter(&[a, b, c, d]) {
        let det = orient_filter::<Separate>(a, b, c, d);
        if det != 0.0 {
            return Sign::from(det);
        }
    }
    orient_exact(a, b, c, d, &mut Exact::default())
}

/// Tests whether q lies inside (positive), on (zero) or outside the sphere through a, b, c and d, whose orientation is
/// positive; if it is negative the sign is the opposite one.
#[must_use]
pub fn in_sphere(a: Point, b: Point, c: Point, d: Point, q: Point) -> Sign {
    if within_filter(&[a, b, c, d, q]) {
        let det = in_sphere_filter::<Separate>(a, b, c, d, q);
        if det != 0.0 {
            return Sign::from(det);
        }
    }
    in_sphere_exact(a, b, c, d, q, &mut Exact::default())
}

/// Returns true if q lies inside the sphere through a, b, c and d, whose orientation is positive, after the perturbation that
/// leaves no ties. The five points must be distinct.
#[must_use]
pub fn conflict(a: Point, b: Point, c: Point, d: Point, q: Point) -> bool {
    if within_filter(&[a, b, c, d, q]) {
        let det = in_sphere_filter::<Separate>(a, b, c, d, q);
        if det != 0.0 {
            return det > 0.0;
        }
    }
    conflict_exact(a, b, c, d, q, &mut Exact::default())
}

/// The order of the perturbation: by the first coordinate, then the second, then the third. 0 and −0 are one number.
#[inline]
#[must_use]
pub fn lexicographic(a: Point, b: Point) -> Ordering {
    crate::perturbation::lexicographic(&a, &b)
}
