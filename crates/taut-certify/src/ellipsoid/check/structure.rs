//! Refusals before any point is read: lengths, ranges, the lists of rows and the sum of the multipliers.

use super::super::{Ellipsoid, EllipsoidCertificate, Hull};
use crate::arithmetic::{Compensated, U, two_sum};
use crate::{Items, Violation};

pub(crate) fn check(
    ellipsoid: &Ellipsoid,
    certificate: &EllipsoidCertificate,
    n: u64,
    columns: usize,
) -> Result<(), Violation> {
    let dim = certificate.items.dim(columns);
    match certificate.items {
        Items::Balls if dim == 0 => return Err(Violation::NoRadius { columns }),
        Items::Ellipsoids if dim == 0 => return Err(Violation::NoShape { columns }),
        _ => {}
    }
    answer(ellipsoid, dim)?;
    at_least_zero("the claimed gap", certificate.gap)?;
    lists_of_rows(certificate, n)?;
    multipliers(&certificate.multipliers, certificate.support.len())?;
    directions(certificate, dim)
}

fn answer(ellipsoid: &Ellipsoid, dim: usize) -> Result<(), Violation> {
    let Ellipsoid { center, factor, hull, .. } = ellipsoid;
    if center.len() != dim {
        return Err(Violation::Dimension { found: center.len(), expected: dim });
    }
    finite(center, |column| format!("coordinate {column} of the center"))?;
    tail(ellipsoid)?;
    match hull {
        None => length("the factor", factor.len(), dim)?,
        Some(_) if factor.len() >= dim => {
            return Err(Violation::NeedlessHull { rank: factor.len(), dim });
        }
        Some(Hull { basis, distance }) => {
            length("the basis of the hull", basis.len(), factor.len())?;
            table("the basis of the hull", basis, dim)?;
            at_least_zero("the distance from the hull", *distance)?;
        }
    }
    table("the factor", factor, dim)?;
    length("the matrix", ellipsoid.matrix.len(), dim)?;
    table("the matrix", &ellipsoid.matrix, dim)?;
    finite(&[ellipsoid.log_volume], |_| "the log-volume".into())
}

/// Tests whether the tail of the center, if there is one, is what rounding the center leaves over.
pub(crate) fn tail(ellipsoid: &Ellipsoid) -> Result<(), Violation> {
    let Ellipsoid { center, center_tail, .. } = ellipsoid;
    if center_tail.is_empty() {
        return Ok(());
    }
    length("the tail of the center", center_tail.len(), center.len())?;
    for (column, (&center, &value)) in center.iter().zip(center_tail).enumerate() {
        // One center has one form: the nearest f64, and what is left.
        if two_sum(center, value) != (center, value) {
            let what = format!("coordinate {column} of the tail of the center");
            let expected = "a number so small that adding it to the coordinate changes nothing";
            return Err(Violation::Number { what, value, expected });
        }
    }
    Ok(())
}

fn lists_of_rows(certificate: &EllipsoidCertificate, n: u64) -> Result<(), Violation> {
    let EllipsoidCertificate { support, left_out, .. } = certificate;
    if support.is_empty() {
        return Err(Violation::EmptySupport);
    }
    let may_repeat = certificate.items != Items::Points;
    if let Some((position, point, problem)) = disorder(support, n, may_repeat) {
        return Err(Violation::Support { position, point, problem });
    }
    if let Some((position, row, problem)) = disorder(left_out, n, false) {
        return Err(Violation::LeftOut { position, row, problem });
    }
    let both = |row: &u64| support.binary_search(row).is_ok();
    match left_out.iter().position(both) {
        Some(position) => {
            let problem = "which is in the support";
            Err(Violation::LeftOut { position, row: left_out[position], problem })
        }
        None => Ok(()),
    }
}

/// The first entry of a list of rows that is out of range or out of order.
fn disorder(rows: &[u64], n: u64, may_repeat: bool) -> Option<(usize, u64, &'static str)> {
    rows.iter().enumerate().find_map(|(position, &row)| {
        let before = position.checked_sub(1).map(|before| rows[before]);
        let problem = match before {
            _ if row >= n => "but there are not so many",
            Some(before) if before == row && !may_repeat => "as does the entry before it",
            Some(before) if before > row => "which is less than the entry before it",
            _ => return None,
        };
        Some((position, row, problem))
    })
}

/// Multipliers are positive, and sum to 1 as well as so many `f64` can.
///
/// Rounding each quotient uᵢ/Σu to `f64` moves their sum by at most 2⁻⁵³, and a sum Σu taken in plain `f64` moves all
/// of them by k·2⁻⁵³ for k numbers; twice that, and a little for small k, is granted.
fn multipliers(multipliers: &[f64], expected: usize) -> Result<(), Violation> {
    length("the list of multipliers", multipliers.len(), expected)?;
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

fn directions(certificate: &EllipsoidCertificate, dim: usize) -> Result<(), Violation> {
    let directions = &certificate.directions;
    let expected = match certificate.items {
        Items::Points => 0,
        Items::Balls | Items::Ellipsoids => certificate.support.len(),
    };
    length("the list of directions", directions.len(), expected)?;
    for (position, direction) in directions.iter().enumerate() {
        length("a direction", direction.len(), dim)?;
        finite(direction, |column| format!("coordinate {column} of direction {position}"))?;
    }
    Ok(())
}

/// Rows of `columns` finite numbers.
fn table(what: &'static str, rows: &[Vec<f64>], columns: usize) -> Result<(), Violation> {
    for (i, row) in rows.iter().enumerate() {
        length(what, row.len(), columns)?;
        finite(row, |j| format!("entry ({i}, {j}) of {what}"))?;
    }
    Ok(())
}

fn length(what: &'static str, found: usize, expected: usize) -> Result<(), Violation> {
    if found == expected { Ok(()) } else { Err(Violation::Length { what, found, expected }) }
}

fn finite(values: &[f64], what: impl Fn(usize) -> String) -> Result<(), Violation> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(at) => {
            let (what, value) = (what(at), values[at]);
            Err(Violation::Number { what, value, expected: "a finite number" })
        }
        None => Ok(()),
    }
}

fn at_least_zero(what: &str, value: f64) -> Result<(), Violation> {
    if value >= 0.0 && value.is_finite() {
        return Ok(());
    }
    Err(Violation::Number { what: what.into(), value, expected: "a finite number, at least 0" })
}
