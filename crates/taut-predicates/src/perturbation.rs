//! The symbolic perturbation: no tie is left, and the answer depends on the points alone.
//!
//! *Idea.* The lift |p|² of every point becomes |p|² + e(p), with e(p) > 0 infinitely small, yet infinitely larger
//! than e of every lexicographically smaller point. The in-sphere determinant D is linear in the lifts, so where
//! D = 0 its sign is that of the first non-zero coefficient when the points are visited from the largest down.
//! The coefficient of e(p) is the cofactor of p's lift, which D has been computed from already; that of the
//! query point q is minus the orientation of the simplex, hence never zero: the visit ends at q at the latest.
//! *Guarantee.* The perturbed points are in general position: a Delaunay triangulation built with these answers
//! is the one projection of a convex hull, whatever the order of insertion, the threads and the tiles. Orientation
//! is never perturbed, so no flat simplices arise.
//! *Reference.* Edelsbrunner & Mücke, ACM Transactions on Graphics 9(1), 1990, for the principle; Devillers &
//! Teillaud, Perturbations for Delaunay and weighted Delaunay 3D triangulations, Computational Geometry 44(3), 2011,
//! for perturbing the lifts in lexicographic order.

use std::cmp::Ordering;

use crate::sign::Sign;

/// By the first coordinate in which they differ; 0 and −0 are equal.
#[inline]
pub(crate) fn lexicographic<const D: usize>(a: &[f64; D], b: &[f64; D]) -> Ordering {
    for (x, y) in a.iter().zip(b) {
        if x < y {
            return Ordering::Less;
        }
        if x > y {
            return Ordering::Greater;
        }
    }
    Ordering::Equal
}

/// The answer where D = 0, positive or negative: the sign of the cofactor, not zero, of the largest vertex beyond q;
/// negative if there is none. Only the cofactors on the way there are asked for.
#[inline(always)]
pub(crate) fn tie<const D: usize, const V: usize>(
    vertices: &[[f64; D]; V],
    q: &[f64; D],
    cofactor: impl Fn(usize) -> Sign,
) -> Sign {
    let (mut largest, mut decisive) = (q, Sign::Negative);
    for (i, vertex) in vertices.iter().enumerate() {
        if lexicographic(vertex, largest).is_gt() {
            let sign = cofactor(i);
            if !sign.is_zero() {
                (largest, decisive) = (vertex, sign);
            }
        }
    }
    decisive
}
