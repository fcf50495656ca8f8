//! Balls in the feature space of a kernel.

use taut::certify::Kernel;
use taut::enclose::{KernelBallMethod, KernelBallOptions, kernel_ball};

use super::{Case, Input, cases, clouds, document};

/// Returns the cases of balls of a kernel.
pub fn all() -> Vec<Case> {
    let mut found = vec![];
    for (dim, count) in [(1, 6), (2, 9), (3, 8)] {
        found.extend(cases(clouds::points(dim, count), |input| {
            let gaussian = |gamma| Kernel::Gaussian { gamma };
            let polynomial = Kernel::Polynomial { gamma: 0.5, offset: 1.0, degree: 3 };
            let kernels =
                [gaussian(0.4), gaussian(1e-9), gaussian(30.0), polynomial, Kernel::Linear];
            kernels
                .iter()
                .flat_map(|&kernel| [None, Some(0.3)].map(|nu| of(input, kernel, nu)))
                .collect()
        }));
    }
    let matrices = [("gram", gram(7, 0.3)), ("identity", gram(5, 1e9))];
    let inputs = matrices.map(|(name, values)| {
        let n = values.len().isqrt();
        Input::new(name, values, n)
    });
    found.extend(cases(inputs.to_vec(), |input| {
        [None, Some(0.4)].map(|nu| of(input, Kernel::Precomputed, nu)).to_vec()
    }));
    found
}

fn of(input: &Input, kernel: Kernel, nu: Option<f64>) -> (String, Option<serde_json::Value>) {
    let method = match (kernel, nu) {
        (Kernel::Gaussian { gamma: 30.0 }, None) => KernelBallMethod::Thesis,
        _ => KernelBallMethod::WorkingSet,
    };
    let options = KernelBallOptions { kernel, nu, method, steps: 12, ..Default::default() };
    let found = input.with(|source| kernel_ball(source, &options));
    (format!("{kernel:?}, ν = {nu:?}"), found.ok().map(|found| document(&found)))
}

/// The Gaussian kernel of points on a parabola.
fn gram(n: usize, gamma: f64) -> Vec<f64> {
    let at = |i: usize| [i as f64, (i * i) as f64 / 4.0];
    let entry = |k: usize| {
        let (a, b) = (at(k / n), at(k % n));
        (-gamma * ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2))).exp()
    };
    (0..n * n).map(entry).collect()
}
