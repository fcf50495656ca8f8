//! Delaunay triangulations of more points than memory holds: times, memory and disk, beside the build in memory.
//!
//! Every triangulation and every check is a process of its own, which the system keeps below the limit on memory. Goals on times
//! are stated for the sizes of the sections and compared in proportion to the points.

mod dealt;
pub(crate) mod diamonds;
mod insertion;
pub(crate) mod one;

use serde::{Deserialize, Serialize};
use taut_points::generate::Parameters;
use taut_points::{GeneratedSource, PointSource, ScalarKind, Scratch};

use crate::prelude::*;
use one::{Done, Task, Way};

/// Sections and sizes.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    options: Options,
    /// Points of each triangulation [default: those of the section].
    #[arg(long, value_name = "N")]
    points: Option<u64>,
    /// MiB of memory [default: those of the section].
    #[arg(long, value_name = "MIB")]
    memory: Option<u64>,
}

/// What is done in a section.
#[derive(Clone, Copy)]
pub(crate) enum Kind {
    /// Triangulates one set.
    Set(Set),
    /// Anything else.
    Run(Run),
}

/// Points that are triangulated on the disk.
#[derive(Clone, Copy)]
pub(crate) struct Set {
    distribution: &'static str,
    dim: usize,
    /// Points that goals on times are stated for.
    points: u64,
    /// MiB.
    memory: u64,
}

impl Set {
    /// Uniform points of the plane.
    pub(crate) const fn uniform_plane(points: u64) -> Self {
        Set { distribution: "uniform", dim: 2, points, memory: 512 }
    }
}

const TIME: Quantity = Quantity::new(
    "time of two threads until all is on the disk, at the points of the section",
    Unit::Seconds,
);
const TEMPORARY: Quantity = Quantity::new(
    "working files over the records of points with their rows, in bytes",
    Unit::Times,
);
const CHECK: Quantity = Quantity::new(
    "time of the check over that of the triangulation until all is on the disk",
    Unit::Times,
);
const OF_MEMORY: Quantity = Quantity::new(
    "processor time of one thread over that of the build in memory, at 10⁷ points",
    Unit::Times,
);
/// The points that it is stated for.
const OF_MEMORY_POINTS: u64 = 10_000_000;
const FRONT: Quantity = Quantity::new("sites that leaves pass up", Unit::Percent);
const SPEEDUP: Quantity = Quantity::new("time of one thread over that of two", Unit::Times);
const OF_LIMIT: Quantity = Quantity::new("peak memory over the limit", Unit::Times);

const PLANE_MUST: &[Goal] = &[
    TIME.at_most(120.0),
    OF_LIMIT.at_most(1.0),
    TEMPORARY.at_most(1.3),
    CHECK.at_most(0.6),
    FRONT.at_most(0.015),
    SPEEDUP.at_least(1.6),
];
const PLANE_AIM: &[Goal] = &[TIME.at_most(40.0)];
const SPACE_MUST: &[Goal] = &[
    TIME.at_most(75.0),
    OF_LIMIT.at_most(1.0),
    TEMPORARY.at_most(1.3),
    CHECK.at_most(0.6),
    OF_MEMORY.at_most(1.8),
    FRONT.at_most(0.1),
    SPEEDUP.at_least(1.6),
];
const SPACE_AIM: &[Goal] = &[TIME.at_most(25.0), OF_MEMORY.at_most(1.4)];
const FEW_MUST: &[Goal] = &[OF_LIMIT.at_most(1.0), OF_MEMORY.at_most(1.8), FRONT.at_most(0.015)];
const FEW_AIM: &[Goal] = &[OF_MEMORY.at_most(1.4)];

const fn set(distribution: &'static str, dim: usize, points: u64, memory: u64) -> Kind {
    Kind::Set(Set { distribution, dim, points, memory })
}

pub(crate) const AREA: Area<Kind> = Area {
    name: "outofcore",
    runs: 1,
    threads: &[],
    limit: 3600,
    peer_budget: 3600,
    sections: &[
        section("plane", set("uniform", 2, 100_000_000, 512))
            .about("Uniform points of the plane within 512 MiB; needs about 10 GB of disk for 10⁸.")
            .must(PLANE_MUST)
            .aim(PLANE_AIM),
        section("roads", set("roads", 2, 100_000_000, 512))
            .about("Points along roads within 512 MiB, in shuffled order.")
            .must(PLANE_MUST)
            .aim(PLANE_AIM),
        section("space", set("uniform", 3, 10_000_000, 1024))
            .about("Uniform points of space within 1 GiB.")
            .must(SPACE_MUST)
            .aim(SPACE_AIM),
        section("plane-10", set("uniform", 2, OF_MEMORY_POINTS, 512))
            .about("10⁷ uniform points of the plane within 512 MiB.")
            .must(FEW_MUST)
            .aim(FEW_AIM),
        section("diamonds", Kind::Run(dealt::run)).about(
            "The method of the thesis: how often diamonds copy a point, and the misses of the k-distributor that deals the copies.",
        ),
        section("insertion", Kind::Run(insertion::run)).about(
            "Is Local RIC I/O-efficient? Misses of four insertion orders in simulated memories (the experiment of 6.3.1).",
        ),
    ],
};

