//! What can be refused from the lists alone, and from the rows that they name.

use taut_points::PointSource;

use super::super::{Curve, CurveCertificate, CurveViolation};
use crate::Violation;

/// Lengths, ranges and lists.
pub(super) fn check(
    curve: &Curve,
    certificate: &CurveCertificate,
    source: &dyn PointSource,
) -> Result<(), Violation> {
    if source.dim() != 2 {
        return Err(CurveViolation::Plane { dim: source.dim() }.into());
    }
    number("the noise", curve.noise)?;
    number("the band", certificate.band)?;
    number("the sampling ratio", certificate.sampling_ratio)?;
    number("the noise ratio", certificate.noise_ratio)?;
    let n = usize::try_from(source.len()).unwrap_or(usize::MAX);
    vertices(curve)?;
    lists(curve, n)?;
    if let Some(tour) = &certificate.tour {
        number("the lower bound of the tour", tour.lower)?;
        let problem = match curve.curves.as_slice() {
            [one] if one.rows.is_empty() => "but its vertices are no rows",
            [_] if !curve.outliers.is_empty() => "but there are outliers",
            [one] => {
                length("the list of potentials", tour.potentials.len(), one.vertices.len())?;
                if let Some(at) = tour.potentials.iter().position(|p| !p.is_finite()) {
                    let (what, value) = (format!("potential {at}"), tour.potentials[at]);
                    return Err(Violation::Number { what, value, expected: "a finite number" });
                }
                return Ok(());
            }
            _ => "but there is not one curve",
        };
        return Err(CurveViolation::NoTour { problem }.into());
    }
    Ok(())
}

fn vertices(curve: &Curve) -> Result<(), Violation> {
    let are_rows = curve.curves.first().is_some_and(|first| !first.rows.is_empty());
    for (number, one) in curve.curves.iter().enumerate() {
        let (found, least) = (one.vertices.len(), if one.closed { 3 } else { 1 });
        if found < least {
            return Err(CurveViolation::Vertices { curve: number, found, least }.into());
        }
        for (vertex, place) in one.vertices.iter().enumerate() {
            if let Some(column) = place.iter().position(|value| !value.is_finite()) {
                let what = format!("coordinate {column} of vertex {vertex} of curve {number}");
                let (value, expected) = (place[column], "a finite number");
                return Err(Violation::Number { what, value, expected });
            }
        }
        if are_rows == one.rows.is_empty() {
            return Err(CurveViolation::Mixed { curve: number }.into());
        }
        if are_rows {
            length("the list of rows of a curve", one.rows.len(), found)?;
        }
        let pairs = one.vertices.windows(2).enumerate();
        let wrap = (one.vertices[0] == one.vertices[found - 1]).then_some((found - 1, 0));
        let wrap = wrap.filter(|_| one.closed);
        let twice = pairs.filter(|(_, pair)| pair[0] == pair[1]).map(|(at, _)| (at + 1, at)).next();
        if let Some((vertex, other_vertex)) = twice.or(wrap) {
            let (curve, other) = (number, number);
            return Err(CurveViolation::Repeated { curve, vertex, other, other_vertex }.into());
        }
    }
    Ok(())
}

fn lists(curve: &Curve, n: usize) -> Result<(), Violation> {
    if curve.noise != 0.0 && curve.curves.iter().any(|one| !one.rows.is_empty()) {
        let (what, value) = ("the noise".to_owned(), curve.noise);
        return Err(Violation::Number { what, value, expected: "0, as vertices are rows" });
    }
    for (number, one) in curve.curves.iter().enumerate() {
        if let Some(vertex) = one.rows.iter().position(|&row| row >= n as u64) {
            let (row, problem) = (one.rows[vertex], "but there are not so many");
            return Err(CurveViolation::Row { curve: number, vertex, row, problem }.into());
        }
        let is_outlier = |row: &u64| curve.outliers.binary_search(row).is_ok();
        if let Some(vertex) = one.rows.iter().position(is_outlier) {
            let (row, problem) = (one.rows[vertex], "but that is an outlier");
            return Err(CurveViolation::Row { curve: number, vertex, row, problem }.into());
        }
    }
    for (position, &row) in curve.outliers.iter().enumerate() {
        let before = position.checked_sub(1).map(|before| curve.outliers[before]);
        let problem = match before {
            _ if row >= n as u64 => "but there are not so many",
            Some(before) if before == row => "as does the entry before it",
            Some(before) if before > row => "which is less than the entry before it",
            _ => continue,
        };
        return Err(CurveViolation::Outlier { position, row, problem }.into());
    }
    if curve.places.is_empty() {
        return Ok(());
    }
    length("the list of places", curve.places.len(), n)?;
    for (row, place) in curve.places.iter().enumerate() {
        let one = curve.curves.get(place.0 as usize);
        let most = one.map_or(-1.0, |one| (one.vertices.len() - usize::from(!one.closed)) as f64);
        let is_there = place.1 >= 0.0 && place.1 <= most;
        if !is_there {
            let (row, curve, position) = (row as u64, place.0, place.1);
            return Err(CurveViolation::NoPlace { row, curve, position }.into());
        }
    }
    Ok(())
}

/// Whether vertices are the rows that they are said to be, to the last bit.
pub(super) fn rows(curve: &Curve, rows: &[[f64; 2]]) -> Result<(), CurveViolation> {
    for (number, one) in curve.curves.iter().enumerate() {
        for (vertex, (&row, place)) in one.rows.iter().zip(&one.vertices).enumerate() {
            if rows[row as usize] != *place {
                let problem = "which has other coordinates";
                return Err(CurveViolation::Row { curve: number, vertex, row, problem });
            }
        }
    }
    Ok(())
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
