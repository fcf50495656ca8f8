//! Exact signs for geometry in the plane and in space, and the one symbolic perturbation that leaves no ties.
//!
//! | you ask | call | answer |
//! |---|---|---|
//! | on which side | [`plane::orient`], [`space::orient`] | [`Sign`] |
//! | inside the circle, the sphere | [`plane::in_circle`], [`space::in_sphere`] | [`Sign`] |
//! | the same, never undecided | [`plane::conflict`], [`space::conflict`] | `bool` |
//! | inside the smallest ball of an edge, a facet | [`plane::in_diametral_circle`], [`space::in_equatorial_sphere`] | [`Sign`] |
//! | where a circumcentre lies | [`plane::circumcenter_side`], [`plane::circumcenter_nearer`] | [`Sign`] |
//!
//! ```
//! use taut_predicates::{Sign, plane};
//!
//! let (a, b, c) = ([0.0, 0.0], [1.0, 0.0], [0.0, 1.0]);
//! assert_eq!(plane::orient(a, b, c), Sign::Positive);                 // counter-clockwise
//! assert_eq!(plane::in_circle(a, b, c, [1.0, 1.0]), Sign::Zero);      // on the circle, exactly
//! assert_eq!(plane::in_circle(a, b, c, [1.0, 1.0 - 1e-16]), Sign::Positive);
//! assert!(!plane::conflict(a, b, c, [1.0, 1.0]));                     // the perturbation: outside
//! assert_eq!(plane::orient([1e-300, 0.0], [0.0, 5e-324], [1e300, 1e300]), Sign::Negative);
//! ```
//!
//! Every sign is that of the exact real number: the coordinates are taken as the fractions they are. Finite
//! coordinates of any magnitude will do; those of infinities and NaN mean nothing (but end, without a panic).

#![forbid(unsafe_code)]

mod cascade;
mod double_double;
mod mul_add;
mod number;
mod perturbation;
pub mod plane;
mod sign;
pub mod space;
mod stages;
mod unbounded;
mod wide;

pub use mul_add::{Fused, MulAdd, Separate};
pub use sign::Sign;
pub use stages::{Exact, Stages};
