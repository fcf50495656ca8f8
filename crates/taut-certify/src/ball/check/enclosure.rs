//! Tests exactly whether every row lies in the ball, and whether the rows are those the certificate speaks of.
//!
//! *Problem.* |p − c| ≤ ρ with ρ = R − r (R for points), for each of n rows, in one pass.
//! *Idea.* Three stages, each asked only about what the one before left open.
//! 1. Plain: S = Σ fl(pⱼ − cⱼ)² in `f64`, with at least two partial sums. Each difference is off by a factor 1 ± u, each
//!    square passes at most m = d/2 + 16 roundings, and the tail t of the center moves the point by at most |t|. So
//!    |p − c| lies within |t| of √S·(1 ± κ) for κ ≥ mu/2 + 4u; κ = (m + 16)u also covers the rounding of the two
//!    thresholds with which S is compared, and what underflows: less than 2⁻¹⁰⁰⁰, beside ρ² ≥ 2⁻⁵⁰⁸, as ρ ≠ 0 is
//!    no less than 2⁻⁵⁴R.
//! 2. Compensated: |p − c|² − ρ² with the running bound of [`Compensated`](crate::arithmetic::Compensated), at most
//!    1e-27·ρ² for d = 1000. Exact ties of rows like the vertices of a cube end here, when nothing was rounded at all.
//! 3. Exact: the sign of the same in fixed-point numbers of 4352 bits.
//!
//! *Guarantee.* No row is misjudged, so the first row found outside does not depend on threads or instruction sets.
//! *Trap.* NaN satisfies no comparison, so it falls through to the check of finiteness before stage 2.

use std::cmp::Ordering;

use taut_points::{Monitor, PointSource, Points, Rows, Scalar};

use super::super::{Ball, BallCertificate};
use super::difference::{Difference, is_tame_number, underflow};
use super::plain_squares::plain_squares;
use super::scale::Scale;
use crate::arithmetic::{ExactSum, Known, U, two_sum};
use crate::hashed_pass::{KeptRows, WantedRows, hashed_pass};
use crate::{CheckError, Items, Violation};

/// Rows whose plain squares are found at once.
const ROWS: usize = 64;

/// One ball, ready to be compared with rows.
pub(super) struct Enclosure<'a> {
    ball: &'a Ball,
    items: Items,
    scale: Scale,
    /// κ of stage 1.
    kappa: f64,
    /// |t| of stage 1, scaled and rounded up.
    tail: f64,
}

impl<'a> Enclosure<'a> {
    pub(super) fn of(ball: &'a Ball, items: Items) -> Self {
        let dim = ball.center.len();
        let scale = Scale::of(ball.radius);
        let kappa = ((dim / 2 + 16) + 16) as f64 * U;
        let squares: f64 = ball.center_tail.iter().map(|t| (t * scale.up).powi(2)).sum();
        // The second term is there for squares that underflow.
        let tail = match ball.center_tail.iter().all(|&t| t == 0.0) {
            true => 0.0,
            false => squares.sqrt() * (1.0 + (dim + 8) as f64 * U) + dim as f64 * 2f64.powi(-500),
        };
        Enclosure { ball, items, scale, kappa, tail }
    }

    /// Reads all rows once; returns those of the support.
    pub(super) fn check(
        &self,
        source: &dyn PointSource,
        certificate: &BallCertificate,
        monitor: &Monitor<'_>,
    ) -> Result<KeptRows, CheckError> {
        let wanted = WantedRows::of(&certificate.support);
        let claimed = certificate.points_hash;
        let (blocks, kept) = hashed_pass(source, claimed, wanted, monitor, |first, rows| {
            Ok(self.block(first, rows)?)
        })?;
        match blocks.into_iter().flatten().next() {
            Some(violation) => Err(violation.into()),
            None => Ok(kept),
        }
    }

    /// The first row of a block that is outside; an error if a row is no point or ball at all.
    pub(super) fn block(
        &self,
        first: u64,
        rows: &Rows<'_>,
    ) -> Result<Option<Violation>, Violation> {
        match rows {
            Rows::F32(points) => self.rows(first, points),
            Rows::F64(points) => self.rows(first, points),
        }
    }

    /// The first row outside; an error if a row is no point or ball at all.
    fn rows<T: Scalar>(
        &self,
        first: u64,
        points: &Points<'_, T>,
    ) -> Result<Option<Violation>, Violation> {
        let mut outside = None;
        let mut difference = Difference::new(self.ball.center.len());
        let thresholds_of_points = self.thresholds(self.ball.radius);
        let (mut wide, mut squares) = (vec![], [0.0; ROWS]);
        let numbered = (first..).step_by(ROWS).zip(points.values().chunks(ROWS * points.dim()));
        for (first, values) in numbered {
            let squares = &mut squares[..values.len() / points.dim()];
            let center = &self.ball.center;
            plain_squares(values, center, self.scale.up, &mut wide, squares);
            let rows = values.chunks_exact(points.dim()).zip(squares);
            for (number, (row, &mut plain)) in (first..).zip(rows) {
                let (position, r) = item(self.items, row);
                let (inside, beyond) = match self.items {
                    Items::Balls => self.thresholds(self.ball.radius - r),
                    _ => thresholds_of_points,
                };
                if plain < inside && r >= 0.0 {
                    continue;
                }
                is_valid(number, row, r)?;
                if outside.is_some() {
                    continue;
                }
                if plain > beyond
                    || self.ball.radius < r
                    || self.is_outside(position, r, &mut difference)
                {
                    outside = Some(self.violation(number, position, r, &mut difference));
                }
            }
        }
        Ok(outside)
    }

