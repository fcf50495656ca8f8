//! By how much a shape matrix is thickened, so that rounding its entries leaves no negative eigenvalue.
//!
//! *Definition.* With D the diagonal of S, a row stands for S + 2τD, where τ is the least of 2⁻⁵⁶, 2⁻⁵⁵, … for which S + τD
//! is positive semidefinite, and for S itself where S is: see [`Items::Ellipsoids`](taut_certify::Items::Ellipsoids).
//! *Idea.* A matrix is positive definite if all pivots of its factorization are positive. Rows and columns are brought
//! to sizes of about 1 by powers of two, and the factorization is done in doubled precision, on the safe side by 2e-27.
//! *Trap.* An eigenvalue in `f64` is known to 1e-16 at best, and τ is of that size: from eigenvalues the checker's τ could
//! not be found again, and answers would be refused.

use taut_kernels::DoubleDouble;
use taut_points::{exponent_of, two_to};

/// Unit roundoff of doubled precision with room for quotients: 64·2⁻¹⁰⁶, as the checker takes it.
const ROUNDOFF: f64 = two_to(-100);

/// The least τ that is tried, 2⁻⁵⁶.
const TAU_MIN: f64 = two_to(-56);

/// 2τ for the lower triangle of S, row by row; `None` where no τ ≤ 1 makes S positive semidefinite.
pub(super) fn thickening(shape: &[f64], dim: usize) -> Option<f64> {
    let diagonal = |j: usize| shape[j * (j + 3) / 2];
    let entry = |j: usize, k: usize| shape[j.max(k) * (j.max(k) + 1) / 2 + j.min(k)];
    if (0..dim).any(|j| diagonal(j) <= 0.0 && (0..dim).any(|k| entry(j, k) != 0.0)) {
        return None;
    }
    let wide: Vec<usize> = (0..dim).filter(|&j| diagonal(j) > 0.0).collect();
    let unit = |j: usize| two_to(-exponent_of(diagonal(j).sqrt()));
    let rows: Vec<Vec<f64>> = wide
        .iter()
        .map(|&j| wide.iter().map(|&k| entry(j, k) * unit(j) * unit(k)).collect())
        .collect();
    if is_definite(&rows, 0.0) {
        return Some(0.0);
    }
    let mut tau = TAU_MIN;
    while !is_definite(&rows, tau) {
        tau *= 2.0;
        if tau > 1.0 {
            return None;
        }
    }
    Some(2.0 * tau)
}

/// Returns true if S + (τ − e)D has positive pivots, with an e that is more than factorizing is off by.
fn is_definite(rows: &[Vec<f64>], tau: f64) -> bool {
    let n = rows.len();
    let e = 64.0 * ((n + 4) * (n + 4)) as f64 * ROUNDOFF;
    let added = DoubleDouble::sum(tau, -e);
    let mut matrix: Vec<Vec<DoubleDouble>> =
        rows.iter().map(|row| row.iter().map(|&v| v.into()).collect()).collect();
    for (j, row) in matrix.iter_mut().enumerate() {
        row[j] = row[j] + row[j] * added;
    }
    for k in 0..n {
        let (done, rest) = matrix.split_at_mut(k + 1);
        let pivot = &done[k];
        let is_positive = pivot[k].high > 0.0 && pivot[k].high.is_finite();
        if !is_positive {
            return false;
        }
        for row in rest {
            let factor = row[k] / pivot[k];
            for (value, above) in row[k + 1..].iter_mut().zip(&pivot[k + 1..]) {
                *value = *value - factor * *above;
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn singular_and_indefinite_matrices_are_thickened_and_no_others() {
        assert_eq!(thickening(&[1.0, 0.5, 1.0], 2), Some(0.0));
        assert_eq!(thickening(&[0.0, 0.0, 3.0], 2), Some(0.0));
        assert_eq!(thickening(&[1e300, 0.0, 1e-300], 2), Some(0.0));
        assert_eq!(thickening(&[4.0, 2.0, 1.0], 2), Some(2.0 * TAU_MIN));
        for (shape, least) in
            [([1.0, 1.0 + 1e-9, 1.0], 1e-9), ([4e200, 2.0 * (1.0 + 3e-12), 1e-200], 3e-12)]
        {
            let found = thickening(&shape, 2).unwrap();
            assert!(found >= 2.0 * least && found <= 4.0 * least, "{shape:?}: {found}");
        }
        for bad in [[-1.0, 0.0, 1.0], [0.0, 1e-9, 1.0], [0.0, 0.0, -1e-9], [1.0, 3.0, 1.0]] {
            assert_eq!(thickening(&bad, 2), None, "{bad:?}");
        }
    }
}
