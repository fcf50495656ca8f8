//! Delaunay triangulations: taut and its peers on the same file, every build a process of its own.

mod case;
mod goals;
pub(crate) mod one;
pub(crate) mod program;
mod rounds;
mod sets;

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Context as _, Result, ensure};
use serde_json::{Value, json};
use taut_points::generate;
use tempfile::TempDir;

use crate::cases::Choice;
use crate::input::SEED;
use crate::report::Report;
use crate::stats::times;
use crate::table::Table;
use case::{CASES, Case};
use program::{Peer, Program};
use rounds::{Effort, PerPoint, Rounds};

/// The peer that ratios are taken of.
const CGAL: Program = Program::Peer(Peer::Cgal);

/// Cases and how often.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    choice: Choice,
    /// Rounds; of the processor times of a program the least counts.
    #[arg(long, default_value_t = 5)]
    runs: usize,
    /// Numbers of threads taut is run with [default: those of the case].
    #[arg(long, value_delimiter = ',')]
    threads: Vec<usize>,
    /// Peers that take part, by the beginnings of their names, or `none` [default: those of the case].
    #[arg(long, value_delimiter = ',')]
    peers: Vec<String>,
    /// Seconds after which one build is stopped.
    #[arg(long, default_value_t = 120)]
    limit: u64,
    /// Processor seconds after which a peer that is slow takes part in no further round of an input.
    #[arg(long, default_value_t = 30)]
    peer_budget: u64,
    /// Triangulate this file instead of the cases: little-endian doubles, the coordinates of one point after another.
    #[arg(long, requires = "dim", conflicts_with = "cases")]
    file: Option<PathBuf>,
    /// Dimension of the points of that file, 2 or 3.
    #[arg(long, requires = "file", value_parser = clap::value_parser!(u64).range(2..=3))]
    dim: Option<u64>,
    /// How many simplices the points of that file have; without it the exact peers say so.
    #[arg(long, requires = "file")]
    simplices: Option<u64>,
    /// Measure nothing: compare the simplices of taut with those of CGAL, one by one, on the inputs of the cases.
    #[arg(long, conflicts_with_all = ["file", "json", "peers"])]
    sets: bool,
}

/// What all cases share.
struct Context<'a> {
    arguments: &'a Arguments,
    effort: Effort,
    temp: TempDir,
    report: Report,
}

/// Runs the cases that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    let Some(cases) = arguments.choice.of(CASES, "delaunay")? else { return Ok(()) };
    ensure!(
        arguments.runs > 0 && !arguments.threads.contains(&0),
        "at least one round and one thread"
    );
    for wanted in &arguments.peers {
        let known = case::PLANE_PEERS.iter().any(|&peer| is_named(Program::Peer(peer), wanted));
        ensure!(known || wanted == "none", "no peer's name begins with `{wanted}`");
    }
    let effort = Effort {
        runs: if arguments.choice.quick { arguments.runs.min(2) } else { arguments.runs },
        limit: Duration::from_secs(arguments.limit),
        peer_budget: Duration::from_secs(arguments.peer_budget),
    };
    let mut context = Context { arguments, effort, temp: TempDir::new()?, report: Report::begin() };
    if let (Some(file), Some(dim)) = (&arguments.file, arguments.dim) {
        return context.file(file, dim as usize);
    }
    if arguments.choice.quick {
        println!("Quick: inputs are smaller than the cases say. Not to be quoted.\n");
    }
    if arguments.sets {
        return sets::run(&cases, arguments.choice.quick);
    }
    for case in cases {
        println!("## {}\n{}\n", case.name, case.about);
        context.case(case)?;
        println!();
        context.write()?;
    }
    Ok(())
}

