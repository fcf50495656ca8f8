//! The checker of the inscribed ellipse, in arithmetic of its own.
//!
//! *Inside.* The number of edges to the left of the center, by exact signs, is odd.
//! *Empty.* No edge enters the ellipse, by exact signs: [`contact`].
//! *Upper bound.* The subdivision is replayed cell by cell, with bounds rounded up: [`replay`], [`bounds`].
//! *Tolerances.* The gap claimed has [`GAP_SLACK`], as the solver may bound its rounding less carefully; inside and empty have none.
//! *Cost.* O(n) for the answer, O(n) for each letter `f`, and for the rest of the tree the edges that meet each cell that is split.

mod bounds;
mod contact;
mod replay;

use taut_points::{Monitor, PointSource};

use self::contact::Ellipse;
use super::{EllipseCertificate, EllipseVerdict, EllipseViolation, InscribedEllipse};
use crate::arithmetic::U;
use crate::polygon::{self, Polygon, Units};
use crate::{CheckError, Violation};

/// How much the gap claimed may fall short of the gap proved, relatively and absolutely.
const GAP_SLACK: (f64, f64) = (1e-9, 4e-15);

/// How far the area claimed may be from that of the axes, relatively.
const AREA_SLACK: f64 = 1e-14;

/// How much farther from the center than the ellipse a touching edge may be, relatively, besides the gap.
const TOUCHING_SLACK: f64 = 1e-9;

pub(super) fn check(
    answer: &InscribedEllipse,
    certificate: &EllipseCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<EllipseVerdict, CheckError> {
    numbers(answer, certificate)?;
    let polygon = polygon::read(source, certificate.points_hash, monitor)?;
    let [x, y] = answer.center;
    if !polygon.is_inside(answer.center) {
        return Err(EllipseViolation::CenterOutside { x, y }.into());
    }
    let units = Units::of(&polygon);
    let ellipse = Ellipse::of(answer, &units).ok_or(EllipseViolation::Flat)?;
    let lower = area(answer, &ellipse, &units)?;
    for edge in 0..polygon.len() {
        if ellipse.is_entered(polygon.edge(edge)) {
            return Err(EllipseViolation::EdgeInside { row: edge as u64 }.into());
        }
    }
    touching(certificate, &ellipse, &polygon)?;
    let square = ellipse.square_of_size;
    let size = replay::replay(certificate, &units, square.sqrt(), monitor)?;
    let upper = (size * size * (1.0 + 4.0 * U)).max(square);
    let gap = ((upper / square) * (1.0 + 8.0 * U) - 1.0).max(0.0);
    let (relative, absolute) = GAP_SLACK;
    let is_proved = gap <= certificate.gap * (1.0 + relative) + absolute;
    if !is_proved {
        return Err(EllipseViolation::Gap { claimed: certificate.gap, proved: gap }.into());
    }
    let upper = lower * (1.0 + gap) * (1.0 + 4.0 * U);
    match upper.is_finite() {
        true => Ok(EllipseVerdict { lower, upper, gap }),
        false => Err(EllipseViolation::Area { claimed: answer.area, found: upper }.into()),
    }
}

/// Refuses numbers that are not finite or out of their range.
fn numbers(answer: &InscribedEllipse, certificate: &EllipseCertificate) -> Result<(), Violation> {
    let wrong = |what: &str, value: f64, expected| Violation::Number {
        what: what.to_owned(),
        value,
        expected,
    };
    for (k, &value) in answer.center.iter().enumerate() {
        if !value.is_finite() {
            return Err(wrong(&format!("coordinate {k} of the center"), value, "a finite number"));
        }
    }
    for (i, row) in answer.axes.iter().enumerate() {
        for (j, &value) in row.iter().enumerate() {
            if !value.is_finite() {
                let what = format!("entry ({i}, {j}) of the axes");
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
    Ok(())
}

/// A lower bound of the area of the axes, to which the area claimed must be equal up to rounding.
fn area(
    answer: &InscribedEllipse,
    ellipse: &Ellipse,
    units: &Units,
) -> Result<f64, EllipseViolation> {
    // π is rounded down to f64; three more operations of at most u each, and divisions by powers of two.
    let found = units.given_area(ellipse.square_of_size * std::f64::consts::PI) * (1.0 - 8.0 * U);
    let is_normal = found >= f64::MIN_POSITIVE && found.is_finite();
    let is_near = (answer.area - found).abs() <= AREA_SLACK * found;
    match is_normal && is_near {
        true => Ok(found),
        false => Err(EllipseViolation::Area { claimed: answer.area, found }),
    }
}

/// Checks the list of touching edges.
fn touching(
    certificate: &EllipseCertificate,
    ellipse: &Ellipse,
    polygon: &Polygon,
) -> Result<(), EllipseViolation> {
    let list = &certificate.touching;
    let wrong = |position, problem| Err(EllipseViolation::Touching { position, problem });
    let mut last = None;
    for (position, &row) in list.iter().enumerate() {
        if last.is_some_and(|last| row <= last) {
            return wrong(position, "does not ascend");
        }
        last = Some(row);
        let Some(edge) = usize::try_from(row).ok().filter(|&row| row < polygon.len()) else {
            return wrong(position, "names a row that does not exist");
        };
        let distance = ellipse.distance(polygon.edge(edge));
        let is_touching = distance <= 1.0 + TOUCHING_SLACK + certificate.gap;
        if !is_touching {
            return wrong(position, "names an edge that the ellipse does not touch");
        }
    }
    match list.is_empty() {
        true => wrong(0, "is missing: a largest ellipse touches at least one edge"),
        false => Ok(()),
    }
}
