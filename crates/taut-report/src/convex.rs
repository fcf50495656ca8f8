//! The report about a convex polygon in a polygon.

use taut::Solution;
use taut::certify::ConvexPolygon;
use taut::points::PointSource;

use crate::numbers::{count, counted, exact, gap};
use crate::{Claims, Field, Report, Summary, gap_and_verified};

impl Summary for ConvexPolygon {
    const FOUND: &'static str = "the polygon found";

    fn title(report: &Report<'_, Self>) -> String {
        let vertices = counted(report.points.len(), "point");
        format!("Large convex polygon in a polygon of {vertices}")
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let proved = report.verdict.as_ref().map(|proved| {
            let upper = exact(proved.upper);
            (proved.gap, format!("no convex set in the polygon has an area above {upper}"))
        });
        let verified = "it is convex and inside, no edge enters it, and the gap is proved";
        let [gap, verified] = gap_and_verified(proved, certificate.gap, verified.to_owned());
        vec![
            Field::new("area", exact(answer.area)),
            Field::new("corners", count(answer.vertices.len() as u64)),
            gap,
            verified,
            Field::new("method", &*report.found.trace.method).remark("a local optimum"),
        ]
    }

    fn dim(_report: &Report<'_, Self>) -> usize {
        2
    }

    fn claims(found: &Solution<Self>, verdict: &Self::Verdict, source: &dyn PointSource) -> Claims {
        let (lower, upper) = (exact(verdict.lower), exact(verdict.upper));
        let points = counted(source.len(), "point");
        let corners = counted(found.answer.vertices.len() as u64, "corner");
        let area = exact(found.answer.area);
        Claims {
            what: format!("convex polygon of {corners} and area {area} in a polygon of {points}"),
            gap: Some(verdict.gap),
            fields: vec![
                Field::proved("bracket", format!("{lower} ≤ largest area ≤ {upper}"))
                    .remark("of convex sets inside by the even-odd rule"),
                Field::proved("gap", gap(verdict.gap)).remark("relative, from the polygon alone"),
            ],
        }
    }
}
