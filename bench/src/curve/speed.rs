//! Times of a million points and of ten million, noisy and clean, beside CGAL's Delaunay triangulation of the same points.

use super::*;

/// Who works on an input.
#[derive(Clone, Copy, PartialEq)]
enum Worker {
    Taut(CurveMethod, usize),
    Cgal,
}

impl Worker {
    fn build(self, file: &Path, limit: Duration) -> Result<Result<Build, Silence>> {
        match self {
            Worker::Taut(method, threads) => one::alone(method, threads, file, limit),
            Worker::Cgal => Program::Peer(CGAL).build(2, file, false, limit),
        }
    }
}

/// All workers on one input.
struct Input {
    n: usize,
    what: &'static str,
    rows: Vec<(Worker, Builds)>,
}

impl Input {
    /// Lets all workers take turns.
    fn run(context: &Context, n: usize, noise: &CurveNoise, workers: &[Worker]) -> Result<Self> {
        let truth = truth("bumpy", TestCurve::VERTICES)?;
        let file = context.file("points.f64");
        write_raw(&file, &sample_curve(&truth, n, noise, context.seeds.start).points)?;
        let mut rows: Vec<(Worker, Builds)> =
            workers.iter().map(|&worker| (worker, Builds::default())).collect();
        by_turns(context.runs, &mut rows, |(worker, builds)| {
            if builds.silence.is_none() {
                builds.keep(worker.build(&file, context.limit)?);
            }
            Ok(())
        })?;
        let what = if noise.delta > 0.0 { "noisy" } else { "clean" };
        Ok(Input { n, what, rows })
    }

    fn of(&self, worker: Worker) -> Option<&Builds> {
        Some(&self.rows.iter().find(|(other, _)| *other == worker)?.1)
    }

    /// The least time of a worker by the clock.
    fn wall(&self, worker: Worker) -> Option<f64> {
        self.of(worker)?.wall()
    }

    /// The least time of a worker over that of CGAL.
    fn of_cgal(&self, worker: Worker) -> Option<f64> {
        Some(self.wall(worker)? / self.wall(Worker::Cgal)?)
    }

    fn print(&self, table: &mut Table) {
        for (worker, builds) in &self.rows {
            let (who, threads) = match worker {
                Worker::Taut(method, threads) => (format!("taut {}", method.name()), *threads),
                Worker::Cgal => ("CGAL, Delaunay alone".to_owned(), 1),
            };
            let cgal = self.of(Worker::Cgal).map(|cgal| cgal.all(|build| build.wall));
            let by_rounds =
                cgal.and_then(|cgal| Summary::of_ratios(&builds.all(|build| build.wall), &cgal));
            table.push(json!({
                "bumpy": self.what, "n": self.n, "program": who, "threads": threads, "clock": builds.wall(),
                "processors": builds.cpu(), "÷ CGAL": self.of_cgal(*worker), "by rounds": by_rounds,
                "B/point": builds.bytes_per_point(), "why": builds.silence, "builds": builds.builds,
                "edges or triangles": builds.builds.first().map(|build| build.simplices),
            }));
        }
    }
}

/// Times, ratios and growth.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let clean = CurveNoise { delta: 0.0, ..NOISE };
    let last = context.last_threads();
    let small = context.count(100_000);
    let mut table = Table::new(
        "bumpy | n | program | threads | clock:s | processors:s | ÷ CGAL:x | by rounds:x | \
            B/point:0 | edges or triangles | why",
    );
    for (noise, method) in [(NOISE, CurveMethod::Auto), (clean, CurveMethod::NnCrust)] {
        let mut inputs = vec![];
        for factor in [1, 10, 100] {
            // Ten million once more would only take longer.
            let threads = if factor == 10 { &context.threads[..] } else { &[last] };
            let taut = threads.iter().map(|&threads| Worker::Taut(method, threads));
            let cgal = (factor == 10).then_some(Worker::Cgal);
            let workers: Vec<Worker> = taut.chain(cgal).collect();
            inputs.push(Input::run(context, factor * small, &noise, &workers)?);
        }
        inputs.iter().for_each(|input| input.print(&mut table));
        let [few, middle, many] = &inputs[..] else { bail!("three sizes") };
        let wall = |input: &Input| input.wall(Worker::Taut(method, last));
        if method == CurveMethod::Auto {
            let what = format!("{} noisy points, {last} threads", middle.n);
            out.at_most(what, wall(middle), [6.0, 2.5], Unit::Seconds);
        } else {
            for &threads in &context.threads {
                let what = format!(
                    "{} clean points, NN-Crust over CGAL's Delaunay, {threads} threads",
                    middle.n
                );
                let ratio = middle.of_cgal(Worker::Taut(method, threads));
                out.at_most(what, ratio, [1.0, 0.5], Unit::Times);
            }
        }
        let growth = wall(many).zip(wall(few)).map(|(many, few)| (many / few).ln() / 100f64.ln());
        let what = format!("{}: exponent of growth from {} to {}", few.what, few.n, many.n);
        out.at_most(what, growth, 1.15, Unit::Fixed(2));
    }
    out.table("", table);
    Ok(())
}
