//! Squared distances in the feature space, each with a bound on its error.
//!
//! *Idea.* All that a ball of a kernel needs is ρ(x, y) = K(x, x) + K(y, y) − 2K(x, y). For the Gaussian kernel this is
//! 2(1 − exp(−γ|x − y|²)), which [`decay`] finds to a few units of the last place however close x and y are; for the linear kernel
//! |x − y|², from differences. So neither loses digits where all points are nearly equal.
//! *Errors.* With u = 2⁻⁵³, a sum of d squared differences is off by at most (d + 6)u of itself, and by d·2⁻¹⁰⁷³ where squares vanish.
//! A dot product is off by (d + 2)u·Σ|xⱼyⱼ|; so γx·y + c by (d + 5)u of γΣ|xⱼyⱼ| + c =: s, and its power by p(d + 7)u·sᵖ, for which
//! 2p(d + 8)u·sᵖ is ample. Where x and y are equal, ρ is 0 without an error.

use super::Kernel;
use crate::arithmetic::{DECAY_ERROR, U, decay};

/// What a sum loses at most where one of its squares vanishes.
const VANISHED: f64 = f64::from_bits(4);

/// A number that is known to within an error.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Approximate {
    pub(super) value: f64,
    pub(super) error: f64,
}

/// K(x, x) where ρ is found from it; 0 elsewhere.
pub(super) fn kernel_of_itself(kernel: Kernel, x: &[f64]) -> Approximate {
    match kernel {
        Kernel::Polynomial { gamma, offset, degree } => polynomial(gamma, offset, degree, x, x),
        _ => Approximate::default(),
    }
}

/// ρ(x, y) for kernels of points; not for a precomputed one. With each point comes its [`kernel_of_itself`].
pub(super) fn squared_distance(
    kernel: Kernel,
    (x, of_x): (&[f64], Approximate),
    (y, of_y): (&[f64], Approximate),
) -> Approximate {
    let dim = x.len() as f64;
    match kernel {
        Kernel::Gaussian { gamma } => {
            let square = squared_difference(x, y);
            if square == 0.0 && x == y {
                return Approximate::default();
            }
            feature_distance(gamma, square, x.len())
        }
        Kernel::Linear | Kernel::Precomputed => {
            let value = squared_difference(x, y);
            let lost = if value == 0.0 && x == y { 0.0 } else { dim * VANISHED };
            Approximate { value, error: (dim + 6.0) * U * value + lost }
        }
        Kernel::Polynomial { .. } if x == y => Approximate::default(),
        Kernel::Polynomial { gamma, offset, degree } => {
            of_kernel(of_x, of_y, polynomial(gamma, offset, degree, x, y))
        }
    }
}

/// 2(1 − e^{−γs}) for a sum s of squared differences in `dim` dimensions.
pub(super) fn feature_distance(gamma: f64, square: f64, dim: usize) -> Approximate {
    let dim = dim as f64;
    let lost = gamma * (dim * VANISHED) + VANISHED;
    let value = 2.0 * decay(gamma * square);
    // An infinite |x − y|² may be one that γ would bring back: what it stands for is unknown.
    let relative = if square.is_finite() { (dim + 8.0) * U + DECAY_ERROR } else { f64::NAN };
    Approximate { value, error: relative * value + 2.0 * lost }
}

/// ρ from K(x, x), K(y, y) and K(x, y).
pub(super) fn of_kernel(of_x: Approximate, of_y: Approximate, both: Approximate) -> Approximate {
    let is_exact = of_x.error == 0.0 && of_y.error == 0.0 && both.error == 0.0;
    if is_exact && of_x.value == both.value && of_y.value == both.value {
        return Approximate::default();
    }
    let value = (of_x.value + of_y.value) - 2.0 * both.value;
    let size = of_x.value.abs() + of_y.value.abs() + 2.0 * both.value.abs();
    let error = of_x.error + of_y.error + 2.0 * both.error + 4.0 * U * size + VANISHED;
    Approximate { value, error: error * (1.0 + 8.0 * U) }
}

pub(super) fn squared_difference(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(a, b)| (a - b) * (a - b)).sum()
}

fn polynomial(gamma: f64, offset: f64, degree: u32, x: &[f64], y: &[f64]) -> Approximate {
    let (mut dot, mut sizes) = (0.0, 0.0);
    for (a, b) in x.iter().zip(y) {
        let product = a * b;
        dot += product;
        sizes += product.abs();
    }
    let (base, size) = (gamma * dot + offset, gamma * sizes + offset);
    let power = |base: f64| (1..degree).fold(base, |power, _| power * base);
    let relative = f64::from(2 * degree) * (x.len() as f64 + 8.0) * U;
    // What vanishes is less than VANISHED for each product, and for each factor after it.
    let lost = (gamma * x.len() as f64 + 2.0) * VANISHED * power(1.0 + size) * f64::from(degree);
    Approximate {
        value: power(base),
        error: relative * power(size) * (1.0 + relative) + 2.0 * lost,
    }
}
