//! The checker of the inscribed rectangle, by exact signs.
//!
//! *Inside.* No edge enters the open rectangle, and its middle is inside by the even-odd rule.
//! *Upper bound.* The subdivision is replayed: [`replay`]. Every rectangle in the polygon is in the bounding box of it, and so in the root.
//! Both ends of a range are given numbers or middles of such, so that halves meet exactly; only areas are rounded, upward.
//! *Tolerances.* The gap claimed has [`GAP_SLACK`], as the solver may bound its rounding less carefully; all else has none.
//! *Cost.* O(n) for the answer, and for each cell that is split or called outside the edges that meet the hull of its parent.

mod replay;

use std::cmp::Ordering;

use taut_points::{Monitor, PointSource};

use super::{InscribedRectangle, RectangleCertificate, RectangleVerdict, RectangleViolation};
use crate::arithmetic::U;
use crate::polygon::{self, Polygon, orientation};
use crate::{CheckError, Violation};

/// How much the gap claimed may fall short of the gap proved, relatively and absolutely.
const GAP_SLACK: (f64, f64) = (1e-9, 4e-15);

/// How far the area claimed may be from that of the sides, relatively.
const AREA_SLACK: f64 = 1e-14;

/// A closed rectangle along the axes; it may be a point.
#[derive(Clone, Copy, Debug)]
struct Rectangle {
    low: [f64; 2],
    high: [f64; 2],
}

impl Rectangle {
    fn corners(&self) -> [[f64; 2]; 4] {
        let (low, high) = (self.low, self.high);
        [low, [high[0], low[1]], high, [low[0], high[1]]]
    }

    /// Whether an edge enters the open rectangle: neither its bounding box nor the line through it parts them.
    fn is_entered(&self, [a, b]: [[f64; 2]; 2]) -> bool {
        let is_apart = |k: usize| {
            self.low[k] >= self.high[k]
                || a[k].max(b[k]) <= self.low[k]
                || a[k].min(b[k]) >= self.high[k]
        };
        if is_apart(0) || is_apart(1) {
            return false;
        }
        let signs = self.corners().map(|corner| orientation(a, b, corner));
        // A point, strictly between all ends, is inside.
        a == b || signs.contains(&Ordering::Greater) && signs.contains(&Ordering::Less)
    }

    /// Whether an edge may meet the closed rectangle: false only if they are apart.
    fn may_meet(&self, [a, b]: [[f64; 2]; 2]) -> bool {
        if (0..2).any(|k| a[k].max(b[k]) < self.low[k] || a[k].min(b[k]) > self.high[k]) {
            return false;
        }
        let signs = self.corners().map(|corner| orientation(a, b, corner));
        let is_apart = signs.iter().all(|&sign| sign == Ordering::Greater)
            || signs.iter().all(|&sign| sign == Ordering::Less);
        !is_apart
    }

    /// A bound of the area: 0 if it is empty, else not below the exact number.
    fn area_up(&self) -> f64 {
        let side = |k: usize| self.high[k] - self.low[k];
        match side(0) > 0.0 && side(1) > 0.0 {
            // A product that underflows is off by less than the least number.
            true => (side(0) * side(1) * (1.0 + 4.0 * U)).next_up(),
            false => 0.0,
        }
    }
}

