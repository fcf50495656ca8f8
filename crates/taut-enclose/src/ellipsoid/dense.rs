//! Small dense linear algebra by rows: triangular factors and the line search on a pencil.

use taut_kernels::vector::{add_scaled, dot};

/// A ← L with A = LL′, of the lower triangle by rows, n × n; false when A is not positive definite to rounding.
pub(crate) fn cholesky(a: &mut [f64], n: usize) -> bool {
    for i in 0..n {
        let (above, row) = a.split_at_mut(i * n);
        for j in 0..i {
            let other = &above[j * n..j * n + j + 1];
            row[j] = (row[j] - dot(&row[..j], &other[..j])) / other[j];
        }
        let pivot = row[i] - dot(&row[..i], &row[..i]);
        // A pivot of nothing but rounding is none.
        if pivot.is_nan() || pivot <= 4.0 * n as f64 * f64::EPSILON * row[i] {
            return false;
        }
        row[i] = pivot.sqrt();
    }
    true
}

/// b ← L⁻¹b.
pub(crate) fn forward(lower: &[f64], n: usize, b: &mut [f64]) {
    for i in 0..n {
        let row = &lower[i * n..i * n + i + 1];
        b[i] = (b[i] - dot(&row[..i], &b[..i])) / row[i];
    }
}

/// M ← L⁻¹M for lower triangular matrices.
pub(crate) fn divide_rows(lower: &[f64], n: usize, m: &mut [f64]) {
    for i in 0..n {
        let (above, row) = m.split_at_mut(i * n);
        for j in 0..i {
            add_scaled(&mut row[..=j], -lower[i * n + j], &above[j * n..j * n + j + 1]);
        }
        row[..=i].iter_mut().for_each(|v| *v /= lower[i * n + i]);
    }
}

/// The t in [0, 1] that maximizes ln det(I + tE) − ct for a symmetric E, of which the lower triangle is given.
///
/// A Householder tridiagonalization of E, once in O(n³), leaves the determinant and its derivative an O(n) recurrence;
/// the function is concave, so its derivative is bisected.
pub(super) fn line_search(e: &[f64], n: usize, c: f64) -> f64 {
    let (diagonal, beside) = tridiagonal(e, n);
    // φ′(t), or none where I + tE is not positive definite.
    let slope = |t: f64| -> Option<f64> {
        let (mut pivot, mut derivative, mut sum) = (1.0, 0.0, -c);
        for i in 0..n {
            let (b, db) = if i > 0 { (t * beside[i - 1], beside[i - 1]) } else { (0.0, 0.0) };
            let ratio = b / pivot;
            derivative = diagonal[i] - 2.0 * ratio * db + ratio * ratio * derivative;
            pivot = 1.0 + t * diagonal[i] - ratio * b;
            if pivot.is_nan() || pivot <= 1e-13 {
                return None;
            }
            sum += derivative / pivot;
        }
        Some(sum)
    };
    if slope(1.0).is_some_and(|slope| slope >= 0.0) {
        return 1.0;
    }
    let (mut low, mut high) = (0.0, 1.0);
    while high - low > 1e-6 * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        match slope(middle) {
            Some(slope) if slope >= 0.0 => low = middle,
            _ => high = middle,
        }
    }
    low
}

/// Diagonal and off-diagonal of a tridiagonal matrix with the eigenvalues of a symmetric one.
fn tridiagonal(matrix: &[f64], n: usize) -> (Vec<f64>, Vec<f64>) {
    let mut a = matrix.to_vec();
    for i in 0..n {
        for j in 0..i {
            a[j * n + i] = a[i * n + j];
        }
    }
    let mut beside = vec![0.0; n.saturating_sub(1)];
    for k in 0..n.saturating_sub(2) {
        // Row k right of the diagonal is reflected onto its first entry.
        let mut v = a[k * n + k + 1..(k + 1) * n].to_vec();
        let norm = dot(&v, &v).sqrt();
        if norm == 0.0 {
            continue;
        }
        let alpha = if v[0] > 0.0 { -norm } else { norm };
        v[0] -= alpha;
        beside[k] = alpha;
        let scale = 2.0 / dot(&v, &v);
        // A ← A − vw′ − wv′ with p = scale·Av and w = p − (scale·v′p/2)v, on what is below and right.
        let mut w: Vec<f64> =
            (k + 1..n).map(|i| scale * dot(&a[i * n + k + 1..(i + 1) * n], &v)).collect();
        let half = scale * dot(&v, &w) / 2.0;
        add_scaled(&mut w, -half, &v);
        for i in k + 1..n {
            let row = &mut a[i * n + k + 1..(i + 1) * n];
            add_scaled(row, -v[i - k - 1], &w);
            add_scaled(row, -w[i - k - 1], &v);
        }
    }
    if n >= 2 {
        beside[n - 2] = a[(n - 2) * n + n - 1];
    }
    ((0..n).map(|i| a[i * n + i]).collect(), beside)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_times_its_transpose_is_the_matrix() {
        let n = 7;
        let entry = |i: usize, j: usize| if i == j { 9.0 } else { 1.0 / (1.0 + (i + j) as f64) };
        let matrix: Vec<f64> = (0..n * n).map(|at| entry(at / n, at % n)).collect();
        let mut lower = matrix.clone();
        assert!(cholesky(&mut lower, n));
        let mut inverse = vec![0.0; n * n];
        (0..n).for_each(|i| inverse[i * n + i] = 1.0);
        divide_rows(&lower, n, &mut inverse);
        for i in 0..n {
            for j in 0..=i {
                let product = dot(&lower[i * n..i * n + j + 1], &lower[j * n..j * n + j + 1]);
                assert!((product - entry(i, j)).abs() < 1e-14);
                let one: f64 = (j..=i).map(|k| lower[i * n + k] * inverse[k * n + j]).sum();
                assert!((one - if i == j { 1.0 } else { 0.0 }).abs() < 1e-14);
            }
        }
        assert!(!cholesky(&mut [1.0, 0.0, 1.0, 1.0], 2));
    }

    #[test]
    fn the_line_search_finds_the_maximum_of_a_known_pencil() {
        // E with eigenvalues λ, turned by a reflection I − 2vv′/v′v: φ′(t) = Σ λ/(1 + tλ) − c.
        let lambda = [3.0, 0.5, -0.9, 0.0, -0.25];
        let v = [1.0, 2.0, -1.0, 0.5, 3.0];
        let vv: f64 = v.iter().map(|v| v * v).sum();
        let turn = |i: usize, j: usize| f64::from(u8::from(i == j)) - 2.0 * v[i] * v[j] / vv;
        let n = lambda.len();
        let mut e = vec![0.0; n * n];
        for i in 0..n {
            for j in 0..n {
                e[i * n + j] = (0..n).map(|k| turn(i, k) * lambda[k] * turn(j, k)).sum();
            }
        }
        for c in [-1.0, 0.0, 0.4, 1.5] {
            let t = line_search(&e, n, c);
            let slope = |t: f64| lambda.iter().map(|l| l / (1.0 + t * l)).sum::<f64>() - c;
            if t == 1.0 {
                assert!(slope(1.0) >= 0.0, "c = {c}");
            } else {
                assert!(slope(t * (1.0 - 1e-4)) > 0.0 && slope(t * (1.0 + 1e-4)) < 0.0, "c = {c}");
            }
        }
    }
}
