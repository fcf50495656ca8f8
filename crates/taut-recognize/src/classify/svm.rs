//! Support vector machines with squared slacks, as minimum enclosing balls.
//!
//! *Problem.* Minimize ½|w|² + ½b² − ρ + ½C·Σξᵢ² with yᵢ(w·φ(xᵢ) + b) ≥ ρ − ξᵢ, where yᵢ = ±1.
//! *Idea.* Its dual is to minimize λᵀK̃λ over λ ≥ 0 with Σλ = 1, where K̃ᵢⱼ = yᵢyⱼ(K(xᵢ, xⱼ) + 1) + [i = j]/C. For a Gaussian kernel the
//! diagonal of K̃ is the constant κ = 2 + 1/C, and so this is the dual of the minimum enclosing ball of the kernel K̃: one solver serves
//! both. Divided by ρ = λᵀK̃λ, which depends on the scale of λ, the sum f(x) = Σ λᵢyᵢ(K(xᵢ, x) + 1)/ρ is 1 less the slack on the border,
//! as usual, so that machines of several classes can be compared.
//! *Guarantee.* A relative gap δ of the squared radius is an absolute one of at most κδ in λᵀK̃λ, which is at least 1/(nC) as K̃ − I/C is
//! positive semidefinite. So δ = ε/(n(2C + 1)) gives the relative gap ε.
//! *Reference.* Tsang, Kwok and Cheung, Core vector machines, JMLR 6, 2005.

use serde::{Deserialize, Serialize};
use taut_certify::Kernel;
use taut_enclose::{KernelBallOptions, kernel_ball};
use taut_points::parallel::{IntoParallel, ParallelSlice};
use taut_points::{Monitor, Points, ReadError, shown_number, try_reserve_exact};

use super::data::Rows;
use super::width::squared_distance;
use super::{Classifier, Score};
use crate::Error;

/// The least gap of a ball: below it rounding decides.
const GAP_MIN: f64 = 1e-14;

/// Machines of one class against the others; for two classes, one machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Svm {
    gamma: f64,
    dim: usize,
    /// The rows that some machine uses, one after the other.
    rows: Vec<f64>,
    /// λᵢyᵢ/ρ: for each row those of all machines.
    coefficients: Vec<f64>,
    machines: usize,
}

impl Svm {
    pub(super) fn learn(
        rows: &Rows,
        gamma: f64,
        cost: f64,
        epsilon: f64,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        if rows.classes < 2 {
            let needs = "a support vector machine needs two";
            return Err(Error::ClassCount { classes: rows.classes, needs });
        }
        if !(cost > 0.0 && cost.is_finite() && (1.0 / cost).is_finite()) {
            return Err(Error::option("cost", shown_number(cost), "a finite number above 0"));
        }
        let n = rows.len();
        let gram = gram(rows, gamma)?;
        let machines = if rows.classes == 2 { 1 } else { rows.classes };
        let solved: Vec<Result<Vec<f64>, Error>> = (0..machines)
            .into_par_iter()
            .map(|machine| {
                // Of two classes the machine is that of the second.
                let class = if machines == 1 { 1 } else { machine };
                let sign = |i: usize| if rows.labels[i] as usize == class { 1.0 } else { -1.0 };
                let signs: Vec<f64> = (0..n).map(sign).collect();
                coefficients(&gram, &signs, cost, epsilon, monitor)
            })
            .collect();
        let solved = solved.into_iter().collect::<Result<Vec<_>, _>>()?;
        let used: Vec<usize> =
            (0..n).filter(|&i| solved.iter().any(|machine| machine[i] != 0.0)).collect();
        Ok(Svm {
            gamma,
            dim: rows.dim,
            rows: used.iter().flat_map(|&i| rows.row(i)).copied().collect(),
            coefficients: used
                .iter()
                .flat_map(|&i| solved.iter().map(move |machine| machine[i]))
                .collect(),
            machines,
        })
    }

    pub(super) fn is_sound(&self, dim: usize, classes: usize) -> bool {
        let machines = if classes == 2 { 1 } else { classes };
        self.dim == dim
            && classes >= 2
            && self.machines == machines
            && self.gamma > 0.0
            && self.rows.len().is_multiple_of(dim)
            && self.coefficients.len() == self.rows.len() / dim * machines
    }
}

/// K(xᵢ, xⱼ) + 1 for all pairs.
fn gram(rows: &Rows, gamma: f64) -> Result<Vec<f64>, Error> {
    let n = rows.len();
    let mut gram = square(n)?;
    gram.par_chunks_mut(n).enumerate().for_each(|(i, out)| {
        for (j, out) in out.iter_mut().enumerate() {
            // The same order of both points for both halves.
            let (x, y) = (rows.row(i.max(j)), rows.row(i.min(j)));
            *out = (-gamma * squared_distance(x, y)).exp() + 1.0;
        }
    });
    Ok(gram)
}