pub(super) fn check(
    answer: &InscribedRectangle,
    certificate: &RectangleCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<RectangleVerdict, CheckError> {
    numbers(answer, certificate)?;
    let polygon = polygon::read(source, certificate.points_hash, monitor)?;
    let own = Rectangle { low: answer.low, high: answer.high };
    let lower = inside(answer, &own, &polygon)?;
    let upper = replay::replay(certificate, &polygon, monitor)?.max(lower);
    let gap = ((upper / lower) * (1.0 + 4.0 * U) - 1.0).max(0.0);
    let (relative, absolute) = GAP_SLACK;
    let is_proved = gap <= certificate.gap * (1.0 + relative) + absolute;
    match is_proved {
        true => Ok(RectangleVerdict { lower, upper, gap }),
        false => Err(RectangleViolation::Gap { claimed: certificate.gap, proved: gap }.into()),
    }
}

/// Refuses numbers that are not finite or out of their range.
fn numbers(
    answer: &InscribedRectangle,
    certificate: &RectangleCertificate,
) -> Result<(), Violation> {
    let wrong = |what: String, value: f64, expected| Violation::Number { what, value, expected };
    for (name, corner) in [("lower", answer.low), ("upper", answer.high)] {
        for (k, value) in corner.into_iter().enumerate() {
            if !value.is_finite() {
                let what = format!("coordinate {k} of the {name} corner");
                return Err(wrong(what, value, "a finite number"));
            }
        }
    }
    let (area, gap) = (answer.area, certificate.gap);
    if !(area > 0.0 && area.is_finite()) {
        return Err(wrong("the area".to_owned(), area, "a finite number above 0"));
    }
    if !(gap >= 0.0 && gap.is_finite()) {
        return Err(wrong("the gap".to_owned(), gap, "a finite number of at least 0"));
    }
    Ok(())
}

/// Returns a lower bound of the area of a rectangle that is inside.
fn inside(
    answer: &InscribedRectangle,
    own: &Rectangle,
    polygon: &Polygon,
) -> Result<f64, RectangleViolation> {
    let middle = [0, 1].map(|k| 0.5 * own.low[k] + 0.5 * own.high[k]);
    for (axis, x) in middle.into_iter().enumerate() {
        let (low, high) = (own.low[axis], own.high[axis]);
        if !(low < x && x < high) {
            return Err(RectangleViolation::Flat { axis, low, high });
        }
    }
    for edge in 0..polygon.len() {
        if own.is_entered(polygon.edge(edge)) {
            return Err(RectangleViolation::EdgeInside { row: edge as u64 });
        }
    }
    if !polygon.is_inside(middle) {
        return Err(RectangleViolation::Outside);
    }
    let sides = [0, 1].map(|k| own.high[k] - own.low[k]);
    let found = sides[0] * sides[1] * (1.0 - 4.0 * U);
    let is_near = (answer.area - found).abs() <= AREA_SLACK * found;
    match found >= f64::MIN_POSITIVE && found.is_finite() && is_near {
        true => Ok(found),
        false => Err(RectangleViolation::Area { claimed: answer.area, found }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_on_the_border_meet_but_do_not_enter() {
        let unit = Rectangle { low: [0.0; 2], high: [1.0; 2] };
        for (edge, enters, meets) in [
            ([[0.0, 0.0], [1.0, 0.0]], false, true),
            ([[0.5, -1.0], [0.5, 0.1]], true, true),
            ([[0.5, -1.0], [0.5, 0.0]], false, true),
            ([[0.5, 0.5], [0.5, 0.5]], true, true),
            ([[1.0, 0.5], [1.0, 0.5]], false, true),
            ([[-1.0, 1.0], [1.0, -1.0]], false, true),
            ([[-1.0, 0.5], [0.5, -1.0]], false, false),
            ([[-1.0, -1.0], [2.0, 2.0]], true, true),
        ] {
            assert_eq!(unit.is_entered(edge), enters, "{edge:?}");
            assert_eq!(unit.may_meet(edge), meets, "{edge:?}");
        }
    }

    #[test]
    fn areas_are_rounded_up() {
        let tiny = f64::from_bits(1);
        let area = |high: [f64; 2]| Rectangle { low: [0.0; 2], high }.area_up();
        assert!(area([1.0, 1.0]) > 1.0 && area([tiny, tiny]) > 0.0);
        assert_eq!((area([0.0, 1.0]), area([-1.0, -1.0])), (0.0, 0.0));
    }
}
