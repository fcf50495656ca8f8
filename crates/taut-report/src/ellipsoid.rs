//! The report about an ellipsoid.

use taut::certify::Ellipsoid;
use taut::certify::Stop;
use taut::points::PointSource;
use taut::{EllipsoidMethod, Solution};

use crate::numbers::{count, counted, exact, gap};
use crate::{Claims, Field, Report, Summary, center, gap_and_verified, inputs, noun, stopped};

impl Summary for Ellipsoid {
    const FOUND: &'static str = "the ellipsoid found";

    fn title(report: &Report<'_, Self>) -> String {
        let (source, left_out) = (report.points, &report.found.certificate.left_out);
        let inside = counted(source.len().saturating_sub(left_out.len() as u64), report.noun());
        let of = match left_out.len() {
            0 => String::new(),
            _ => format!(" of {}", count(source.len())),
        };
        let dim = counted(<Self as Summary>::dim(report) as u64, "dimension");
        format!("Smallest ellipsoid around {inside}{of} in {dim}")
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let trace = &report.found.trace;
        // The points may lie far from the origin: digits of the center count beside the extent of the ellipsoid.
        let longest = answer.factor.iter().flatten().fold(0.0f64, |m, f| m.max(f.abs()));
        let size = if longest > 0.0 { 1.0 / longest } else { 1.0 };
        let volume = Field::new("log-volume", exact(answer.log_volume));
        let volume = match (answer.rank(), answer.dim()) {
            (0, _) => volume.remark("all are one point"),
            (r, d) if r < d => {
                volume.remark(format!("of dimension {r}: all lie in a flat of {d} dimensions"))
            }
            _ => volume,
        };
        let proved = report.verdict.as_ref().map(|proved| {
            let lower = exact(proved.lower);
            (proved.gap, format!("no enclosing ellipsoid has a log-volume below {lower}"))
        });
        let verified = format!("every {} is inside, and the gap is proved", report.noun());
        let [gap, verified] = gap_and_verified(proved, certificate.gap, verified);
        let support = count(certificate.support.len() as u64);
        let mut fields = vec![volume, center(&answer.center, size), gap, verified];
        if !certificate.left_out.is_empty() {
            fields.push(Field::new(
                "left out",
                counted(certificate.left_out.len() as u64, report.noun()),
            ));
        }
        fields.extend([
            Field::new("method", &*trace.method).remark(report.ended()),
            Field::new("core-set", counted(trace.core_set, report.noun()))
                .remark(format!("{support} of them in the support")),
            Field::new("passes", count(trace.passes))
                .remark(counted(trace.iterations, "iteration")),
        ]);
        fields
    }

    fn dim(report: &Report<'_, Self>) -> usize {
        report.found.answer.dim()
    }

    fn claims(found: &Solution<Self>, verdict: &Self::Verdict, source: &dyn PointSource) -> Claims {
        let (answer, certificate) = (&found.answer, &found.certificate);
        let inputs = inputs(certificate.items, source.len(), source.dim());
        let bracket =
            format!("{} ≤ least log-volume ≤ {}", exact(verdict.lower), exact(verdict.upper));
        let dimension = Field::proved("dimension", verdict.rank.to_string());
        let dimension = match &answer.hull {
            Some(_) => dimension.remark(format!(
                "all lie within {} of a flat, and the bracket is about their projections to it",
                gap(verdict.off_hull)
            )),
            None => dimension,
        };
        Claims {
            what: format!("ellipsoid of log-volume {} around {inputs}", exact(answer.log_volume)),
            gap: Some(verdict.gap),
            fields: vec![
                Field::proved("bracket", bracket),
                Field::proved("gap", gap(verdict.gap))
                    .remark("in log-volume, from the points alone"),
                dimension,
                Field::proved("excess", gap(verdict.excess))
                    .remark("by which |F(x − c)| exceeds 1 at worst; it is part of the gap"),
                Field::proved("matrix", gap(verdict.matrix_excess))
                    .remark("by which (x − c)ᵀQ(x − c) can exceed 1 at worst"),
            ],
        }
    }
}

impl Report<'_, Ellipsoid> {
    fn ended(&self) -> &'static str {
        let trace = &self.found.trace;
        match trace.stop {
            Stop::PassBudget if trace.method == EllipsoidMethod::ThesisInitial.name() => {
                "done, as it does not search: the gap is what its points prove"
            }
            stop => stopped(stop),
        }
    }

    fn noun(&self) -> &'static str {
        noun(self.found.certificate.items)
    }
}
