//! What is said about curves.

use taut::certify::CurveVerdict;
use taut::{Curve, PointSource, Solution};
use taut_draw::{DrawOptions, Error as DrawError, Figure, curve_figures};

use crate::numbers::{count, counted, exact, gap, short};
use crate::report::{
    Claims, Fact, Report, Summary, rows_of, without_outliers, yes_without_outliers,
};

impl Summary for Curve {
    const FOUND: &'static str = "the curves found";

    fn title(report: &Report<'_, Self>) -> String {
        let points = counted(report.points.source().len(), "point");
        format!("{points} in the plane: {}", curves_of(report.found))
    }

    fn facts(report: &Report<'_, Self>) -> Vec<Fact> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let closed = answer.curves.iter().filter(|curve| curve.closed).count() as u64;
        let all = answer.curves.len() as u64;
        let vertices: usize = answer.curves.iter().map(|curve| curve.vertices.len()).sum();
        let are_rows = answer.curves.iter().all(|curve| !curve.rows.is_empty());
        let vertices = Fact::new("vertices", count(vertices as u64));
        let mut facts = vec![
            Fact::new("curves", count(all)).remark(match (all, closed) {
                (0, _) => "nothing to join".to_owned(),
                (1, 1) => "closed".to_owned(),
                (1, 0) => "open".to_owned(),
                (all, closed) => format!("{} closed, {} open", count(closed), count(all - closed)),
            }),
            match are_rows && all > 0 {
                true => vertices.remark("each is a point of the input"),
                false => vertices,
            },
        ];
        if !are_rows {
            facts.push(
                Fact::new("noise", short(answer.noise))
                    .remark("half the width of its band, as estimated"),
            );
        }
        let band = report.verdict.as_ref().map_or(certificate.band, |proved| proved.band);
        facts.push(match (&report.verdict, answer.outliers.is_empty()) {
            (None, _) => Fact::new("band", exact(band)).remark("as the solver says"),
            (Some(_), true) => {
                Fact::new("band", exact(band)).remark("no point is farther from the curves")
            }
            (Some(_), false) => Fact::new("band", exact(band))
                .remark("no point but the outliers is farther from the curves"),
        });
        if !answer.outliers.is_empty() {
            facts.push(rows_of("outliers", &answer.outliers));
        }
        match &report.verdict {
            Some(proved) => facts.extend(judged(proved)),
            None => facts.push(match certificate.certified {
                true => Fact::new("certified", "yes").remark("as the solver says"),
                false => Fact::new("certified", "no").remark("as the solver says"),
            }),
        }
        facts.push(match &report.verdict {
            Some(proved) if proved.is_simple => {
                Fact::new("verified", "yes").remark("no two edges meet, and the band holds")
            }
            Some(_) => Fact::new("verified", "yes").remark("a tour, and its bound"),
            None => Fact::new("verified", "not checked"),
        });
        facts.push(Fact::new("method", &*report.found.trace.method));
        facts
    }

    fn dim(report: &Report<'_, Self>) -> usize {
        report.points.source().dim()
    }

    fn figures(report: &Report<'_, Self>, options: &DrawOptions) -> Result<Vec<Figure>, DrawError> {
        curve_figures(report.found, report.points.source(), options)
    }

    fn claims(
        found: &Solution<Self>,
        verdict: &Self::Verdict,
        _source: &dyn PointSource,
    ) -> Claims {
        let band = Fact::proved("band", exact(verdict.band));
        let mut facts = vec![
            match verdict.outliers {
                0 => band.remark("no point is farther off"),
                _ => band.remark("no point but outliers is farther off"),
            },
            match verdict.is_simple {
                true => {
                    Fact::proved("simple", "yes").remark("no two edges meet, by exact predicates")
                }
                false => Fact::proved("simple", "no").remark("edges of the tour meet"),
            },
        ];
        facts.extend(judged(verdict));
        let used = verdict.rows - verdict.outliers;
        let rows = without_outliers(used, verdict.rows, verdict.outliers, "in the plane");
        Claims {
            what: format!("{} through {rows}", curves_of(found)),
            gap: verdict.tour_gap,
            facts,
        }
    }
}

/// How many, and of which kind: "3 curves".
pub(crate) fn curves_of(found: &Solution<Curve>) -> String {
    match (&found.certificate.tour, &found.answer.curves[..]) {
        (Some(_), [tour]) => if tour.closed { "a tour" } else { "a path" }.to_owned(),
        (_, curves) => counted(curves.len() as u64, "curve"),
    }
}

/// Whether the sampling is dense enough, and of a tour how short it is.
fn judged(verdict: &CurveVerdict) -> Vec<Fact> {
    let mut facts = vec![match &verdict.doubt {
        None => {
            let value = yes_without_outliers(verdict.rows, verdict.outliers);
            Fact::evidence("certified", value).remark(format!(
                "sampled at ε ≤ {}, noise at {} of the feature size",
                short_ratio(verdict.sampling_ratio),
                short_ratio(verdict.noise_ratio)
            ))
        }
        Some(doubt) => Fact::evidence("certified", "no").remark(doubt.to_string()),
    }];
    if let Some(proved) = verdict.tour_gap {
        let meaning = "length over its lower bound, less 1";
        facts.push(Fact::proved("tour gap", gap(proved)).remark(meaning));
    }
    facts
}

fn short_ratio(ratio: f64) -> String {
    format!("{ratio:.3}")
}
