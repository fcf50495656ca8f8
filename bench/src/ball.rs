//! The cases of the minimum enclosing ball, each with a name, an input, peers and goals.

mod balls;
mod case;
mod core_sets;
pub(crate) mod file;
mod goals;
mod paired;
mod points;
mod threads;

use std::path::PathBuf;

use anyhow::Result;

use crate::cases::Choice;
use crate::context::Context;
use case::{CASES, Kind};

/// Cases and how often.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    choice: Choice,
    /// Paired runs of each case.
    #[arg(long, default_value_t = 9)]
    runs: usize,
    /// Numbers of threads taut is run with; ratios are those of the last.
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2])]
    threads: Vec<usize>,
    /// Seconds after which one run of a peer, or of a method in the case `core-sets`, is stopped.
    #[arg(long, default_value_t = 60)]
    limit: u64,
    /// Seconds after which a peer that is slow takes part in no further run of a case.
    #[arg(long, default_value_t = 120)]
    peer_budget: u64,
    /// Folder for the 10 GB file of the case `file`, which is kept there; needs as much free disk.
    #[arg(long)]
    scratch: Option<PathBuf>,
}

/// Runs the cases that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let Some(cases) = arguments.choice.of(CASES, "ball")? else { return Ok(()) };
    let runs = if arguments.choice.quick { arguments.runs.min(3) } else { arguments.runs };
    let seconds = [arguments.limit, arguments.peer_budget];
    let scratch = arguments.scratch.as_ref();
    let mut context =
        Context::begin(runs, arguments.choice.quick, &arguments.threads, seconds, scratch)?;
    context.run_all(cases, arguments.choice.json.as_ref(), |context, case| match &case.kind {
        Kind::Points(points) => points::run(context, case, points),
        Kind::Usps => points::run_usps(context, case),
        Kind::Balls(balls) => balls::run(context, case, balls),
        Kind::File => file::run(context, case),
        Kind::CoreSets => core_sets::run(context, case),
        Kind::Threads => threads::run(context, case),
    })
}
