//! The checker of a convex polygon, by exact signs.
//!
//! *Convex.* The border turns left at each corner, and once around: [`convex`].
//! *Inside.* One point of it is inside the rings by the even-odd rule, and no edge enters it: [`is_entered`].
//! *Upper bound.* The ellipse in the certificate is checked as an answer of its own; in a convex body of area A the largest ellipse has an
//! area of at least π/(3√3)·A (Behrend, Math. Ann. 113, 1937; equality for triangles). The hull of all vertices is a bound as well.
//! *Areas* are sums of cross products in doubled precision with a bound of their errors: [`area`].
//! *Cost.* O(n log n), the check of the ellipse, and O(m) for each edge that comes near the m corners.

use std::cmp::Ordering;

use taut_points::{Monitor, OrderBy, PointSource};

use super::{ConvexCertificate, ConvexPolygon, ConvexVerdict, ConvexViolation};
use crate::arithmetic::{DoubleDouble, Field, Ring, U};
use crate::polygon::{self, Polygon, Units, orientation};
use crate::{Answer, CheckError, Violation};

/// How much the gap claimed may fall short of the gap proved, relatively and absolutely.
const GAP_SLACK: (f64, f64) = (1e-9, 4e-15);

/// How far the area claimed may be from that of the corners, relative to the sum of the sizes of its terms.
const AREA_SLACK: f64 = 1e-12;

/// 3√3/π = 1.65398668626537614…, rounded up.
const RATIO_MAX: f64 = 1.653_986_686_265_376_4;

/// Bound of what underflow can change in a term of an area of scaled coordinates: 2⁻¹⁰⁰⁰.
const UNDERFLOW: f64 = f64::from_bits((1023 - 1000) << 52);

