//! Eigenvalues and eigenvectors of small symmetric matrices.
//!
//! *Idea.* Jacobi's cyclic rotations: each makes one entry beside the diagonal 0, and their squares vanish
//! quadratically after a few sweeps.
//! *Guarantee.* Eigenvalues to a few units in the last place of the largest; vectors orthonormal to the same.
//! *Reference.* Golub and Van Loan, Matrix Computations, section 8.5.

/// Sweeps after which it is left at that; ten is much.
const SWEEPS: usize = 60;

/// The eigenvalues of a symmetric matrix, n × n, and the eigenvectors as rows; the matrix is used up.
pub(crate) fn eigen(a: &mut [f64], n: usize) -> (Vec<f64>, Vec<f64>) {
    let mut v = vec![0.0; n * n];
    (0..n).for_each(|i| v[i * n + i] = 1.0);
    for _ in 0..SWEEPS {
        let beside: f64 = (0..n)
            .flat_map(|i| (0..i).map(move |j| (i, j)))
            .map(|(i, j)| a[i * n + j] * a[i * n + j])
            .sum();
        let on: f64 = (0..n).map(|i| a[i * n + i] * a[i * n + i]).sum();
        if !(beside > 1e-34 * on) {
            break;
        }
        for p in 1..n {
            for q in 0..p {
                rotate(a, &mut v, n, q, p);
            }
        }
    }
    ((0..n).map(|i| a[i * n + i]).collect(), v)
}

/// Makes entry (p, q) zero, p < q.
fn rotate(a: &mut [f64], v: &mut [f64], n: usize, p: usize, q: usize) {
    let apq = a[p * n + q];
    if apq == 0.0 {
        return;
    }
    let theta = (a[q * n + q] - a[p * n + p]) / (2.0 * apq);
    // The smaller root of t² + 2θt − 1, also where θ² is no f64.
    let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
    let c = 1.0 / t.hypot(1.0);
    let s = t * c;
    let (above, below) = a.split_at_mut(q * n);
    turn(&mut above[p * n..(p + 1) * n], &mut below[..n], c, s);
    for row in a.chunks_exact_mut(n) {
        let (x, y) = (row[p], row[q]);
        row[p] = c * x - s * y;
        row[q] = s * x + c * y;
    }
    (a[p * n + q], a[q * n + p]) = (0.0, 0.0);
    let (above, below) = v.split_at_mut(q * n);
    turn(&mut above[p * n..(p + 1) * n], &mut below[..n], c, s);
}

fn turn(x: &mut [f64], y: &mut [f64], c: f64, s: f64) {
    for (x, y) in x.iter_mut().zip(y) {
        (*x, *y) = (c * *x - s * *y, s * *x + c * *y);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_vectors_put_together_are_the_matrix() {
        for n in [1, 2, 5, 12] {
            let entry =
                |i: usize, j: usize| 1.0 / (1.0 + (i + j) as f64) - f64::from(u8::from(i == j));
            let matrix: Vec<f64> = (0..n * n).map(|at| entry(at / n, at % n)).collect();
            let (values, vectors) = eigen(&mut matrix.clone(), n);
            for i in 0..n {
                for j in 0..n {
                    let sum: f64 =
                        (0..n).map(|k| values[k] * vectors[k * n + i] * vectors[k * n + j]).sum();
                    assert!((sum - entry(i, j)).abs() < 1e-14);
                    let product: f64 =
                        (0..n).map(|k| vectors[i * n + k] * vectors[j * n + k]).sum();
                    assert!((product - f64::from(u8::from(i == j))).abs() < 1e-14);
                }
            }
        }
    }
}