/// An n × n matrix of zeros, if there is memory for it.
fn square(n: usize) -> Result<Vec<f64>, Error> {
    let too_large = || Error::TooLarge { points: n };
    let size = n.checked_mul(n).ok_or_else(too_large)?;
    let mut matrix = vec![];
    try_reserve_exact(&mut matrix, size).map_err(|_| too_large())?;
    matrix.resize(size, 0.0);
    Ok(matrix)
}

/// λᵢyᵢ/ρ of one machine.
fn coefficients(
    gram: &[f64],
    signs: &[f64],
    cost: f64,
    epsilon: f64,
    monitor: &Monitor<'_>,
) -> Result<Vec<f64>, Error> {
    let n = signs.len();
    let mut matrix = square(n)?;
    for i in 0..n {
        for j in 0..n {
            matrix[i * n + j] = signs[i] * signs[j] * gram[i * n + j];
        }
        matrix[i * n + i] += 1.0 / cost;
    }
    let points = Points::new(&matrix, n).map_err(ReadError::from)?;
    let options = KernelBallOptions {
        kernel: Kernel::Precomputed,
        epsilon: (epsilon / (n as f64 * (2.0 * cost + 1.0))).max(GAP_MIN),
        monitor: *monitor,
        ..KernelBallOptions::default()
    };
    let ball = kernel_ball(&points, &options)?.answer;
    let mut lambda = vec![0.0; n];
    for (&i, &l) in ball.support.iter().zip(&ball.multipliers) {
        lambda[i as usize] = l;
    }
    let of_row = |i: usize| (0..n).map(|j| matrix[i * n + j] * lambda[j]).sum::<f64>();
    let rho: f64 = ball.support.iter().map(|&i| lambda[i as usize] * of_row(i as usize)).sum();
    if !(rho > 0.0 && rho.recip().is_finite()) {
        return Err(Error::Overflow);
    }
    Ok(lambda.iter().zip(signs).map(|(l, sign)| l * sign / rho).collect())
}

impl Classifier for Svm {
    fn dim(&self) -> usize {
        self.dim
    }

    fn classes(&self) -> usize {
        self.machines.max(2)
    }

