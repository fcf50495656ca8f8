//! Predicates of the plane.

mod circumcenter;
pub(crate) mod exact;
mod filter;
mod polynomials;

use std::cmp::Ordering;

use crate::mul_add::Separate;
use crate::sign::Sign;
use crate::stages::Exact;

pub use circumcenter::{circumcenter_nearer, circumcenter_side, in_diametral_circle};
pub use exact::{conflict_exact, in_circle_exact, orient_exact};
pub use filter::{IN_CIRCLE_ERROR, ORIENT_ERROR, UNDERFLOW_ERROR, in_circle_filter, orient_filter};

/// A point of the plane.
pub type Point = [f64; 2];

/// Greatest magnitude for which the filters are proved.
const FILTER_MAX: f64 = (1u64 << 40) as f64;

fn within_filter(points: &[Point]) -> bool {
    points.as_flattened().iter().all(|x| x.abs() <= FILTER_MAX)
}

/// The side of c as seen along the line from a to b: positive if a, b, c turn counter-clockwise.
#[must_use]
pub fn orient(a: Point, b: Point, c: Point) -> Sign {
    if within_filter(&[a, b, c]) {
        let det = orient_filter::<Separate>(a, b, c);
        if det != 0.0 {
            return Sign::from(det);
        }
    }
    orient_exact(a, b, c, &mut Exact::default())
}

/// Tests whether q lies inside (positive), on (zero) or outside the circle through a, b and c, which turn
/// counter-clockwise; if they turn clockwise the sign is the opposite one.
#[must_use]
pub fn in_circle(a: Point, b: Point, c: Point, q: Point) -> Sign {
    if within_filter(&[a, b, c, q]) {
        let det = in_circle_filter::<Separate>(a, b, c, q);
        if det != 0.0 {
            return Sign::from(det);
        }
    }
    in_circle_exact(a, b, c, q, &mut Exact::default())
}

/// Returns true if q lies inside the circle through a, b and c, which turn counter-clockwise, after the perturbation that
/// leaves no ties. The four points must be distinct.
#[must_use]
pub fn conflict(a: Point, b: Point, c: Point, q: Point) -> bool {
    if within_filter(&[a, b, c, q]) {
        let det = in_circle_filter::<Separate>(a, b, c, q);
        if det != 0.0 {
            return det > 0.0;
        }
    }
    conflict_exact(a, b, c, q, &mut Exact::default())
}

/// The order of the perturbation: by the first coordinate, then by the second. 0 and −0 are one number.
#[inline]
#[must_use]
pub fn lexicographic(a: Point, b: Point) -> Ordering {
    crate::perturbation::lexicographic(&a, &b)
}
