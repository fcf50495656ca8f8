//! taut as a program of its own: one reconstruction, one line, as the Delaunay peers do it.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use anyhow::{Context as _, Result};
use taut_points::Points;
use taut_reconstruct::{CurveMethod, CurveOptions, curve};

use crate::delaunay::program::{self, Build};
use crate::meter::Meter;
use crate::peer::Silence;

/// What to reconstruct.
#[derive(clap::Args)]
pub(crate) struct OneArguments {
    /// Method, by its name.
    #[arg(long)]
    method: String,
    /// Threads.
    #[arg(long)]
    threads: usize,
    /// Little-endian doubles, row by row.
    file: PathBuf,
}

/// Reconstructs and prints what it cost.
pub(crate) fn run(arguments: &OneArguments) -> Result<()> {
    let mut file =
        File::open(&arguments.file).with_context(|| arguments.file.display().to_string())?;
    let mut values = vec![0.0f64; file.metadata()?.len() as usize / 8];
    file.read_exact(bytemuck::cast_slice_mut(&mut values))?;
    let points = Points::new(&values, 2)?;
    let method: CurveMethod = arguments.method.parse()?;
    let options =
        CurveOptions { method, threads: Some(arguments.threads), ..CurveOptions::default() };
    let meter = Meter::start();
    let found = curve(&points, &options)?;
    let cost = meter.stop();
    let curves = &found.answer.curves;
    let edges = curves.iter().map(|curve| curve.vertices.len() as u64 - u64::from(!curve.closed));
    let build = Build {
        program: format!("taut {}", env!("TAUT_BUILT_FROM")),
        points: points.len() as u64,
        simplices: edges.sum(),
        cpu: cost.cpu,
        wall: cost.wall,
        peak: cost.peak,
        exact: None,
        counters: BTreeMap::from([("curves".to_owned(), curves.len() as u64)]),
        judged: None,
    };
    println!("{}", serde_json::to_string(&build)?);
    Ok(())
}

/// One reconstruction of the points in `file`, in a process of its own.
pub(super) fn alone(
    method: CurveMethod,
    threads: usize,
    file: &Path,
    limit: Duration,
) -> Result<Result<Build, Silence>> {
    let mut command = Command::new(std::env::current_exe()?);
    command.arg("one-curve").args(["--method", method.name()]);
    command.args(["--threads", &threads.to_string()]).arg(file);
    program::run(command, limit)
}
