//! The checker of the inscribed triangle, in arithmetic of its own.
//!
//! *Inside.* The number of edges to the left of the centroid, by exact signs, is odd.
//! *Empty.* No edge enters the triangle, by exact signs: [`contact`].
//! *Upper bound.* The subdivision is replayed cell by cell, with bounds rounded up: [`replay`], [`bounds`], [`tile`].
//! *Tolerances.* The gap claimed has [`GAP_SLACK`], as the solver may bound its rounding less carefully; inside and empty have none.
//! *Cost.* O(n) for the answer; for each box of a corner the edges that meet the box that it is half of; for each leaf a few hundred
//! operations, and the edges that meet a box where a half-plane is named.

mod bounds;
mod contact;
mod replay;
mod tile;

use taut_points::{Monitor, PointSource};

use self::contact::Triangle;
use super::{InscribedTriangle, TriangleCertificate, TriangleVerdict, TriangleViolation};
use crate::arithmetic::U;
use crate::polygon::{self, Polygon, Units};
use crate::{CheckError, Violation};

/// How much the gap claimed may fall short of the gap proved, relatively and absolutely.
const GAP_SLACK: (f64, f64) = (1e-9, 4e-15);

/// How far the area claimed may be from the bounds of that of the corners, relatively.
const AREA_SLACK: f64 = 1e-14;

/// How much the triangle may have to grow from its centroid to reach a touching edge, relatively, besides the gap.
const TOUCHING_SLACK: f64 = 1e-9;

/// Largest skew in size.
const SKEW_MAX: f64 = 4.0;

pub(super) fn check(
    answer: &InscribedTriangle,
    certificate: &TriangleCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<TriangleVerdict, CheckError> {
    numbers(answer, certificate)?;
    let polygon = polygon::read(source, certificate.points_hash, monitor)?;
    let units = Units::of(&polygon).skewed(certificate.skew);
    let triangle = Triangle::of(answer.corners).ok_or(TriangleViolation::Orientation)?;
    let centroid = triangle.centroid();
    if !(triangle.holds(centroid) && polygon.is_inside(centroid)) {
        let [x, y] = centroid;
        return Err(TriangleViolation::CentroidOutside { x, y }.into());
    }
    for edge in 0..polygon.len() {
        if triangle.is_entered(polygon.edge(edge)) {
            return Err(TriangleViolation::EdgeInside { row: edge as u64 }.into());
        }
    }
    let [doubled, doubled_most] = triangle.doubled_area(&units);
    let lower = area(answer, [doubled, doubled_most], &units)?;
    touching(certificate, &triangle, &units, &polygon)?;
    let upper = replay::replay(certificate, &units, monitor)?.max(doubled);
    let gap = ((upper / doubled) * (1.0 + 8.0 * U) - 1.0).max(0.0);
    let (relative, absolute) = GAP_SLACK;
    let is_proved = gap <= certificate.gap * (1.0 + relative) + absolute;
    if !is_proved {
        return Err(TriangleViolation::Gap { claimed: certificate.gap, proved: gap }.into());
    }
    let upper = lower * (1.0 + gap) * (1.0 + 4.0 * U);
    match upper.is_finite() {
        true => Ok(TriangleVerdict { lower, upper, gap }),
        false => Err(TriangleViolation::Area { claimed: answer.area, found: upper }.into()),
    }
}

/// Refuses numbers that are not finite or out of their range.
fn numbers(answer: &InscribedTriangle, certificate: &TriangleCertificate) -> Result<(), Violation> {
    let wrong = |what: &str, value: f64, expected| Violation::Number {
        what: what.to_owned(),
        value,
        expected,
    };
    for (i, corner) in answer.corners.iter().enumerate() {
        for (k, &value) in corner.iter().enumerate() {
            if !value.is_finite() {
                let what = format!("coordinate {k} of corner {i}");
                return Err(wrong(&what, value, "a finite number"));
            }
        }
    }
    let (area, gap) = (answer.area, certificate.gap);
    if !(area > 0.0 && area.is_finite()) {
        return Err(wrong("the area", area, "a finite number above 0"));
    }
    if !(gap >= 0.0 && gap.is_finite()) {
        return Err(wrong("the gap", gap, "a finite number of at least 0"));
    }
    match certificate.skew.abs() <= SKEW_MAX {
        true => Ok(()),
        false => Err(TriangleViolation::Range { what: "the skew" }.into()),
    }
}

/// A lower bound of the area of the corners. The area claimed must be between the bounds, which are equal up to rounding except
/// for triangles that are almost as thin as the last digits of their corners.
fn area(
    answer: &InscribedTriangle,
    doubled: [f64; 2],
    units: &Units,
) -> Result<f64, TriangleViolation> {
    // Products with powers of two, which round where the area is not normal.
    let [found, most] = doubled.map(|doubled| 0.5 * units.given_area(doubled));
    let is_normal = found >= f64::MIN_POSITIVE && found.is_finite();
    let is_near =
        answer.area >= found * (1.0 - AREA_SLACK) && answer.area <= most * (1.0 + AREA_SLACK);
    match is_normal && is_near {
        true => Ok(found),
        false => Err(TriangleViolation::Area { claimed: answer.area, found }),
    }
}

/// Checks the list of touching edges.
fn touching(
    certificate: &TriangleCertificate,
    triangle: &Triangle,
    units: &Units,
    polygon: &Polygon,
) -> Result<(), TriangleViolation> {
    let list = &certificate.touching;
    let wrong = |position, problem| Err(TriangleViolation::Touching { position, problem });
    let mut last = None;
    for (position, &row) in list.iter().enumerate() {
        if last.is_some_and(|last| row <= last) {
            return wrong(position, "does not ascend");
        }
        last = Some(row);
        let Some(edge) = usize::try_from(row).ok().filter(|&row| row < polygon.len()) else {
            return wrong(position, "names a row that does not exist");
        };
        let scale = triangle.scale_to_reach(polygon.edge(edge), units);
        let is_touching = scale <= 1.0 + TOUCHING_SLACK + certificate.gap;
        if !is_touching {
            return wrong(position, "names an edge that the triangle does not touch");
        }
    }
    match list.is_empty() {
        true => wrong(0, "is missing: a largest triangle touches at least one edge"),
        false => Ok(()),
    }
}
