//! The checker of balls of a kernel.
//!
//! *Problem.* Given rows xₖ, a kernel, and multipliers λᵢ > 0 on few rows, which the checker takes divided by their sum, prove
//! L ≤ J* ≤ J, where J is the objective of the ball with center c = Σ λᵢφ(xᵢ) and squared radius R², and J* the least of all balls.
//! *Distances.* |φ(x) − c|² = Σ λᵢρ(x, xᵢ) − D with D = ½ Σ λᵢλⱼρ(xᵢ, xⱼ), where ρ comes with a bound on its error ([`distance`]).
//! *Upper bound.* Around all points: no squared distance, with its error added, exceeds R², and J = R². Soft: J = R² + Σ ξₖ/(νn) with
//! ξₖ the part of the squared distance above R², errors added.
//! *Lower bound.* D: for any ball of center y and squared radius r² with slacks ξ, Σ λᵢ|φ(xᵢ) − y|² = D + |c − y|² ≤ r² + Σ λᵢξᵢ, and
//! that is at most r² + Σ ξₖ/(νn) where λᵢ ≤ 1/(νn). Where some λᵢ is larger, by a factor of up to s, D/s is a lower bound, as
//! r² + s·Σ ξₖ/(νn) is at most s times the objective.
//! *Rounding.* With k multipliers of sum 1 ± 2(k + 2)u, a sum Σ λᵢρᵢ of k terms is off by the errors of the ρᵢ and by (4k + 12)u of its
//! terms' sizes, the division by the sum of the multipliers included.
//! *Cost.* O(nkd) for n rows, in two passes; of a Gaussian kernel O(nd) and O(kd) for each row that no few distances prove to be inside
//! ([`jensen`](super::jensen)).
//! *Reference.* Tax and Duin, Support vector data description, Mach. Learn. 54, 2004; the duality gap is new here.

use taut_points::{Monitor, PointSource};

use super::distance::{Approximate, kernel_of_itself, of_kernel, squared_distance};
use super::jensen::Bounds;
use super::{Kernel, KernelBall, KernelBallCertificate, KernelBallVerdict, KernelBallViolation};
use crate::arithmetic::{Compensated, U};
use crate::hashed_pass::{KeptRows, WantedRows, all_finite, hashed_pass};
use crate::{CheckError, Violation};

/// The amount by which the gap claimed may fall short of the gap proved, relatively and in units of 1.
const GAP_SLACK: (f64, f64) = (1e-9, 4e-16);

/// How far below 0, in parts of its terms, a squared distance by a precomputed kernel may be: matrices are products that were rounded.
/// That a matrix is positive semidefinite is assumed; this finds those that clearly are not.
const INDEFINITE: f64 = 1e-9;

