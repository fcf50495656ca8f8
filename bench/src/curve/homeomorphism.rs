//! How often the default method finds the right curves, without outliers and with a tenth of them.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};
use taut_points::generate::curves::{CurveNoise, TestCurve};
use taut_reconstruct::CurveOptions;

use super::drawn::{CURVES, NOISE, Trials, error, pool, truth};
use crate::context::Context;
use crate::goals::Goals;
use crate::stats::seconds;
use crate::table::Table;

/// Connectivity over many draws.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let pool = pool(context.threads[context.threads.len() - 1])?;
    let options = CurveOptions::default();
    let (mut goals, mut report) = (Goals::default(), vec![]);
    let head = [
        "curve",
        "outliers",
        "n",
        "right",
        "wrong seeds",
        "rms",
        "Hausdorff",
        "median time of a draw",
    ];
    let mut table = Table::new(&head);
    let mut rights = vec![];
    for (outliers, share) in [(0.0, 0.95), (0.1, 0.85)] {
        for name in CURVES {
            let truth = truth(name, TestCurve::VERTICES)?;
            let n = (1000.0 * truth.length_over_feature).ceil() as usize;
            let noise = CurveNoise { outliers, ..NOISE };
            let trials = Trials::run(&pool, &truth, n, &noise, &options, seeds.clone())?;
            let (right, all) = (trials.right(), trials.trials.len());
            table.push(vec![
                name.to_owned(),
                format!("{} %", 100.0 * outliers),
                n.to_string(),
                format!("{right} of {all}"),
                trials.wrong(),
                error(trials.rms()),
                error(trials.median(|trial| trial.quality.hausdorff)),
                seconds(trials.median(|trial| trial.seconds)),
            ]);
            rights.push((name, outliers, share, right, all));
            report.push(json!({ "curve": name, "outliers": outliers, "trials": trials.json() }));
        }
    }
    println!("{table}");
    for (name, outliers, share, right, all) in rights {
        let with = if outliers > 0.0 { ", a tenth outliers" } else { "" };
        goals.must(
            format!("{name}{with}: right in {} of 100", 100.0 * share),
            format!("{right} of {all}"),
            right as f64 >= share * all as f64,
        );
    }
    Ok(json!({ "draws": report, "goals": goals.json() }))
}
