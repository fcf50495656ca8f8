//! The report about a bounding dop.

use taut::Solution;
use taut::certify::BoundingDop;
use taut::points::PointSource;

use crate::numbers::{count, counted, exact};
use crate::{Claims, Field, Report, Summary};

impl Summary for BoundingDop {
    const FOUND: &'static str = "the dop found";

    fn title(report: &Report<'_, Self>) -> String {
        let points = counted(report.points.len(), "point");
        format!("Smallest {}-dop around {points}", report.found.answer.normals.len())
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let answer = &report.found.answer;
        let verified = match report.verdict {
            Some(_) => Field::new("verified", "yes")
                .remark("every point is inside, and each facet touches one"),
            None => Field::new("verified", "not checked"),
        };
        let mut rows = report.found.certificate.touching.clone();
        rows.sort_unstable();
        rows.dedup();
        vec![
            Field::new("volume", exact(answer.volume)),
            Field::new("vertices", count(answer.vertices.len() as u64)),
            Field::new("touched", counted(rows.len() as u64, "point")),
            verified,
        ]
    }

    fn dim(_report: &Report<'_, Self>) -> usize {
        3
    }

    fn claims(found: &Solution<Self>, verdict: &Self::Verdict, source: &dyn PointSource) -> Claims {
        let (lower, upper) = (exact(verdict.volume_lower), exact(verdict.volume_upper));
        let points = counted(source.len(), "point");
        Claims {
            what: format!("{}-dop around {points}", found.answer.normals.len()),
            gap: None,
            fields: vec![
                Field::proved("inside", "every point is inside").remark("by exact signs"),
                Field::proved("smallest", "each facet touches a point")
                    .remark("its offset is the least number that holds it"),
                Field::proved("vertices", count(found.answer.vertices.len() as u64))
                    .remark("those of the half-spaces, up to rounding"),
                Field::proved("volume", format!("{lower} ≤ volume ≤ {upper}")),
            ],
        }
    }
}
