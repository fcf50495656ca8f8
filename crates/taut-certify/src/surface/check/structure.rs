//! Refusals from the lists alone.

use taut_points::PointSource;

use super::super::{Surface, SurfaceCertificate, SurfaceMode, SurfaceViolation};
use super::buckets;
use crate::Violation;

/// Most triangles of a surface: with so many, the number of a corner fits into 32 bits.
const TRIANGLES_MAX: usize = (u32::MAX / 3) as usize;

pub(super) fn check(
    surface: &Surface,
    certificate: &SurfaceCertificate,
    source: &dyn PointSource,
) -> Result<(), Violation> {
    if source.dim() != 3 {
        return Err(SurfaceViolation::Space { dim: source.dim() }.into());
    }
    let n = source.len();
    moved(surface, certificate, n)?;
    let triangles = surface.triangles.len();
    if triangles > TRIANGLES_MAX {
        return Err(SurfaceViolation::TooMany { triangles }.into());
    }
    if !certificate.apexes.is_empty() {
        length("the list of apexes", certificate.apexes.len(), triangles)?;
    }
    if let SurfaceMode::Alpha { radius } = certificate.mode {
        number("the radius of the mode", radius)?;
    }
    for (triangle, corners) in surface.triangles.iter().enumerate() {
        if let Some(corner) = corners.iter().position(|&row| u64::from(row) >= n) {
            let row = corners[corner];
            return Err(SurfaceViolation::Corner { triangle, corner, row, rows: n }.into());
        }
        let [a, b, c] = *corners;
        if a == b || b == c || c == a {
            let row = if a == b { a } else { c };
            return Err(SurfaceViolation::Repeated { triangle, row }.into());
        }
    }
    for (doubt, named) in certificate.doubts.iter().enumerate() {
        let wrong = named.rows.iter().find(|&&row| u64::from(row) >= n);
        let row = match (wrong, named.rows.is_empty()) {
            (Some(row), _) => format!("row {row}"),
            (None, true) => "no row".to_owned(),
            (None, false) => continue,
        };
        return Err(SurfaceViolation::DoubtRows { doubt, row, rows: n }.into());
    }
    Ok(())
}

/// The new places of rows, if there are any.
fn moved(surface: &Surface, certificate: &SurfaceCertificate, n: u64) -> Result<(), Violation> {
    number("the displacement", certificate.displacement)?;
    if surface.vertices.is_empty() {
        return Ok(());
    }
    let n = usize::try_from(n).unwrap_or(usize::MAX);
    length("the list of vertices", surface.vertices.len(), n)?;
    let flat = surface.vertices.as_flattened();
    match flat.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(at) => {
            let what = format!("coordinate {} of vertex {}", at % 3, at / 3);
            Err(Violation::Number { what, value: flat[at], expected: "a finite number" })
        }
    }
}

/// No three vertices twice.
pub(super) fn twice(triangles: &[[u32; 3]]) -> Result<(), SurfaceViolation> {
    let sorted = |(number, triangle): (u32, &[u32; 3])| {
        let mut rows = *triangle;
        rows.sort_unstable();
        (rows, number)
    };
    let all: Vec<([u32; 3], u32)> = (0..).zip(triangles).map(sorted).collect();
    let rows = all.iter().map(|(rows, _)| rows[0] as usize + 1).max().unwrap_or(0);
    let all = buckets::sorted(&all, rows, |(rows, _)| rows[0]);
    let pairs = all.windows(2).filter(|pair| pair[0].0 == pair[1].0);
    match pairs.min_by_key(|pair| pair[1].1) {
        None => Ok(()),
        Some(pair) => Err(SurfaceViolation::Twice { triangle: pair[1].1, first: pair[0].1 }),
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
