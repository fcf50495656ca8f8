//! A file larger than the memory that is allowed: passes beside `cat`, and the peak memory of the process.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::time::Instant;

use anyhow::{Context as _, Result, ensure};
use serde::{Deserialize, Serialize};
use serde_json::json;
use taut_certify::{Stop, Verdict};
use taut_enclose::{BallOptions, ball};
use taut_points::{FileSource, Monitor, ScalarKind};

use super::Context;
use super::case::Case;
use super::goals::Measured;
use crate::goals;
use crate::input::SEED;
use crate::meter;
use crate::raw;
use crate::stats::{Summary, seconds};
use crate::table::Table;

/// The process that solves one raw file and nothing else, so that its peak memory is that of the solver.
#[derive(clap::Args)]
pub(crate) struct SolveArguments {
    /// The file: n · d little-endian single-precision values.
    path: PathBuf,
    /// Number of points.
    n: u64,
    /// Dimension.
    dim: usize,
    /// Threads.
    threads: usize,
}

/// What that process prints.
#[derive(Serialize, Deserialize)]
struct Solved {
    seconds: f64,
    /// Seconds of each pass, from its announcement to the last of its points.
    passes: Vec<f64>,
    stop: Stop,
    radius: f64,
    lower: f64,
    gap: f64,
    rejected: Option<String>,
    core_set: u64,
    support: usize,
    /// Peak resident memory of the process up to the answer, bytes; `None` where /proc is missing.
    peak: Option<u64>,
}

/// Solves the file, verifies the answer, and prints one line of JSON.
pub(crate) fn solve(arguments: &SolveArguments) -> Result<()> {
    let source = FileSource::open(&arguments.path, 0, arguments.n, arguments.dim, ScalarKind::F32)?;
    // Of each pass: when it began, how many of its points are done, when the last was.
    let clock: Mutex<Vec<(Instant, u64, Instant)>> = Mutex::new(Vec::new());
    let lock = || clock.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    let on_pass = |_, _| {
        let now = Instant::now();
        lock().push((now, 0, now));
    };
    let on_points = |points| {
        if let Some((_, done, last)) = lock().last_mut() {
            *done += points;
            if *done <= arguments.n {
                *last = Instant::now();
            }
        }
    };
    let monitor = Monitor { on_points: Some(&on_points), on_pass: Some(&on_pass), cancel: None };
    let options =
        BallOptions { epsilon: 0.0, threads: Some(arguments.threads), ..BallOptions::default() };
    let start = Instant::now();
    let found = ball(&source, &BallOptions { monitor, ..options })?;
    let total = start.elapsed().as_secs_f64();
    let peak = meter::peak();
    let verdict = found.check(&source);
    let solved = Solved {
        seconds: total,
        passes: lock().iter().map(|(began, _, ended)| (*ended - *began).as_secs_f64()).collect(),
        stop: found.trace.stop,
        radius: found.answer.radius,
        lower: verdict.as_ref().map_or(0.0, |v| v.lower),
        gap: verdict.as_ref().map_or(f64::MAX, |v| v.gap),
        rejected: verdict.err().map(|error| error.to_string()),
        core_set: found.trace.core_set,
        support: found.certificate.support.len(),
        peak,
    };
    println!("{}", serde_json::to_string(&solved)?);
    Ok(())
}

/// Runs the case: makes the file unless it is there, then solves and reads it by turns.
pub(super) fn run(context: &mut Context, case: &Case) -> Result<()> {
    let (n, dim) = if context.quick { (20_000, 2500) } else { (1_000_000, 2500) };
    let Some(folder) = context.folder(case.name, "10 GB") else { return Ok(()) };
    let path = folder.join(format!("normal-{n}x{dim}-seed{SEED}.f32"));
    raw::make(&path, n, dim)?;
    let bytes = n * dim as u64 * 4;
    let threads = context.threads[context.threads.len() - 1];

    let mut table = Table::new(&[
        "run",
        "cat before",
        "cat after",
        "solve",
        "passes",
        "seconds of each pass",
        "speed of each pass",
        "peak memory",
    ]);
    let (mut of_cat, mut all) = (Vec::new(), Vec::new());
    let mut last = None;
    cat(&path)?; // so that all runs find what memory can hold in memory
    let mut before = cat(&path)?;
    for run in 0..context.runs.min(3) {
        let numbers = [n.to_string(), dim.to_string(), threads.to_string()];
        let arguments = ["solve-file".into(), path.clone().into_os_string()];
        let arguments = [&arguments[..], &numbers.map(Into::into)].concat();
        let solved: Solved = raw::alone(&arguments)?;
        let after = cat(&path)?;
        let beside = 0.5 * (before + after);
        of_cat.extend(solved.passes.iter().map(|pass| beside / pass));
        let join = |show: &dyn Fn(f64) -> String| {
            solved.passes.iter().map(|&p| show(p)).collect::<Vec<_>>().join(" ")
        };
        table.push(vec![
            (run + 1).to_string(),
            seconds(before),
            seconds(after),
            seconds(solved.seconds),
            solved.passes.len().to_string(),
            join(&|pass| format!("{pass:.2}")),
            join(&|pass| format!("{:.0} %", 100.0 * beside / pass)),
            solved.peak.map_or("unknown".into(), |peak| format!("{} MiB", peak >> 20)),
        ]);
        all.push(json!({ "cat_before": before, "cat_after": after, "solved": &solved }));
        before = after;
        last = Some(solved);
    }
    let solved = last.context("no run")?;
    println!(
        "{}: {:.2} GB, {threads} threads; speed is that of `cat` beside it = 100 %\n\n{table}",
        path.display(),
        bytes as f64 / 1e9
    );
    if let Some(reason) = &solved.rejected {
        println!("REJECTED by the checker: {reason}");
    }
    let verdict = solved.rejected.is_none().then_some(Verdict {
        lower: solved.lower,
        upper: solved.radius,
        gap: solved.gap,
    });
    println!(
        "radius {:.12}, core-set {}, support {}",
        solved.radius, solved.core_set, solved.support
    );
    let measured = Measured {
        verdict,
        passes: solved.passes.len() as u64,
        stop: solved.stop,
        peak: solved.peak,
        of_cat: Summary::of(&of_cat),
        ..Measured::default()
    };
    let goals = goals::print(&[case.must], &[case.aim], &measured);
    context.report.add(json!({ "name": case.name, "runs": all, "goals": goals }));
    Ok(())
}

/// Seconds of `cat FILE > /dev/null`.
fn cat(path: &Path) -> Result<f64> {
    let start = Instant::now();
    let status = Command::new("cat").arg(path).stdout(Stdio::null()).status().context("cat")?;
    ensure!(status.success(), "cat failed on {}", path.display());
    Ok(start.elapsed().as_secs_f64())
}