pub(super) fn check(
    ball: &KernelBall,
    certificate: &KernelBallCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<KernelBallVerdict, CheckError> {
    check_structure(ball, certificate, source)?;
    let claimed = certificate.points_hash;
    monitor.pass(1, source.len());
    let wanted = WantedRows::of(&ball.support);
    let (_, kept) =
        hashed_pass(source, claimed, wanted, monitor, |first, rows| Ok(all_finite(first, rows)?))?;
    let center = Center::new(ball, &kept)?;
    monitor.pass(2, source.len());
    let blocks = hashed_pass(source, claimed, WantedRows::none(), monitor, |first, rows| {
        let mut row = vec![0.0; source.dim()];
        let mut block = Block::default();
        for k in 0..rows.len() {
            rows.copy_row(k, &mut row);
            block.add(&center, first + k as u64, &row)?;
        }
        Ok(block)
    })?;
    let (blocks, _) = blocks;
    let outside = blocks.iter().map(|block| block.outside).sum();
    let slacks: f64 = blocks.iter().map(|block| block.slacks).sum();
    // Sums of rows in a block, then of blocks.
    let terms =
        blocks.iter().map(|block| block.rows).max().unwrap_or(0) as f64 + blocks.len() as f64;
    let slacks = slacks * (1.0 + 2.0 * (terms + 2.0) * U);
    let points = source.len() as f64;
    // A quotient that vanishes is still more than nothing.
    let share = |nu: f64| (slacks / (nu * points) * (1.0 + 6.0 * U)).next_up();
    let share = ball.nu.filter(|_| slacks > 0.0).map_or(0.0, share);
    let upper = (ball.squared_radius + share) * (1.0 + 2.0 * U);
    let lower = center.lower_bound(source.len());
    let gap = match upper {
        0.0 => 0.0,
        _ => ((upper / lower.max(0.0)) * (1.0 + 2.0 * U) - 1.0).next_up().max(0.0),
    };
    let (relative, absolute) = GAP_SLACK;
    // An infinite gap is none, and must not pass as no more than a claim that overflows.
    let is_proved = gap.is_finite() && gap <= certificate.gap * (1.0 + relative) + absolute;
    if !is_proved {
        return Err(Violation::Gap { claimed: certificate.gap, proved: gap }.into());
    }
    Ok(KernelBallVerdict { lower: lower.max(0.0), upper, gap, outside })
}

/// What a block of rows contributes.
#[derive(Default)]
struct Block {
    rows: usize,
    /// Rows that are outside for certain.
    outside: u64,
    /// The sum of ξ.
    slacks: f64,
}

impl Block {
    fn add(&mut self, center: &Center<'_>, number: u64, row: &[f64]) -> Result<(), CheckError> {
        self.rows += 1;
        let squared_radius = center.ball.squared_radius;
        if center.is_surely_inside(row) {
            return Ok(());
        }
        let distance = center.squared_distance(number, row)?;
        let most = (distance.value + distance.error) * (1.0 + U);
        if most <= squared_radius {
            return Ok(());
        }
        // NaN comes here, too.
        if !most.is_finite() {
            return Err(KernelBallViolation::Range { row: number }.into());
        }
        if center.ball.nu.is_none() {
            let squared_distance = most;
            return Err(KernelBallViolation::Outside {
                row: number,
                squared_distance,
                squared_radius,
            }
            .into());
        }
        self.slacks += (most - squared_radius) * (1.0 + 2.0 * U);
        self.outside += u64::from(distance.value - distance.error > squared_radius);
        Ok(())
    }
}

/// The center of the ball with the rows it is made of.
struct Center<'a> {
    ball: &'a KernelBall,
    kept: &'a KeptRows,
    /// The rows of the support with their K(x, x), for kernels of points.
    support: Vec<(&'a [f64], Approximate)>,
    /// D.
    spread: Approximate,
    /// What proves most points to be inside, for a Gaussian kernel.
    jensen: Option<Bounds>,
}

impl<'a> Center<'a> {
    fn new(ball: &'a KernelBall, kept: &'a KeptRows) -> Result<Self, CheckError> {
        let row = |&id: &u64| (kept.row(id), kernel_of_itself(ball.kernel, kept.row(id)));
        let support = ball.support.iter().map(row).collect();
        let mut center =
            Center { ball, kept, support, spread: Approximate::default(), jensen: None };
        let mut sums = vec![];
        for &row in &ball.support {
            sums.push(center.mean_distance(row, kept.row(row))?);
        }
        let mean = center.weighted(sums.into_iter());
        center.spread = Approximate { value: mean.value / 2.0, error: mean.error / 2.0 };
        if !(center.spread.value + center.spread.error).is_finite() {
            return Err(KernelBallViolation::Range { row: ball.support[0] }.into());
        }
        if let Kernel::Gaussian { gamma } = ball.kernel {
            let rows: Vec<&[f64]> = center.support.iter().map(|point| point.0).collect();
            center.jensen = Some(Bounds::of(gamma, &rows, &ball.multipliers));
        }
        Ok(center)
    }

    /// Whether Jensen's bound proves a row to be inside.
    fn is_surely_inside(&self, row: &[f64]) -> bool {
        let Some(bounds) = &self.jensen else { return false };
        let kernel = self.ball.kernel;
        let least = self.spread.value - self.spread.error;
        let is_inside = |bound: f64| (bound - least) * (1.0 + 4.0 * U) <= self.ball.squared_radius;
        let term = |place: usize| {
            let of_row = Approximate::default();
            let distance = squared_distance(kernel, (row, of_row), self.support[place]);
            self.ball.multipliers[place] * (distance.value + distance.error)
        };
        bounds.any(row, term, is_inside)
    }

    /// Σ λᵢ·termᵢ divided by Σ λᵢ.
    fn weighted(&self, terms: impl Iterator<Item = Approximate>) -> Approximate {
        let (mut value, mut size, mut error) = (0.0, 0.0, 0.0);
        for (lambda, term) in self.ball.multipliers.iter().zip(terms) {
            value += lambda * term.value;
            size += lambda * term.value.abs();
            error += lambda * term.error;
        }
        let k = self.ball.multipliers.len() as f64;
        let error = error * (1.0 + (4.0 * k + 12.0) * U) + (4.0 * k + 12.0) * U * size;
        Approximate {
            value,
            error: error * (1.0 + 4.0 * U)
                + k * f64::from_bits(8) * f64::from(u8::from(size > 0.0)),
        }
    }

    /// Σ λᵢρ(x, xᵢ) for row `number`, which is x.
    fn mean_distance(&self, number: u64, x: &[f64]) -> Result<Approximate, CheckError> {
        let support = &self.ball.support;
        if self.ball.kernel != Kernel::Precomputed {
            let (kernel, x) = (self.ball.kernel, (x, kernel_of_itself(self.ball.kernel, x)));
            let distances = self.support.iter().map(|&y| squared_distance(kernel, x, y));
            return Ok(self.weighted(distances));
        }
        let exact = |value| Approximate { value, error: 0.0 };
        for &row in support {
            let (value, other) = (x[row as usize], self.kept.row(row)[number as usize]);
            if value != other {
                let column = row;
                return Err(KernelBallViolation::NotSymmetric {
                    row: number,
                    column,
                    value,
                    other,
                }
                .into());
            }
        }
        let of_itself = exact(x[number as usize]);
        let distance = |row: u64| match row == number {
            true => Approximate::default(),
            false => {
                let of_other = exact(self.kept.row(row)[row as usize]);
                of_kernel(of_itself, of_other, exact(x[row as usize]))
            }
        };
        for &row in support {
            let value = distance(row).value;
            let size = of_itself.value.abs() + self.kept.row(row)[row as usize].abs();
            // NaN is for the sums to refuse.
            if value < -INDEFINITE * size {
                let column = row;
                return Err(KernelBallViolation::Indefinite { row: number, column, value }.into());
            }
        }
        Ok(self.weighted(support.iter().map(|&row| distance(row))))
    }

    /// |φ(x) − c|².
    fn squared_distance(&self, number: u64, x: &[f64]) -> Result<Approximate, CheckError> {
        let mean = self.mean_distance(number, x)?;
        let value = mean.value - self.spread.value;
        let error = (mean.error + self.spread.error) * (1.0 + 4.0 * U) + 2.0 * U * value.abs();
        Ok(Approximate { value, error })
    }

    /// L, rounded down.
    fn lower_bound(&self, points: u64) -> f64 {
        let least = (self.spread.value - self.spread.error) * (1.0 - 2.0 * U);
        let Some(nu) = self.ball.nu else { return least };
        let largest = self.ball.multipliers.iter().copied().fold(0.0, f64::max);
        let slack = 1.0 + (2.0 * self.ball.multipliers.len() as f64 + 16.0) * U;
        let excess = (largest * nu * points as f64 * slack).max(1.0);
        (least / excess * (1.0 - 2.0 * U)).next_down()
    }
}

/// Refusals before any point is read.
fn check_structure(
    ball: &KernelBall,
    certificate: &KernelBallCertificate,
    source: &dyn PointSource,
) -> Result<(), CheckError> {
    ball.kernel.check(source.len(), source.dim())?;
    let number = |what: &str, value: f64, expected| {
        Err(Violation::Number { what: what.to_owned(), value, expected }.into())
    };
    let is_size = |value: f64| value >= 0.0 && value.is_finite();
    if !is_size(ball.squared_radius) {
        return number("the squared radius", ball.squared_radius, "a finite number, at least 0");
    }
    if !is_size(certificate.gap) {
        return number("the claimed gap", certificate.gap, "a finite number, at least 0");
    }
    match ball.nu {
        Some(nu) if !(nu > 0.0 && nu <= 1.0) => {
            return number("nu", nu, "a number above 0, at most 1");
        }
        _ => {}
    }
    if ball.support.is_empty() {
        return Err(Violation::EmptySupport.into());
    }
    let (found, expected) = (ball.multipliers.len(), ball.support.len());
    if found != expected {
        return Err(Violation::Length { what: "the list of multipliers", found, expected }.into());
    }
    for (position, &point) in ball.support.iter().enumerate() {
        let before = position.checked_sub(1).map(|before| ball.support[before]);
        let problem = match before {
            _ if point >= source.len() => "but there are not so many",
            Some(before) if before >= point => "which is not more than the entry before it",
            _ => continue,
        };
        return Err(Violation::Support { position, point, problem }.into());
    }
    let mut sum = Compensated::default();
    for (position, &value) in ball.multipliers.iter().enumerate() {
        if !(value >= f64::MIN_POSITIVE && value.is_finite()) {
            let what = format!("multiplier {position}");
            return number(&what, value, "a finite normal number above 0");
        }
        sum.add(value);
    }
    let mut beside_one = sum;
    beside_one.add(-1.0);
    // As so many rounded quotients have it; the bounds of `weighted` are made for this.
    let is_one = beside_one.known().size() <= 2.0 * (expected + 2) as f64 * U;
    if !is_one {
        return Err(Violation::MultiplierSum { sum: sum.known().high }.into());
    }
    Ok(())
}
