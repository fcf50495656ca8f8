//! Memory of a reconstruction above its input.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};
use taut_points::generate::curves::{CurveNoise, TestCurve, sample_curve};
use taut_reconstruct::CurveMethod;

use super::drawn::{NOISE, truth};
use super::one;
use crate::context::Context;
use crate::goals::Goals;
use crate::input::write_raw;
use crate::table::Table;

/// The bytes per point that reconstruction may take at its peak.
const BYTES_PER_POINT_MAX: f64 = 300.0;

/// Peaks of the methods that are quick.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let n = if context.quick { 100_000 } else { 1_000_000 };
    let truth = truth("bumpy", TestCurve::VERTICES)?;
    let threads = context.threads[context.threads.len() - 1];
    let file = context.temp.path().join("points.f64");
    let mut table = Table::new(&["method", "points", "B/point", ""]);
    let (mut goals, mut report) = (Goals::default(), vec![]);
    let mut peaks = vec![];
    for (method, delta) in [
        (CurveMethod::Auto, 0.05),
        (CurveMethod::Auto, 0.0),
        (CurveMethod::NnCrust, 0.0),
        (CurveMethod::HnnCrust, 0.0),
        (CurveMethod::OneStepCrust, 0.0),
        (CurveMethod::Crust, 0.0),
    ] {
        let noise = CurveNoise { delta, ..NOISE };
        write_raw(&file, &sample_curve(&truth, n, &noise, seeds.start).points)?;
        let what = if delta > 0.0 { "noisy" } else { "clean" };
        let built = one::alone(method, threads, &file, context.limit)?;
        let peak =
            built.as_ref().ok().and_then(|build| build.peak).map(|peak| peak as f64 / n as f64);
        let said = built.as_ref().err().map(ToString::to_string).unwrap_or_default();
        table.push(vec![
            method.name().to_owned(),
            what.to_owned(),
            peak.map(|peak| format!("{peak:.0}")).unwrap_or_default(),
            said,
        ]);
        report.push(json!({ "method": method.name(), "points": what, "build": built.ok() }));
        peaks.push((format!("{}, {what}: bytes per point", method.name()), peak));
    }
    println!("n = {n}, {threads} threads\n\n{table}");
    for (what, peak) in peaks {
        goals.at_most(&what, peak, (BYTES_PER_POINT_MAX, None), |value| format!("{value:.0}"));
    }
    Ok(json!({ "n": n, "builds": report, "goals": goals.json() }))
}
