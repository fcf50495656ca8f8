//! How the error of the default method falls with the number of points.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};
use taut_points::generate::curves::{CurveNoise, TestCurve};
use taut_reconstruct::CurveOptions;

use super::drawn::{NOISE, Trials, error, pool, truth};
use crate::context::Context;
use crate::goals::Goals;
use crate::stats::seconds;
use crate::table::Table;

const SIZES: [usize; 5] = [1000, 4000, 16_000, 64_000, 250_000];

/// Errors over sizes, and at 10⁴ points.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let pool = pool(context.threads[context.threads.len() - 1])?;
    let options = CurveOptions::default();
    let sizes = if context.quick { &SIZES[..3] } else { &SIZES[..] };
    let (mut goals, mut report) = (Goals::default(), vec![]);
    let mut table =
        Table::new(&["curve", "noise", "n", "rms", "largest", "right", "noise told", "time"]);
    let mut slopes = vec![];
    let normal = CurveNoise { delta: 0.03, gaussian: true, ..NOISE };
    for (name, noise) in
        [("circle", NOISE), ("bumpy", NOISE), ("circle", normal), ("bumpy", normal)]
    {
        // So many points that chords between them stray by far less than any error that is measured.
        let truth = truth(name, 40_000)?;
        let mut points = vec![];
        for &n in sizes {
            let trials = Trials::run(&pool, &truth, n, &noise, &options, seeds.clone())?;
            table.push(row(name, &noise, &trials));
            points.push([(n as f64).ln(), trials.rms().ln()]);
            report.push(
                json!({ "curve": name, "gaussian": noise.gaussian, "trials": trials.json() }),
            );
        }
        slopes.push((name, noise.gaussian, slope(&points)));
    }
    let mut errors = vec![];
    for (name, must, aim) in [
        ("circle", 1e-3, Some(5e-4)),
        ("ellipse3", 3e-3, Some(1.5e-3)),
        ("flower5", 6e-3, Some(3.5e-3)),
        ("bumpy", 1e-2, Some(6e-3)),
    ] {
        let truth = truth(name, TestCurve::VERTICES)?;
        let trials = Trials::run(&pool, &truth, 10_000, &NOISE, &options, seeds.clone())?;
        table.push(row(name, &NOISE, &trials));
        errors.push((name, trials.rms(), must, aim));
        report.push(json!({ "curve": name, "trials": trials.json() }));
    }
    println!("{table}");
    for (name, gaussian, slope) in slopes {
        let show = |slope: f64| format!("{slope:.2}");
        let measured = show(slope);
        if gaussian {
            goals.aim(
                format!("{name}, normal noise: slope at most -0.38"),
                measured,
                slope <= -0.38,
            );
        } else {
            let what = format!("{name}: slope of ln rms over ln n");
            goals.at_most(&what, Some(slope), (-0.5, Some(-0.62)), show);
        }
    }
    for (name, rms, must, aim) in errors {
        let what = format!("{name}, n = 10⁴: rms");
        match name {
            "circle" | "flower5" => goals.at_most(&what, Some(rms), (must, aim), error),
            // The others are hoped for alone.
            _ => {
                let aim = aim.unwrap_or(must);
                goals.aim(format!("{what} at most {}", error(aim)), error(rms), rms <= aim);
            }
        }
    }
    Ok(json!({ "draws": report, "goals": goals.json() }))
}

fn row(name: &str, noise: &CurveNoise, trials: &Trials) -> Vec<String> {
    let law = if noise.gaussian { "normal" } else { "uniform" };
    vec![
        name.to_owned(),
        format!("{law} {}", noise.delta),
        trials.n.to_string(),
        error(trials.rms()),
        error(trials.median(|trial| trial.quality.vertex_max)),
        format!("{} of {}", trials.right(), trials.trials.len()),
        error(trials.median(|trial| trial.noise)),
        seconds(trials.median(|trial| trial.seconds)),
    ]
}

/// Slope of the line that fits best, in the sense of least squares.
pub(super) fn slope(points: &[[f64; 2]]) -> f64 {
    let n = points.len() as f64;
    let mean = |k: usize| points.iter().map(|p| p[k]).sum::<f64>() / n;
    let (x, y) = (mean(0), mean(1));
    let cross: f64 = points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum();
    cross / points.iter().map(|p| (p[0] - x).powi(2)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_power_law_has_its_exponent_as_slope() {
        let points: Vec<[f64; 2]> =
            [1e3f64, 4e3, 1.6e4].iter().map(|n| [n.ln(), (3.0 * n.powf(-0.6)).ln()]).collect();
        assert!((super::slope(&points) + 0.6).abs() < 1e-12);
    }
}
