//! The report about a ball.

use taut::certify::Ball;
use taut::points::PointSource;
use taut::{Items, Solution};

use crate::numbers::{count, counted, exact, gap};
use crate::{Claims, Field, Report, Summary, center, gap_and_verified, inputs, noun, stopped};

impl Summary for Ball {
    const FOUND: &'static str = "the ball found";

    fn title(report: &Report<'_, Self>) -> String {
        let around = counted(report.points.len(), noun(report.items()));
        format!(
            "Smallest ball around {around} in {}",
            counted(Self::dim(report) as u64, "dimension")
        )
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, trace) = (&report.found.answer, &report.found.trace);
        let (certificate, noun) = (&report.found.certificate, noun(report.items()));
        let support = count(certificate.support.len() as u64);
        let proved = report.verdict.as_ref().map(|proved| {
            let lower = exact(proved.lower);
            (proved.gap, format!("no enclosing ball has a radius below {lower}"))
        });
        let verified = format!("every {noun} is inside, and the gap is proved");
        let [gap, verified] = gap_and_verified(proved, certificate.gap, verified);
        vec![
            Field::new("radius", exact(answer.radius)),
            center(&answer.center, answer.radius),
            gap,
            verified,
            Field::new("method", &*trace.method).remark(stopped(trace.stop)),
            Field::new("core-set", counted(trace.core_set, noun))
                .remark(format!("{support} of them in the support")),
            Field::new("passes", count(trace.passes))
                .remark(counted(trace.iterations, "iteration")),
        ]
    }

    fn dim(report: &Report<'_, Self>) -> usize {
        report.items().dim(report.points.dim())
    }

    fn no_picture(found: &Solution<Self>) -> Option<&'static str> {
        let is_around_ellipsoids = found.certificate.items == Items::Ellipsoids;
        is_around_ellipsoids.then_some("there are no pictures of balls around ellipsoids")
    }

    fn claims(found: &Solution<Self>, verdict: &Self::Verdict, source: &dyn PointSource) -> Claims {
        let inputs = inputs(found.certificate.items, source.len(), source.dim());
        let bracket =
            format!("{} ≤ smallest radius ≤ {}", exact(verdict.lower), exact(verdict.upper));
        Claims {
            what: format!("ball of radius {} around {inputs}", exact(found.answer.radius)),
            gap: Some(verdict.gap),
            fields: vec![
                Field::proved("bracket", bracket),
                Field::proved("gap", gap(verdict.gap)).remark("relative, from the points alone"),
            ],
        }
    }
}

impl Report<'_, Ball> {
    fn items(&self) -> Items {
        self.found.certificate.items
    }
}
