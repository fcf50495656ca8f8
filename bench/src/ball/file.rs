//! A file larger than the memory that is allowed: passes beside `cat`, and the peak memory of the process.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::time::Instant;

use anyhow::{Context as _, Result, ensure};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::json;
use taut_certify::{Items, Stop, Verdict};
use taut_enclose::{BallOptions, ball_of_source};
use taut_points::{
    Blocks, Distribution, FileSource, GeneratedSource, Monitor, PointSource, Rows, ScalarKind,
    Scratch,
};

use super::Context;
use super::case::Case;
use super::goals::{self, Measured};
use crate::input::SEED;
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
    let found = ball_of_source(&source, Items::Points, &options, &monitor)?;
    let total = start.elapsed().as_secs_f64();
    let peak = peak_memory();
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

/// The high-water mark of the resident memory of this process, in bytes.
pub(crate) fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? << 10)
}

/// Runs the case: makes the file unless it is there, then solves and reads it by turns.
pub(super) fn run(context: &mut Context, case: &Case) -> Result<()> {
    let (n, dim) = if context.quick { (20_000, 2500) } else { (1_000_000, 2500) };
    let folder = match (&context.scratch, context.quick) {
        (Some(folder), _) => folder.clone(),
        (None, true) => context.temp.path().to_owned(),
        (None, false) => {
            println!("left out: give --scratch FOLDER, with 10 GB of free disk, for the file");
            context.report.add(json!({ "name": case.name, "left_out": "no --scratch" }));
            return Ok(());
        }
    };
    let path = folder.join(format!("normal-{n}x{dim}-seed{SEED}.f32"));
    make(&path, n, dim)?;
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
        let output = Command::new(std::env::current_exe()?)
            .arg("solve-file")
            .arg(&path)
            .args([n.to_string(), dim.to_string(), threads.to_string()])
            .stderr(Stdio::inherit())
            .output()?;
        ensure!(output.status.success(), "the solving process failed");
        let solved: Solved = serde_json::from_slice(&output.stdout)?;
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
        dim,
        passes: solved.passes.len() as u64,
        stop: solved.stop,
        peak: solved.peak,
        of_cat: Summary::of(&of_cat),
        ..Measured::default()
    };
    let goals = goals::print(case.must, case.aim, &measured);
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

/// Writes the points, block by block, unless a file of that size is there.
pub(crate) fn make(path: &Path, n: u64, dim: usize) -> Result<()> {
    let bytes = n * dim as u64 * 4;
    if path.metadata().is_ok_and(|found| found.len() == bytes) {
        return Ok(());
    }
    println!("writing {} ({:.2} GB)", path.display(), bytes as f64 / 1e9);
    let source = GeneratedSource::new(Distribution::Normal, n, dim, SEED, ScalarKind::F32)?;
    let blocks = Blocks::of(&source);
    // Under another name first, so that a file of the right name is a whole one.
    let part = path.with_extension("part");
    let mut file = BufWriter::with_capacity(1 << 20, File::create(&part)?);
    let batch = 64 * rayon::current_num_threads() as u64;
    for first in (0..blocks.count()).step_by(batch as usize) {
        let drawn: Vec<Vec<f32>> = (first..(first + batch).min(blocks.count()))
            .into_par_iter()
            .map(|block| -> Result<Vec<f32>> {
                let mut scratch = Scratch::new();
                match source.read(blocks.range(block), &mut scratch)? {
                    Rows::F32(points) => Ok(points.values().to_vec()),
                    Rows::F64(_) => anyhow::bail!("single precision was asked for"),
                }
            })
            .collect::<Result<_>>()?;
        for values in drawn {
            file.write_all(bytemuck::cast_slice(&values))?;
        }
    }
    file.flush()?;
    Ok(std::fs::rename(part, path)?)
}
