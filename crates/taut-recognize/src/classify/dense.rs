//! Small dense matrices, row after row: factors and eigenvalues, the same bits for any number of threads.

use taut_points::OrderBy;

/// The part of the mean diagonal that is added at first where a factor does not exist; ten times as much each time after.
const RIDGE_START: f64 = 1e-12;
/// Sweeps of rotations after which off-diagonal values are rounding: they fall quadratically, and ten do for any matrix of doubles.
const SWEEPS_MAX: usize = 60;

/// The lower factor L of a symmetric matrix A = L·Lᵀ; none where A is not positive definite.
fn factor(a: &[f64], n: usize) -> Option<Vec<f64>> {
    let mut l = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| l[i * n + k] * l[j * n + k]).sum();
            let rest = a[i * n + j] - dot;
            if i == j {
                // Written so that NaN refuses.
                if !(rest > a[i * n + i] * f64::EPSILON && rest.is_finite()) {
                    return None;
                }
                l[i * n + i] = rest.sqrt();
            } else {
                l[i * n + j] = rest / l[j * n + j];
            }
        }
    }
    Some(l)
}

/// The lower factor of a positive semidefinite matrix, to which the least multiple of the identity that is needed is added; none where
/// values are not finite.
pub(super) fn factor_with_ridge(a: &[f64], n: usize) -> Option<Vec<f64>> {
    let trace: f64 = (0..n).map(|i| a[i * n + i]).sum();
    if !trace.is_finite() {
        return None;
    }
    let size = if trace > 0.0 { trace / n as f64 } else { 1.0 };
    let mut ridge = 0.0;
    while ridge <= 1e6 {
        let mut sum = a.to_vec();
        (0..n).for_each(|i| sum[i * n + i] += ridge * size);
        if let Some(l) = factor(&sum, n) {
            return Some(l);
        }
        ridge = if ridge == 0.0 { RIDGE_START } else { 10.0 * ridge };
    }
    None
}

/// Solves L·y = x in place.
pub(super) fn solve_lower(l: &[f64], n: usize, x: &mut [f64]) {
    for i in 0..n {
        let dot: f64 = (0..i).map(|k| l[i * n + k] * x[k]).sum();
        x[i] = (x[i] - dot) / l[i * n + i];
    }
}

/// Eigenvalues of a symmetric matrix, largest first, and the eigenvectors as rows (Jacobi's rotations).
pub(super) fn eigen(a: &[f64], n: usize) -> (Vec<f64>, Vec<f64>) {
    let mut a = a.to_vec();
    let mut v = vec![0.0; n * n];
    (0..n).for_each(|i| v[i * n + i] = 1.0);
    for _ in 0..SWEEPS_MAX {
        let off: f64 = (0..n)
            .flat_map(|i| (0..i).map(move |j| (i, j)))
            .map(|(i, j)| a[i * n + j].powi(2))
            .sum();
        let on: f64 = (0..n).map(|i| a[i * n + i].powi(2)).sum();
        if off <= f64::EPSILON.powi(2) * on || off.is_nan() {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                rotate(&mut a, &mut v, n, p, q);
            }
        }
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.order_by(&|&i, &j| a[j * n + j].total_cmp(&a[i * n + i]));
    let values = order.iter().map(|&i| a[i * n + i]).collect();
    let vectors = order
        .iter()
        .flat_map(|&i| (0..n).map(move |k| (i, k)))
        .map(|(i, k)| v[k * n + i])
        .collect();
    (values, vectors)
}

/// One rotation that makes a[p][q] vanish (Golub and Van Loan, Matrix Computations, 8.5).
fn rotate(a: &mut [f64], v: &mut [f64], n: usize, p: usize, q: usize) {
    let off = a[p * n + q];
    if off == 0.0 {
        return;
    }
    let tau = (a[q * n + q] - a[p * n + p]) / (2.0 * off);
    let t = tau.signum() / (tau.abs() + (1.0 + tau * tau).sqrt());
    let c = 1.0 / (1.0 + t * t).sqrt();
    let s = t * c;
    for k in 0..n {
        let (x, y) = (a[k * n + p], a[k * n + q]);
        (a[k * n + p], a[k * n + q]) = (c * x - s * y, s * x + c * y);
        let (x, y) = (v[k * n + p], v[k * n + q]);
        (v[k * n + p], v[k * n + q]) = (c * x - s * y, s * x + c * y);
    }
    for k in 0..n {
        let (x, y) = (a[p * n + k], a[q * n + k]);
        (a[p * n + k], a[q * n + k]) = (c * x - s * y, s * x + c * y);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATRIX: [f64; 9] = [4.0, 1.0, -2.0, 1.0, 3.0, 0.5, -2.0, 0.5, 5.0];

    #[test]
    fn a_factor_multiplies_back_and_solves() {
        let l = factor(&MATRIX, 3).unwrap();
        for i in 0..3 {
            for j in 0..3 {
                let product: f64 = (0..3).map(|k| l[i * 3 + k] * l[j * 3 + k]).sum();
                assert!((product - MATRIX[i * 3 + j]).abs() < 1e-14);
            }
        }
        let mut x = [1.0, 2.0, 3.0];
        solve_lower(&l, 3, &mut x);
        let back: f64 = (0..3).map(|k| l[6 + k] * x[k]).sum();
        assert!((back - 3.0).abs() < 1e-14);
        assert!(factor(&[1.0, 2.0, 2.0, 1.0], 2).is_none());
        // Of rank 1: a ridge of about 1e-12 does.
        let l = factor_with_ridge(&[1.0, 1.0, 1.0, 1.0], 2).unwrap();
        assert!(l[3] > 0.0 && l[3] < 1e-4);
        assert!(factor_with_ridge(&[f64::NAN], 1).is_none());
        assert_eq!(factor_with_ridge(&[0.0; 4], 2).map(|l| l.len()), Some(4));
    }

    #[test]
    fn eigenvectors_diagonalize() {
        let (values, vectors) = eigen(&MATRIX, 3);
        assert!(values.windows(2).all(|pair| pair[0] >= pair[1]));
        for (value, v) in values.iter().zip(vectors.chunks_exact(3)) {
            for i in 0..3 {
                let product: f64 = (0..3).map(|k| MATRIX[i * 3 + k] * v[k]).sum();
                assert!((product - value * v[i]).abs() < 1e-13);
            }
        }
        assert!((values.iter().sum::<f64>() - 12.0).abs() < 1e-13);
        assert_eq!(eigen(&[2.0, 0.0, 0.0, 3.0], 2).0, [3.0, 2.0]);
    }
}
