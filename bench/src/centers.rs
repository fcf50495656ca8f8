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

use anyhow::Result;

use crate::cases::Choice;
use crate::context::Context;
use case::{CASES, Kind};

/// Cases and how often.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    choice: Choice,
    /// Permutations of an input, each solved once with each number of threads; their median counts.
    #[arg(long, default_value_t = 5)]
    runs: usize,
    /// Numbers of threads taut is run with: goals are about the clock with the last of them.
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2])]
    threads: Vec<usize>,
    /// Seconds after which one run of a peer is stopped.
    #[arg(long, default_value_t = 120)]
    limit: u64,
    /// Seconds after which a peer that is slow takes part in no further round of an input.
    #[arg(long, default_value_t = 600)]
    peer_budget: u64,
}

/// Runs the cases that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let Some(cases) = arguments.choice.of(CASES, "centers")? else { return Ok(()) };
    let runs = if arguments.choice.quick { arguments.runs.min(2) } else { arguments.runs };
    let seconds = [arguments.limit, arguments.peer_budget];
    let mut context =
        Context::begin(runs, arguments.choice.quick, &arguments.threads, seconds, None)?;
    context.run_all(cases, arguments.choice.json.as_ref(), |context, case| match &case.kind {
        Kind::Free(tasks) => free::run(context, case, tasks),
        Kind::Discrete => discrete::run(context, case),
        Kind::Traversal => traversal::run(context, case),
        Kind::Outliers => outliers::run(context, case),
        Kind::Streams => streams::run(context, case),
    })
}
