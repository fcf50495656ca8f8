//! The report about a robust ellipsoid.

use taut::certify::RobustEllipsoid;
use taut::points::PointSource;
use taut::{RobustMethod, Solution};

use crate::numbers::{count, counted, exact, gap};
use crate::{Claims, Field, Report, Summary, center, rows_of};

impl Summary for RobustEllipsoid {
    const FOUND: &'static str = "the ellipsoid found";

    fn title(report: &Report<'_, Self>) -> String {
        let source = report.points;
        let dim = counted(Self::dim(report) as u64, "dimension");
        format!("Robust ellipsoid of {} in {dim}", counted(source.len(), "point"))
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let trace = &report.found.trace;
        let (n, dim, rank) = (report.points.len(), answer.center.len(), answer.factor.len());
        let widest = (0..dim).map(|a| answer.scatter[a][a].sqrt()).fold(0.0, f64::max);
        let size = if widest > 0.0 { widest } else { 1.0 };
        let border = match certificate.method {
            RobustMethod::Trim => "of the ellipsoid around the points kept".to_owned(),
            _ => format!("of the ellipsoid that holds {} of normal points", certificate.level),
        };
        let mut fields = vec![
            center(&answer.center, size),
            Field::new("log-det", exact(answer.log_det)).remark("of the scatter"),
            Field::new("log-volume", exact(answer.log_volume)).remark(border),
            Field::new("kept", format!("{} of {}", count(certificate.kept), counted(n, "point"))),
            rows_of("outliers", &answer.flagged),
        ];
        if answer.hull.is_some() {
            let on = report.verdict.map_or_else(
                || "most points".to_owned(),
                |proved| format!("{} of {}", count(proved.on_hull), counted(n, "point")),
            );
            fields.push(
                Field::new("exact fit", format!("{on} in a flat of dimension {rank}"))
                    .remark("center and scatter are theirs, and all others are outliers"),
            );
        }
        fields.push(match &report.verdict {
            Some(_) => Field::new("verified", "yes").remark(
                "all is calculated again, and no C-step leads on; other points kept might do better",
            ),
            None => Field::new("verified", "not checked"),
        });
        if let Some(enclosure) = &certificate.enclosure {
            let proved = report.verdict.and_then(|verdict| verdict.enclosure);
            let value = proved.map_or(enclosure.certificate.gap, |proved| proved.gap);
            fields.push(
                Field::new("gap", gap(value))
                    .remark("in log-volume, of the ellipsoid around the points kept"),
            );
        }
        fields.extend([
            Field::new("method", certificate.method.name())
                .remark(counted(trace.iterations, "C-step")),
            Field::new("passes", count(trace.passes)),
        ]);
        fields
    }

    fn dim(report: &Report<'_, Self>) -> usize {
        report.found.answer.center.len()
    }

    fn claims(found: &Solution<Self>, verdict: &Self::Verdict, source: &dyn PointSource) -> Claims {
        let (answer, certificate) = (&found.answer, &found.certificate);
        let off = verdict.flag_excess;
        let flags = if off > 0.0 {
            format!("the points outside the ellipsoid, but for rounding by {off:.0e} of its size")
        } else {
            "exactly the points outside the ellipsoid".to_owned()
        };
        let mut fields = vec![
            Field::proved("objective", exact(verdict.objective))
                .remark(format!("that of the points kept, within {:.0e}", verdict.slack)),
            match verdict.enclosure {
                None => Field::proved("local optimum", "yes").remark("no C-step leads on"),
                Some(_) => Field::evidence("local optimum", "yes").remark(
                    "no C-step leads on from the ellipsoid told, which is the smallest within the gap",
                ),
            },
            Field::new("optimum", "not judged").remark("other points kept might do better"),
            Field::proved("kept", count(verdict.kept))
                .remark(format!("at least {} were to be kept", count(verdict.wanted))),
            Field::proved("outliers", count(answer.flagged.len() as u64)).remark(flags),
            Field::proved("dimension", verdict.rank.to_string()),
        ];
        if certificate.method != RobustMethod::Trim {
            let level = format!("{} of normal points", certificate.level);
            fields.push(Field::new("level", level).remark("which the ellipsoid is to hold"));
        }
        if let Some(enclosure) = &verdict.enclosure {
            fields.push(
                Field::proved("gap", gap(enclosure.gap))
                    .remark("in log-volume, of the ellipsoid around the points kept"),
            );
        }
        let dim = counted(answer.center.len() as u64, "dimension");
        Claims {
            what: format!(
                "robust ellipsoid by {} of {} of {} in {dim}",
                certificate.method,
                count(certificate.kept),
                counted(source.len(), "point")
            ),
            gap: verdict.enclosure.map(|enclosure| enclosure.gap),
            fields,
        }
    }
}
