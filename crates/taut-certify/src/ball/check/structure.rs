//! Refusals before any point is read: lengths, ranges, the support and the sum of the multipliers.

use super::super::{Ball, BallCertificate};
use crate::arithmetic::{Compensated, U, two_sum};
use crate::{Items, Violation};

pub(super) fn check(
    ball: &Ball,
    certificate: &BallCertificate,
    n: u64,
    columns: usize,
) -> Result<(), Violation> {
    let dim = certificate.items.dim(columns);
    match certificate.items {
        Items::Balls if dim == 0 => return Err(Violation::NoRadius { columns }),
        Items::Ellipsoids if dim == 0 => return Err(Violation::NoShape { columns }),
        _ => {}
    }
    answer(ball, dim)?;
    number("the claimed gap", certificate.gap)?;
    support(certificate, n)?;
    multipliers(&certificate.multipliers)?;
    directions(certificate.items, &certificate.directions, certificate.support.len(), dim)
}

/// Ellipsoids have a direction of `dim` finite numbers for each of `count` points of theirs, and other items none.
pub(crate) fn directions(
    items: Items,
    directions: &[Vec<f64>],
    count: usize,
    dim: usize,
) -> Result<(), Violation> {
    let expected = if items == Items::Ellipsoids { count } else { 0 };
    length("the list of directions", directions.len(), expected)?;
    for (position, direction) in directions.iter().enumerate() {
        length("a direction", direction.len(), dim)?;
        if let Some(column) = direction.iter().position(|value| !value.is_finite()) {
            let what = format!("coordinate {column} of direction {position}");
            let value = direction[column];
            return Err(Violation::Number { what, value, expected: "a finite number" });
        }
    }
    Ok(())
}

fn answer(ball: &Ball, dim: usize) -> Result<(), Violation> {
    if ball.center.len() != dim {
        return Err(Violation::Dimension { found: ball.center.len(), expected: dim });
    }
    number("the radius", ball.radius)?;
    for (column, &value) in ball.center.iter().enumerate() {
        if !value.is_finite() {
            let what = format!("coordinate {column} of the center");
            return Err(Violation::Number { what, value, expected: "a finite number" });
        }
    }
    if ball.center_tail.is_empty() {
        return Ok(());
    }
    length("the tail of the center", ball.center_tail.len(), dim)?;
    for (column, (&center, &value)) in ball.center.iter().zip(&ball.center_tail).enumerate() {
        // One center has one form: the nearest f64, and what is left.
        if two_sum(center, value) != (center, value) {
            let what = format!("coordinate {column} of the tail of the center");
            let expected = "a number so small that adding it to the coordinate changes nothing";
            return Err(Violation::Number { what, value, expected });
        }
    }
    Ok(())
}

fn support(certificate: &BallCertificate, n: u64) -> Result<(), Violation> {
    let support = &certificate.support;
    if support.is_empty() {
        return Err(Violation::EmptySupport);
    }
    length("the list of multipliers", certificate.multipliers.len(), support.len())?;
    let may_repeat = certificate.items == Items::Ellipsoids;
    for (position, &point) in support.iter().enumerate() {
        let before = position.checked_sub(1).map(|before| support[before]);
        let problem = match before {
            _ if point >= n => "but there are not so many",
            Some(before) if before == point && !may_repeat => "as does the entry before it",
            Some(before) if before > point => "which is less than the entry before it",
            _ => continue,
        };
        return Err(Violation::Support { position, point, problem });
    }
    Ok(())
}

/// Multipliers are positive, and sum to 1 as well as so many `f64` can.
///
/// Rounding each quotient λᵢ/Σλ to `f64` moves their sum by at most u, and a sum Σλ taken in plain `f64` moves all of
/// them by k·u for k numbers; twice that, and a little for small k, is granted.
fn multipliers(multipliers: &[f64]) -> Result<(), Violation> {
    let mut sum = Compensated::default();
    for (position, &value) in multipliers.iter().enumerate() {
        if !(value > 0.0 && value.is_finite()) {
            let what = format!("multiplier {position}");
            return Err(Violation::Number { what, value, expected: "a finite number above 0" });
        }
        sum.add(value);
    }
    let mut beside_one = sum;
    beside_one.add(-1.0);
    if beside_one.known().size() <= 2.0 * (multipliers.len() + 2) as f64 * U {
        Ok(())
    } else {
        Err(Violation::MultiplierSum { sum: sum.known().high })
    }
}

fn length(what: &'static str, found: usize, expected: usize) -> Result<(), Violation> {
    if found == expected { Ok(()) } else { Err(Violation::Length { what, found, expected }) }
}

fn number(what: &str, value: f64) -> Result<(), Violation> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(Violation::Number { what: what.into(), value, expected: "a finite number, at least 0" })
}
