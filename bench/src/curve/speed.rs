//! Times of a million points and of ten million, noisy and clean, beside CGAL's Delaunay triangulation of the same points.

use std::ops::Range;

use anyhow::Result;
use serde_json::{Value, json};
use taut_points::generate::curves::{CurveNoise, TestCurve, sample_curve};
use taut_reconstruct::CurveMethod;

use super::drawn::{NOISE, truth};
use super::one;
use crate::context::Context;
use crate::delaunay::program::{Build, Peer, Program};
use crate::goals::Goals;
use crate::input::write_raw;
use crate::peer::Silence;
use crate::stats::{Summary, seconds, times};
use crate::table::Table;

/// Who works on an input.
#[derive(Clone, Copy, PartialEq)]
enum Worker {
    Taut(CurveMethod, usize),
    Cgal,
}

/// The builds of one worker on one input.
struct Row {
    worker: Worker,
    builds: Vec<Build>,
    silence: Option<Silence>,
}

impl Row {
    /// The least of these.
    fn least(&self, of: impl Fn(&Build) -> f64) -> Option<f64> {
        self.builds.iter().map(of).min_by(f64::total_cmp)
    }
}

/// All workers on one input.
struct Input {
    n: usize,
    what: &'static str,
    rows: Vec<Row>,
}

impl Input {
    /// Lets all workers take turns.
    fn run(
        context: &Context,
        n: usize,
        noise: &CurveNoise,
        seed: u64,
        workers: &[Worker],
    ) -> Result<Self> {
        let truth = truth("bumpy", TestCurve::VERTICES)?;
        let file = context.temp.path().join("points.f64");
        write_raw(&file, &sample_curve(&truth, n, noise, seed).points)?;
        let start = |&worker: &Worker| Row { worker, builds: vec![], silence: None };
        let mut rows: Vec<Row> = workers.iter().map(start).collect();
        for round in 0..context.runs {
            let mut order: Vec<&mut Row> = rows.iter_mut().collect();
            if round % 2 == 1 {
                order.reverse();
            }
            for row in order {
                if row.silence.is_some() {
                    continue;
                }
                let built = match row.worker {
                    Worker::Taut(method, threads) => {
                        one::alone(method, threads, &file, context.limit)?
                    }
                    Worker::Cgal => {
                        Program::Peer(Peer::Cgal).build(2, &file, false, context.limit)?
                    }
                };
                match built {
                    Ok(build) => row.builds.push(build),
                    Err(silence) => row.silence = Some(silence),
                }
            }
        }
        let what = if noise.delta > 0.0 { "noisy" } else { "clean" };
        Ok(Input { n, what, rows })
    }

    fn row(&self, worker: Worker) -> Option<&Row> {
        self.rows.iter().find(|row| row.worker == worker)
    }

    /// The least time of a worker by the clock.
    fn wall(&self, worker: Worker) -> Option<f64> {
        self.row(worker)?.least(|build| build.wall)
    }

    /// The least time of a worker over that of CGAL, with the range round by round.
    fn of_cgal(&self, worker: Worker) -> Option<(f64, Summary)> {
        let walls =
            |worker| Some(self.row(worker)?.builds.iter().map(|b| b.wall).collect::<Vec<_>>());
        let range = Summary::of_ratios(&walls(worker)?, &walls(Worker::Cgal)?)?;
        Some((self.wall(worker)? / self.wall(Worker::Cgal)?, range))
    }

    fn print(&self, table: &mut Table) {
        for row in &self.rows {
            let (who, threads) = match row.worker {
                Worker::Taut(method, threads) => (format!("taut {}", method.name()), threads),
                Worker::Cgal => ("CGAL, Delaunay alone".to_owned(), 1),
            };
            let show =
                |value: Option<f64>, show: fn(f64) -> String| value.map(show).unwrap_or_default();
            let peak = row.builds.iter().filter_map(|build| build.peak).max();
            let ratio = self.of_cgal(row.worker).map(|(least, range)| {
                format!("{} ({}–{})", times(least), times(range.min), times(range.max))
            });
            table.push(vec![
                self.what.to_owned(),
                self.n.to_string(),
                who,
                threads.to_string(),
                show(row.least(|build| build.wall), seconds),
                show(row.least(|build| build.cpu), seconds),
                ratio.unwrap_or_default(),
                peak.map(|peak| format!("{:.0}", peak as f64 / self.n as f64)).unwrap_or_default(),
                row.builds.first().map(|build| build.simplices.to_string()).unwrap_or_default(),
                row.silence.as_ref().map(Silence::to_string).unwrap_or_default(),
            ]);
        }
    }

    fn json(&self) -> Value {
        let rows = self.rows.iter().map(|row| {
            let silence = row.silence.as_ref().map(Silence::to_string);
            json!({ "builds": row.builds, "silence": silence })
        });
        json!({ "what": self.what, "n": self.n, "rows": rows.collect::<Vec<_>>() })
    }
}

/// Times, ratios and growth.
pub(super) fn run(context: &Context, seeds: Range<u64>) -> Result<Value> {
    let clean = CurveNoise { delta: 0.0, ..NOISE };
    let last = context.threads[context.threads.len() - 1];
    let small = if context.quick { 10_000 } else { 100_000 };
    let mut inputs = vec![];
    for (noise, method) in [(NOISE, CurveMethod::Auto), (clean, CurveMethod::NnCrust)] {
        for factor in [1, 10, 100] {
            // Ten million once more would only take longer.
            let threads = if factor == 10 { &context.threads[..] } else { &[last] };
            let mut workers: Vec<Worker> =
                threads.iter().map(|&threads| Worker::Taut(method, threads)).collect();
            if factor == 10 {
                workers.push(Worker::Cgal);
            }
            inputs.push(Input::run(context, factor * small, &noise, seeds.start, &workers)?);
        }
    }
    let head = [
        "bumpy",
        "n",
        "program",
        "threads",
        "clock",
        "processors",
        "÷ CGAL",
        "B/point",
        "edges or triangles",
        "",
    ];
    let mut table = Table::new(&head);
    inputs.iter().for_each(|input| input.print(&mut table));
    println!("{table}");
    let mut goals = Goals::default();
    let [noisy, clean] = [&inputs[..3], &inputs[3..]];
    let fit = Worker::Taut(CurveMethod::Auto, last);
    goals.at_most(
        &format!("{} noisy points, {last} threads", noisy[1].n),
        noisy[1].wall(fit),
        (6.0, Some(2.5)),
        seconds,
    );
    for &threads in &context.threads {
        let ratio = clean[1].of_cgal(Worker::Taut(CurveMethod::NnCrust, threads));
        let what = format!(
            "{} clean points, NN-Crust over CGAL's Delaunay, {threads} threads",
            clean[1].n
        );
        goals.at_most(&what, ratio.map(|(least, _)| least), (1.0, Some(0.5)), times);
    }
    for (inputs, method) in [(noisy, CurveMethod::Auto), (clean, CurveMethod::NnCrust)] {
        let wall = |input: &Input| input.wall(Worker::Taut(method, last));
        let growth = wall(&inputs[2])
            .zip(wall(&inputs[0]))
            .map(|(large, little)| (large / little).ln() / 100f64.ln());
        let what = format!(
            "{}: exponent of growth from {} to {}",
            inputs[0].what, inputs[0].n, inputs[2].n
        );
        goals.at_most(&what, growth, (1.15, None), |value| format!("{value:.2}"));
    }
    let inputs: Vec<Value> = inputs.iter().map(Input::json).collect();
    Ok(json!({ "inputs": inputs, "goals": goals.json() }))
}
