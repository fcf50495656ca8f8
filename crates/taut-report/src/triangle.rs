//! The report about a triangle in a polygon.

use taut::Solution;
use taut::certify::{InscribedTriangle, Stop};
use taut::points::PointSource;

use crate::numbers::{count, counted, exact, gap};
use crate::{Claims, Field, Report, Summary, gap_and_verified, rows_of, stopped};

impl Summary for InscribedTriangle {
    const FOUND: &'static str = "the triangle found";

    fn title(report: &Report<'_, Self>) -> String {
        let vertices = counted(report.points.len(), "point");
        let size = match &*report.found.trace.method {
            "branch-and-bound" => "Largest",
            _ => "Large",
        };
        format!("{size} triangle in a polygon of {vertices}")
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let trace = &report.found.trace;
        let proved = report.verdict.as_ref().map(|proved| {
            let upper = exact(proved.upper);
            (proved.gap, format!("no triangle in the polygon has an area above {upper}"))
        });
        let ended = match trace.stop {
            Stop::NodeBudget => "a larger gap was proved within the budget of cells",
            stop => stopped(stop),
        };
        let verified = "it lies in the polygon, and the gap is proved".to_owned();
        let [gap, verified] = gap_and_verified(proved, certificate.gap, verified);
        let corner = |[x, y]: [f64; 2]| format!("({}, {})", exact(x), exact(y));
        vec![
            Field::new("area", exact(answer.area)),
            Field::new("corners", answer.corners.map(corner).join(", ")),
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
            what: format!("inscribed triangle of area {area} in a polygon of {points}"),
            gap: Some(verdict.gap),
            fields: vec![
                Field::proved("bracket", format!("{lower} ≤ largest area ≤ {upper}"))
                    .remark("of triangles inside by the even-odd rule"),
                Field::proved("gap", gap(verdict.gap)).remark("relative, from the polygon alone"),
            ],
        }
    }
}
