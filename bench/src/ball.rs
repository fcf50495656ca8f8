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
    /// Paired runs of each case.
    #[arg(long, default_value_t = 9)]
    runs: usize,
    /// Inputs of about a tenth of their size and at most three runs: to try the bench, not to quote.
    #[arg(long)]
    quick: bool,
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
    /// Write everything that was measured to this file.
    #[arg(long)]
    json: Option<PathBuf>,
}

/// Runs the cases that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    if arguments.list {
        for case in CASES {
            println!("{:<24} {}", case.name, case.about);
        }
        return Ok(());
    }
    let cases = select(CASES, |case| case.name, &arguments.cases, "ball")?;
    let runs = if arguments.quick { arguments.runs.min(3) } else { arguments.runs };
    let seconds = [arguments.limit, arguments.peer_budget];
    let scratch = arguments.scratch.as_ref();
    let mut context = Context::begin(runs, arguments.quick, &arguments.threads, seconds, scratch)?;
    let head = |case: &'static Case| [case.name, case.about];
    context.run_all(cases, arguments.json.as_ref(), head, |context, case| match &case.kind {
        Kind::Points(points) => points::run(context, case, points),
        Kind::Usps => points::run_usps(context, case),
        Kind::Balls(balls) => balls::run(context, case, balls),
        Kind::File => file::run(context, case),
        Kind::CoreSets => core_sets::run(context, case),
        Kind::Threads => threads::run(context, case),
    })
}
