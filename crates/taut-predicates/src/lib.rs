//! Exact signs for geometry in the plane and in space, and the one symbolic perturbation that leaves no ties.
//!
//! | you ask | call | answer |
//! |---|---|---|
//! | on which side | [`plane::orient`], [`space::orient`] | [`Sign`] |
//! | inside the circle, the sphere | [`plane::in_circle`], [`space::in_sphere`] | [`Sign`] |
//! | the same, never undecided | [`plane::conflict`], [`space::conflict`] | `bool` |
//! | inside the smallest ball of an edge, a facet | [`plane::in_diametral_circle`], [`space::in_equatorial_sphere`] | [`Sign`] |
//! | how large the smallest sphere of a facet, or that of a simplex, is beside a given one | [`space::equatorial_radius`], [`space::sphere_radius`] | [`Sign`] |
//! | where a circumcenter lies | [`plane::circumcenter_side`], [`plane::circumcenter_nearer`] | [`Sign`] |
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
//! coordinates of any magnitude will do; those of infinities and NaN mean nothing (but end, without a panic). Nothing
//! allocates. The arithmetic is that of IEEE 754 and of integers, in a fixed order, so no compiler, option or processor
//! changes a sign.
//!
//! # Stages
//! A call ends at the first stage that is sure of its answer. Each has its idea, proof and sources at its head.
//!
//! | stage | sure of | in-circle, in-sphere |
//! |---|---|---|
//! | filter, `f64` with an error bound | all but near ties | 13, 20 ns |
//! | whole numbers in `f64` | everything, for small whole numbers | 9, 30 ns |
//! | integers of fixed width | everything, for 62 bits of differences | 35, 80 ns |
//! | double-double | all but ties to 2⁻⁹⁸, for magnitudes up to 2⁶⁰ | 65, 160 ns |
//! | integers of any length | everything | from 1 µs, by length |
//!
//! A kernel calls the filters itself ([`plane::in_circle_filter`], generic over [`MulAdd`]), and where one answers 0 the
//! cold continuation ([`plane::conflict_exact`]) with its [`Exact`], which counts the stages. All others call the plain
//! functions. The figures are of `examples/stages.rs`, on one core of an AMD EPYC of 2024 (family 26) at 2.6 GHz, without
//! fused operations.

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
#[cfg(test)]
mod tests;
mod unbounded;
mod wide;

pub use mul_add::{Fused, MulAdd, Separate};
pub use sign::Sign;
pub use stages::{Exact, Stages};
