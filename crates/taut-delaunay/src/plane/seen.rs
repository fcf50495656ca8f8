//! Sites as seen from the query point, and the signs of the plane in these coordinates.
//!
//! With a, b, d relative to q and [uv] = uₓvᵧ − uᵧvₓ, the orientation of (q, a, b) is [ab], and q lies inside the circle
//! through the counter-clockwise triangle (d, b, a) iff D = |a|²[db] + |b|²[ad] − |d|²[ab] > 0.
//!
//! *Filters.* Instead of the permanents of Shewchuk's stage A their bounds by lifts are used, which are at hand:
//! |uₓvᵧ| + |uᵧvₓ| ≤ |u||v| ≤ (|u|² + |v|²)/2, hence the permanent of D is at most |a|²|b|² + |b|²|d|² + |d|²|a|².
//! *Guarantee.* With ε = 2⁻⁵³ the rounding errors of [ab] and D are below (3 + 16ε)ε and (10 + 96ε)ε of the computed
//! permanents; the constants below are larger by more than the few ε that the bounds lose to rounding themselves. What
//! underflow may add is far below `UNDERFLOW_ERROR` as long as coordinates do not exceed 2⁴⁰, which is what `filtered` promises.
//! *Reference.* Shewchuk, Discrete & Computational Geometry 18, 1997.

use taut_points::two_to;
use taut_predicates::plane::{conflict_exact, in_circle_filter, orient_exact, orient_filter};
use taut_predicates::{Exact, MulAdd, Separate, Sign};

const EPSILON: f64 = f64::EPSILON / 2.0;
/// The error of an orientation, as a part of the bound |a|² + |b|², which is twice the permanent.
const ORIENT_ERROR: f64 = 1.75 * EPSILON;
const IN_CIRCLE: f64 = 11.0 * EPSILON;
/// The error that underflow may add, 2⁻⁹⁰⁰. A product that underflows is off by less than 2⁻¹⁰⁷⁴ and is multiplied by
/// at most a lift, below 2⁸⁴.
const UNDERFLOW_ERROR: f64 = two_to(-900);

/// The coordinates of the ghost vertex: every comparison with it is false, so the common path need not ask for it.
const NOWHERE: [f64; 2] = [f64::NAN; 2];

/// p − q, and its square.
#[derive(Clone, Copy)]
pub(super) struct PointOffset {
    x: f64,
    y: f64,
    lift: f64,
}

/// [ab]
#[inline(always)]
pub(super) fn minor<M: MulAdd>(a: PointOffset, b: PointOffset) -> f64 {
    M::mul_add(a.x, b.y, -(a.y * b.x))
}

/// The sites and the point they are seen from.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    sites: &'a [[f64; 2]],
    q: [f64; 2],
    filtered: bool,
    orient: f64,
    in_circle: f64,
}

impl<'a> View<'a> {
    /// Without filters every error bound is infinite or not a number.
    #[inline(always)]
    pub(super) fn new(sites: &'a [[f64; 2]], q: [f64; 2], filtered: bool) -> View<'a> {
        let (orient, in_circle) =
            if filtered { (ORIENT_ERROR, IN_CIRCLE) } else { (f64::INFINITY, f64::INFINITY) };
        View { sites, q, filtered, orient, in_circle }
    }

    /// A vertex as seen from q; not a number if it is the ghost vertex.
    #[inline(always)]
    pub(super) fn see<M: MulAdd>(&self, vertex: u32) -> PointOffset {
        let p = self.sites.get(vertex as usize).unwrap_or(&NOWHERE);
        let (x, y) = (p[0] - self.q[0], p[1] - self.q[1]);
        PointOffset { x, y, lift: M::mul_add(x, x, y * y) }
    }

    /// [ab] if its sign is beyond doubt, and zero if it is not.
    #[inline(always)]
    pub(super) fn side<M: MulAdd>(&self, a: PointOffset, b: PointOffset, minor: f64) -> f64 {
        let error = M::mul_add(self.orient, a.lift + b.lift, UNDERFLOW_ERROR);
        if minor.abs() > error { minor } else { 0.0 }
    }

    /// The sign of [ab] for two sites, whatever it takes.
    pub(super) fn side_exact(&self, a: u32, b: u32, exact: &mut Exact) -> Sign {
        let [a, b] = [a, b].map(|v| self.sites[v as usize]);
        let sign = |i: usize, p: [f64; 2]| Sign::from(p[i] - self.q[i]);
        // A difference is zero only between equals. If both products are zero, or one of two signs, there is nothing
        // to subtract: all there is to know of a hull whose edge is parallel to an axis.
        let (left, right) = (sign(0, a) * sign(1, b), sign(1, a) * sign(0, b));
        if left != right || left.is_zero() {
            exact.stages.filter += 1;
            return if left == right {
                Sign::Zero
            } else if left > right {
                Sign::Positive
            } else {
                Sign::Negative
            };
        }
        let side = if self.filtered { orient_filter::<Separate>(a, b, self.q) } else { 0.0 };
        if side == 0.0 {
            return orient_exact(a, b, self.q, exact);
        }
        exact.stages.filter += 1;
        Sign::from(side)
    }

    /// D for the triangle (d, b, a) if its sign is beyond doubt, and zero if it is not.
    #[inline(always)]
    pub(super) fn in_circle<M: MulAdd>(
        &self,
        [a, b, d]: [PointOffset; 3],
        [ab, ad, db]: [f64; 3],
    ) -> f64 {
        let determinant = M::mul_add(a.lift, db, M::mul_add(b.lift, ad, -(d.lift * ab)));
        let permanent = M::mul_add(d.lift, a.lift + b.lift, a.lift * b.lift);
        let error = M::mul_add(self.in_circle, permanent, UNDERFLOW_ERROR);
        if determinant.abs() > error { determinant } else { 0.0 }
    }

    /// Tests whether the perturbed circumcircle of a counter-clockwise triangle holds q, whatever it takes.
    #[inline(always)]
    pub(super) fn conflict_exact(&self, a: u32, b: u32, c: u32, exact: &mut Exact) -> bool {
        let [a, b, c] = [a, b, c].map(|v| self.sites[v as usize]);
        let determinant =
            if self.filtered { in_circle_filter::<Separate>(a, b, c, self.q) } else { 0.0 };
        if determinant == 0.0 {
            return conflict_exact(a, b, c, self.q, exact);
        }
        exact.stages.filter += 1;
        determinant > 0.0
    }
}
