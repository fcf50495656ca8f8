//! A ball around ellipsoids {m + v : vvᵀ ⪯ S}.
//!
//! *Upper bound.* The frame y = f(x − c) with f ≥ 1/R makes the ball one that holds nothing but what |y| ≤ 1 says, and an
//! ellipsoid E reaches to max |y| ≤ √φ(μ) for every μ with μI ≻ f²S,
//!
//! > φ(μ) = μ·(1 + gᵀ(μI − f²S)⁻¹g),  g = f(m − c),
//!
//! as proved in the head of [`reach`](crate::ellipsoid::check::reach), in plain and then in doubled precision. √φ(μ) ≤ 1 is
//! asked without any tolerance; f is 1/R rounded up, so that R must exceed what is needed by an ulp or two.
//! *Lower bound.* Each direction names a point p of its ellipsoid, so the ball holds all pᵢ, and what multipliers prove for
//! points they prove here. With W = Σλᵢ, p̄ = Σλᵢpᵢ/W, tᵢ = |pᵢ − c|² − R² and σ = |p̄ − c|² − Σλᵢtᵢ/W, every ball that holds
//! the pᵢ has a radius of at least √(R² − σ) = R − x, x = σ/(R + √(R² − σ)): the formula of the head of the checker, all
//! rᵢ being 0. The sums are taken in doubled precision, and x, which grows with σ, from σ rounded up.
//! *Rounding.* A point is off by a vector of length εᵢ, so |pᵢ − c|² is by (2|pᵢ − c| + εᵢ)εᵢ; each of the sums over k rows of d
//! coordinates passes at most k + d + 16 roundings.
//! *Trap.* A ball of radius 0 has no such frame: then all ellipsoids must be the point c.

use taut_points::{Monitor, PointSource, ReadError, Rows};

use super::super::{Ball, BallCertificate};
use super::lower_bound::Bound;
use crate::arithmetic::{DoubleDouble, Field, Ring, U};
use crate::ellipsoid::check::enclosure::kind_of;
use crate::ellipsoid::check::frame::Frame;
use crate::ellipsoid::check::item::Item;
use crate::ellipsoid::check::lower_bound::Touching;
use crate::ellipsoid::check::reach;
use crate::hashed_pass::{KeptRows, WantedRows, all_finite, hashed_pass};
use crate::{CheckError, Ellipsoid, Items, Violation};

/// By how much σ may be negative, in units of R²: what rounding the entries of a singular shape matrix does to the points
/// it touches at is less.
const SQUARE_BELOW: f64 = 1e-12;

