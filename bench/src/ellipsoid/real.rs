//! Small sets of real data, beside the brackets in which their optima are known to lie.

use std::collections::BTreeMap;

use anyhow::{Context as _, Result};
use serde::Deserialize;
use serde_json::json;

use super::case::Case;
use super::goals::Measured;
use super::points::{COLUMNS, solve};
use super::{Context, data, read};
use crate::goals;
use crate::table::Table;

/// Up to this dimension the time counts.
const TIMED_DIM_MAX: usize = 13;

/// What is known of a set; those in a hyperplane have no bracket.
#[derive(Deserialize)]
struct Known {
    log_volume_lower: Option<f64>,
    log_volume_upper: Option<f64>,
}

/// Solves all sets of which a bracket is known.
pub(super) fn run(context: &mut Context, case: &Case) -> Result<()> {
    let Some(folder) = data() else {
        context.report.add(json!({ "name": case.name, "left_out": "no TAUT_DATA" }));
        return Ok(());
    };
    let text = std::fs::read_to_string(folder.join("reference_optima.json"))?;
    let known: BTreeMap<String, Known> = serde_json::from_str(&text)?;
    let mut table = Table::new(&[&["set", "n × d"], &COLUMNS[..], &["outside"]].concat());
    let (mut measured, mut sets) = (Vec::new(), Vec::new());
    // A set takes less than a millisecond: one that is disturbed in each of a few rounds would say nothing.
    let runs = context.runs;
    context.runs = 4 * runs;
    for (name, known) in &known {
        let (Some(lower), Some(upper)) = (known.log_volume_lower, known.log_volume_upper) else {
            continue;
        };
        let (values, d) = read(&folder.join(name), None).with_context(|| name.clone())?;
        let solved = solve(context, &values, d, None)?;
        let found = solved.rounds.found.answer.log_volume;
        let outside = (found - upper).max(lower - found).max(0.0);
        let size = format!("{} × {d}", values.len() / d);
        table.push(
            [vec![name.clone(), size], solved.cells(), vec![format!("{outside:.1e}")]].concat(),
        );
        let mut of = Measured { outside: Some(outside), ..solved.measured() };
        if d > TIMED_DIM_MAX {
            // No worse than any other.
            for time in [&mut of.clock, &mut of.processors, &mut of.one_thread] {
                *time = time.map(|_| 0.0);
            }
        }
        measured.push(of);
        sets.push(json!({ "set": name, "outside": outside, "solved": solved.json() }));
    }
    context.runs = runs;
    println!("{} sets; the time counts where d ≤ {TIMED_DIM_MAX}\n\n{table}", measured.len());
    let worst = Measured::worst(measured).unwrap_or_default();
    let goals = goals::print(&[case.must], &[case.aim], &worst);
    context.report.add(json!({ "name": case.name, "sets": sets, "goals": goals }));
    Ok(())
}