impl Context<'_> {
    /// Runs all inputs of a case.
    fn case(&mut self, case: &Case) -> Result<()> {
        let programs = self.programs(case.peers, case.threads);
        let mut uniform: Vec<(usize, PerPoint)> = Vec::new();
        let mut cliffs = Cliffs::new(&programs);
        let mut inputs = Vec::new();
        for input in case.inputs {
            let n = if self.arguments.choice.quick { input.n / 10 } else { input.n };
            let distribution = input.distribution(n, case.dim)?;
            let what = format!("{distribution} -n {n} -d {} --seed {SEED}", case.dim);
            let file = self.temp.path().join("points.f64");
            let values: Vec<f64> = generate(distribution, n, case.dim, SEED)?;
            write(&file, &values)?;
            // The children are measured alone.
            drop(values);
            let known = (!self.arguments.choice.quick).then_some(input.simplices);
            let found = rounds::run(&file, n as u64, case.dim, &programs, known, self.effort)?;
            let base = uniform.iter().find(|(size, _)| *size == n).map(|(_, cost)| cost.clone());
            let found = found.beside(base);
            if input.distribution == "uniform" {
                uniform.push((n, found.per_point()));
            }
            cliffs.push(&what, &found);
            println!("{what}\n\n{}", found.table());
            let goals = crate::goals::print(&[input.must], &[input.aim], &found);
            println!();
            inputs.push(json!({ "input": what, "measured": found.json(), "goals": goals }));
        }
        if cliffs.table.len() > 1 {
            println!(
                "Cost per point over that of a uniform set of the same size\n\n{}",
                cliffs.table
            );
        }
        self.report.add(json!({ "name": case.name, "inputs": Value::from(inputs) }));
        Ok(())
    }

    /// Runs one file of the user's.
    fn file(&mut self, file: &Path, dim: usize) -> Result<()> {
        let bytes = file.metadata().with_context(|| file.display().to_string())?.len();
        let row = 8 * dim as u64;
        ensure!(
            bytes % row == 0,
            "{}: {bytes} bytes are no whole points of {dim} doubles",
            file.display()
        );
        let peers = match dim {
            2 => case::PLANE_PEERS,
            _ => case::SPACE_PEERS,
        };
        let programs = self.programs(peers, &[1]);
        let known = self.arguments.simplices;
        let found = rounds::run(file, bytes / row, dim, &programs, known, self.effort)?;
        println!("{}, {} × {dim}\n\n{}", file.display(), bytes / row, found.table());
        let name = file.file_name().map(|name| name.to_string_lossy());
        self.report.add(json!({ "name": name, "measured": found.json() }));
        self.write()
    }

    /// taut first, then the peers, as far as the command line lets them.
    fn programs(&self, peers: &[Peer], threads: &[usize]) -> Vec<Program> {
        let threads = match &self.arguments.threads[..] {
            [] => threads,
            given => given,
        };
        let given = &self.arguments.peers;
        let wanted = |program: &Program| {
            given.is_empty() || given.iter().any(|given| is_named(*program, given))
        };
        let peers = peers.iter().map(|&peer| Program::Peer(peer)).filter(wanted);
        threads.iter().map(|&threads| Program::Taut(threads)).chain(peers).collect()
    }

    fn write(&self) -> Result<()> {
        match &self.arguments.choice.json {
            Some(path) => self.report.write(path),
            None => Ok(()),
        }
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
}

impl Cliffs {
    fn new(programs: &[Program]) -> Self {
        let name = |program: &Program| match program {
            Program::Taut(threads @ 2..) => format!("taut, {threads} threads"),
            other => other.name().to_owned(),
        };
        let head: Vec<String> =
            ["input".to_owned()].into_iter().chain(programs.iter().map(name)).collect();
        let head: Vec<&str> = head.iter().map(String::as_str).collect();
        Cliffs { programs: programs.to_vec(), table: Table::new(&head) }
    }

    fn push(&mut self, what: &str, found: &Rounds) {
        let ratios: Vec<String> = self
            .programs
            .iter()
            .map(|&program| found.of_uniform(program).map(times).unwrap_or_default())
            .collect();
        if ratios.iter().any(|ratio| !ratio.is_empty()) {
            self.table.push([what.to_owned()].into_iter().chain(ratios).collect());
        }
    }
}

/// Writes the points as all programs read them.
fn write(path: &Path, values: &[f64]) -> Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    file.write_all(bytemuck::cast_slice(values))?;
    Ok(file.flush()?)
}
