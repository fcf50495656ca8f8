//! The report about a circle in a polygon.

use taut::Solution;
use taut::certify::{InscribedCircle, Stop};
use taut::points::PointSource;

use crate::numbers::{count, counted, exact, gap};
use crate::{Claims, Field, Report, Summary, center, gap_and_verified, rows_of, stopped};

impl Summary for InscribedCircle {
    const FOUND: &'static str = "the circle found";

    fn title(report: &Report<'_, Self>) -> String {
        let vertices = counted(report.points.len(), "point");
        format!("Largest circle in a polygon of {vertices}")
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let trace = &report.found.trace;
        let proved = report.verdict.as_ref().map(|proved| {
            let upper = exact(proved.upper);
            (proved.gap, format!("no circle in the polygon has a radius above {upper}"))
        });
        let ended = match trace.stop {
            Stop::NodeBudget => "a larger gap was proved within the budget of cells",
            stop => stopped(stop),
        };
        let verified = "its center is inside, no edge enters it, and the gap is proved".to_owned();
        let [gap, verified] = gap_and_verified(proved, certificate.gap, verified);
        vec![
            Field::new("radius", exact(answer.radius)),
            center(&answer.center, answer.radius),
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
        let radius = exact(found.answer.radius);
        Claims {
            what: format!("inscribed circle of radius {radius} in a polygon of {points}"),
            gap: Some(verdict.gap),
            fields: vec![
                Field::proved("bracket", format!("{lower} ≤ largest radius ≤ {upper}"))
                    .remark("of circles with their center inside by the even-odd rule"),
                Field::proved("gap", gap(verdict.gap)).remark("relative, from the polygon alone"),
            ],
        }
    }
}