pub(super) fn check(
    answer: &ConvexPolygon,
    certificate: &ConvexCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<ConvexVerdict, CheckError> {
    numbers(answer, certificate)?;
    convex(&answer.vertices)?;
    let polygon = polygon::read(source, certificate.ellipse_certificate.points_hash, monitor)?;
    inside(answer, certificate.inside, &polygon)?;
    let units = Units::of(&polygon);
    let body = area(&answer.vertices, &units);
    let lower = body.lower;
    let is_near = (answer.area - lower).abs() <= AREA_SLACK * body.terms.min(f64::MAX);
    if !(lower >= f64::MIN_POSITIVE && lower.is_finite() && is_near) {
        return Err(ConvexViolation::Area { claimed: answer.area, found: lower }.into());
    }
    let ellipse = certificate.ellipse.check(&certificate.ellipse_certificate, source, monitor)?;
    let by_ellipse = ellipse.upper * RATIO_MAX * (1.0 + 4.0 * U);
    let upper = by_ellipse.min(area(&hull(&polygon), &units).upper);
    let gap = ((upper / lower) * (1.0 + 4.0 * U) - 1.0).max(0.0);
    let (relative, absolute) = GAP_SLACK;
    let is_proved = gap <= certificate.gap * (1.0 + relative) + absolute;
    if !is_proved {
        return Err(ConvexViolation::Gap { claimed: certificate.gap, proved: gap }.into());
    }
    match upper.is_finite() {
        true => Ok(ConvexVerdict { lower, upper: upper.max(lower), gap }),
        false => Err(ConvexViolation::Area { claimed: answer.area, found: upper }.into()),
    }
}

/// Refuses numbers that are not finite or out of their range.
fn numbers(answer: &ConvexPolygon, certificate: &ConvexCertificate) -> Result<(), Violation> {
    let wrong = |what: String, value: f64, expected| Violation::Number { what, value, expected };
    for (corner, p) in answer.vertices.iter().enumerate() {
        for (k, &value) in p.iter().enumerate() {
            if !value.is_finite() {
                let what = format!("coordinate {k} of corner {corner}");
                return Err(wrong(what, value, "a finite number"));
            }
        }
    }
    for &value in &certificate.inside {
        if !value.is_finite() {
            let what = "a coordinate of the point inside".to_owned();
            return Err(wrong(what, value, "a finite number"));
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

/// Refuses corners that are not those of a convex polygon, counterclockwise.
///
/// Each turn to the left is below half a turn. The turns add up to as many whole ones as there are sides that lead up, or
/// level to the right, after a side that does not.
fn convex(corners: &[[f64; 2]]) -> Result<(), ConvexViolation> {
    let n = corners.len();
    if n < 3 {
        return Err(ConvexViolation::TooFewCorners { corners: n });
    }
    let at = |i: usize| corners[i % n];
    let leads_up = |i: usize| {
        let (a, b) = (at(i), at(i + 1));
        b[1] > a[1] || (b[1] == a[1] && b[0] > a[0])
    };
    let mut turns = 0;
    for i in 0..n {
        if orientation(at(i), at(i + 1), at(i + 2)) != Ordering::Greater {
            return Err(ConvexViolation::NotConvex { corner: (i + 1) % n });
        }
        turns += usize::from(leads_up(i + 1) && !leads_up(i));
    }
    match turns {
        1 => Ok(()),
        _ => Err(ConvexViolation::Winding { turns }),
    }
}

/// Refuses a convex polygon that is not inside the rings.
fn inside(
    answer: &ConvexPolygon,
    witness: [f64; 2],
    polygon: &Polygon,
) -> Result<(), ConvexViolation> {
    let ([x, y], corners) = (witness, &answer.vertices);
    let is_left = |[a, b]: [[f64; 2]; 2]| orientation(a, b, witness) == Ordering::Greater;
    if !sides(corners).all(is_left) {
        return Err(ConvexViolation::WitnessOutside { x, y });
    }
    let bounds = [f64::min, f64::max]
        .map(|most| [0, 1].map(|k| corners.iter().map(|p| p[k]).reduce(most).unwrap_or(f64::NAN)));
    for edge in 0..polygon.len() {
        if is_entered(corners, bounds, polygon.edge(edge)) {
            return Err(ConvexViolation::EdgeInside { row: edge as u64 });
        }
    }
    // No edge passes through it, so that it is on no edge.
    match polygon.is_inside(witness) {
        true => Ok(()),
        false => Err(ConvexViolation::Outside { x, y }),
    }
}

fn sides(corners: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> {
    let next = |i: usize| corners[if i + 1 == corners.len() { 0 } else { i + 1 }];
    corners.iter().enumerate().map(move |(i, &corner)| [corner, next(i)])
}

/// Whether an edge enters the open convex polygon with these bounds.
///
/// If not, a line parts them, and one of the lines along a side or along the edge does as well.
fn is_entered(corners: &[[f64; 2]], [low, high]: [[f64; 2]; 2], edge: [[f64; 2]; 2]) -> bool {
    let [a, b] = edge;
    if (0..2).any(|k| a[k].max(b[k]) <= low[k] || a[k].min(b[k]) >= high[k]) {
        return false;
    }
    let has = |side: Ordering| corners.iter().any(|&corner| orientation(a, b, corner) == side);
    let is_behind =
        |[p, q]: [[f64; 2]; 2]| edge.iter().all(|&end| orientation(p, q, end) != Ordering::Greater);
    let is_point = a == b;
    (is_point || has(Ordering::Greater) && has(Ordering::Less)) && !sides(corners).any(is_behind)
}

/// Bounds of an area, and the sum of the sizes of its terms.
struct Area {
    lower: f64,
    upper: f64,
    terms: f64,
}

/// The area of a convex polygon within the bounding box of the rings.
///
/// Scaled coordinates are below 2 and exact but for underflow, and so are areas taken back to the input.
fn area(corners: &[[f64; 2]], units: &Units) -> Area {
    let scaled = corners.iter().map(|p| [units.scaled(0, p[0]), units.scaled(1, p[1])]);
    let scaled: Vec<[f64; 2]> = scaled.collect();
    let (mut sum, mut terms) = (DoubleDouble::of(0.0), 0.0);
    if let Some((&first, rest)) = scaled.split_first() {
        let from_first = |p: &[f64; 2]| [0, 1].map(|k| DoubleDouble::difference(p[k], first[k]));
        for pair in rest.windows(2) {
            let ([a, b], [c, d]) = (from_first(&pair[0]), from_first(&pair[1]));
            let (one, other) = (a.times(&d), b.times(&c));
            terms += 0.5 * (one.rounded().abs() + other.rounded().abs());
            sum = sum.plus(&one.minus(&other));
        }
    }
    let found = 0.5 * sum.rounded();
    // Each term is off by less than 32 relative errors of its size, and each sum by some of the terms so far.
    let count = corners.len() as f64;
    let error = DoubleDouble::ROUNDOFF * (64.0 + 8.0 * count) * terms
        + 4.0 * U * found.abs()
        + UNDERFLOW * count;
    let given = |area: f64| units.given_area(units.grown(area));
    Area { lower: given(found - error), upper: given(found + error), terms: given(terms) }
}

/// The corners of the convex hull of all vertices, counterclockwise (Andrew's chain, by exact signs).
fn hull(polygon: &Polygon) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = (0..polygon.len()).map(|edge| polygon.edge(edge)[0]).collect();
    points.order_by(&|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    let chain = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut kept: Vec<[f64; 2]> = vec![];
        for p in points {
            while let [.., o, q] = kept[..] {
                if orientation(o, q, p) == Ordering::Greater {
                    break;
                }
                kept.pop();
            }
            kept.push(p);
        }
        kept.pop();
        kept
    };
    let mut hull = chain(&mut points.iter().copied());
    hull.extend(chain(&mut points.iter().rev().copied()));
    hull
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];

    #[test]
    fn a_border_that_winds_twice_is_refused() {
        assert_eq!(convex(&SQUARE), Ok(()));
        let pentagram: Vec<[f64; 2]> = (0..5)
            .map(|i| (f64::from(i) * 0.8 * std::f64::consts::PI).sin_cos())
            .map(|(sine, cosine)| [cosine, sine])
            .collect();
        assert_eq!(convex(&pentagram), Err(ConvexViolation::Winding { turns: 2 }));
        let twice = [SQUARE, SQUARE].concat();
        assert_eq!(convex(&twice), Err(ConvexViolation::Winding { turns: 2 }));
        let mut clockwise = SQUARE;
        clockwise.reverse();
        assert!(matches!(convex(&clockwise), Err(ConvexViolation::NotConvex { .. })));
        for turn in 0..4 {
            let mut turned = SQUARE;
            turned.rotate_left(turn);
            assert_eq!(convex(&turned), Ok(()));
        }
    }

    #[test]
    fn edges_that_touch_do_not_enter() {
        let bounds = [[0.0; 2], [2.0; 2]];
        for (edge, expected) in [
            ([[0.5, 0.5], [0.6, 0.7]], true),
            ([[1.0, 1.0], [1.0, 1.0]], true),
            ([[0.0, 0.0], [0.0, 0.0]], false),
            ([[-1.0, 1.0], [3.0, 1.5]], true),
            ([[-1.0, -1.0], [3.0, 3.0]], true),
            ([[0.0, 0.0], [2.0, 0.0]], false),
            ([[2.0, -1.0], [2.0, 3.0]], false),
            ([[-1.0, 1.0], [1.0, -1.0]], false),
            ([[-1.0, 2.5], [2.5, -1.0]], true),
        ] {
            assert_eq!(is_entered(&SQUARE, bounds, edge), expected, "{edge:?}");
            assert_eq!(is_entered(&SQUARE, bounds, [edge[1], edge[0]]), expected, "{edge:?}");
        }
    }
}