/// Proves both bounds: one pass, then the rows of the support.
pub(super) fn prove(
    ball: &Ball,
    certificate: &BallCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<Bound, CheckError> {
    let as_ellipsoid = as_ellipsoid(&ball.center, &ball.center_tail, ball.radius);
    let frame = Frame::of(&as_ellipsoid);
    let wanted = WantedRows::of(&certificate.support);
    let claimed = certificate.points_hash;
    let (blocks, support) = hashed_pass(source, claimed, wanted, monitor, |first, rows| {
        all_finite(first, rows)?;
        Ok(block(ball, &frame, first, rows))
    })?;
    blocks.into_iter().collect::<Result<(), _>>()?;
    if ball.radius == 0.0 {
        return Ok(Bound { lower: 0.0, gap: 0.0 });
    }
    lower_bound(ball, certificate, &frame, &support, monitor)
}

/// A ball as the ellipsoid that it is, of which the frame takes F and c.
pub(crate) fn as_ellipsoid(center: &[f64], center_tail: &[f64], radius: f64) -> Ellipsoid {
    let dim = center.len();
    let stretch = if radius > 0.0 { (1.0 / radius).next_up() } else { 0.0 };
    let unit = |i: usize| (0..dim).map(|j| if i == j { stretch } else { 0.0 }).collect();
    Ellipsoid {
        center: center.to_vec(),
        center_tail: center_tail.to_vec(),
        matrix: vec![],
        factor: (0..dim).map(unit).collect(),
        hull: None,
        log_volume: 0.0,
    }
}

/// By how much of the radius an item reaches beyond the ball of a frame; at most 0 where it is known to lie in it. Beyond a ball of
/// radius 0 everything reaches infinitely far but its center.
pub(crate) fn excess(frame: &Frame<'_>, radius: f64, item: &Item<'_>) -> f64 {
    if radius > 0.0 {
        return reach::excess(frame, item);
    }
    let has_tail = (0..frame.dim).any(|j| frame.tail(j) != 0.0);
    let is_center = item.is_point() && !has_tail && item.center() == frame.center;
    if is_center { 0.0 } else { f64::INFINITY }
}

fn block(ball: &Ball, frame: &Frame<'_>, first: u64, rows: &Rows<'_>) -> Result<(), Violation> {
    let mut values = vec![0.0; Items::Ellipsoids.columns(frame.dim)];
    for i in 0..rows.len() {
        rows.copy_row(i, &mut values);
        let row = first + i as u64;
        let item = Item::of(Items::Ellipsoids, frame.dim, &values);
        item.is_valid(row, kind_of(rows))?;
        let (radius, excess) = (ball.radius, excess(frame, ball.radius, &item));
        let is_inside = excess <= 0.0;
        if !is_inside {
            if radius == 0.0 {
                let distance = f64::MIN_POSITIVE;
                return Err(Violation::Outside { row, distance, radius, excess: distance });
            }
            let distance = radius * (1.0 + excess);
            return Err(Violation::Outside { row, distance, radius, excess: radius * excess });
        }
    }
    Ok(())
}

/// Sums over the support, in the units of the frame.
struct Sums {
    weight: DoubleDouble,
    /// Σλᵢtᵢ.
    excess: DoubleDouble,
    /// Σλᵢ(pᵢ − c).
    moment: Vec<DoubleDouble>,
    /// Σλᵢ(|pᵢ − c|² + R²), and what points off by εᵢ do to the two sums.
    size: f64,
    excess_error: f64,
    moment_error: f64,
    count: usize,
}

fn lower_bound(
    ball: &Ball,
    certificate: &BallCertificate,
    frame: &Frame<'_>,
    support: &KeptRows,
    monitor: &Monitor<'_>,
) -> Result<Bound, CheckError> {
    let zero = DoubleDouble::of(0.0);
    let mut sums = Sums {
        weight: zero,
        excess: zero,
        moment: vec![zero; frame.dim],
        size: 0.0,
        excess_error: 0.0,
        moment_error: 0.0,
        count: 0,
    };
    let radius = DoubleDouble::of(ball.radius).scaled(frame.scale);
    let square = radius.times(&radius);
    let each = certificate.support.iter().zip(&certificate.multipliers);
    for ((&id, &lambda), direction) in each.zip(&certificate.directions) {
        monitor.check().map_err(ReadError::from)?;
        let item = Item::of(Items::Ellipsoids, frame.dim, support.row(id));
        let touching = Touching::of(frame, &item, direction);
        let errors = touching.coordinate_errors();
        sums.add(lambda, &touching.offset, errors.as_deref(), &square, frame);
    }
    Ok(sums.bound(ball.radius, radius.rounded())?)
}

impl Sums {
    fn add(
        &mut self,
        lambda: f64,
        offset: &[DoubleDouble],
        errors: Option<&[f64]>,
        square: &DoubleDouble,
        frame: &Frame<'_>,
    ) {
        let weight = DoubleDouble::of(lambda);
        self.weight = self.weight.plus(&weight);
        let mut t = DoubleDouble::of(0.0).minus(square);
        let mut error = 0.0;
        for (j, (x, moment)) in offset.iter().zip(&mut self.moment).enumerate() {
            t = t.plus(&x.times(x));
            *moment = moment.plus(&weight.times(x));
            let tail = (frame.tail(j) * frame.scale).abs();
            error += errors.map_or(0.0, |errors| errors[j])
                + 8.0 * DoubleDouble::ROUNDOFF * (x.rounded().abs() + tail)
                + f64::MIN_POSITIVE;
        }
        self.excess = self.excess.plus(&weight.times(&t));
        let length = offset.iter().map(|x| x.rounded().powi(2)).sum::<f64>().sqrt();
        self.size += lambda * (length * length + square.rounded());
        self.excess_error += lambda * error * (2.0 * length + error);
        self.moment_error += lambda * error;
        self.count += 1;
    }

    /// From the sums to x, and from x to the bounds; `scaled` is R in the units of the frame.
    fn bound(&self, radius: f64, scaled: f64) -> Result<Bound, Violation> {
        let square = scaled * scaled;
        let zero = DoubleDouble::of(0.0);
        let mut sigma = zero.minus(&self.excess.over(&self.weight));
        for moment in &self.moment {
            let mean = moment.over(&self.weight);
            sigma = sigma.plus(&mean.times(&mean));
        }
        let weight = self.weight.rounded() * (1.0 - 8.0 * U);
        let roundings = 4.0 * (self.count + self.moment.len() + 16) as f64 * DoubleDouble::ROUNDOFF;
        // |M|/W ≤ √(Σλ|p − c|²/W), so M² is off by at most (2√(size/W) + error)·error.
        let mean = (self.size / weight).sqrt();
        let moved = self.moment_error / weight;
        let error =
            (roundings * self.size + self.excess_error) / weight + (2.0 * mean + moved) * moved;
        let sigma = (sigma.rounded() + error * (1.0 + 16.0 * U)) * (1.0 + 8.0 * U);
        if !(sigma.is_finite() && square.is_finite()) {
            // Sums beyond the largest number prove nothing.
            return Ok(Bound { lower: 0.0, gap: f64::INFINITY });
        }
        // Points that lie within R of c have tᵢ ≤ 0, so σ ≥ 0.
        if sigma < -SQUARE_BELOW * square {
            return Err(Violation::NegativeGap { gap: 0.5 * sigma / square });
        }
        let sigma = sigma.max(0.0);
        let root = (square - sigma).max(0.0).sqrt();
        let x = (sigma / (scaled + root) * (1.0 + 16.0 * U)).min(scaled);
        if x == 0.0 {
            return Ok(Bound { lower: radius, gap: 0.0 });
        }
        let least = scaled - x;
        let gap = x / least * (1.0 + 8.0 * U);
        let lower = (radius * (1.0 - x / scaled * (1.0 + 8.0 * U))).next_down().max(0.0);
        Ok(Bound { lower, gap: if least > 0.0 { gap } else { f64::INFINITY } })
    }
}
