//! The report about a rectangle in a polygon.

use taut::Solution;
use taut::certify::{InscribedRectangle, Stop};
use taut::points::PointSource;

use crate::numbers::{count, counted, exact, gap};
use crate::{Claims, Field, Report, Summary, gap_and_verified, stopped};

impl Summary for InscribedRectangle {
    const FOUND: &'static str = "the rectangle found";

    fn title(report: &Report<'_, Self>) -> String {
        let vertices = counted(report.points.len(), "point");
        format!("Largest rectangle along the axes in a polygon of {vertices}")
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let trace = &report.found.trace;
        let proved = report.verdict.as_ref().map(|proved| {
            let upper = exact(proved.upper);
            (
                proved.gap,
                format!("no rectangle along the axes in the polygon has an area above {upper}"),
            )
        });
        let ended = match trace.stop {
            Stop::NodeBudget => "a larger gap was proved within the budget of cells",
            stop => stopped(stop),
        };
        let verified = "it is inside, no edge enters it, and the gap is proved".to_owned();
        let [gap, verified] = gap_and_verified(proved, certificate.gap, verified);
        vec![
            Field::new("area", exact(answer.area)),
            Field::new("corners", format!("{} and {}", corner(answer.low), corner(answer.high))),
            gap,
            verified,
            Field::new("method", &*trace.method).remark(ended),
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
            what: format!("inscribed rectangle of area {area} in a polygon of {points}"),
            gap: Some(verdict.gap),
            fields: vec![
                Field::proved("bracket", format!("{lower} ≤ largest area ≤ {upper}"))
                    .remark("of rectangles inside by the even-odd rule"),
                Field::proved("gap", gap(verdict.gap)).remark("relative, from the polygon alone"),
            ],
        }
    }
}

/// A corner as a pair.
pub(crate) fn corner([x, y]: [f64; 2]) -> String {
    format!("({}, {})", exact(x), exact(y))
}
