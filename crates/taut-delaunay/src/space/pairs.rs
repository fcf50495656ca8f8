//! Pairs of numbers, some 106 bits, in lanes: for what the filter leaves open all over, as on the surface of a sphere.
//!
//! *Idea.* The double-double stage of `taut-predicates`, operation for operation, on all simplices of a group at once. The
//! differences of coordinates are exact pairs, and one call of the exact stages costs as much as a group.
//! *Guarantee.* Its error is at most 8·k·u² of the permanent, as proved there, with k = 16 roundings; the permanent is at
//! most 72 times the product that the filter's bound is made of.
//! *Reference.* Joldes, Muller and Popescu, ACM Trans. Math. Softw. 44(2), 2017.

use std::ops::{Add, Mul, Sub};

use taut_points::two_to;

use super::signs::{Lane, Number, determinant, product};

/// As for the filter, with u² for u.
const IN_SPHERE_ERROR: f64 = 73.0 * 8.0 * 16.0 * (f64::EPSILON * f64::EPSILON / 4.0);
/// 2⁻⁶⁵⁰: more than all underflows can cost.
const UNDERFLOW_ERROR: f64 = two_to(-650);

/// The unevaluated sum of two numbers, of which the second is at most half a unit in the last place of the first. Only
/// for lanes with fused multiply-add.
#[derive(Clone, Copy)]
pub(super) struct Pair<L>(L, L);

impl<L: Lane> Pair<L> {
    /// x + y without error (Knuth).
    #[inline(always)]
    fn sum(x: L, y: L) -> Self {
        let high = x + y;
        let back = high - x;
        Pair(high, (x - (high - back)) + (y - back))
    }

    /// x − y without error.
    #[inline(always)]
    pub(super) fn difference(x: L, y: L) -> Self {
        let high = x - y;
        let back = high - x;
        Pair(high, (x - (high - back)) - (y + back))
    }
}

impl<L: Lane> Add for Pair<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let top = Self::sum(self.0, other.0);
        Self::sum(top.0, top.1 + (self.1 + other.1))
    }
}

impl<L: Lane> Sub for Pair<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let top = Self::difference(self.0, other.0);
        Self::sum(top.0, top.1 + (self.1 - other.1))
    }
}

impl<L: Lane> Mul for Pair<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let top = self.0 * other.0;
        let rest = L::mul_sub(self.0, other.0, top);
        let low = rest + (self.0 * other.1 + self.1 * other.0);
        // The first is larger, or both are zero: three operations instead of six (Dekker).
        let high = top + low;
        Pair(high, low - (high - top))
    }
}

impl<L: Lane> Number for Pair<L> {
    #[inline(always)]
    fn mul_add(a: Self, b: Self, c: Self) -> Self {
        a * b + c
    }
    #[inline(always)]
    fn mul_sub(a: Self, b: Self, c: Self) -> Self {
        a * b - c
    }
}

/// The in-sphere determinant, to its leading part, and the bound of its error. For differences up to 2⁶⁰.
#[inline(always)]
pub(super) fn in_sphere<L: Lane>(corners: [[Pair<L>; 3]; 4]) -> (L, L) {
    let Pair(det, _) = determinant(corners);
    let [a, b, c, d] = corners;
    let leading = [
        [a[0].0, a[1].0, a[2].0],
        [b[0].0, b[1].0, b[2].0],
        [c[0].0, c[1].0, c[2].0],
        [d[0].0, d[1].0, d[2].0],
    ];
    (det, L::mul_add(L::splat(IN_SPHERE_ERROR), product(leading), L::splat(UNDERFLOW_ERROR)))
}
