//! The checker of the inscribed oriented rectangle, in arithmetic of its own.
//!
//! *Inside.* The number of edges to the left of the center, by exact signs, is odd.
//! *Empty.* Each edge is beyond a side, or all corners are on one side of its line, by more than rounding: [`clear`].
//! *Upper bound.* The subdivision is replayed for the area that the gap claims: [`replay`], [`cell`], [`bounds`].
//! *Tolerances.* None but that of the area claimed, which is rounded.
//! *Cost.* O(n) for the answer and for each range of slopes; for each cell the edges that may meet its parent; a few hundred
//! operations for each leaf.

mod bounds;
mod cell;
mod clear;
mod replay;

use taut_points::{Monitor, PointSource};

use super::{
    InscribedOrientedRectangle, OrientedRectangleCertificate, OrientedRectangleVerdict,
    OrientedRectangleViolation,
};
use crate::arithmetic::U;
use crate::polygon::{self, Units};
use crate::{CheckError, Violation};

use self::clear::Given;

/// How far the area claimed may be from that of the sides, relatively.
const AREA_SLACK: f64 = 1e-14;

pub(super) fn check(
    answer: &InscribedOrientedRectangle,
    certificate: &OrientedRectangleCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<OrientedRectangleVerdict, CheckError> {
    numbers(answer, certificate)?;
    let polygon = polygon::read(source, certificate.points_hash, monitor)?;
    let units = Units::square(&polygon);
    let given = Given::of(answer, &units).ok_or(OrientedRectangleViolation::Flat)?;
    if !polygon.is_inside(answer.center) {
        return Err(OrientedRectangleViolation::Outside.into());
    }
    for edge in 0..polygon.len() {
        if !given.is_clear_of(polygon.edge(edge), &units) {
            return Err(OrientedRectangleViolation::EdgeInside { row: edge as u64 }.into());
        }
    }
    let in_units = given.area_below(&units);
    let lower = units.given_area(in_units);
    let is_normal = lower >= f64::MIN_POSITIVE && lower.is_finite();
    if !(is_normal && (answer.area - lower).abs() <= AREA_SLACK * lower) {
        return Err(OrientedRectangleViolation::Area { claimed: answer.area, found: lower }.into());
    }
    let gap = certificate.gap;
    // Two roundings, downward: what is proved for the smaller bound holds for the larger one.
    replay::replay(certificate, &units, in_units * (1.0 + gap) * (1.0 - 4.0 * U), monitor)?;
    let upper = lower * (1.0 + gap) * (1.0 + 4.0 * U);
    match upper.is_finite() {
        true => Ok(OrientedRectangleVerdict { lower, upper, gap }),
        false => {
            Err(OrientedRectangleViolation::Area { claimed: answer.area, found: upper }.into())
        }
    }
}

/// Refuses numbers that are not finite or out of their range.
fn numbers(
    answer: &InscribedOrientedRectangle,
    certificate: &OrientedRectangleCertificate,
) -> Result<(), Violation> {
    let wrong = |what: String, value: f64, expected| Violation::Number { what, value, expected };
    for (name, pair) in [("the center", answer.center), ("the axis", answer.axis)] {
        for (k, value) in pair.into_iter().enumerate() {
            if !value.is_finite() {
                return Err(wrong(format!("coordinate {k} of {name}"), value, "a finite number"));
            }
        }
    }
    for (k, value) in certificate.pivot.into_iter().enumerate() {
        if !(0.0..=2.0).contains(&value) {
            return Err(wrong(format!("coordinate {k} of the pivot"), value, "from 0 to 2"));
        }
    }
    let (ratio, area, gap) = (answer.ratio, answer.area, certificate.gap);
    if !(ratio > 0.0 && ratio <= 1.0) {
        return Err(wrong("the ratio".to_owned(), ratio, "above 0 and at most 1"));
    }
    if !(area > 0.0 && area.is_finite()) {
        return Err(wrong("the area".to_owned(), area, "a finite number above 0"));
    }
    if !(gap >= 0.0 && gap.is_finite()) {
        return Err(wrong("the gap".to_owned(), gap, "a finite number of at least 0"));
    }
    Ok(())
}
