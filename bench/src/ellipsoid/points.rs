//! Smallest ellipsoids of points: solved by rounds, then proved.

use anyhow::Result;
use serde_json::{Value, json};
use taut_certify::{Ellipsoid, EllipsoidVerdict, Solution, Stop};
use taut_enclose::{EllipsoidOptions, ellipsoid};
use taut_points::Points;

use super::case::{Case, Input};
use super::goals::Measured;
use super::rounds::TIME_COLUMNS;
use super::{Context, rounds};
use crate::goals;
use crate::input::SEED;
use crate::table::Table;

/// The gap that is asked for.
pub(super) const EPSILON: f64 = 1e-12;

/// One set of points, solved and judged.
pub(super) struct Solved {
    /// The answers and times.
    pub(super) rounds: rounds::Rounds<Solution<Ellipsoid>>,
    /// What the checker says.
    pub(super) verdict: Result<EllipsoidVerdict, String>,
}

/// Solves `values`, rows of d numbers; `peer` is a program and the file it reads.
pub(super) fn solve(
    context: &Context,
    values: &[f64],
    d: usize,
    peer: Option<(&str, &std::path::Path)>,
) -> Result<Solved> {
    let points = Points::new(values, d)?;
    let options = EllipsoidOptions { epsilon: EPSILON, ..EllipsoidOptions::default() };
    let rounds =
        rounds::run(context, &context.threads, peer, || Ok(ellipsoid(&points, &options)?))?;
    let verdict = rounds.found.check(&points).map_err(|why| why.to_string());
    Ok(Solved { rounds, verdict })
}

impl Solved {
    /// What goals ask for.
    pub(super) fn measured(&self) -> Measured {
        Measured {
            rejected: self.verdict.as_ref().err().cloned(),
            gap: self.verdict.as_ref().ok().map(|verdict| verdict.gap),
            passes: Some(self.rounds.found.trace.passes),
            ..self.rounds.measured()
        }
    }

    /// Cells: clock, processors, one thread, gap, stop, passes, steps, support.
    pub(super) fn cells(&self) -> Vec<String> {
        let trace = &self.rounds.found.trace;
        let mut cells = self.rounds.cells();
        cells.extend([
            match &self.verdict {
                Ok(verdict) => format!("{:.1e}", verdict.gap),
                Err(why) => format!("REJECTED: {why}"),
            },
            match trace.stop {
                Stop::Converged => "converged",
                Stop::Rounding => "rounding",
                Stop::PassBudget => "pass budget",
                Stop::NodeBudget => "node budget",
                Stop::ProofBudget => "proof budget",
            }
            .to_owned(),
            trace.passes.to_string(),
            trace.iterations.to_string(),
            self.rounds.found.certificate.support.len().to_string(),
        ]);
        cells
    }

    /// Everything, for the report.
    pub(super) fn json(&self) -> Value {
        let found = &self.rounds.found;
        json!({
            "times": self.rounds.json(),
            "gap": self.verdict.as_ref().ok().map(|verdict| verdict.gap),
            "rejected": self.verdict.as_ref().err(),
            "log_volume": found.answer.log_volume,
            "support": found.certificate.support.len(),
            "trace": &found.trace,
        })
    }
}

/// The names of the columns of [`Solved::cells`].
pub(super) const COLUMNS: [&str; 8] = [
    TIME_COLUMNS[0],
    TIME_COLUMNS[1],
    TIME_COLUMNS[2],
    "verified gap",
    "stop",
    "passes",
    "steps",
    "support",
];

/// Runs all inputs of a case, each under all of its seeds.
pub(super) fn run(context: &mut Context, case: &Case, inputs: &[Input]) -> Result<()> {
    let mut all = Vec::new();
    for input in inputs {
        let n = if context.quick { input.n / 10 } else { input.n };
        let what = format!("{}, {n} × {}", input.law, input.d);
        let mut table = Table::new(&[&["seed"], &COLUMNS[..]].concat());
        let (mut measured, mut seeds) = (Vec::new(), Vec::new());
        for seed in SEED..SEED + input.seeds {
            let values = input.law.draw(n, input.d, seed)?;
            let solved = solve(context, &values, input.d, None)?;
            table.push([vec![seed.to_string()], solved.cells()].concat());
            measured.push(solved.measured());
            seeds.push(json!({ "seed": seed, "solved": solved.json() }));
        }
        println!("{what}\n\n{table}");
        let worst = Measured::worst(measured).unwrap_or_default();
        let goals = goals::print(&[case.must, input.must], &[case.aim, input.aim], &worst);
        println!();
        all.push(json!({ "input": what, "seeds": seeds, "goals": goals }));
    }
    context.report.add(json!({ "name": case.name, "inputs": all }));
    Ok(())
}
