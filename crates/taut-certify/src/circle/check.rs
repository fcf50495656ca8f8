//! The checker of the inscribed circle, in arithmetic of its own.
//!
//! *Inside.* The number of edges to the left of the center, by exact signs, is odd: [`Polygon`].
//! *Empty.* The distance from the center to every edge, rounded down, is at least the radius: [`distance`].
//! *Upper bound.* The subdivision is replayed cell by cell, with distances rounded up: [`replay`].
//! *Tolerances.* The gap claimed has [`GAP_SLACK`], as the solver may bound its rounding less carefully; inside and empty have none.
//! *Cost.* O(n) and, for the tree, the edges that meet each cell that is split.

mod distance;
mod replay;

use taut_points::{Monitor, PointSource};

use self::distance::{distance, error, rounded_down};
use super::{CircleCertificate, CircleVerdict, CircleViolation, InscribedCircle};
use crate::arithmetic::U;
use crate::polygon::{self, Polygon};
use crate::{CheckError, Violation};

/// The amount by which the gap claimed may fall short of the gap proved, relatively and absolutely.
const GAP_SLACK: (f64, f64) = (1e-9, 4e-15);

/// The largest excess of the distance of a touching edge over the radius, relative to the radius.
const TOUCHING_SLACK: f64 = 1e-9;

/// How many times the bound of its error the distance of a touching edge may be above the radius.
const TOUCHING_ERRORS: f64 = 8.0;

pub(super) fn check(
    answer: &InscribedCircle,
    certificate: &CircleCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<CircleVerdict, CheckError> {
    numbers(answer, certificate)?;
    let polygon = polygon::read(source, certificate.points_hash, monitor)?;
    let [x, y] = answer.center;
    if !polygon.is_inside(answer.center) {
        return Err(CircleViolation::CenterOutside { x, y }.into());
    }
    is_empty(answer, &polygon)?;
    touching(answer, &certificate.touching, &polygon)?;
    let radius = polygon.scaled(answer.radius);
    let upper = replay::replay(certificate, &polygon, monitor)?.max(radius);
    let gap = ((upper / radius) * (1.0 + 8.0 * U) - 1.0).max(0.0);
    let (relative, absolute) = GAP_SLACK;
    let is_proved = gap <= certificate.gap * (1.0 + relative) + absolute;
    if !is_proved {
        return Err(CircleViolation::Gap { claimed: certificate.gap, proved: gap }.into());
    }
    let upper = match upper > radius {
        true => polygon.unscaled_up(upper),
        false => answer.radius,
    };
    Ok(CircleVerdict { lower: answer.radius, upper, gap })
}

/// Refuses numbers that are not finite or out of their range.
fn numbers(answer: &InscribedCircle, certificate: &CircleCertificate) -> Result<(), Violation> {
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
    let (radius, gap) = (answer.radius, certificate.gap);
    if !(radius > 0.0 && radius.is_finite()) {
        return Err(wrong("the radius", radius, "a finite number above 0"));
    }
    if !(gap >= 0.0 && gap.is_finite()) {
        return Err(wrong("the gap", gap, "a finite number of at least 0"));
    }
    Ok(())
}

/// Proves that no edge enters the circle.
fn is_empty(answer: &InscribedCircle, polygon: &Polygon) -> Result<(), CircleViolation> {
    let (center, radius) = (polygon.scaled_point(answer.center), polygon.scaled_up(answer.radius));
    for edge in 0..polygon.len() {
        let lower = rounded_down(distance(center, polygon.scaled_edge(edge)));
        let is_outside = lower >= radius;
        if !is_outside {
            let distance = polygon.unscaled(lower);
            return Err(CircleViolation::EdgeInside { row: edge as u64, distance });
        }
    }
    Ok(())
}

/// Checks the list of touching edges.
///
/// The center is rounded, so that three edges at the same distance from the exact center are at distances that differ by its
/// rounding: half a unit in the last place of each coordinate.
fn touching(
    answer: &InscribedCircle,
    list: &[u64],
    polygon: &Polygon,
) -> Result<(), CircleViolation> {
    let wrong = |position, problem| Err(CircleViolation::Touching { position, problem });
    let (center, radius) = (polygon.scaled_point(answer.center), polygon.scaled_up(answer.radius));
    let rounding = 4.0 * U * (center[0].abs() + center[1].abs());
    let mut last = None;
    for (position, &row) in list.iter().enumerate() {
        if last.is_some_and(|last| row <= last) {
            return wrong(position, "does not ascend");
        }
        last = Some(row);
        let Some(edge) = usize::try_from(row).ok().filter(|&row| row < polygon.len()) else {
            return wrong(position, "names a row that does not exist");
        };
        let distance = distance(center, polygon.scaled_edge(edge));
        // In a needle the bound of the distance's error may be more than the slack.
        let slack = radius * TOUCHING_SLACK + rounding + TOUCHING_ERRORS * error(distance);
        let is_touching = rounded_down(distance) <= radius + slack;
        if !is_touching {
            return wrong(position, "names an edge that the circle does not touch");
        }
    }
    match list.is_empty() {
        true => wrong(0, "is missing: a largest circle touches at least one edge"),
        false => Ok(()),
    }
}
