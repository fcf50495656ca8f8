//! Sites as seen from the query point, and the signs of the plane in these coordinates.
//!
//! With a, b, d relative to q and [uv] = uₓvᵧ − uᵧvₓ, the orientation of (q, a, b) is [ab], and q lies inside the circle
//! through the counter-clockwise triangle (d, b, a) iff D = |a|²[db] + |b|²[ad] − |d|²[ab] > 0.
//!
//! *Filters.* Instead of the permanents of Shewchuk's stage A their bounds by lifts are used, which are at hand:
//! |uₓvᵧ| + |uᵧvₓ| ≤ |u||v| ≤ (|u|² + |v|²)/2, hence the permanent of D is at most |a|²|b|² + |b|²|d|² + |d|²|a|².
//! *Guarantee.* With ε = 2⁻⁵³ the rounding errors of [ab] and D are below (3 + 16ε)ε and (10 + 96ε)ε of the computed
//! permanents; the constants below are larger by more than the few ε that the bounds lose to rounding themselves. What
//! underflow may add is far below `TINY` as long as coordinates do not exceed 2⁴⁰, which is what `filtered` promises.
//! *Reference.* Shewchuk, Discrete & Computational Geometry 18, 1997.

use taut_predicates::plane::{conflict_exact, orient_exact};
use taut_predicates::{Exact, Sign};

const EPSILON: f64 = f64::EPSILON / 2.0;
/// Of the bound |a|² + |b|², which is twice the permanent.
const ORIENT: f64 = 1.75 * EPSILON;
const IN_CIRCLE: f64 = 11.0 * EPSILON;
/// 2⁻⁹⁰⁰. A product that underflows is off by less than 2⁻¹⁰⁷⁴ and is multiplied by at most a lift, below 2⁸⁴.
const TINY: f64 = f64::from_bits((1023 - 900) << 52);

/// p − q, and its square.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    x: f64,
    y: f64,
    lift: f64,
}

/// [ab]
#[inline(always)]
pub(super) fn minor(a: Seen, b: Seen) -> f64 {
    a.x * b.y - a.y * b.x
}

/// The sites and the point they are seen from.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    sites: &'a [[f64; 2]],
    q: [f64; 2],
    orient: f64,
    in_circle: f64,
}

impl<'a> View<'a> {
    /// `sites` ends with the place of the ghost vertex. Without filters every error bound is infinite or not a number.
    #[inline(always)]
    pub(super) fn new(sites: &'a [[f64; 2]], q: [f64; 2], filtered: bool) -> View<'a> {
        let (orient, in_circle) =
            if filtered { (ORIENT, IN_CIRCLE) } else { (f64::INFINITY, f64::INFINITY) };
        View { sites, q, orient, in_circle }
    }

    /// A vertex as seen from q; not a number if it is the ghost vertex.
    #[inline(always)]
    pub(super) fn see(&self, vertex: u32) -> Seen {
        let p = self.sites[(vertex as usize).min(self.sites.len() - 1)];
        let (x, y) = (p[0] - self.q[0], p[1] - self.q[1]);
        Seen { x, y, lift: x * x + y * y }
    }

    /// [ab] if its sign is beyond doubt, and zero if it is not.
    #[inline(always)]
    pub(super) fn side(&self, a: Seen, b: Seen, minor: f64) -> f64 {
        let error = self.orient * (a.lift + b.lift) + TINY;
        if minor.abs() > error { minor } else { 0.0 }
    }

    /// The sign of [ab] for two sites.
    pub(super) fn side_exact(&self, a: u32, b: u32, exact: &mut Exact) -> Sign {
        let (p, r) = (self.see(a), self.see(b));
        let side = self.side(p, r, minor(p, r));
        if side == 0.0 {
            orient_exact(self.sites[a as usize], self.sites[b as usize], self.q, exact)
        } else {
            Sign::from(side)
        }
    }

    /// D for the triangle (d, b, a) if its sign is beyond doubt, and zero if it is not.
    #[inline(always)]
    pub(super) fn in_circle(&self, [a, b, d]: [Seen; 3], [ab, ad, db]: [f64; 3]) -> f64 {
        let determinant = a.lift * db + b.lift * ad - d.lift * ab;
        let error = self.in_circle * (a.lift * b.lift + d.lift * (a.lift + b.lift)) + TINY;
        if determinant.abs() > error { determinant } else { 0.0 }
    }

    /// Whether the perturbed circumcircle of a counter-clockwise triangle holds q.
    pub(super) fn conflict_exact(&self, triangle: [u32; 3], exact: &mut Exact) -> bool {
        let [a, b, c] = triangle.map(|v| self.sites[v as usize]);
        conflict_exact(a, b, c, self.q, exact)
    }
}
