//! Delaunay triangulations: taut and its peers on the same file, every build a process of its own.

mod case;
pub(crate) mod one;
pub(crate) mod program;
mod rounds;
mod sets;

use std::collections::BTreeMap;
use std::process::{Command, Stdio};

use serde::{Deserialize, Serialize};
use taut_delaunay::{Complex, Counters, DelaunayOptions, Plane, Space, Triangulation};
use taut_points::Error;
use taut_points::generate::Parameters;

use crate::context::pool;
use crate::meter::Cost;
use crate::prelude::*;
use crate::process;
use crate::process::Judged;
pub(crate) use case::AREA;
use case::{BYTES, CHECK, Case, EXACT_RATE, OF_CGAL, OF_UNIFORM, SPEEDUP};
use one::Task;
use program::{CGAL, DELAUNATOR, Program, QHULL, SPADE, TRIANGLE};
use rounds::{PerPoint, Rounds};

/// Sections and how often.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    options: Options,
    /// Peers that take part, by the beginnings of their names, or `none` [default: those of the section].
    #[arg(long, value_delimiter = ',')]
    peers: Vec<String>,
    /// Triangulate this file instead: little-endian doubles, the coordinates of one point after another.
    #[arg(long, requires = "dim", conflicts_with = "sections")]
    file: Option<PathBuf>,
    /// Dimension of the points of that file, 2 or 3.
    #[arg(long, requires = "file", value_parser = clap::value_parser!(u64).range(2..=3))]
    dim: Option<u64>,
    /// How many simplices the points of that file have; without it the exact peers say so.
    #[arg(long, requires = "file")]
    simplices: Option<u64>,
    /// Measure nothing: compare the simplices of taut with those of CGAL, one by one, on the inputs of the sections.
    #[arg(long, conflicts_with_all = ["file", "json", "peers"])]
    sets: bool,
}

/// Runs the sections that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    for wanted in &arguments.peers {
        let known = case::PLANE_PEERS.iter().any(|&peer| is_named(Program::Peer(peer), wanted));
        ensure!(known || wanted == "none", "no peer's name begins with `{wanted}`");
    }
    let options = &arguments.options;
    if let (Some(file), Some(dim)) = (&arguments.file, arguments.dim) {
        let name = file.display().to_string();
        return AREA.run_one(options, &name, |context, out| {
            arguments.run_file(context, out, file, dim as usize)
        });
    }
    if arguments.sets {
        let Some(cases) = AREA.choose(options)? else { return Ok(()) };
        return sets::run(&AREA.context(options)?, &cases);
    }
    AREA.run(options, |context, out, section| arguments.run_case(context, out, &section.kind))
}

impl Arguments {
    /// Runs all inputs of a case.
    fn run_case(&self, context: &Context, out: &mut Outcome, case: &Case) -> Result<()> {
        let programs = self.programs(context, case.peers, case.threads);
        let mut uniform: Vec<(usize, PerPoint)> = Vec::new();
        let mut cliffs = Cliffs::new(&programs);
        for input in case.inputs {
            let n = context.count(input.n);
            let distribution = input.distribution(n, case.dim)?;
            let what = format!("{distribution} -n {n} -d {} --seed {SEED}", case.dim);
            let file = context.file("points.f64");
            let values: Vec<f64> = generate(distribution, n, case.dim, SEED)?;
            write_raw(&file, &values)?;
            // The children are measured alone.
            drop(values);
            let known = (!context.quick).then_some(input.simplices);
            let found = rounds::run(context, &file, n as u64, case.dim, &programs, known)?;
            let base = uniform.iter().find(|(size, _)| *size == n).map(|(_, cost)| cost.clone());
            let found = found.beside(base);
            if input.distribution == "uniform" {
                uniform.push((n, found.per_point()));
            }
            cliffs.push(&what, &found);
            out.table(&what, found.table());
            out.keep("measured", found.json());
            out.judge_by([input.must, input.aim], &found.found());
            out.close(&what);
        }
        if cliffs.rows > 1 {
            out.table("Cost per point over that of a uniform set of the same size", cliffs.table);
        }
        Ok(())
    }

    /// Runs one file of the user's.
    fn run_file(
        &self,
        context: &Context,
        out: &mut Outcome,
        file: &Path,
        dim: usize,
    ) -> Result<()> {
        let bytes = file.metadata().with_context(|| file.display().to_string())?.len();
        let row = 8 * dim as u64;
        ensure!(
            bytes % row == 0,
            "{}: {bytes} bytes are no whole points of {dim} doubles",
            file.display()
        );
        let peers = if dim == 2 { case::PLANE_PEERS } else { case::SPACE_PEERS };
        let programs = self.programs(context, peers, &[1]);
        let found = rounds::run(context, file, bytes / row, dim, &programs, self.simplices)?;
        out.table(&format!("{}, {} × {dim}", file.display(), bytes / row), found.table());
        out.keep("measured", found.json());
        Ok(())
    }

    /// taut first, then the peers, as far as the command line lets them.
    fn programs(
        &self,
        context: &Context,
        peers: &[&'static str],
        threads: &[usize],
    ) -> Vec<Program> {
        let threads = if context.threads.is_empty() { threads } else { &context.threads };
        let wanted = |program: &Program| {
            self.peers.is_empty() || self.peers.iter().any(|given| is_named(*program, given))
        };
        let peers = peers.iter().map(|&peer| Program::Peer(peer)).filter(wanted);
        threads.iter().map(|&threads| Program::Taut(threads)).chain(peers).collect()
    }
}

/// Whether the name of a program begins with `wanted`, whatever the case of its letters.
fn is_named(program: Program, wanted: &str) -> bool {
    program.name().to_lowercase().starts_with(&wanted.to_lowercase())
}

/// The table that shows who falls off where.
struct Cliffs {
    programs: Vec<Program>,
    table: Table,
    rows: usize,
}

impl Cliffs {
    fn new(programs: &[Program]) -> Self {
        let name = |program: &Program| match program {
            Program::Taut(threads @ 2..) => format!(" | taut, {threads} threads:x"),
            other => format!(" | {}:x", other.name()),
        };
        let names: String = programs.iter().map(name).collect();
        let table = Table::new(&format!("input{names}"));
        Cliffs { programs: programs.to_vec(), table, rows: 0 }
    }

    fn push(&mut self, what: &str, found: &Rounds) {
        let of_uniform = |&program: &Program| found.of_uniform(program);
        let ratios: Vec<Option<f64>> = self.programs.iter().map(of_uniform).collect();
        if ratios.iter().any(Option::is_some) {
            let cells = ratios.into_iter().map(|ratio| json!(ratio));
            self.table.push([json!(what)].into_iter().chain(cells).collect::<Value>());
            self.rows += 1;
        }
    }
}
