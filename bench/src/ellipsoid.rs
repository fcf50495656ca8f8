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
use std::time::Duration;

use anyhow::{Result, ensure};
use tempfile::TempDir;

use crate::report::Report;
use crate::select::select;
use case::{CASES, Kind};

/// Cases and how often.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Cases to run, by whole name, else by the beginning of it; none means all. `--list` shows them.
    cases: Vec<String>,
    /// Show the cases and do nothing.
    #[arg(long)]
    list: bool,
    /// Rounds; of the times of a program the least counts.
    #[arg(long, default_value_t = 5)]
    runs: usize,
    /// Inputs of a tenth of their size and at most two rounds: to try the bench, not to quote.
    #[arg(long)]
    quick: bool,
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
    /// Write everything that was measured to this file.
    #[arg(long)]
    json: Option<PathBuf>,
}

/// What all cases share.
struct Context {
    runs: usize,
    quick: bool,
    threads: Vec<usize>,
    limit: Duration,
    peer_budget: Duration,
    scratch: Option<PathBuf>,
    temp: TempDir,
    report: Report,
}

/// Runs the cases that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    if arguments.list {
        for case in CASES {
            println!("{:<16} {}", case.name, case.about);
        }
        return Ok(());
    }
    let cases = select(CASES, |case| case.name, &arguments.cases, "ellipsoid")?;
    ensure!(
        arguments.runs > 0 && !arguments.threads.is_empty() && !arguments.threads.contains(&0),
        "at least one round and one thread"
    );
    let mut context = Context {
        runs: if arguments.quick { arguments.runs.min(2) } else { arguments.runs },
        quick: arguments.quick,
        threads: arguments.threads.clone(),
        limit: Duration::from_secs(arguments.limit),
        peer_budget: Duration::from_secs(arguments.peer_budget),
        scratch: arguments.scratch.clone(),
        temp: TempDir::new()?,
        report: Report::begin(),
    };
    if context.quick {
        println!("Quick: inputs are smaller than the cases say. Not to be quoted.\n");
    }
    for case in cases {
        println!("## {}\n{}\n", case.name, case.about);
        match &case.kind {
            Kind::Points(inputs) => points::run(&mut context, case, inputs)?,
            Kind::Plane(laws) => plane::run(&mut context, case, laws)?,
            Kind::Real => real::run(&mut context, case)?,
            Kind::Shapes => shapes::run(&mut context, case)?,
            Kind::Conic => conic::run(&mut context, case)?,
            Kind::Approximate => approximate::run(&mut context, case)?,
            Kind::Contaminated(cloud) => robust::run(&mut context, case, *cloud)?,
            Kind::Flags => robust::run_flags(&mut context, case)?,
            Kind::File => file::run(&mut context, case)?,
        }
        println!();
        if let Some(path) = &arguments.json {
            context.report.write(path)?;
        }
    }
    Ok(())
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
