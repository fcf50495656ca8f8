//! Whole numbers in lanes: determinants without error, and ties broken by the cofactors they were made of.
//!
//! *Idea.* On a grid most of what the filter leaves open is a tie. Where all differences are whole and at most 659, no
//! number of the in-sphere determinant exceeds 72·659⁵ < 2⁵³, so `f64` arithmetic has no error and zero means zero. Then
//! the perturbation decides: of the vertices that come after q in lexicographic order, the last one whose cofactor is not
//! zero says whether q is inside, and if there is none q is outside.
//! *Without branches.* x·2²² + y·2¹¹ + z is positive if a vertex comes after q, and larger for later vertices. So all
//! that remains is the sign that stands beside a maximum, which whole numbers can say in sums and maxima.

use super::signs::{Lane, cofactors, extents, lift};

/// Largest difference for which the determinant is exact.
const REACH_MAX: f64 = 659.0;
const _: () = assert!(72 * 659_u64.pow(5) <= 1 << 53);

/// More than any determinant: a bound that leaves open.
const ERROR_MAX: f64 = 1e300;

/// The lesser of two whole numbers.
#[inline(always)]
fn min<L: Lane>(a: L, b: L) -> L {
    a - (a - b).max(L::splat(0.0))
}

/// The sign of a whole number.
#[inline(always)]
fn sign<L: Lane>(a: L) -> L {
    min(a, L::splat(1.0)).max(L::splat(-1.0))
}

/// The place of a vertex in lexicographic order, q being 0; or 0 if its cofactor has no sign.
#[inline(always)]
fn place<L: Lane>(p: [L; 3], sign: L) -> L {
    let shift = L::splat(2048.0);
    L::mul_add(L::mul_add(p[0], shift, p[1]), shift, p[2]) * sign.abs()
}

/// The sign, if this is the place of the last vertex, or 0.
#[inline(always)]
fn chosen<L: Lane>(sign: L, place: L, last: L) -> L {
    sign * (L::splat(1.0) - min(last - place, L::splat(1.0)))
}

/// The in-sphere determinant; a number of the sign of the perturbed one; and a bound that both exceed unless the first is
/// zero, or the differences are too large.
#[inline(always)]
pub(super) fn in_sphere<L: Lane>(corners: [[L; 3]; 4]) -> (L, L, L) {
    let [u, v, w, t] = cofactors(corners);
    let [a, b, c, d] = corners;
    let det = L::mul_add(lift(a), u, lift(b) * v) + L::mul_add(lift(c), w, lift(d) * t);
    let (u, v, w, t) = (sign(u), sign(v), sign(w), sign(t));
    let (i, j, k, l) = (place(a, u), place(b, v), place(c, w), place(d, t));
    let last = i.max(j).max(k.max(l)).max(L::splat(0.0));
    let tie = (chosen(u, i, last) + chosen(v, j, last)) + (chosen(w, k, last) + chosen(t, l, last));
    // A determinant that is not zero is at least 1.
    let perturbed = L::mul_add(L::splat(4.0), det, L::mul_sub(L::splat(2.0), tie, L::splat(1.0)));
    let [x, y, z] = extents(corners);
    let beyond = (x.max(y).max(z) - L::splat(REACH_MAX)).max(L::splat(0.0));
    (det, perturbed, L::mul_add(L::splat(ERROR_MAX), beyond, L::splat(0.5)))
}