/// Runs the sections that were asked for.
pub(crate) fn run(arguments: &Arguments) -> Result<()> {
    AREA.run(&arguments.options, |context, out, section| match &section.kind {
        Kind::Set(set) => arguments.run_set(context, out, set),
        Kind::Run(run) => run(context, out),
    })
}

impl Arguments {
    fn run_set(&self, context: &Context, out: &mut Outcome, set: &Set) -> Result<()> {
        let points = self.points.unwrap_or(context.size(set.points, set.points / 100));
        let memory = self.memory.unwrap_or(set.memory) << 20;
        let Some(place) = context.folder("6 times the bytes of the points") else {
            return out.left_out();
        };
        let folder = tempfile::TempDir::new_in(place)?;
        let file = folder.path().join("points.f64");
        write_points(&file, set, points)?;
        let task = |threads, way| Task { dim: set.dim, points, threads, file: file.clone(), way };
        let mut table = Table::new(
            "what | threads | time:s | processor:s | peak:MiB | front:% | working:MiB | tiles:MiB",
        );
        let mut row = |what: &str, threads: usize, done: &Done| {
            table.push(json!({
                "what": what, "threads": threads, "time": done.wall, "processor": done.cpu,
                "peak": done.peak, "front": done.front as f64 / points as f64,
                "working": done.working, "tiles": done.tiles,
            }));
        };
        let run = |task: Task, memory| -> Result<Done> {
            task.run(context, memory)?.map_err(|silence| anyhow!("a process of its own {silence}"))
        };
        let mut found = Found::default();
        let mut walls = [f64::NAN; 2];
        let mut of_one = f64::NAN;
        for threads in [1usize, 2] {
            let tiles = folder.path().join(format!("tiles-{threads}"));
            let way = Way::Folder { memory, folder: tiles.clone() };
            let done = run(task(threads, way), Some(memory))?;
            row("on the disk", threads, &done);
            walls[threads - 1] = done.wall;
            found.add(OF_LIMIT, done.peak.map(|peak| peak as f64 / memory as f64));
            let record = 8 * set.dim as u64 + 4;
            found.add(TEMPORARY, done.working as f64 / (points * record) as f64);
            found.add(FRONT, done.front as f64 / points as f64);
            if threads == 1 {
                of_one = done.cpu;
            } else {
                // What is written is work of the triangulation, for which the check would wait otherwise.
                let start = Instant::now();
                let synced = std::process::Command::new("sync").status()?;
                ensure!(synced.success(), "sync failed");
                let wall = done.wall + start.elapsed().as_secs_f64();
                row("the same until all is on the disk", 2, &Done { wall, ..done.clone() });
                let checked = task(2, Way::Check { memory, folder: tiles.clone() });
                let checked = run(checked, Some(memory))?;
                row("its check", 2, &checked);
                found.add(CHECK, checked.wall / wall);
                found.reject(checked.rejected);
                found.add(TIME, wall * set.points as f64 / points as f64);
            }
            std::fs::remove_dir_all(&tiles)?;
        }
        found.add(SPEEDUP, walls[0] / walls[1]);
        // Beyond that the build in memory may not fit, and its time for each point does not change much.
        let few = points.min(OF_MEMORY_POINTS);
        let in_memory = Task { points: few, ..task(1, Way::Memory) };
        let in_memory = if few < points {
            let part = folder.path().join("part.f64");
            write_points(&part, set, few)?;
            run(Task { file: part, ..in_memory }, None)?
        } else {
            run(in_memory, None)?
        };
        row(&format!("the build in memory, {few} points"), 1, &in_memory);
        if points == OF_MEMORY_POINTS {
            found.add(OF_MEMORY, of_one / in_memory.cpu);
        }
        out.table(&format!("{} × {}, {} MiB", points, set.dim, memory >> 20), table);
        out.judge(&found);
        Ok(())
    }
}

impl Task {
    /// Does it in a process of its own, which gets no more memory than that from the system.
    pub(crate) fn run(
        self,
        context: &Context,
        memory: Option<u64>,
    ) -> Result<Result<Done, Silence>> {
        let job = serde_json::to_string(&Job::OutOfCore(self))?;
        let program = std::env::current_exe()?;
        let mut command = match memory {
            // Data counts what is mapped to be written, stacks of threads included.
            Some(bytes) => {
                let mut shell = std::process::Command::new("sh");
                shell.arg("-c").arg(format!("ulimit -d {}; exec \"$@\"", bytes >> 10)).arg("sh");
                shell.arg(program);
                shell
            }
            None => std::process::Command::new(program),
        };
        command.arg("job").arg(job);
        crate::process::run(command, context.limit)
    }
}

/// Writes a set of points block by block.
pub(crate) fn write_points(file: &Path, set: &Set, points: u64) -> Result<()> {
    use std::io::Write;
    let distribution =
        Distribution::named(set.distribution, points, set.dim, &Parameters::default())?;
    let source = GeneratedSource::new(distribution, points, set.dim, SEED, ScalarKind::F64)?;
    let mut out = std::io::BufWriter::with_capacity(1 << 20, std::fs::File::create(file)?);
    let (mut scratch, mut row) = (Scratch::new(), vec![0.0; set.dim]);
    for begin in (0..points).step_by(1 << 16) {
        let rows = source.read(begin..points.min(begin + (1 << 16)), &mut scratch)?;
        for i in 0..rows.len() {
            rows.copy_row(i, &mut row);
            row.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
        }
    }
    Ok(out.flush()?)
}