    /// The values below and above which the plain square tells a row at distance at most `rho` from others.
    #[inline(always)]
    fn thresholds(&self, rho: f64) -> (f64, f64) {
        let rho = rho * self.scale.up;
        let inside = (rho * (1.0 - self.kappa) - self.tail).max(0.0);
        let beyond = (rho + self.tail) * (1.0 + self.kappa);
        (inside * inside, beyond * beyond)
    }

    /// Stages 2 and 3, for finite rows with r ≤ R.
    fn is_outside<T: Scalar>(&self, position: &[T], r: f64, difference: &mut Difference) -> bool {
        let Ball { center, center_tail, radius } = self.ball;
        if *radius == r {
            // Only the center itself is left. A tail other than 0 is no part of any f64.
            return center_tail.iter().any(|&t| t != 0.0)
                || position.iter().zip(center).any(|(&x, &c)| x.into() != c);
        }
        difference.fill(position, self.ball, self.scale);
        let excess = excess_square(difference, *radius, r, self.scale);
        let bound = excess.error + underflow(position.len());
        if excess.high.abs() * (1.0 - 4.0 * U) > bound {
            return excess.high > 0.0;
        }
        let is_exact = excess.error == 0.0
            && is_tame_number(two_sum(*radius, -r).1)
            && difference.is_tame(self.scale);
        if excess.high == 0.0 && is_exact {
            return false;
        }
        self.is_outside_exactly(position, r)
    }

    fn is_outside_exactly<T: Scalar>(&self, position: &[T], r: f64) -> bool {
        let Ball { center, center_tail, radius } = self.ball;
        let mut sum = ExactSum::zero();
        for (column, (&x, &c)) in position.iter().zip(center).enumerate() {
            let (high, low) = match two_sum(x.into(), -c) {
                (high, low) if high.is_finite() => (high, low),
                _ => (x.into(), -c),
            };
            let tail = center_tail.get(column).map_or(0.0, |t| -t);
            sum.add_square(&[high, low, tail]);
        }
        sum.subtract_square(&[*radius, -r]);
        sum.sign() == Ordering::Greater
    }

    /// Returns how far row `number` reaches from the center, for people to read.
    fn violation<T: Scalar>(
        &self,
        row: u64,
        position: &[T],
        r: f64,
        difference: &mut Difference,
    ) -> Violation {
        let radius = self.ball.radius;
        difference.fill(position, self.ball, self.scale);
        let length = difference.square().known().high.sqrt();
        let rho = (radius - r) * self.scale.up;
        if (1e-70..1e70).contains(&length) && rho >= 0.0 {
            let excess = excess_square(difference, radius, r, self.scale).high / (length + rho);
            let distance = length * self.scale.down + r;
            return Violation::Outside { row, distance, radius, excess: excess * self.scale.down };
        }
        // Far from the scale of this ball no small excess is at stake, nor the tail of the center.
        let distance = distance(position, &self.ball.center) + r;
        Violation::Outside { row, distance, radius, excess: distance - radius }
    }
}

/// |p − c| to a few units in the last place, whatever its size.
fn distance<T: Scalar>(position: &[T], center: &[f64]) -> f64 {
    let differences = || position.iter().zip(center).map(|(&x, &c)| x.into() - c);
    let largest = differences().fold(0.0, |m: f64, d| m.max(d.abs()));
    if largest == 0.0 || largest.is_infinite() {
        return largest;
    }
    largest * differences().map(|d| (d / largest).powi(2)).sum::<f64>().sqrt()
}

/// |p − c|² − (R − r)² for the difference p − c that was filled in, all of it scaled; [`underflow`] comes on top.
pub(super) fn excess_square(difference: &Difference, radius: f64, r: f64, scale: Scale) -> Known {
    let mut sum = difference.square();
    let (rho, error) = two_sum(radius, -r);
    sum.add_square(-1.0, rho * scale.up, error * scale.up);
    sum.known()
}

/// Position and radius of a row.
#[inline(always)]
pub(super) fn item<T: Scalar>(items: Items, row: &[T]) -> (&[T], f64) {
    match (items, row) {
        (Items::Balls, [position @ .., r]) => (position, (*r).into()),
        _ => (row, 0.0),
    }
}

/// Refuses rows that are no point or ball.
fn is_valid<T: Scalar>(number: u64, row: &[T], r: f64) -> Result<(), Violation> {
    for (column, &value) in row.iter().enumerate() {
        let value: f64 = value.into();
        if !value.is_finite() {
            return Err(Violation::NonFinite { row: number, column, value });
        }
    }
    if r >= 0.0 { Ok(()) } else { Err(Violation::NegativeRadius { row: number, value: r }) }
}
