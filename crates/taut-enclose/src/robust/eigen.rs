//! Eigenvectors of a small symmetric matrix, by Jacobi's rotations in cyclic order: slow, sure and always the same.

/// It is left at that after this many sweeps; convergence is quadratic, and ten are many.
const SWEEPS_MAX: usize = 60;

/// An orthonormal basis of eigenvectors, by rows; `matrix`, n × n, becomes diagonal but for rounding.
pub(super) fn eigenvectors(matrix: &mut [f64], n: usize) -> Vec<f64> {
    let mut vectors = vec![0.0; n * n];
    (0..n).for_each(|i| vectors[i * n + i] = 1.0);
    for _ in 0..SWEEPS_MAX {
        let mut rotated = false;
        for p in 0..n {
            for q in p + 1..n {
                let off = matrix[p * n + q];
                let (low, high) = (matrix[p * n + p], matrix[q * n + q]);
                if off.abs() <= f64::EPSILON * 0.25 * (low.abs() * high.abs()).sqrt()
                    || off.abs() < f64::MIN_POSITIVE
                {
                    continue;
                }
                rotated = true;
                let theta = (high - low) / (2.0 * off);
                let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
                let c = 1.0 / (t * t + 1.0).sqrt();
                let s = t * c;
                for k in 0..n {
                    let (a, b) = (matrix[k * n + p], matrix[k * n + q]);
                    (matrix[k * n + p], matrix[k * n + q]) = (c * a - s * b, s * a + c * b);
                }
                for k in 0..n {
                    let (a, b) = (matrix[p * n + k], matrix[q * n + k]);
                    (matrix[p * n + k], matrix[q * n + k]) = (c * a - s * b, s * a + c * b);
                    let (a, b) = (vectors[p * n + k], vectors[q * n + k]);
                    (vectors[p * n + k], vectors[q * n + k]) = (c * a - s * b, s * a + c * b);
                }
                (matrix[p * n + q], matrix[q * n + p]) = (0.0, 0.0);
            }
        }
        if !rotated {
            break;
        }
    }
    vectors
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_eigenvectors() {
        let n = 6;
        let entry = |i: usize, j: usize| 1.0 / (1.0 + i as f64 + j as f64);
        let matrix: Vec<f64> = (0..n * n).map(|at| entry(at / n, at % n)).collect();
        let mut diagonal = matrix.clone();
        let vectors = eigenvectors(&mut diagonal, n);
        for (k, v) in vectors.chunks(n).enumerate() {
            for (row, &vi) in matrix.chunks(n).zip(v) {
                let image: f64 = row.iter().zip(v).map(|(a, v)| a * v).sum();
                assert!((image - diagonal[k * n + k] * vi).abs() < 1e-15);
            }
            for (l, w) in vectors.chunks(n).enumerate() {
                let product: f64 = v.iter().zip(w).map(|(v, w)| v * w).sum();
                assert!((product - f64::from(u8::from(k == l))).abs() < 1e-14);
            }
        }
    }
}
