//! The checker of the inscribed circle, in arithmetic of its own.
//!
//! *Inside.* The number of edges to the left of the center, by exact signs, is odd: [`ring`].
//! *Empty.* The distance from the center to every edge, rounded down, is at least the radius: [`distance`].
//! *Upper bound.* The subdivision is replayed cell by cell, with distances rounded up: [`replay`].
//! *Tolerances.* The gap claimed has [`GAP_SLACK`], as the solver may bound its rounding less carefully; inside and empty have none.
//! *Cost.* O(n) and, for the tree, the edges that meet each cell that is split.

mod distance;
mod replay;
mod ring;
mod signs;

use taut_points::{Monitor, PointSource};

use self::distance::{distance, rounded_down};
use self::ring::Ring;
use super::{CircleCertificate, CircleVerdict, CircleViolation, InscribedCircle};
use crate::arithmetic::U;
use crate::hashed_pass::{WantedRows, all_finite, hashed_pass};
use crate::{CheckError, Violation};

/// The amount by which the gap claimed may fall short of the gap proved, relatively and absolutely.
const GAP_SLACK: (f64, f64) = (1e-9, 4e-15);

/// The largest excess of the distance of a touching edge over the radius, relative to the radius.
const TOUCHING_SLACK: f64 = 1e-9;

pub(super) fn check(
    answer: &InscribedCircle,
    certificate: &CircleCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<CircleVerdict, CheckError> {
    numbers(answer, certificate)?;
    if source.dim() != 2 {
        return Err(CircleViolation::Plane { dim: source.dim() }.into());
    }
    monitor.pass(1, source.len());
    let ring = Ring::of(read(source, certificate, monitor)?);
    let [x, y] = answer.center;
    if !ring.is_inside(answer.center) {
        return Err(CircleViolation::CenterOutside { x, y }.into());
    }
    is_empty(answer, &ring)?;
    touching(answer, &certificate.touching, &ring)?;
    let radius = ring.scaled(answer.radius);
    let upper = replay::replay(certificate, &ring, monitor)?.max(radius);
    let gap = ((upper / radius) * (1.0 + 8.0 * U) - 1.0).max(0.0);
    let (relative, absolute) = GAP_SLACK;
    let is_proved = gap <= certificate.gap * (1.0 + relative) + absolute;
    if !is_proved {
        return Err(CircleViolation::Gap { claimed: certificate.gap, proved: gap }.into());
    }
    let upper = match upper > radius {
        true => ring.unscaled_up(upper),
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

/// Reads all rows, which must be finite and those of the hash.
fn read(
    source: &dyn PointSource,
    certificate: &CircleCertificate,
    monitor: &Monitor<'_>,
) -> Result<Vec<[f64; 2]>, CheckError> {
    let claimed = certificate.points_hash;
    let (blocks, _) = hashed_pass(source, claimed, WantedRows::none(), monitor, |first, rows| {
        all_finite(first, rows)?;
        let mut point = [0.0; 2];
        let points = (0..rows.len()).map(|row| {
            rows.copy_row(row, &mut point);
            point
        });
        Ok(points.collect::<Vec<_>>())
    })?;
    Ok(blocks.concat())
}

/// Proves that no edge enters the circle.
fn is_empty(answer: &InscribedCircle, ring: &Ring) -> Result<(), CircleViolation> {
    let (center, radius) = (ring.scaled_point(answer.center), ring.scaled_up(answer.radius));
    for edge in 0..ring.len() {
        let lower = rounded_down(distance(center, ring.scaled_edge(edge)));
        let is_outside = lower >= radius;
        if !is_outside {
            let distance = ring.unscaled(lower);
            return Err(CircleViolation::EdgeInside { row: edge as u64, distance });
        }
    }
    Ok(())
}

/// Checks the list of touching edges.
///
/// The center is rounded, so that three edges at the same distance from the exact center are at distances that differ by its
/// rounding: half a unit in the last place of each coordinate.
fn touching(answer: &InscribedCircle, list: &[u64], ring: &Ring) -> Result<(), CircleViolation> {
    let wrong = |position, problem| Err(CircleViolation::Touching { position, problem });
    let (center, radius) = (ring.scaled_point(answer.center), ring.scaled_up(answer.radius));
    let rounding = 4.0 * U * (center[0].abs() + center[1].abs());
    let mut last = None;
    for (position, &row) in list.iter().enumerate() {
        if last.is_some_and(|last| row <= last) {
            return wrong(position, "does not ascend");
        }
        last = Some(row);
        let Some(edge) = usize::try_from(row).ok().filter(|&row| row < ring.len()) else {
            return wrong(position, "names a row that does not exist");
        };
        let lower = rounded_down(distance(center, ring.scaled_edge(edge)));
        let is_touching = lower <= radius * (1.0 + TOUCHING_SLACK) + rounding;
        if !is_touching {
            return wrong(position, "names an edge that the circle does not touch");
        }
    }
    match list.is_empty() {
        true => wrong(0, "is missing: a largest circle touches at least one edge"),
        false => Ok(()),
    }
}
