//! The report about a ball in the feature space of a kernel.

use taut::Solution;
use taut::certify::{Kernel, KernelBall};
use taut::points::PointSource;

use crate::numbers::{count, counted, exact, gap};
use crate::{Claims, Field, Report, Summary, gap_and_verified, rows_of, stopped};

impl Summary for KernelBall {
    const FOUND: &'static str = "the ball found";

    fn title(report: &Report<'_, Self>) -> String {
        let around = counted(report.points.len(), "point");
        let ball = ball_of(&report.found.answer);
        format!("{ball} around {around}")
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, trace) = (&report.found.answer, &report.found.trace);
        let proved = report.verdict.as_ref().map(|proved| {
            let lower = exact(proved.lower);
            let what = if answer.nu.is_some() { "objective" } else { "squared radius" };
            (proved.gap, format!("the {what} of every ball is at least {lower}"))
        });
        let verified = match answer.nu {
            None => "every point is inside, and the gap is proved",
            Some(_) => "the gap of the objective is proved",
        };
        let [gap, verified] =
            gap_and_verified(proved, report.found.certificate.gap, verified.to_owned());
        let mut fields = vec![
            Field::new("squared radius", exact(answer.squared_radius))
                .remark("in the feature space"),
            rows_of("support", &answer.support),
        ];
        if let (Some(_), Some(verdict)) = (answer.nu, &report.verdict) {
            fields.push(Field::new(
                "outside",
                format!("at least {}", counted(verdict.outside, "point")),
            ));
            fields.push(Field::new("objective", exact(verdict.upper)));
        }
        fields.extend([
            gap,
            verified,
            Field::new("method", &*trace.method).remark(stopped(trace.stop)),
            Field::new("passes", count(trace.passes))
                .remark(counted(trace.iterations, "iteration")),
        ]);
        fields
    }

    fn dim(report: &Report<'_, Self>) -> usize {
        report.points.dim()
    }

    fn claims(found: &Solution<Self>, verdict: &Self::Verdict, source: &dyn PointSource) -> Claims {
        let points = counted(source.len(), "point");
        let bracket = format!("{} ≤ least ≤ {}", exact(verdict.lower), exact(verdict.upper));
        let what = if found.answer.nu.is_some() { "objective" } else { "squared radius" };
        let mut fields = vec![
            Field::proved("bracket", bracket).remark(format!("of the {what}")),
            Field::proved("gap", gap(verdict.gap)).remark("relative, from the points alone"),
            Field::proved("outside", format!("at least {}", counted(verdict.outside, "point")))
                .remark("rounding leaves no doubt of them"),
        ];
        if found.answer.kernel == Kernel::Precomputed {
            fields.push(
                Field::evidence("kernel", "taken as positive semidefinite")
                    .remark("the rows of the support are symmetric"),
            );
        }
        Claims {
            what: format!("{} around {points}", ball_of(&found.answer)),
            gap: Some(verdict.gap),
            fields,
        }
    }
}

/// The kind of ball and its parameters.
fn ball_of(ball: &KernelBall) -> String {
    let kernel = match ball.kernel {
        Kernel::Gaussian { gamma } => format!("a Gaussian kernel with γ = {}", exact(gamma)),
        Kernel::Polynomial { gamma, offset, degree } => {
            format!("the kernel ({} x·y + {})^{degree}", exact(gamma), exact(offset))
        }
        other => format!("a {} kernel", other.name()),
    };
    match ball.nu {
        None => format!("Smallest ball of {kernel}"),
        Some(nu) => format!("Soft ball (ν = {}) of {kernel}", exact(nu)),
    }
}
