//! Refusals before any row is read: lengths, ranges, lists, and the gap between the bounds.

use taut_points::OrderBy;

use super::super::{Centers, CentersCertificate, CentersViolation, Placement};
use super::item::Layout;
use crate::arithmetic::U;
use crate::ball::check::structure::directions;
use crate::{Items, Violation};

/// The amount by which the gap claimed may fall short of the gap found, relatively and in units of 1: a solver forms the quotient in
/// arithmetic of its own.
const GAP_SLACK: (f64, f64) = (1e-9, 4e-16);

/// The way in which rows are to be read.
#[derive(Clone, Copy, Debug)]
pub(super) enum Reading {
    /// As points or balls.
    Items(Layout),
    /// As ellipsoids in a space of this dimension.
    Ellipsoids(usize),
}

impl Reading {
    fn of(certificate: &CentersCertificate, columns: usize) -> Result<Self, Violation> {
        if certificate.items != Items::Ellipsoids {
            return Ok(Reading::Items(Layout::of(certificate, columns)?));
        }
        let problem = match () {
            () if certificate.weights => "with weights, which points alone can have",
            () if certificate.group.is_some() => "in groups, but each is a group of its own",
            () if certificate.placement == Placement::Rows => {
                "with centers among them, which are no points"
            }
            () => {
                return match Items::Ellipsoids.dim(columns) {
                    0 => Err(Violation::NoShape { columns }),
                    dim => Ok(Reading::Ellipsoids(dim)),
                };
            }
        };
        Err(CentersViolation::Ellipsoids { problem }.into())
    }

    fn dim(self) -> usize {
        match self {
            Reading::Items(layout) => layout.dim,
            Reading::Ellipsoids(dim) => dim,
        }
    }
}

/// Returns what rows are, and the gap found.
pub(super) fn check(
    answer: &Centers,
    certificate: &CentersCertificate,
    n: u64,
    columns: usize,
) -> Result<(Reading, f64), Violation> {
    let reading = Reading::of(certificate, columns)?;
    if n == 0 {
        return Err(CentersViolation::Empty.into());
    }
    number("the radius", answer.radius)?;
    number("the lower bound", answer.lower_bound)?;
    number("the claimed gap", certificate.gap)?;
    centers(answer, certificate, reading.dim())?;
    rows(answer, certificate, n)?;
    outliers(answer, certificate, n)?;
    if !answer.assignment.is_empty() {
        let expected = usize::try_from(n).unwrap_or(usize::MAX);
        length("the assignment", answer.assignment.len(), expected)?;
    }
    core_set(certificate, n)?;
    let (points, dim) = (certificate.core_set.len(), reading.dim());
    directions(certificate.items, &certificate.directions, points, dim)?;
    Ok((reading, gap(answer, certificate)?))
}

fn centers(
    answer: &Centers,
    certificate: &CentersCertificate,
    dim: usize,
) -> Result<(), Violation> {
    let found = answer.centers.len();
    if found == 0 || found as u64 > certificate.k {
        return Err(CentersViolation::Count { found, k: certificate.k }.into());
    }
    for (center, place) in answer.centers.iter().enumerate() {
        if place.len() != dim {
            let found = place.len();
            return Err(CentersViolation::Dimension { center, found, expected: dim }.into());
        }
        if let Some(column) = place.iter().position(|value| !value.is_finite()) {
            let what = format!("coordinate {column} of center {center}");
            let value = place[column];
            return Err(Violation::Number { what, value, expected: "a finite number" });
        }
    }
    Ok(())
}

fn rows(answer: &Centers, certificate: &CentersCertificate, n: u64) -> Result<(), Violation> {
    let expected = match certificate.placement {
        Placement::Free => 0,
        Placement::Rows => answer.centers.len(),
    };
    length("the list of rows of the centers", answer.rows.len(), expected)?;
    match answer.rows.iter().position(|&row| row >= n) {
        Some(center) => {
            let (row, problem) = (answer.rows[center], "but there are not so many");
            Err(CentersViolation::Row { center, row, problem }.into())
        }
        None => Ok(()),
    }
}

fn outliers(answer: &Centers, certificate: &CentersCertificate, n: u64) -> Result<(), Violation> {
    let (rows, most) = (&answer.outliers, certificate.outliers);
    // Of groups it is told later how many rows they have.
    if certificate.group.is_none() && rows.len() as u64 > most {
        return Err(CentersViolation::Outliers { found: rows.len(), most }.into());
    }
    for (position, &row) in rows.iter().enumerate() {
        let before = position.checked_sub(1).map(|before| rows[before]);
        let problem = match before {
            _ if row >= n => "but there are not so many",
            Some(before) if before == row => "as does the entry before it",
            Some(before) if before > row => "which is less than the entry before it",
            _ => continue,
        };
        return Err(Violation::LeftOut { position, row, problem });
    }
    Ok(())
}

fn core_set(certificate: &CentersCertificate, n: u64) -> Result<(), Violation> {
    let rows = &certificate.core_set;
    let refused = |position: usize, problem| CentersViolation::CoreSet {
        position,
        row: rows[position],
        problem,
    };
    if let Some(position) = rows.iter().position(|&row| row >= n) {
        return Err(refused(position, "but there are not so many").into());
    }
    if certificate.items == Items::Ellipsoids {
        return Ok(());
    }
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.order_by_key(|&position| (rows[position], position));
    let twice = order.windows(2).find(|pair| rows[pair[0]] == rows[pair[1]]);
    twice.map_or(Ok(()), |pair| Err(refused(pair[1], "as does an entry before it").into()))
}

/// R/L − 1, rounded up.
fn gap(answer: &Centers, certificate: &CentersCertificate) -> Result<f64, Violation> {
    let (lower, radius) = (answer.lower_bound, answer.radius);
    if lower > radius {
        return Err(CentersViolation::Order { lower, radius }.into());
    }
    let found = match radius == lower {
        true => 0.0,
        // The difference of neighbors is exact, and of others is off by half an ulp.
        false => (radius - lower) / lower * (1.0 + 8.0 * U),
    };
    let (relative, absolute) = GAP_SLACK;
    if found > certificate.gap * (1.0 + relative) + absolute {
        return Err(CentersViolation::Gap { claimed: certificate.gap, found }.into());
    }
    Ok(found)
}

fn length(what: &'static str, found: usize, expected: usize) -> Result<(), Violation> {
    if found == expected { Ok(()) } else { Err(Violation::Length { what, found, expected }) }
}

fn number(what: &str, value: f64) -> Result<(), Violation> {
    // By −0 a quotient would be −∞, as good a gap as any.
    if value >= 0.0 && value.is_sign_positive() && value.is_finite() {
        return Ok(());
    }
    Err(Violation::Number { what: what.into(), value, expected: "a finite number, at least 0" })
}
