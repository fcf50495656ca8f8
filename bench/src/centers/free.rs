//! Free centres of points to a gap: medians over permutations of the rows.

use anyhow::{Result, ensure};
use serde_json::json;
use taut_enclose::{CentersOptions, centers};
use taut_points::{Distribution, Points, generate};

use super::case::{Case, Set, Task};
use super::judgement::{self, COLUMNS, judge};
use super::{Context, cities};
use crate::goals::{self, Goal};
use crate::input::SEED;
use crate::meter::Meter;
use crate::stats::{Summary, seconds};
use crate::table::Table;

/// Coordinates, one row after another, and the dimension.
type Rows = (Vec<f64>, usize);

impl Set {
    /// Its rows and their dimension; `None`, after saying so, where they are not to be had.
    fn load(self, quick: bool) -> Result<Option<Rows>> {
        Ok(match self {
            // A tenth of the cities would have other optima.
            Set::Cities(name) => cities::read(name)?.map(|values| (values, 2)),
            Set::Normal(n) => {
                let n = if quick { n / 10 } else { n };
                Some((generate(Distribution::Normal, n, 3, SEED)?, 3))
            }
        })
    }

    fn name(self) -> &'static str {
        match self {
            Set::Cities(name) => name,
            Set::Normal(_) => "normal",
        }
    }
}

/// Runs all tasks of a case.
pub(super) fn run(context: &mut Context, case: &Case, tasks: &[Task]) -> Result<()> {
    let mut all = Vec::new();
    // `None` for a set that is not to be had, so that this is said once.
    let mut loaded: Option<(Set, Option<Rows>)> = None;
    for task in tasks {
        let values = match loaded.take() {
            Some((set, values)) if set == task.set => values,
            _ => task.set.load(context.quick)?,
        };
        let (_, values) = loaded.insert((task.set, values));
        let Some((values, dim)) = values else {
            all.push(json!({ "set": task.set.name(), "k": task.k, "left_out": "no TAUT_DATA" }));
            continue;
        };
        all.push(run_task(context, case, task, values, *dim)?);
    }
    context.report.add(json!({ "name": case.name, "tasks": all }));
    Ok(())
}

fn run_task(
    context: &Context,
    case: &Case,
    task: &Task,
    values: &[f64],
    dim: usize,
) -> Result<serde_json::Value> {
    let options = CentersOptions { epsilon: task.epsilon, ..CentersOptions::default() };
    let pools = context
        .threads
        .iter()
        .map(|&threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build())
        .collect::<Result<Vec<_>, _>>()?;
    let head = ["permutation", "clock", "processors", "one thread", "nodes"];
    let mut table = Table::new(&[&head[..], &COLUMNS[..]].concat());
    let (mut judgements, mut clocks, mut report) = (vec![], vec![], vec![]);
    for permutation in 0..context.runs.min(task.permutations) as u64 {
        let rows = cities::permuted(values, dim, SEED + permutation)?;
        let points = Points::new(&rows, dim)?;
        let (mut times, mut found) = (vec![], None);
        for (pool, &threads) in pools.iter().zip(&context.threads) {
            let meter = Meter::start();
            let answer = pool.install(|| centers(&points, task.k, &options))?;
            let cost = meter.stop();
            times.push(json!({ "threads": threads, "wall": cost.wall, "cpu": cost.cpu }));
            let is_same = found.as_ref().is_none_or(|(before, _)| *before == answer);
            ensure!(is_same, "{threads} threads give another answer than fewer");
            let one = (threads == 1).then_some(cost.cpu);
            let one = found.as_ref().and_then(|(_, (_, one))| *one).or(one);
            found = Some((answer, (cost, one)));
        }
        let Some((answer, (cost, one))) = found else { continue };
        let judgement = match pools.last() {
            Some(pool) => pool.install(|| judge(&answer, &points)),
            None => judge(&answer, &points),
        };
        let nodes = answer.trace.iterations;
        table.push(
            [
                vec![
                    permutation.to_string(),
                    seconds(cost.wall),
                    seconds(cost.cpu),
                    one.map(seconds).unwrap_or_default(),
                    nodes.to_string(),
                ],
                judgement.cells(),
            ]
            .concat(),
        );
        report.push(json!({ "times": times, "nodes": nodes, "judgement": judgement.json() }));
        clocks.push(cost.wall);
        judgements.push(judgement);
    }
    let n = values.len() / dim;
    println!("{}, {n} × {dim}, k = {}, ε = {:e}\n\n{table}", task.set.name(), task.k, task.epsilon);
    let mut measured = judgement::measured(&judgements);
    measured.clock = Summary::of(&clocks);
    let gap = [Goal::gap(task.epsilon)];
    // What is only hoped for is no must by its gap.
    let gap: &[Goal] = if task.aim.contains(&gap[0]) { &[] } else { &gap };
    let goals = goals::print(&[gap, case.must, task.must], &[task.aim], &measured);
    println!();
    Ok(json!({
        "set": task.set.name(), "k": task.k, "epsilon": task.epsilon, "permutations": report, "goals": goals,
    }))
}
