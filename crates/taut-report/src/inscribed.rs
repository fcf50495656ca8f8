//! The report about an ellipsoid inside a polytope.

use taut::Solution;
use taut::certify::InscribedEllipsoid;
use taut::certify::Stop;
use taut::points::PointSource;

use crate::numbers::{count, counted, exact, gap};
use crate::{Claims, Field, Report, Summary, center, gap_and_verified, stopped};

impl Summary for InscribedEllipsoid {
    const FOUND: &'static str = "the ellipsoid found";

    fn title(report: &Report<'_, Self>) -> String {
        let sides = counted(report.points.len(), "half-space");
        let dim = counted(Self::dim(report) as u64, "dimension");
        format!("Largest ellipsoid inside {sides} in {dim}")
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let trace = &report.found.trace;
        // Digits of the center count beside the extent of the ellipsoid.
        let widest = answer.axes.iter().flatten().fold(0.0f64, |m, g| m.max(g.abs()));
        let proved = report.verdict.as_ref().map(|proved| {
            let upper = exact(proved.upper);
            (proved.gap, format!("no ellipsoid inside has a log-volume above {upper}"))
        });
        let ended = match trace.stop {
            Stop::PassBudget => "stopped early by the budget of steps",
            stop => stopped(stop),
        };
        let verified = "it lies in every half-space, and the gap is proved".to_owned();
        let [gap, verified] = gap_and_verified(proved, certificate.gap, verified);
        vec![
            Field::new("log-volume", exact(answer.log_volume)),
            center(&answer.center, if widest > 0.0 { widest } else { 1.0 }),
            gap,
            verified,
            Field::new("method", &*trace.method).remark(ended),
            Field::new("support", counted(certificate.support.len() as u64, "half-space"))
                .remark("with a multiplier above 0"),
            Field::new("steps", count(trace.iterations)),
        ]
    }

    fn dim(report: &Report<'_, Self>) -> usize {
        report.found.answer.center.len()
    }

    fn claims(found: &Solution<Self>, verdict: &Self::Verdict, source: &dyn PointSource) -> Claims {
        let (lower, upper) = (exact(verdict.lower), exact(verdict.upper));
        let sides = counted(source.len(), "half-space");
        let dim = counted(found.answer.center.len() as u64, "dimension");
        let volume = exact(found.answer.log_volume);
        Claims {
            what: format!("inscribed ellipsoid of log-volume {volume} within {sides} in {dim}"),
            gap: Some(verdict.gap),
            fields: vec![
                Field::proved("bracket", format!("{lower} ≤ largest log-volume ≤ {upper}")),
                Field::proved("gap", gap(verdict.gap))
                    .remark("in log-volume, from the half-spaces alone"),
            ],
        }
    }
}
