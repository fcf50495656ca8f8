//! Cases of points in memory, solved exactly.

use anyhow::Result;
use serde_json::json;
use taut_enclose::BallOptions;

use super::case::{Case, PointsCase};
use super::goals::Measured;
use super::{Context, paired};
use crate::goals;
use crate::input::Input;

/// Runs a case of generated points.
pub(super) fn run(context: &mut Context, case: &Case, points: &PointsCase) -> Result<()> {
    let n = if context.quick { (points.n / 10).max(500) } else { points.n };
    let input = if points.single {
        Input::single(points.distribution, n, points.d)?
    } else {
        Input::points(points.distribution, n, points.d)?
    };
    run_input(context, case, &input, points.peers)
}

/// Runs the case of the USPS digits, beside the Fischer–Gärtner–Kutz code.
pub(super) fn run_usps(context: &mut Context, case: &Case) -> Result<()> {
    match Input::usps()? {
        Some(input) => run_input(context, case, &input, &["fgk-native", "fgk-o2"]),
        None => {
            println!("left out: set TAUT_DATA to a folder with ball/usps_train.csv.xz");
            context.report.add(json!({ "name": case.name, "left_out": "TAUT_DATA is not set" }));
            Ok(())
        }
    }
}

fn run_input(context: &mut Context, case: &Case, input: &Input, peers: &[&str]) -> Result<()> {
    let options = BallOptions { epsilon: 0.0, ..BallOptions::default() };
    let paired = paired::run(context, input, &options, peers)?;
    println!("{}\n\n{}", input.what, paired.table());
    let measured = Measured {
        verdict: paired.verdict.clone().ok(),
        passes: paired.found.trace.passes,
        stop: paired.found.trace.stop,
        paired: Some(&paired),
        ..Measured::default()
    };
    let goals = goals::print(&[case.must], &[case.aim], &measured);
    context.report.add(json!({
        "name": case.name,
        "input": input.what,
        "measured": paired.json(),
        "goals": goals,
    }));
    Ok(())
}
