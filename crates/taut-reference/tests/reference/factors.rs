//! LU factors and Fourier transforms against their definitions.

use proptest::prelude::*;
use taut_reference::algorithms::{Direction, fft, lu};

/// Elements of an m × n matrix that repeat, so that pivots tie.
fn matrices() -> impl Strategy<Value = (usize, usize, Vec<f64>)> {
    (0usize..20, 0usize..20).prop_flat_map(|(m, n)| {
        let elements = prop_oneof![-4i32..5, -1000i32..1000].prop_map(f64::from);
        (Just(m), Just(n), prop::collection::vec(elements, m * n))
    })
}

proptest! {
    /// |P·A − L·U| ≤ γ·|L|·|U| with γ = k·u / (1 − k·u) for sums of k products; |L| ≤ 1.
    #[test]
    fn factors_multiply_to_the_matrix((m, n, matrix) in matrices()) {
        let mut a = matrix.clone();
        let factors = lu(&mut a, m, n).expect("a matrix");
        let k = m.min(n);
        let mut exchanged = matrix;
        for (j, &pivot) in factors.pivots.iter().enumerate() {
            prop_assert!((j..m).contains(&pivot));
            (0..n).for_each(|column| exchanged.swap(j * n + column, pivot * n + column));
        }
        let lower = |i: usize, j: usize| if i == j { 1.0 } else { a[i * n + j] };
        for i in 0..m {
            for j in 0..n {
                let terms = (0..=i.min(j).min(k - 1)).map(|s| lower(i, s) * a[s * n + j]);
                let (sum, size) = terms.fold((0.0, 0.0), |(sum, size), x| (sum + x, size + x.abs()));
                // The factors' own rounding, and that of the sum here.
                let gamma = 2.0 * (k as f64 + 1.0) * f64::EPSILON;
                prop_assert!((sum - exchanged[i * n + j]).abs() <= gamma * size, "{i}, {j}");
                prop_assert!(j >= i || j >= k || lower(i, j).abs() <= 1.0, "{i}, {j}");
            }
        }
        let zero = (0..k).find(|&j| a[j * n + j] == 0.0);
        prop_assert_eq!(factors.zero_pivot, zero);
    }

    /// Each line of the spectrum is the sum of its definition, within the stated error.
    #[test]
    fn transforms_equal_the_definition(
        log in 0u32..8,
        parts in prop::collection::vec(-1.0f64..1.0, 256),
        inverse in any::<bool>(),
    ) {
        let n = 1usize << log;
        let signal: Vec<[f64; 2]> = parts.as_chunks::<2>().0.iter().copied().cycle().take(n).collect();
        let (direction, sign) =
            if inverse { (Direction::Inverse, 1.0) } else { (Direction::Forward, -1.0) };
        let mut found = signal.clone();
        fft(&mut found, direction).expect("a power of two");
        let (mut error, mut norm) = (0.0, 0.0);
        for (k, &[re, im]) in found.iter().enumerate() {
            let sum = signal.iter().enumerate().fold([0.0, 0.0], |[x, y], (j, &[a, b])| {
                let (sin, cos) = (sign * std::f64::consts::TAU * (j * k % n) as f64 / n as f64).sin_cos();
                [x + a * cos - b * sin, y + a * sin + b * cos]
            });
            error += (re - sum[0]).powi(2) + (im - sum[1]).powi(2);
            norm += sum[0].powi(2) + sum[1].powi(2);
        }
        // The sums here are off by up to n·u of the sum of their terms, √n times the norm of the signal.
        let bound = 1e-15 * f64::from(log) + n as f64 * f64::EPSILON;
        prop_assert!(error.sqrt() <= bound * norm.sqrt(), "{:e}", (error / norm).sqrt());
    }
}

/// Forward and back gives n·x; a wave of the definition has one line.
#[test]
fn long_signals_within_the_stated_error() {
    let n = 1usize << 16;
    let bound = 1e-15 * 16.0;
    let line = n / 3 + 5;
    let wave: Vec<[f64; 2]> = (0..n)
        .map(|j| (std::f64::consts::TAU * (j * line % n) as f64 / n as f64).sin_cos())
        .map(|(sin, cos)| [cos, sin])
        .collect();
    let mut signal = wave.clone();
    fft(&mut signal, Direction::Forward).expect("a power of two");
    let off: f64 = signal
        .iter()
        .enumerate()
        .map(|(k, &[re, im])| (re - if k == line { n as f64 } else { 0.0 }).powi(2) + im * im)
        .sum();
    // The norm of the spectrum is n; the wave itself is rounded, by half a unit in each part.
    assert!(off.sqrt() <= (bound + f64::EPSILON) * n as f64, "{:e}", off.sqrt() / n as f64);
    fft(&mut signal, Direction::Inverse).expect("a power of two");
    let off: f64 = signal
        .iter()
        .zip(&wave)
        .map(|(x, y)| (x[0] / n as f64 - y[0]).powi(2) + (x[1] / n as f64 - y[1]).powi(2))
        .sum();
    assert!(off.sqrt() <= 2.0 * bound * (n as f64).sqrt(), "{:e}", off.sqrt());
}

#[test]
fn wrong_lengths_are_refused_and_singular_matrices_named() {
    assert!(lu(&mut [0.0; 5], 2, 3).is_err());
    for n in [0, 3, 6] {
        assert!(fft(&mut vec![[0.0; 2]; n], Direction::Forward).is_err(), "{n}");
    }
    let mut singular = [1.0, 2.0, 2.0, 4.0];
    assert_eq!(lu(&mut singular, 2, 2).expect("a matrix").zero_pivot, Some(1));
    let mut none = [0.0; 6];
    assert_eq!(lu(&mut none, 3, 2).expect("a matrix").zero_pivot, Some(0));
}
