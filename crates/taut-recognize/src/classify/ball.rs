//! The smallest ball of a Gaussian kernel around each class, hard or soft (thesis, 7.6).
//!
//! *Idea.* With the center c = Σ λᵢφ(xᵢ), the squared distance of a point is |φ(x) − c|² = Σ λᵢρ(x, xᵢ) − D, where
//! ρ(x, y) = 2(1 − exp(−γ|x − y|²)) and D = ½ Σ λᵢλⱼρ(xᵢ, xⱼ). The Voronoi rule compares these; the power rule subtracts R², which is
//! the better one where classes have balls of unequal size.
//! *Trap.* Far from all points every kernel value is 0 in double precision. Then distances differ by D only, and are equal where classes
//! have one point each: the logarithm of Σ λᵢ exp(−γ|x − xᵢ|²) breaks such ties.

use serde::{Deserialize, Serialize};
use taut_certify::Kernel;
use taut_enclose::{KernelBallMethod, KernelBallOptions, kernel_ball};
use taut_points::parallel::IntoParallel;
use taut_points::{Monitor, Points, shown_number};

use super::data::Rows;
use super::method::Cells;
use super::width::squared_distance;
use super::{Classifier, Score};
use crate::Error;

/// Sums of kernel values below this have lost digits: their logarithm is found from exponents.
const SUM_MIN: f64 = 1e-290;

/// A ball for each class.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Balls {
    gamma: f64,
    dim: usize,
    cells: Cells,
    balls: Vec<Ball>,
}

/// The ball of one class.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Ball {
    /// The rows of the support, one after the other.
    rows: Vec<f64>,
    /// λᵢ > 0; they sum to 1.
    multipliers: Vec<f64>,
    /// D.
    spread: f64,
    /// R².
    squared_radius: f64,
}

/// What a ball is learned with.
#[derive(Clone, Copy)]
pub(super) struct BallParameters {
    pub(super) gamma: f64,
    pub(super) cells: Cells,
    pub(super) nu: Option<f64>,
    pub(super) steps: Option<u64>,
    pub(super) epsilon: f64,
    pub(super) seed: u64,
}

impl Balls {
    pub(super) fn learn(
        rows: &Rows,
        parameters: &BallParameters,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        let of_class = |class| Ball::learn(&rows.of_class(class), rows.dim, parameters, monitor);
        let balls: Vec<Result<Ball, Error>> =
            (0..rows.classes).into_par_iter().map(of_class).collect();
        let balls = balls.into_iter().collect::<Result<_, _>>()?;
        Ok(Balls { gamma: parameters.gamma, dim: rows.dim, cells: parameters.cells, balls })
    }

    pub(super) fn is_sound(&self, dim: usize, classes: usize) -> bool {
        let is_ball = |ball: &Ball| {
            !ball.multipliers.is_empty() && ball.rows.len() == ball.multipliers.len() * dim
        };
        self.dim == dim
            && self.gamma > 0.0
            && self.balls.len() == classes
            && self.balls.iter().all(is_ball)
    }
}

impl Ball {
    fn learn(
        values: &[f64],
        dim: usize,
        parameters: &BallParameters,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        let BallParameters { gamma, nu, steps, epsilon, seed, .. } = *parameters;
        let points = Points::new(values, dim).map_err(taut_points::ReadError::from)?;
        let options = KernelBallOptions {
            kernel: Kernel::Gaussian { gamma },
            nu,
            epsilon,
            method: match steps {
                Some(_) => KernelBallMethod::Thesis,
                None => KernelBallMethod::WorkingSet,
            },
            steps: steps.unwrap_or(2),
            seed,
            monitor: *monitor,
            ..KernelBallOptions::default()
        };
        let found = kernel_ball(&points, &options)?.answer;
        let rows: Vec<f64> =
            found.support.iter().flat_map(|&i| points.row(i as usize)).copied().collect();
        let mut ball = Ball {
            rows,
            multipliers: found.multipliers,
            spread: 0.0,
            squared_radius: found.squared_radius,
        };
        let support = ball.rows.chunks_exact(dim).zip(&ball.multipliers);
        let weighted = support.map(|(x, l)| l * ball.at(x, gamma, dim).mean_distance);
        ball.spread = weighted.sum::<f64>() / 2.0;
        Ok(ball)
    }

    /// Σ λᵢρ(x, xᵢ), and the sum of kernel values.
    fn at(&self, x: &[f64], gamma: f64, dim: usize) -> At {
        let (mut mean_distance, mut sum) = (0.0, 0.0);
        for (y, l) in self.rows.chunks_exact(dim).zip(&self.multipliers) {
            let exponent = -gamma * squared_distance(x, y);
            mean_distance -= 2.0 * l * exponent.exp_m1();
            sum += l * exponent.exp();
        }
        At { mean_distance, sum }
    }

    /// log Σ λᵢ exp(−γ|x − xᵢ|²), by the largest exponent.
    fn log_sum(&self, x: &[f64], gamma: f64, dim: usize) -> f64 {
        let exponents: Vec<f64> =
            self.rows.chunks_exact(dim).map(|y| -gamma * squared_distance(x, y)).collect();
        let largest = exponents.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if largest == f64::NEG_INFINITY {
            return largest;
        }
        let parts = exponents.iter().zip(&self.multipliers);
        largest + parts.map(|(e, l)| l * (e - largest).exp()).sum::<f64>().ln()
    }
}

/// What a ball says of a point.
struct At {
    mean_distance: f64,
    sum: f64,
}

impl Classifier for Balls {
    fn dim(&self) -> usize {
        self.dim
    }

    fn classes(&self) -> usize {
        self.balls.len()
    }

    fn scores(&self, x: &[f64], out: &mut [Score]) {
        for (ball, out) in self.balls.iter().zip(out) {
            let At { mean_distance, sum } = ball.at(x, self.gamma, self.dim);
            let squared = mean_distance - ball.spread;
            let value = match self.cells {
                Cells::Voronoi => -squared,
                Cells::Power => ball.squared_radius - squared,
            };
            let tie = if sum > SUM_MIN { sum.ln() } else { ball.log_sum(x, self.gamma, self.dim) };
            *out = Score { value, tie };
        }
    }
}

/// Refuses a ν that is out of its range.
pub(super) fn check_nu(nu: Option<f64>) -> Result<(), Error> {
    match nu {
        Some(nu) if !(nu > 0.0 && nu <= 1.0) => {
            Err(Error::option("nu", shown_number(nu), "a number above 0, at most 1"))
        }
        _ => Ok(()),
    }
}
