//! The report about curves.

use taut::certify::Curve;
use taut::certify::CurveVerdict;
use taut::{PointSource, Solution};

use crate::numbers::{count, counted, exact, gap, short};
use crate::{
    Claims, Field, Report, Summary, rows_of, share, without_outliers, yes_without_outliers,
};

impl Summary for Curve {
    const FOUND: &'static str = "the curves found";

    fn title(report: &Report<'_, Self>) -> String {
        let points = counted(report.points.len(), "point");
        format!("{points} in the plane: {}", curves_of(report.found))
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let closed = answer.curves.iter().filter(|curve| curve.closed).count() as u64;
        let all = answer.curves.len() as u64;
        let vertices: usize = answer.curves.iter().map(|curve| curve.vertices.len()).sum();
        let are_rows = answer.curves.iter().all(|curve| !curve.rows.is_empty());
        let vertices = Field::new("vertices", count(vertices as u64));
        let mut fields = vec![
            Field::new("curves", count(all)).remark(match (all, closed) {
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
            fields.push(
                Field::new("noise", short(answer.noise))
                    .remark("half the width of its band, as estimated"),
            );
        }
        let band = report.verdict.as_ref().map_or(certificate.band, |proved| proved.band);
        fields.push(match (&report.verdict, answer.outliers.is_empty()) {
            (None, _) => Field::new("band", exact(band)).remark("as the solver says"),
            (Some(_), true) => {
                Field::new("band", exact(band)).remark("no point is farther from the curves")
            }
            (Some(_), false) => Field::new("band", exact(band))
                .remark("no point but the outliers is farther from the curves"),
        });
        if !answer.outliers.is_empty() {
            fields.push(rows_of("outliers", &answer.outliers));
        }
        match &report.verdict {
            Some(proved) => fields.extend(judged(proved)),
            None => fields.push(match certificate.certified {
                true => Field::new("certified", "yes").remark("as the solver says"),
                false => Field::new("certified", "no").remark("as the solver says"),
            }),
        }
        fields.push(match &report.verdict {
            Some(proved) if proved.is_simple => {
                Field::new("verified", "yes").remark("no two edges meet, and the band holds")
            }
            Some(_) => Field::new("verified", "yes").remark("a tour, and its bound"),
            None => Field::new("verified", "not checked"),
        });
        fields.push(Field::new("method", &*report.found.trace.method));
        let rows = report.points.len();
        fields.extend(advice(report.found, rows).map(|text| Field::new("try", text)));
        fields
    }

    fn dim(report: &Report<'_, Self>) -> usize {
        report.points.dim()
    }

    fn claims(
        found: &Solution<Self>,
        verdict: &Self::Verdict,
        _source: &dyn PointSource,
    ) -> Claims {
        let band = Field::proved("band", exact(verdict.band));
        let mut fields = vec![
            match verdict.outliers {
                0 => band.remark("no point is farther off"),
                _ => band.remark("no point but outliers is farther off"),
            },
            match verdict.is_simple {
                true => {
                    Field::proved("simple", "yes").remark("no two edges meet, by exact predicates")
                }
                false => Field::proved("simple", "no").remark("edges of the tour meet"),
            },
        ];
        fields.extend(judged(verdict));
        let used = verdict.rows - verdict.outliers;
        let rows = without_outliers(used, verdict.rows, verdict.outliers, "in the plane");
        Claims {
            what: format!("{} through {rows}", curves_of(found)),
            gap: verdict.tour_gap,
            fields,
        }
    }
}

/// A fit that leaves out more than one in so many of the points is told to be doubtful.
const ROWS_PER_OUTLIER_MIN: f64 = 1.0 / 0.15;

/// Returns what to try instead of a method that found little, and why it did.
fn advice(found: &Solution<Curve>, rows: u64) -> Option<String> {
    let (answer, trace) = (&found.answer, &found.trace);
    let counted = |name: &str| trace.counters.get(name).copied().unwrap_or(0);
    match &*trace.method {
        "thesis" | "thesis-crude" if answer.curves.is_empty() && rows > 0 => {
            let (sparse, wide) = (counted("samples_too_sparse"), counted("samples_not_flat"));
            Some(match sparse > wide {
                _ if 2 * (sparse + wide) < rows => format!(
                    "--method fit, or a smaller --feature: the disks are so large that pruning left {} of the centers",
                    counted("centers_selected")
                ),
                true => format!(
                    "--method fit, or --feature: around {} the points are too sparse beside the least feature size",
                    share(sparse, rows)
                ),
                false => format!(
                    "--method fit, a smaller --rho, or --feature: around {} no disk within the least feature size is ρ times \
                     as long as its points are wide",
                    share(wide, rows)
                ),
            })
        }
        "fit" if answer.curves.is_empty() && rows > 0 => Some(
            "--method corners or hnn-crust, for points without noise: no band of noise was found".to_owned(),
        ),
        "fit" if answer.outliers.len() as f64 * ROWS_PER_OUTLIER_MIN > rows as f64 => Some(format!(
            "--method corners or hnn-crust, if the points have no noise: {} lie on no curve of the fit",
            share(answer.outliers.len() as u64, rows)
        )),
        "fit" if answer.curves.iter().all(|one| !one.closed) && !answer.curves.is_empty() => {
            Some("--method corners or hnn-crust, if the points have no noise: all curves of the fit are open".to_owned())
        }
        _ => None,
    }
}

/// Returns how many, and of which kind: "3 curves".
pub(crate) fn curves_of(found: &Solution<Curve>) -> String {
    match (&found.certificate.tour, &found.answer.curves[..]) {
        (Some(_), [tour]) => if tour.closed { "a tour" } else { "a path" }.to_owned(),
        (_, curves) => counted(curves.len() as u64, "curve"),
    }
}

/// Tests whether the sampling is dense enough, and of a tour how short it is.
fn judged(verdict: &CurveVerdict) -> Vec<Field> {
    let mut fields = vec![match &verdict.doubt {
        None => {
            let value = yes_without_outliers(verdict.rows, verdict.outliers);
            Field::evidence("certified", value).remark(format!(
                "sampled at ε ≤ {}, noise at {} of the feature size",
                short_ratio(verdict.sampling_ratio),
                short_ratio(verdict.noise_ratio)
            ))
        }
        Some(doubt) => {
            Field::evidence("certified", "no").remark(format!("{doubt}; all counted from 0"))
        }
    }];
    if let Some(proved) = verdict.tour_gap {
        let meaning = "length over its lower bound, less 1";
        fields.push(Field::proved("tour gap", gap(proved)).remark(meaning));
    }
    fields
}

fn short_ratio(ratio: f64) -> String {
    format!("{ratio:.3}")
}
