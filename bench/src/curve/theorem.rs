//! The algorithm of section 4.1 of the thesis where its theorem holds.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};
use taut_mesh::{Polyline, compare};
use taut_points::generate::curves::{CurveNoise, TestCurve, TruthCurves, sample_curve};
use taut_reconstruct::{CurveMethod, CurveOptions, CurveThesisOptions};

use super::drawn::{CURVES, Trials, error, pool, true_lines, truth};
use crate::context::Context;
use crate::goals::Goals;
use crate::input::write_rows;
use crate::peer::{Peer, Silence};
use crate::stats::seconds;
use crate::table::Table;

/// δ = 1 / 9ρ² for ρ = 4.
const DELTA: f64 = 1.0 / 144.0;
/// Curves and numbers of points whose centres are compared with those of the plain implementation.
const COMPARED_CURVES: [(&str, [usize; 3]); 2] =
    [("circle", [1000, 4000, 16_000]), ("flower5", [1000, 4000, 16_000])];
/// How many samples of each case are drawn.
const DRAWS_PER_CASE: u64 = 40;

/// The rms of the distances of the plain implementation's centres from the curve, over all draws.
fn plain(
    context: &Context,
    truth: &TruthCurves,
    n: usize,
    noise: &CurveNoise,
    seeds: Range<u64>,
) -> Result<Result<f64, Silence>> {
    let lines = true_lines(truth);
    let file = context.temp.path().join("plain");
    let (mut squares, draws) = (0.0, seeds.clone().count());
    for seed in seeds {
        write_rows(&file, &sample_curve(truth, n, noise, seed).points, 2)?;
        let mut running = match Peer::start("plain-curve", &file, context.temp.path())? {
            Ok(running) => running,
            Err(silence) => return Ok(Err(silence)),
        };
        let centers = match running.solve(context.limit)? {
            Ok(answer) => answer.center,
            Err(silence) => return Ok(Err(silence)),
        };
        let vertices: Vec<[f64; 2]> = centers.chunks_exact(2).map(|c| [c[0], c[1]]).collect();
        let polyline = Polyline { vertices: &vertices, closed: false };
        squares += compare(&lines, &[polyline]).vertex_rms.powi(2);
    }
    Ok(Ok((squares / draws as f64).sqrt()))
}

/// Connectivity over many draws, then errors beside those that are known.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let pool = pool(context.threads[context.threads.len() - 1])?;
    let thesis = CurveThesisOptions { rho: 4.0, ..CurveThesisOptions::DEFAULT };
    let options = CurveOptions { method: CurveMethod::Thesis(thesis), ..CurveOptions::default() };
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
    let told = CurveThesisOptions { feature: Some(1.0), ..thesis };
    let told = CurveOptions { method: CurveMethod::Thesis(told), ..options };
    let few = seeds.start..seeds.end.min(seeds.start + DRAWS_PER_CASE);
    for (name, sizes) in COMPARED_CURVES {
        let truth = truth(name, TestCurve::VERTICES)?;
        for n in sizes {
            let trials = Trials::run(&pool, &truth, n, &noise, &told, few.clone())?;
            let rms = trials.rms();
            let (theirs, silence) = match plain(context, &truth, n, &noise, few.clone())? {
                Ok(rms) => (Some(rms), None),
                Err(silence) => (None, Some(silence.to_string())),
            };
            let what = format!("{name}, n = {n}: rms of the centres no more than plain");
            let shown = theirs.map_or("no answer to compare with".to_owned(), |theirs| {
                format!("{} and {}", error(rms), error(theirs))
            });
            goals.must(what, shown, theirs.map(|theirs| rms <= theirs));
            report.push(json!({
                "curve": name, "rms_of_centres": rms, "plain": theirs, "silence": silence, "trials": trials.json()
            }));
        }
    }
    Ok(json!({ "draws": report, "goals": goals.json() }))
}
