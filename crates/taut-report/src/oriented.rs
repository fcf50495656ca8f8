//! The report about a rectangle of any direction in a polygon.

use taut::Solution;
use taut::certify::{InscribedOrientedRectangle, Stop};
use taut::points::PointSource;

use crate::numbers::{count, counted, exact, gap};
use crate::rectangle::corner;
use crate::{Claims, Field, Report, Summary, gap_and_verified, stopped};

impl Summary for InscribedOrientedRectangle {
    const FOUND: &'static str = "the rectangle found";

    fn title(report: &Report<'_, Self>) -> String {
        let vertices = counted(report.points.len(), "point");
        format!("Largest rectangle of any direction in a polygon of {vertices}")
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let trace = &report.found.trace;
        let proved = report.verdict.as_ref().map(|proved| {
            let upper = exact(proved.upper);
            (proved.gap, format!("no rectangle in the polygon has an area above {upper}"))
        });
        let ended = match trace.stop {
            Stop::NodeBudget => "a larger gap was proved within the budget of cells",
            stop => stopped(stop),
        };
        let verified = "it is inside, no edge enters it, and the gap is proved".to_owned();
        let [gap, verified] = gap_and_verified(proved, certificate.gap, verified);
        let degrees = answer.axis[1].atan2(answer.axis[0]).to_degrees();
        vec![
            Field::new("area", exact(answer.area)),
            Field::new("corners", answer.corners().map(corner).join(", ")),
            Field::new("angle", format!("{degrees:.3} degrees")).remark("of the longer sides"),
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
            what: format!(
                "inscribed rectangle of any direction of area {area} in a polygon of {points}"
            ),
            gap: Some(verdict.gap),
            fields: vec![
                Field::proved("bracket", format!("{lower} ≤ largest area ≤ {upper}"))
                    .remark("of rectangles of any direction inside by the even-odd rule"),
                Field::proved("gap", gap(verdict.gap)).remark("relative, from the polygon alone"),
            ],
        }
    }
}
