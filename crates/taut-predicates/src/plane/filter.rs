//! The filter: `f64` with a bound on its own error, for the inner loop of a kernel.
//!
//! *Idea.* Evaluate the determinant, and beside it the *permanent*: the same polynomial of absolute values. The
//! determinant is off by at most a known multiple of the permanent; beyond that its sign is certain.
//! *Guarantee.* For coordinates up to 2⁴⁰. Let u = 2⁻⁵³, D the exact determinant, det the computed one, P and perm their
//! permanents. A monomial of D passes through k roundings at most (each factor that is a difference brings its own), and
//! the last of them is at most u·|det|; so |det − D| ≤ u·|det| + ((k − 1)u + k²u²)·P, and P ≤ perm·(1 + 2ku). With
//! |det| > k·u·perm the sign of det is that of D, as k(1 − u) > (k − 1 + k²u)(1 + 2ku) for k < 2⁶: the one u to spare
//! pays for everything of higher order. A fused operation only leaves a rounding out.
//! - `orient`: 2 differences, a product, the final sum: k = 4.
//! - `in_circle`: 4 differences, minor 2, lift 2, their product, two sums: k = 11.
//!
//! *Underflow.* A product below 2⁻¹⁰²² is off by 2⁻¹⁰⁷⁵ at most, which the later factors, differences up to 2⁴¹ and
//! sums of a few of them, make at most 2⁻¹⁰⁷⁵·2⁶·(2⁴¹)³ < 2⁻⁹⁴⁰; fewer than 2⁶ such errors, and those of the permanent,
//! stay below [`UNDERFLOW_ERROR`].
//! *Ghosts.* A coordinate that is NaN, or an overflow, makes the comparison false: uncertain.
//! *Reference.* Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric predicates,
//! Discrete & Computational Geometry 18, 1997, stage A; Brönnimann, Burnikel & Pion, Interval arithmetic yields
//! efficient dynamic filters for computational geometry, Discrete Applied Mathematics 109, 2001.

use crate::mul_add::MulAdd;
use crate::plane::Point;

const U: f64 = f64::EPSILON / 2.0;

/// Relative to the permanent, the largest error of the determinant of [`orient_filter`].
pub const ORIENT_ERROR: f64 = 4.0 * U;
/// Relative to the permanent, the largest error of the determinant of [`in_circle_filter`].
pub const IN_CIRCLE_ERROR: f64 = 11.0 * U;
/// The error that is allowed for underflow, 2⁻⁹⁰⁰: more than it can cost for coordinates up to 2⁴⁰.
pub const UNDERFLOW_ERROR: f64 = f64::from_bits((1023 - 900) << 52);

/// A number whose sign is that of `orient(a, b, c)`, or 0 if rounding may hide it. For coordinates up to 2⁴⁰.
#[inline(always)]
#[must_use]
pub fn orient_filter<M: MulAdd>(a: Point, b: Point, c: Point) -> f64 {
    let (ux, uy) = (b[0] - a[0], b[1] - a[1]);
    let (vx, vy) = (c[0] - a[0], c[1] - a[1]);
    let cross = uy * vx;
    let det = M::mul_add(ux, vy, -cross);
    let permanent = M::mul_add(ux.abs(), vy.abs(), cross.abs());
    certain::<M>(det, permanent, ORIENT_ERROR)
}

/// A number whose sign is that of `in_circle(a, b, c, q)`, or 0 if rounding may hide it. For coordinates up to 2⁴⁰.
#[inline(always)]
#[must_use]
pub fn in_circle_filter<M: MulAdd>(a: Point, b: Point, c: Point, q: Point) -> f64 {
    let [(ax, ay), (bx, by), (cx, cy)] = [a, b, c].map(|p| (p[0] - q[0], p[1] - q[1]));
    let (by_cx, cy_ax, ay_bx) = (by * cx, cy * ax, ay * bx);
    let bc = M::mul_add(bx, cy, -by_cx);
    let ca = M::mul_add(cx, ay, -cy_ax);
    let ab = M::mul_add(ax, by, -ay_bx);
    let a2 = M::mul_add(ax, ax, ay * ay);
    let b2 = M::mul_add(bx, bx, by * by);
    let c2 = M::mul_add(cx, cx, cy * cy);
    let det = M::mul_add(a2, bc, M::mul_add(b2, ca, c2 * ab));
    let bc = M::mul_add(bx.abs(), cy.abs(), by_cx.abs());
    let ca = M::mul_add(cx.abs(), ay.abs(), cy_ax.abs());
    let ab = M::mul_add(ax.abs(), by.abs(), ay_bx.abs());
    let permanent = M::mul_add(a2, bc, M::mul_add(b2, ca, c2 * ab));
    certain::<M>(det, permanent, IN_CIRCLE_ERROR)
}

#[inline(always)]
fn certain<M: MulAdd>(det: f64, permanent: f64, error: f64) -> f64 {
    // A comparison with NaN is false, as it must be.
    if det.abs() > M::mul_add(error, permanent, UNDERFLOW_ERROR) { det } else { 0.0 }
}
