//! Eigenvalues and eigenvectors of small symmetric matrices.
//!
//! *Idea.* Householder reflections make the matrix tridiagonal, and rotations with Wilkinson's shift chase what is left
//! beside the diagonal off its end: two or three for each eigenvalue.
//! *Guarantee.* Eigenvalues to a few units in the last place of the largest; vectors orthonormal to the same.
//! *Reference.* Golub and Van Loan, Matrix Computations, sections 8.3.1 and 8.3.4.

use taut_kernels::vector::{add_scaled, dot};

/// At most this many rotations of the whole matrix are made for each eigenvalue; three are usual.
const ROTATIONS_MAX: usize = 60;

/// The eigenvalues of a symmetric matrix, n × n, and the eigenvectors as rows; the matrix is used up.
pub(crate) fn eigen(a: &mut [f64], n: usize) -> (Vec<f64>, Vec<f64>) {
    let (mut on, mut beside, mut vectors) = tridiagonal(a, n);
    let mut end = n;
    let mut turns = ROTATIONS_MAX * n;
    while end > 1 && turns > 0 {
        turns -= 1;
        let is_zero =
            |k: usize| beside[k].abs() <= 0.25 * f64::EPSILON * (on[k].abs() + on[k + 1].abs());
        if is_zero(end - 2) {
            beside[end - 2] = 0.0;
            end -= 1;
            continue;
        }
        let mut start = end - 2;
        while start > 0 && !is_zero(start - 1) {
            start -= 1;
        }
        chase(&mut on, &mut beside, &mut vectors, n, start, end);
    }
    (on, vectors)
}

/// One implicit step with Wilkinson's shift on rows `start..end`.
fn chase(
    on: &mut [f64],
    beside: &mut [f64],
    vectors: &mut [f64],
    n: usize,
    start: usize,
    end: usize,
) {
    let last = end - 1;
    let half = (on[last - 1] - on[last]) / 2.0;
    let b = beside[last - 1];
    let sign = if half < 0.0 { -1.0 } else { 1.0 };
    let shift = on[last] - b * (b / (half + sign * half.hypot(b)));
    let (mut x, mut z) = (on[start] - shift, beside[start]);
    for k in start..last {
        let r = x.hypot(z);
        let (c, s) = if r == 0.0 { (1.0, 0.0) } else { (x / r, z / r) };
        if k > start {
            beside[k - 1] = r;
        }
        let (p, q, e) = (on[k], on[k + 1], beside[k]);
        on[k] = c * c * p + 2.0 * c * s * e + s * s * q;
        on[k + 1] = s * s * p - 2.0 * c * s * e + c * c * q;
        beside[k] = c * s * (q - p) + (c * c - s * s) * e;
        if k + 1 < last {
            (x, z) = (beside[k], s * beside[k + 1]);
            beside[k + 1] *= c;
        }
        let (above, below) = vectors.split_at_mut((k + 1) * n);
        for (u, v) in above[k * n..].iter_mut().zip(&mut below[..n]) {
            (*u, *v) = (c * *u + s * *v, c * *v - s * *u);
        }
    }
}

/// Diagonal, what stands beside it, and the rows of an orthogonal Q with QAQ′ of that form.
fn tridiagonal(a: &mut [f64], n: usize) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let mut q = vec![0.0; n * n];
    (0..n).for_each(|i| q[i * n + i] = 1.0);
    let mut beside = vec![0.0; n.saturating_sub(1)];
    let (mut v, mut w) = (vec![], vec![]);
    for k in 0..n.saturating_sub(2) {
        // Row k right of the diagonal is reflected onto its first entry.
        v.clear();
        v.extend_from_slice(&a[k * n + k + 1..(k + 1) * n]);
        let norm = dot(&v, &v).sqrt();
        let rest = v[1..].iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if rest == 0.0 {
            beside[k] = v[0];
            continue;
        }
        let alpha = if v[0] > 0.0 { -norm } else { norm };
        v[0] -= alpha;
        beside[k] = alpha;
        let square = dot(&v, &v);
        if square == 0.0 {
            continue;
        }
        let scale = 2.0 / square;
        // A ← A − vw′ − wv′ with p = scale·Av and w = p − (scale·v′p/2)v, on what is below and right.
        w.clear();
        w.extend((k + 1..n).map(|i| scale * dot(&a[i * n + k + 1..(i + 1) * n], &v)));
        let half = scale * dot(&w, &v) / 2.0;
        add_scaled(&mut w, -half, &v);
        for i in k + 1..n {
            let row = &mut a[i * n + k + 1..(i + 1) * n];
            add_scaled(row, -v[i - k - 1], &w);
            add_scaled(row, -w[i - k - 1], &v);
        }
        // Q ← HQ: rows k + 1.. of Q lose scale·v(v′Q).
        w.clear();
        w.resize(n, 0.0);
        for (i, &v) in v.iter().enumerate() {
            add_scaled(&mut w, scale * v, &q[(k + 1 + i) * n..(k + 2 + i) * n]);
        }
        for (i, &v) in v.iter().enumerate() {
            add_scaled(&mut q[(k + 1 + i) * n..(k + 2 + i) * n], -v, &w);
        }
    }
    if n >= 2 {
        beside[n - 2] = a[(n - 2) * n + n - 1];
    }
    ((0..n).map(|i| a[i * n + i]).collect(), beside, q)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(matrix: &[f64], n: usize) {
        let (values, vectors) = eigen(&mut matrix.to_vec(), n);
        let size = matrix.iter().fold(1e-300f64, |m, v| m.max(v.abs()));
        for i in 0..n {
            for j in 0..n {
                let sum: f64 =
                    (0..n).map(|k| values[k] * vectors[k * n + i] * vectors[k * n + j]).sum();
                assert!((sum - matrix[i * n + j]).abs() < 2e-14 * size, "{i}, {j}: {sum}");
                let product = dot(&vectors[i * n..(i + 1) * n], &vectors[j * n..(j + 1) * n]);
                assert!((product - f64::from(u8::from(i == j))).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn values_and_vectors_put_together_are_the_matrix() {
        for n in [1, 2, 3, 5, 12, 30] {
            let identity = |at: usize| f64::from(u8::from(at / n == at % n));
            let hilbert = |at: usize| 1.0 / (1.0 + (at / n + at % n) as f64);
            check(&(0..n * n).map(|at| hilbert(at) - identity(at)).collect::<Vec<_>>(), n);
            check(&(0..n * n).map(identity).collect::<Vec<_>>(), n);
            check(&vec![0.0; n * n], n);
            check(&vec![1.0; n * n], n);
            // Sizes from 1 to 1e-20, in either order.
            let graded = |at: usize| 10f64.powi(-((at / n + at % n) as i32) / 2);
            check(&(0..n * n).map(graded).collect::<Vec<_>>(), n);
            check(&(0..n * n).rev().map(graded).collect::<Vec<_>>(), n);
            let far = |at: usize| 1e200 * (hilbert(at) + identity(at));
            let scaled: Vec<f64> = (0..n * n).map(|at| far(at) * 1e-60).collect();
            check(&scaled, n);
        }
    }
}
