//! taut as a program of its own: one surface, one line, as the Delaunay peers do it.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use anyhow::{Context as _, Result};
use taut_points::Points;
use taut_reconstruct::{SurfaceOptions, surface};

use super::judged::Judged;
use crate::delaunay::program::{self, Build};
use crate::meter::Meter;
use crate::peer::Silence;

/// What to reconstruct.
#[derive(clap::Args)]
pub(crate) struct OneArguments {
    /// Threads.
    #[arg(long)]
    threads: usize,
    /// Little-endian doubles, row by row.
    file: PathBuf,
}

/// Reconstructs and prints what it cost; then the triangles are judged.
pub(crate) fn run(arguments: &OneArguments) -> Result<()> {
    let mut file =
        File::open(&arguments.file).with_context(|| arguments.file.display().to_string())?;
    let mut values = vec![0.0f64; file.metadata()?.len() as usize / 8];
    file.read_exact(bytemuck::cast_slice_mut(&mut values))?;
    let points = Points::new(&values, 3)?;
    let options = SurfaceOptions { threads: Some(arguments.threads), ..SurfaceOptions::default() };
    let meter = Meter::start();
    let found = surface(&points, &options)?;
    let cost = meter.stop();
    let judged = Judged::of(values.as_chunks().0, &found.answer.triangles)?;
    let build = Build {
        program: format!("taut {}", env!("TAUT_BUILT_FROM")),
        points: points.len() as u64,
        simplices: found.answer.triangles.len() as u64,
        cpu: cost.cpu,
        wall: cost.wall,
        peak: cost.peak,
        exact: None,
        counters: judged.counters(),
        judged: None,
    };
    println!("{}", serde_json::to_string(&build)?);
    Ok(())
}

/// The surface of the points in `file`, in a process of its own.
pub(super) fn alone(
    threads: usize,
    file: &Path,
    limit: Duration,
) -> Result<Result<Build, Silence>> {
    let mut command = Command::new(std::env::current_exe()?);
    command.arg("one-surface").args(["--threads", &threads.to_string()]).arg(file);
    program::run(command, limit)
}
