//! The little linear algebra that judging needs, apart from taut's.

/// Σ xy.
pub(super) fn product(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// A ← L with A = LL′, of the lower triangle of d rows; ln det A, or `None` where A is not positive definite.
pub(super) fn cholesky(matrix: &mut [f64], d: usize) -> Option<f64> {
    let mut log_det = 0.0;
    for j in 0..d {
        for k in 0..=j {
            let rest = matrix[j * d + k] - product(&matrix[j * d..][..k], &matrix[k * d..][..k]);
            matrix[j * d + k] = if j == k { rest.sqrt() } else { rest / matrix[k * d + k] };
        }
        log_det += 2.0 * matrix[j * d + j].ln();
    }
    log_det.is_finite().then_some(log_det)
}

/// The logarithm of the volume of the unit ball.
pub(super) fn log_unit_ball(d: usize) -> f64 {
    // V(d) = 2π/d · V(d − 2), V(0) = 1, V(1) = 2.
    let first = if d.is_multiple_of(2) { 0.0 } else { 2f64.ln() };
    let factors = (2 + d % 2..=d).step_by(2).map(|k| (std::f64::consts::TAU / k as f64).ln());
    first + factors.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volumes_and_determinants_are_those_of_the_book() {
        let pi = std::f64::consts::PI;
        for (d, volume) in [(1, 2.0), (2, pi), (3, 4.0 / 3.0 * pi), (4, pi * pi / 2.0)] {
            assert!((log_unit_ball(d) - f64::ln(volume)).abs() < 1e-15, "{d}");
        }
        // The upper triangle is not looked at.
        assert!((cholesky(&mut [4.0, f64::NAN, 2.0, 3.0], 2).unwrap() - 8f64.ln()).abs() < 1e-15);
        assert_eq!(cholesky(&mut [1.0, 2.0, 2.0, 1.0], 2), None);
    }
}
