//! Cases of balls, under each of six radius laws.

use anyhow::Result;
use serde_json::{Value, json};
use taut_enclose::BallOptions;

use super::case::{BallsCase, Case};
use super::goals::Measured;
use super::{Context, paired};
use crate::goals;
use crate::input::{Input, Radii};

/// Runs the case under all six laws.
pub(super) fn run(context: &mut Context, case: &Case, balls: &BallsCase) -> Result<()> {
    let n = if context.quick { balls.n / 10 } else { balls.n };
    let mut laws = Vec::new();
    for radii in Radii::ALL {
        let input = Input::balls(radii, n, balls.d)?;
        let options = BallOptions { epsilon: 0.0, ..BallOptions::default() };
        let paired = paired::run(context, &input, &options, balls.peers)?;
        println!("{}\n\n{}", input.what, paired.table());
        let measured = Measured {
            verdict: paired.verdict.clone().ok(),
            passes: paired.found.trace.passes,
            stop: paired.found.trace.stop,
            paired: Some(&paired),
            ..Measured::default()
        };
        let goals = goals::print(&[case.must], &[case.aim], &measured);
        println!();
        laws.push(json!({ "input": input.what, "measured": paired.json(), "goals": goals }));
    }
    context.report.add(json!({ "name": case.name, "laws": Value::from(laws) }));
    Ok(())
}
