//! Beside published errors of FitConnect, which is not run: its figures are from one draw of the same law.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};
use taut_points::generate::curves::TestCurve;
use taut_reconstruct::CurveOptions;

use super::drawn::{NOISE, Trials, error, truth};
use crate::context::Context;
use crate::goals::Goals;
use crate::stats::{seconds, times};
use crate::table::Table;

const N: usize = 2000;
/// Curve, rms, Hausdorff distance and seconds of FitConnect.
const FITCONNECT: [(&str, f64, f64, &str); 5] = [
    ("circle", 0.0133, 0.038, "3.1–5.6"),
    ("ellipse3", 0.0214, 0.076, "11.9"),
    ("flower5", 0.0226, 0.062, "1.1"),
    ("bumpy", 0.0224, 0.084, "14.2"),
    ("gear20", 0.0217, 0.135, ".72"),
];

/// Errors and times row by row.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let threads = context.threads[context.threads.len() - 1];
    let options = CurveOptions { threads: Some(threads), ..CurveOptions::default() };
    // One draw after another, so that times are those of a draw alone.
    let pool = super::drawn::pool(1)?;
    let (mut goals, mut report) = (Goals::default(), vec![]);
    let head = [
        "curve",
        "rms",
        "FitConnect's",
        "ratio",
        "Hausdorff",
        "FitConnect's",
        "right",
        "time",
        "FitConnect's [s]",
    ];
    let mut table = Table::new(&head);
    let mut rows = vec![];
    for (name, their_rms, their_hausdorff, their_seconds) in FITCONNECT {
        let truth = truth(name, TestCurve::VERTICES)?;
        let trials = Trials::timed(&pool, &truth, N, &NOISE, &options, seeds.clone())?;
        let rms = trials.rms();
        let worst = trials.trials.iter().map(|trial| trial.seconds).fold(0.0, f64::max);
        let (right, all) = (trials.right(), trials.trials.len());
        table.push(vec![
            name.to_owned(),
            error(rms),
            error(their_rms),
            times(rms / their_rms),
            error(trials.median(|trial| trial.quality.hausdorff)),
            error(their_hausdorff),
            format!("{right} of {all}"),
            seconds(worst),
            their_seconds.to_owned(),
        ]);
        rows.push((name, rms / their_rms, right == all, format!("{right} of {all}"), worst));
        report.push(json!({ "curve": name, "fitconnect_rms": their_rms, "trials": trials.json() }));
    }
    println!("n = {N}, the slowest of all draws, {threads} threads\n\n{table}");
    for (name, ratio, is_right, right, worst) in rows {
        let what = format!("{name}: rms over FitConnect's");
        goals.at_most(&what, Some(ratio), (1.0, Some(0.5)), times);
        goals.must(format!("{name}: right in all draws"), right, is_right);
        goals.at_most(&format!("{name}: time"), Some(worst), (0.05, Some(0.01)), seconds);
    }
    Ok(json!({ "draws": report, "goals": goals.json() }))
}
