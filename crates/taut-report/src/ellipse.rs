//! The report about an ellipse in a polygon.

use taut::Solution;
use taut::certify::{InscribedEllipse, Stop};
use taut::points::PointSource;

use crate::numbers::{count, counted, exact, gap};
use crate::{Claims, Field, Report, Summary, center, gap_and_verified, rows_of, stopped};

impl Summary for InscribedEllipse {
    const FOUND: &'static str = "the ellipse found";

    fn title(report: &Report<'_, Self>) -> String {
        let vertices = counted(report.points.len(), "point");
        let size = match &*report.found.trace.method {
            "branch-and-bound" => "Largest",
            _ => "Large",
        };
        format!("{size} ellipse in a polygon of {vertices}")
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let trace = &report.found.trace;
        let proved = report.verdict.as_ref().map(|proved| {
            let upper = exact(proved.upper);
            (proved.gap, format!("no ellipse in the polygon has an area above {upper}"))
        });
        let ended = match trace.stop {
            Stop::NodeBudget => "a larger gap was proved within the budget of cells",
            stop => stopped(stop),
        };
        let verified = "its center is inside, no edge enters it, and the gap is proved".to_owned();
        let [gap, verified] = gap_and_verified(proved, certificate.gap, verified);
        let ([larger, smaller], angle) = semi_axes(&answer.axes, answer.area);
        vec![
            Field::new("area", exact(answer.area)),
            center(&answer.center, smaller),
            Field::new("semi-axes", format!("{} and {}", exact(larger), exact(smaller)))
                .remark(&*format!("the longer one at {angle:.3}° from the first axis")),
            gap,
            verified,
            Field::new("method", &*trace.method).remark(ended),
            rows_of("touching edges", &certificate.touching),
            Field::new("cells", count(certificate.tree.len() as u64)).remark("of the proof"),
        ]
    }

    fn dim(_report: &Report<'_, Self>) -> usize {
        2
    }

    fn claims(found: &Solution<Self>, verdict: &Self::Verdict, source: &dyn PointSource) -> Claims {
        let (lower, upper) = (exact(verdict.lower), exact(verdict.upper));
        let points = counted(source.len(), "point");
        let area = exact(found.answer.area);
        Claims {
            what: format!("inscribed ellipse of area {area} in a polygon of {points}"),
            gap: Some(verdict.gap),
            fields: vec![
                Field::proved("bracket", format!("{lower} ≤ largest area ≤ {upper}"))
                    .remark("of ellipses with their center inside by the even-odd rule"),
                Field::proved("gap", gap(verdict.gap)).remark("relative, from the polygon alone"),
            ],
        }
    }
}

/// The half lengths of the axes of {Gz : |z| ≤ 1}, the longer one first, and its angle in degrees from 0 to 180.
///
/// The shorter one comes from the area: as a difference it would have no digits left in a long ellipse.
fn semi_axes([[a, b], [c, d]]: &[[f64; 2]; 2], area: f64) -> ([f64; 2], f64) {
    // Singular values and rotations from the two multiples of rotations that a matrix of two by two is the sum of.
    let (sum, difference) = ((a + d).hypot(c - b), (a - d).hypot(b + c));
    let angle = 0.5 * ((c - b).atan2(a + d) + (b + c).atan2(a - d));
    let larger = 0.5 * (sum + difference);
    let smaller = (area / larger / std::f64::consts::PI).min(larger);
    ([larger, smaller], angle.to_degrees().rem_euclid(180.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn semi_axes_are_those_of_the_ellipse() {
        let pi = std::f64::consts::PI;
        let (sine, cosine) = 0.7f64.sin_cos();
        let axes = [[3.0 * cosine, -sine], [3.0 * sine, cosine]];
        let ([larger, smaller], angle) = semi_axes(&axes, 3.0 * pi);
        assert!((larger - 3.0).abs() < 1e-14 && (smaller - 1.0).abs() < 1e-14);
        assert!((angle - 0.7f64.to_degrees()).abs() < 1e-12, "{angle}");
        let ([larger, smaller], angle) = semi_axes(&[[1.0, 0.0], [0.0, 2.0]], 2.0 * pi);
        assert!((larger - 2.0).abs() + (smaller - 1.0).abs() < 1e-15 && angle == 90.0);
    }

    #[test]
    fn the_shorter_axis_of_a_long_ellipse_keeps_its_digits() {
        let axes = [[5e15, 0.0], [0.0, 0.5]];
        let ([larger, smaller], _) = semi_axes(&axes, 2.5e15 * std::f64::consts::PI);
        assert!(larger == 5e15 && (smaller - 0.5).abs() < 1e-15, "{smaller}");
    }
}
