//! Refusals before any point is read: lengths, ranges, and the lists of rows.

use taut_points::PointSource;

use super::super::{RobustCertificate, RobustEllipsoid, RobustMethod};
use crate::ellipsoid::check::structure;
use crate::{Items, Violation};

pub(super) fn check(
    answer: &RobustEllipsoid,
    certificate: &RobustCertificate,
    source: &dyn PointSource,
) -> Result<(), Violation> {
    let (n, dim) = (source.len(), source.dim());
    let RobustEllipsoid { center, matrix, factor, hull, scatter, .. } = answer;
    if center.len() != dim {
        return Err(Violation::Dimension { found: center.len(), expected: dim });
    }
    table("the matrix", matrix, dim, dim)?;
    table("the scatter", scatter, dim, dim)?;
    match hull {
        None => table("the factor", factor, dim, dim)?,
        Some(_) if factor.len() >= dim => {
            return Err(Violation::NeedlessHull { rank: factor.len(), dim });
        }
        Some(hull) => {
            table("the factor", factor, factor.len(), dim)?;
            table("the basis of the hull", &hull.basis, factor.len(), dim)?;
            number("the distance from the hull", hull.distance, hull.distance >= 0.0)?;
        }
    }
    center.iter().try_for_each(|&value| number("the center", value, true))?;
    structure::tail(&answer.ellipsoid())?;
    number("the log-volume", answer.log_volume, true)?;
    number("the log-determinant", answer.log_det, true)?;
    number("the objective", certificate.objective, true)?;
    let is_trimmed = certificate.method == RobustMethod::Trim;
    let level = certificate.level;
    let is_level = if is_trimmed { level == 1.0 } else { level > 0.0 && level < 1.0 };
    number("the level", level, is_level)?;
    number("the quantile", certificate.cutoff, certificate.cutoff >= 0.0)?;
    number("the first factor", certificate.raw_scale, certificate.raw_scale > 0.0)?;
    number("the factor of the scatter", certificate.scale, certificate.scale >= 0.0)?;
    for (list, rows) in [
        ("outliers", &answer.outliers),
        ("left out", &certificate.left_out),
        ("weighed out", &certificate.weighed_out),
    ] {
        ascending(list, rows, n)?;
    }
    outliers(answer, certificate)?;
    enough(certificate, n, dim)?;
    kept(certificate, n)?;
    match &certificate.enclosure {
        None => Ok(()),
        Some(enclosure) if enclosure.certificate.items == Items::Points => structure::check(
            &enclosure.ellipsoid,
            &enclosure.certificate,
            source.len(),
            source.dim(),
        ),
        Some(_) => Err(Violation::NoPoints),
    }
}

/// By `mcd` and `mve`, h is at least ⌊(n + d + 1)/2⌋, or n: below, the points left out could be the majority, and any
/// cluster would do for an estimate.
fn enough(certificate: &RobustCertificate, n: u64, dim: usize) -> Result<(), Violation> {
    let least = (n + dim as u64).div_ceil(2).min(n);
    if certificate.method == RobustMethod::Trim || certificate.kept >= least {
        return Ok(());
    }
    let value = certificate.kept as f64;
    let expected =
        "at least half of the points and dimensions, ⌊(n + d + 1)/2⌋, but no more than n";
    Err(Violation::Number { what: "the number of points kept".into(), value, expected })
}

/// By `trim`, the outliers are the rows left out, as on the border nothing else would tell, and none is weighed out.
fn outliers(answer: &RobustEllipsoid, certificate: &RobustCertificate) -> Result<(), Violation> {
    let (outliers, left_out) = (&answer.outliers, &certificate.left_out);
    if certificate.method != RobustMethod::Trim {
        return Ok(());
    }
    length("the list of points weighed out", certificate.weighed_out.len(), 0)?;
    if outliers == left_out {
        return Ok(());
    }
    let missing = left_out.iter().find(|row| outliers.binary_search(row).is_err());
    let spare = outliers.iter().find(|row| left_out.binary_search(row).is_err());
    let (problem, row) = match (missing, spare) {
        (Some(&row), _) => ("lacks", row),
        (None, spare) => ("names", spare.copied().unwrap_or(0)),
    };
    Err(Violation::Listed { list: "outliers", problem, row, distance: 1.0 })
}

/// Tests whether as many rows are kept as is said, and the ellipsoid around them leaves out the same.
fn kept(certificate: &RobustCertificate, n: u64) -> Result<(), Violation> {
    let kept = n - certificate.left_out.len() as u64;
    let claimed = certificate.kept as f64;
    let what = || "the number of points kept".to_owned();
    let fits = match certificate.method {
        RobustMethod::Mcd => kept == certificate.kept,
        RobustMethod::Mve | RobustMethod::Trim => kept >= certificate.kept,
    };
    if !fits || certificate.kept == 0 {
        return Err(Violation::Estimate { what: what(), claimed, found: kept as f64 });
    }
    let wanted = usize::from(certificate.method != RobustMethod::Mcd);
    match &certificate.enclosure {
        Some(enclosure) if wanted == 1 => {
            let theirs = &enclosure.certificate.left_out;
            if *theirs == certificate.left_out {
                return Ok(());
            }
            let found = (n - (theirs.len() as u64).min(n)) as f64;
            Err(Violation::Estimate { what: what(), claimed: kept as f64, found })
        }
        None if wanted == 0 => Ok(()),
        other => {
            let found = usize::from(other.is_some());
            Err(Violation::Length { what: "the list of enclosures", found, expected: wanted })
        }
    }
}

fn ascending(list: &'static str, rows: &[u64], n: u64) -> Result<(), Violation> {
    let is_wrong = |(i, &row): (usize, &u64)| row >= n || (i > 0 && rows[i - 1] >= row);
    match rows.iter().enumerate().position(is_wrong) {
        None => Ok(()),
        Some(at) => {
            let value = rows[at] as f64;
            let what = format!("entry {at} of the list of points {list}");
            Err(Violation::Number { what, value, expected: "rows that exist, ascending" })
        }
    }
}

fn table(what: &'static str, rows: &[Vec<f64>], count: usize, dim: usize) -> Result<(), Violation> {
    length(what, rows.len(), count)?;
    for row in rows {
        length(what, row.len(), dim)?;
        row.iter().try_for_each(|&value| number(what, value, true))?;
    }
    Ok(())
}

fn length(what: &'static str, found: usize, expected: usize) -> Result<(), Violation> {
    if found == expected { Ok(()) } else { Err(Violation::Length { what, found, expected }) }
}

fn number(what: &str, value: f64, is_in_range: bool) -> Result<(), Violation> {
    if value.is_finite() && is_in_range {
        return Ok(());
    }
    Err(Violation::Number { what: what.into(), value, expected: "a finite number in its range" })
}
