//! Ellipsoids: of points, of ellipsoids, and robust ones, each answer proved before its time is believed.

mod approximate;
mod case;
mod conic;
pub(crate) mod file;
mod goals;
mod judgement;
mod laws;
mod linear;
mod plane;
mod points;
mod real;
mod robust;
mod rounds;
mod shapes;

use std::path::{Path, PathBuf};

use anyhow::{Result, ensure};

use crate::cases::Choice;
use crate::context::Context;
use case::{CASES, Kind};

/// Cases and how often.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    choice: Choice,
    /// Rounds; of the times of a program the least counts.
    #[arg(long, default_value_t = 5)]
    runs: usize,
    /// Numbers of threads taut is run with: goals are about the clock with the last of them.
    #[arg(long, value_delimiter = ',', default_values_t = [1, 2])]
    threads: Vec<usize>,
    /// Seconds after which one run of a peer is stopped.
    #[arg(long, default_value_t = 120)]
    limit: u64,
    /// Seconds after which a peer that is slow takes part in no further round of an input.
    #[arg(long, default_value_t = 60)]
    peer_budget: u64,
    /// Folder for the 1.2 GB file of the case `file`, which is kept there.
    #[arg(long)]
    scratch: Option<PathBuf>,
}

/// Runs the cases that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let Some(cases) = arguments.choice.of(CASES, "ellipsoid")? else { return Ok(()) };
    let runs = if arguments.choice.quick { arguments.runs.min(2) } else { arguments.runs };
    let seconds = [arguments.limit, arguments.peer_budget];
    let scratch = arguments.scratch.as_ref();
    let mut context =
        Context::begin(runs, arguments.choice.quick, &arguments.threads, seconds, scratch)?;
    context.run_all(cases, arguments.choice.json.as_ref(), |context, case| match &case.kind {
        Kind::Points(inputs) => points::run(context, case, inputs),
        Kind::Plane(laws) => plane::run(context, case, laws),
        Kind::Real => real::run(context, case),
        Kind::Shapes => shapes::run(context, case),
        Kind::Conic => conic::run(context, case),
        Kind::Approximate => approximate::run(context, case),
        Kind::Contaminated(cloud) => robust::run(context, case, *cloud),
        Kind::Flags => robust::run_flags(context, case),
        Kind::File => file::run(context, case),
    })
}

/// The folder `ellipsoid` of `TAUT_DATA`; `None`, after saying so, where there is none.
fn data() -> Option<PathBuf> {
    let folder = std::env::var_os("TAUT_DATA").map(|data| Path::new(&data).join("ellipsoid"));
    let folder = folder.filter(|folder| folder.join("reference_optima.json").exists());
    if folder.is_none() {
        println!("left out: set TAUT_DATA to a folder with ellipsoid/reference_optima.json");
    }
    folder
}

/// The numbers of a file with one line of names, the first `columns` of each row, or all.
fn read(path: &Path, columns: Option<usize>) -> Result<(Vec<f64>, usize)> {
    let text = std::fs::read_to_string(path)?;
    let mut values = Vec::new();
    let mut width = None;
    for line in text.lines().skip(1) {
        let row = line.split(',').take(columns.unwrap_or(usize::MAX));
        let row = row.map(|field| field.trim().parse()).collect::<Result<Vec<f64>, _>>()?;
        ensure!(
            *width.get_or_insert(row.len()) == row.len(),
            "{}: rows of several lengths",
            path.display()
        );
        values.extend(row);
    }
    Ok((values, width.unwrap_or(0)))
}
