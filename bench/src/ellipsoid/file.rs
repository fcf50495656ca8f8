//! A file larger than the memory that is allowed: reads of it, and the peak memory of the process that solves it.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::Result;
use serde::{Deserialize, Serialize};
use serde_json::json;
use taut_enclose::{EllipsoidOptions, ellipsoid};
use taut_points::{FileSource, ScalarKind};

use super::Context;
use super::case::Case;
use super::goals::Measured;
use crate::goals;
use crate::input::SEED;
use crate::meter;
use crate::raw;
use crate::stats::seconds;
use crate::table::Table;

const D: usize = 3;

/// The process that solves one raw file and nothing else, so that its peak memory is that of the solver.
#[derive(clap::Args)]
pub(crate) struct SolveArguments {
    /// The file: n · 3 little-endian single-precision values.
    path: PathBuf,
    /// Number of points.
    n: u64,
    /// Threads.
    threads: usize,
}

/// What that process prints.
#[derive(Serialize, Deserialize)]
struct Solved {
    seconds: f64,
    passes: u64,
    log_volume: f64,
    gap: Option<f64>,
    rejected: Option<String>,
    support: usize,
    /// Peak resident memory of the process up to the answer, bytes; `None` where /proc is missing.
    peak: Option<u64>,
}

/// Solves the file, verifies the answer, and prints one line of JSON.
pub(crate) fn solve(arguments: &SolveArguments) -> Result<()> {
    let source = FileSource::open(&arguments.path, 0, arguments.n, D, ScalarKind::F32)?;
    let options =
        EllipsoidOptions { threads: Some(arguments.threads), ..EllipsoidOptions::default() };
    let start = Instant::now();
    let found = ellipsoid(&source, &options)?;
    let seconds = start.elapsed().as_secs_f64();
    let peak = meter::peak();
    let verdict = found.check(&source);
    let solved = Solved {
        seconds,
        passes: found.trace.passes,
        log_volume: found.answer.log_volume,
        gap: verdict.as_ref().ok().map(|verdict| verdict.gap),
        rejected: verdict.err().map(|why| why.to_string()),
        support: found.certificate.support.len(),
        peak,
    };
    println!("{}", serde_json::to_string(&solved)?);
    Ok(())
}

/// Runs the case: makes the file unless it is there, then solves it in a process of its own.
pub(super) fn run(context: &mut Context, case: &Case) -> Result<()> {
    let n: u64 = if context.quick { 1_000_000 } else { 100_000_000 };
    let Some(folder) = context.folder(case.name, "1.2 GB") else { return Ok(()) };
    let path = folder.join(format!("normal-{n}x{D}-seed{SEED}.f32"));
    raw::make(&path, n, D)?;
    let mut table =
        Table::new(&["threads", "time", "passes", "verified gap", "support", "peak memory"]);
    let (mut all, mut measured) = (Vec::new(), Vec::new());
    for &threads in &context.threads {
        let arguments = ["solve-ellipsoid".into(), path.clone().into_os_string()];
        let numbers = [n.to_string().into(), threads.to_string().into()];
        let solved: Solved = raw::alone(&[&arguments[..], &numbers].concat())?;
        table.push(vec![
            threads.to_string(),
            seconds(solved.seconds),
            solved.passes.to_string(),
            solved.gap.map_or("REJECTED".into(), |gap| format!("{gap:.1e}")),
            solved.support.to_string(),
            solved.peak.map_or("unknown".into(), |peak| format!("{} MiB", peak >> 20)),
        ]);
        measured.push(Measured {
            rejected: solved.rejected.clone(),
            gap: solved.gap,
            passes: Some(solved.passes),
            peak: solved.peak,
            ..Measured::default()
        });
        all.push(json!({ "threads": threads, "solved": &solved }));
    }
    println!("{}: {:.2} GB\n\n{table}", path.display(), (n * 4 * D as u64) as f64 / 1e9);
    let worst = Measured::worst(measured).unwrap_or_default();
    let goals = goals::print(&[case.must], &[case.aim], &worst);
    context.report.add(json!({ "name": case.name, "runs": all, "goals": goals }));
    Ok(())
}
