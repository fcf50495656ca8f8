//! The algorithm of section 4.1 of the thesis where its theorem holds.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};
use taut_points::generate::curves::{CurveNoise, TestCurve};
use taut_reconstruct::{CurveMethod, CurveOptions};

use super::drawn::{CURVES, Trials, error, pool, truth};
use super::goals::Goals;
use crate::context::Context;
use crate::stats::seconds;
use crate::table::Table;

/// δ = 1 / 9ρ² for ρ = 4.
const DELTA: f64 = 1.0 / 144.0;
/// Errors of a plain implementation, which is told the unit, at the centres that pruning leaves; one draw each, by curve and number
/// of points.
const PLAIN: [(&str, [(usize, f64); 3]); 2] = [
    ("circle", [(1000, 1.56e-3), (4000, 6.0e-4), (16_000, 2.25e-4)]),
    ("flower5", [(1000, 3.8e-3), (4000, 2.6e-3), (16_000, 1.4e-3)]),
];

/// Connectivity over many draws, then errors beside those that are known.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let pool = pool(context.threads[context.threads.len() - 1])?;
    let options = CurveOptions { method: CurveMethod::Thesis, rho: 4.0, ..CurveOptions::default() };
    let noise = CurveNoise { delta: DELTA, ..CurveNoise::default() };
    let (mut goals, mut report) = (Goals::default(), vec![]);
    let mut table = Table::new(&[
        "curve",
        "n",
        "right",
        "wrong seeds",
        "rms",
        "Hausdorff",
        "median time of a draw",
    ]);
    let mut rights = vec![];
    for name in CURVES {
        let truth = truth(name, TestCurve::VERTICES)?;
        let per_length = if context.quick { 80.0 } else { 800.0 };
        let n = (per_length * truth.length_over_feature).ceil() as usize;
        let trials = Trials::run(&pool, &truth, n, &noise, &options, seeds.clone())?;
        let (right, all) = (trials.right(), trials.trials.len());
        table.push(vec![
            name.to_owned(),
            n.to_string(),
            format!("{right} of {all}"),
            trials.wrong(),
            error(trials.rms()),
            error(trials.median(|trial| trial.quality.hausdorff)),
            seconds(trials.median(|trial| trial.seconds)),
        ]);
        rights.push((name, right, all));
        report.push(json!({ "curve": name, "trials": trials.json() }));
    }
    println!("{table}");
    for (name, right, all) in rights {
        let met = right as f64 >= 0.95 * all as f64;
        goals.must(format!("{name}: right in 95 of 100"), format!("{right} of {all}"), met);
    }
    println!();
    let told = CurveOptions { feature: Some(1.0), ..options };
    let few = seeds.start..seeds.end.min(seeds.start + 10);
    for (name, sizes) in PLAIN {
        let truth = truth(name, TestCurve::VERTICES)?;
        for (n, known) in sizes {
            let trials = Trials::run(&pool, &truth, n, &noise, &told, few.clone())?;
            let rms = trials.median(|trial| trial.quality.vertex_rms);
            let what = format!("{name}, n = {n}: median rms of the centres");
            goals.at_most(&what, Some(rms), (known, None), error);
            report.push(json!({ "curve": name, "rms_of_centres": rms, "trials": trials.json() }));
        }
    }
    Ok(json!({ "draws": report, "goals": goals.json() }))
}
