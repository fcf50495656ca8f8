use super::*;
use proptest::prelude::*;

fn numbers(n: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    (0..n)
        .map(|_| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 40) as f64 / (1u64 << 23) as f64 - 1.0
        })
        .collect()
}

/// Largest |P·A − L·U| over n·u·|L|·|U|, and the promises of form.
fn check(a: &[f64], m: usize, n: usize) -> Lu {
    let mut f = a.to_vec();
    let factors = lu(MatrixViewMut::new(&mut f, m, n).unwrap());
    let mut permuted: Vec<&[f64]> = a.chunks(n.max(1)).take(m).collect();
    assert_eq!(factors.pivots.len(), m.min(n));
    for (j, &pivot) in factors.pivots.iter().enumerate() {
        assert!(pivot >= j && pivot < m);
        permuted.swap(j, pivot);
    }
    for i in 0..m {
        for j in 0..n {
            let (mut sum, mut magnitude) = (0.0, 0.0);
            for k in 0..=i.min(j) {
                let l = if k == i { 1.0 } else { f[i * n + k] };
                assert!(l.abs() <= 1.0 || k >= n.min(m), "L({i}, {k}) = {l}");
                sum += l * f[k * n + j];
                magnitude += (l * f[k * n + j]).abs();
            }
            let bound = 2.0 * (n + 2) as f64 * f64::EPSILON * magnitude;
            assert!((permuted[i][j] - sum).abs() <= bound, "({i}, {j}) of {m} × {n}");
        }
    }
    factors
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 1 } else { 40 }))]
    #[test]
    fn the_factors_multiply_to_the_matrix(m in 0usize..70, n in 0usize..70, seed: u64, integers: bool) {
        let (m, n) = if cfg!(miri) { (m % 20, n % 20) } else { (m, n) };
        let mut a = numbers(m * n, seed);
        if integers {
            // Ties between pivots and singular leading parts.
            a.iter_mut().for_each(|x| *x = (*x * 1.5).round());
        }
        check(&a, m, n);
    }

    #[test]
    fn solutions_solve(n in 1usize..60, seed: u64) {
        let n = if cfg!(miri) { n % 18 + 1 } else { n };
        let a = numbers(n * n, seed);
        let x = numbers(n, !seed);
        let mut b: Vec<f64> =
            a.chunks(n).map(|row| row.iter().zip(&x).map(|(p, q)| p * q).sum()).collect();
        let right = b.clone();
        let mut f = a.clone();
        let factors = lu(MatrixViewMut::new(&mut f, n, n).unwrap());
        prop_assume!(factors.zero_pivot.is_none());
        lu_solve(MatrixView::new(&f, n, n).unwrap(), &factors, &mut b).unwrap();
        for (row, r) in a.chunks(n).zip(right) {
            let product: f64 = row.iter().zip(&b).map(|(p, q)| p * q).sum();
            let size: f64 = row.iter().zip(&b).map(|(p, q)| (p * q).abs()).sum();
            // The residual is that of the factors, whose growth is below n for such matrices.
            prop_assert!((product - r).abs() <= 1e-13 * (n * n) as f64 * (size + 1.0));
        }
    }
}

#[test]
fn singular_matrices_are_factored_and_told() {
    let n = if cfg!(miri) { 12 } else { 30 };
    let factors = check(&vec![1.0; n * n], n, n);
    assert_eq!(factors.zero_pivot, Some(1));
    assert_eq!(check(&[0.0; 40], 8, 5).zero_pivot, Some(0));
    let f = [1.0, 1.0, 1.0, 0.0];
    let view = MatrixView::new(&f, 2, 2).unwrap();
    let singular = Lu { pivots: vec![0, 1], zero_pivot: Some(1) };
    assert!(lu_solve(view, &singular, &mut [1.0, 1.0]).is_err());
    let foreign = Lu { pivots: vec![0, 7], zero_pivot: None };
    assert!(lu_solve(view, &foreign, &mut [1.0, 1.0]).is_err());
    assert!(lu_solve(view, &foreign, &mut [1.0]).is_err());
}

#[test]
fn not_a_number_ends() {
    let n = if cfg!(miri) { 12 } else { 40 };
    let mut clean = numbers(n * n, 7);
    let (mut a, wrong) = (clean.clone(), n - 3);
    a[wrong] = f64::NAN;
    let factors = lu(MatrixViewMut::new(&mut a, n, n).unwrap());
    let expected = lu(MatrixViewMut::new(&mut clean, n, n).unwrap());
    // Columns left of it do not hear of it.
    assert_eq!(factors.pivots[..wrong], expected.pivots[..wrong]);
    for row in 0..wrong {
        assert_eq!(a[row * n..][..wrong], clean[row * n..][..wrong]);
    }
    assert!(a.iter().any(|x| x.is_nan()));
    assert!((wrong..n).all(|j| (j..n).contains(&factors.pivots[j])));
}