    fn scores(&self, x: &[f64], out: &mut [Score]) {
        let mut sums = vec![0.0; self.machines];
        let rows = self.rows.chunks_exact(self.dim);
        for (y, coefficients) in rows.zip(self.coefficients.chunks_exact(self.machines)) {
            let value = (-self.gamma * squared_distance(x, y)).exp() + 1.0;
            for (sum, coefficient) in sums.iter_mut().zip(coefficients) {
                *sum += coefficient * value;
            }
        }
        match sums[..] {
            [only] => {
                out[0] = Score { value: -only, tie: 0.0 };
                out[1] = Score { value: only, tie: 0.0 };
            }
            _ => {
                for (out, value) in out.iter_mut().zip(sums) {
                    *out = Score { value, tie: 0.0 };
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points of two classes that overlap, by a fixed recipe.
    fn overlapping(n: usize) -> Rows {
        let angle = |i: usize| (i * i + 7 * i) as f64 * 0.613;
        let values = (0..n)
            .flat_map(|i| {
                let shift = if i % 2 == 0 { 0.0 } else { 1.2 };
                [shift + angle(i).cos(), angle(i + 3).sin() * 1.5]
            })
            .collect();
        Rows { values, dim: 2, labels: (0..n).map(|i| (i % 2) as u32).collect(), classes: 2 }
    }

    /// The optimum of λᵀK̃λ by another way: the active set, solved by Gaussian elimination in each step (Wolfe's minimum norm point).
    fn reference(matrix: &[f64], n: usize) -> Vec<f64> {
        let mut active = vec![0usize];
        let mut lambda = vec![0.0; n];
        lambda[0] = 1.0;
        loop {
            let gradient: Vec<f64> =
                (0..n).map(|i| (0..n).map(|j| matrix[i * n + j] * lambda[j]).sum()).collect();
            let value: f64 = lambda.iter().zip(&gradient).map(|(l, g)| l * g).sum();
            let next = (0..n).min_by(|&i, &j| gradient[i].total_cmp(&gradient[j])).unwrap();
            if gradient[next] >= value * (1.0 - 1e-13) || active.contains(&next) {
                return lambda;
            }
            active.push(next);
            loop {
                let solved = equal_gradients(matrix, n, &active);
                if solved.iter().all(|&l| l > 0.0) {
                    lambda.fill(0.0);
                    active.iter().zip(&solved).for_each(|(&i, &l)| lambda[i] = l);
                    break;
                }
                // As far as the first multiplier that becomes 0.
                let ratio = |(&i, &l): (&usize, &f64)| {
                    if l > 0.0 { f64::INFINITY } else { lambda[i] / (lambda[i] - l) }
                };
                let step = active.iter().zip(&solved).map(ratio).fold(1.0, f64::min);
                for (&i, &l) in active.iter().zip(&solved) {
                    lambda[i] += step * (l - lambda[i]);
                }
                active.retain(|&i| lambda[i] > 1e-15);
                (0..n).filter(|i| !active.contains(i)).for_each(|i| lambda[i] = 0.0);
            }
        }
    }

    /// λ with sum 1 on the active rows, all gradients being equal there.
    fn equal_gradients(matrix: &[f64], n: usize, active: &[usize]) -> Vec<f64> {
        let k = active.len();
        let mut a: Vec<Vec<f64>> = active
            .iter()
            .map(|&i| active.iter().map(|&j| matrix[i * n + j]).chain([1.0]).collect())
            .collect();
        for p in 0..k {
            let pivot = (p..k).max_by(|&i, &j| a[i][p].abs().total_cmp(&a[j][p].abs())).unwrap();
            a.swap(p, pivot);
            for i in p + 1..k {
                let factor = a[i][p] / a[p][p];
                for j in p..=k {
                    a[i][j] -= factor * a[p][j];
                }
            }
        }
        let mut x = vec![0.0; k];
        for p in (0..k).rev() {
            let rest: f64 = (p + 1..k).map(|j| a[p][j] * x[j]).sum();
            x[p] = (a[p][k] - rest) / a[p][p];
        }
        let sum: f64 = x.iter().sum();
        x.into_iter().map(|x| x / sum).collect()
    }

    #[test]
    fn the_dual_is_that_of_a_reference_solver() {
        let rows = overlapping(40);
        for (gamma, cost) in [(0.5, 1.0), (2.0, 10.0), (0.1, 0.3), (1.0, 100.0)] {
            let gram = gram(&rows, gamma).unwrap();
            let signs: Vec<f64> =
                rows.labels.iter().map(|&label| if label == 1 { 1.0 } else { -1.0 }).collect();
            let n = rows.len();
            let found = coefficients(&gram, &signs, cost, 1e-9, &Monitor::silent()).unwrap();
            let matrix: Vec<f64> = (0..n * n)
                .map(|at| {
                    let (i, j) = (at / n, at % n);
                    signs[i] * signs[j] * gram[at] + if i == j { 1.0 / cost } else { 0.0 }
                })
                .collect();
            let value = |lambda: &[f64]| -> f64 {
                (0..n * n).map(|at| lambda[at / n] * matrix[at] * lambda[at % n]).sum()
            };
            // Σ|λy/ρ| = 1/ρ brings back λ, on the simplex.
            let scale: f64 = found.iter().map(|c| c.abs()).sum();
            let lambda: Vec<f64> = found.iter().zip(&signs).map(|(c, y)| c * y / scale).collect();
            assert!(lambda.iter().all(|&l| l >= 0.0));
            let (ours, theirs) = (value(&lambda), value(&reference(&matrix, n)));
            assert!((ours / theirs - 1.0).abs() < 1e-8, "{gamma} {cost}: {ours} {theirs}");
            assert!((1.0 / scale / ours - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn support_vectors_have_the_slack_of_their_multiplier() {
        // yf = 1 − ξ/ρ with ξᵢ = λᵢ/C wherever λᵢ > 0, and yf ≥ 1 elsewhere.
        let rows = overlapping(30);
        let svm = Svm::learn(&rows, 0.7, 5.0, 1e-10, &Monitor::silent()).unwrap();
        let mut out = [Score::default(); 2];
        let kept = svm.rows.chunks_exact(2).zip(&svm.coefficients);
        for (x, coefficient) in kept {
            svm.scores(x, &mut out);
            let (f, y) = (out[1].value, coefficient.signum());
            assert!((y * f - (1.0 - coefficient.abs() / 5.0)).abs() < 1e-5, "{f} {coefficient}");
        }
        for (x, class) in rows.iter() {
            svm.scores(x, &mut out);
            assert!(out[class].value > 1.0 - 1e-5 || svm.rows.chunks_exact(2).any(|row| row == x));
        }
    }

    #[test]
    fn bad_costs_and_single_classes_are_refused() {
        let rows = overlapping(4);
        for cost in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-320] {
            assert!(Svm::learn(&rows, 1.0, cost, 1e-6, &Monitor::silent()).is_err());
        }
        let single = Rows { labels: vec![0; 4], classes: 1, ..rows };
        let refused = Svm::learn(&single, 1.0, 1.0, 1e-6, &Monitor::silent()).unwrap_err();
        assert_eq!(refused.to_string(), "there is 1 class: a support vector machine needs two");
    }
}
