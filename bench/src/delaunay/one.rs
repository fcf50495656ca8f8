//! taut as a program of its own: one build, one line, as the peers do it.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::Read;
use std::path::PathBuf;

use anyhow::{Context as _, Result, bail};
use taut_delaunay::{Complex, Counters, DelaunayOptions, Plane, Space, Triangulation};
use taut_points::{Monitor, Points};

use super::program::{Build, Judged};
use crate::meter::{Cost, Meter};

/// What to build.
#[derive(clap::Args)]
pub(crate) struct OneArguments {
    /// Dimension, 2 or 3.
    #[arg(long)]
    dim: usize,
    /// Threads.
    #[arg(long)]
    threads: usize,
    /// Judge the answer as well, when the build is over.
    #[arg(long)]
    check: bool,
    /// Little-endian doubles, row by row.
    file: PathBuf,
}

/// Builds the triangulation and prints what it cost.
pub(crate) fn run(arguments: &OneArguments) -> Result<()> {
    let mut file =
        File::open(&arguments.file).with_context(|| arguments.file.display().to_string())?;
    let mut values = vec![0.0f64; file.metadata()?.len() as usize / 8];
    file.read_exact(bytemuck::cast_slice_mut(&mut values))?;
    let points = Points::new(&values, arguments.dim)?;
    let options =
        DelaunayOptions { threads: Some(arguments.threads), ..DelaunayOptions::default() };
    let n = points.len() as u64;
    let meter = Meter::start();
    let build = match arguments.dim {
        2 => {
            let built = Plane::build(&points, &options)?;
            let build = line(n, meter.stop(), &built);
            Build { judged: arguments.judge(&built, &points)?, ..build }
        }
        3 => {
            let built = Space::build(&points, &options)?;
            let build = line(n, meter.stop(), &built);
            Build { judged: arguments.judge(&built, &points)?, ..build }
        }
        dim => bail!("--dim is {dim}: expected 2 or 3"),
    };
    println!("{}", serde_json::to_string(&build)?);
    Ok(())
}

impl OneArguments {
    /// What it takes to have an answer of the triangulation and to judge it, with as many threads as the build.
    fn judge<const D: usize, const V: usize>(
        &self,
        built: &Triangulation<D, V>,
        points: &Points<'_, f64>,
    ) -> Result<Option<Judged>> {
        if !self.check {
            return Ok(None);
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(self.threads).build()?;
        pool.install(|| {
            let meter = Meter::start();
            let solution = built.solution(points, &Monitor::silent())?;
            let answer = meter.stop().cpu;
            let meter = Meter::start();
            let verdict = solution.check(points);
            let check = meter.stop().cpu;
            Ok(Some(Judged { answer, check, rejected: verdict.err().map(|why| why.to_string()) }))
        })
    }
}

fn line<const D: usize, const V: usize>(
    points: u64,
    cost: Cost,
    built: &Triangulation<D, V>,
) -> Build {
    let simplices = match built.complex() {
        Complex::Nothing => 0,
        Complex::Point => 1,
        Complex::Line(chain) => chain.len() as u64 - 1,
        Complex::Flat(triangles) => triangles.iter().filter(|t| !t.is_ghost()).count() as u64,
        Complex::Full => built.simplices().count() as u64,
    };
    let Counters { insertions, walk_steps, orientations, conflict_tests, replaced, stages } =
        *built.counters();
    let open = stages.calls() - stages.filter;
    let calls = orientations + conflict_tests;
    let counters = [
        ("sites", built.site_count() as u64),
        ("insertions", insertions),
        ("walk_steps", walk_steps),
        ("orientations", orientations),
        ("conflict_tests", conflict_tests),
        ("replaced", replaced),
        ("integer", stages.integer),
        ("double_double", stages.double_double),
        ("wide", stages.wide),
        ("unbounded", stages.unbounded),
        ("ties", stages.ties),
    ];
    Build {
        program: format!("taut {}", env!("TAUT_BUILT_FROM")),
        points,
        simplices,
        cpu: cost.cpu,
        wall: cost.wall,
        peak: cost.peak,
        exact: (calls > 0).then(|| open as f64 / calls as f64),
        counters: BTreeMap::from(counters.map(|(name, count)| (name.to_owned(), count))),
        judged: None,
    }
}
