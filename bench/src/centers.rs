//! k centres: proven optima of cities and of space, centres among the points, traversals, outliers and streams.

mod case;
mod cities;
mod discrete;
mod free;
mod goals;
mod judgement;
mod outliers;
mod streams;
mod traversal;

use std::path::PathBuf;

use anyhow::Result;

use crate::context::Context;
use crate::select::select;
use case::{CASES, Case, Kind};

/// Cases and how often.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Cases to run, by whole name, else by the beginning of it; none means all. `--list` shows them.
    cases: Vec<String>,
    /// Show the cases and do nothing.
    #[arg(long)]
    list: bool,
    /// Permutations of an input, each solved once with each number of threads; their median counts.
    #[arg(long, default_value_t = 5)]
    runs: usize,
    /// Inputs of about a tenth of their size and at most two permutations: to try the bench, not to quote.
    #[arg(long)]
    quick: bool,
    /// Numbers of threads taut is run with: goals are about the clock with the last of them.
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2])]
    threads: Vec<usize>,
    /// Seconds after which one run of a peer is stopped.
    #[arg(long, default_value_t = 120)]
    limit: u64,
    /// Seconds after which a peer that is slow takes part in no further round of an input.
    #[arg(long, default_value_t = 600)]
    peer_budget: u64,
    /// Write everything that was measured to this file.
    #[arg(long)]
    json: Option<PathBuf>,
}

/// Runs the cases that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    if arguments.list {
        for case in CASES {
            println!("{:<16} {}", case.name, case.about);
        }
        return Ok(());
    }
    let cases = select(CASES, |case| case.name, &arguments.cases, "centers")?;
    let runs = if arguments.quick { arguments.runs.min(2) } else { arguments.runs };
    let seconds = [arguments.limit, arguments.peer_budget];
    let mut context = Context::begin(runs, arguments.quick, &arguments.threads, seconds, None)?;
    let head = |case: &'static Case| [case.name, case.about];
    context.run_all(cases, arguments.json.as_ref(), head, |context, case| match &case.kind {
        Kind::Free(tasks) => free::run(context, case, tasks),
        Kind::Discrete => discrete::run(context, case),
        Kind::Traversal => traversal::run(context, case),
        Kind::Outliers => outliers::run(context, case),
        Kind::Streams => streams::run(context, case),
    })
}
