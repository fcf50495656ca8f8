//! Free centers of points to a gap: medians over permutations of the rows.

use super::*;

/// Coordinates, one row after another, and the dimension.
type Rows = (Vec<f64>, usize);

impl Set {
    /// Its rows and their dimension; `None`, after saying so, where they are not to be had.
    fn load(self, context: &Context) -> Result<Option<Rows>> {
        Ok(match self {
            // A tenth of the cities would have other optima.
            Set::Cities(name) => cities::read(name)?.map(|values| (values, 2)),
            Set::Normal(n) => {
                let n = context.count(n);
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

/// Runs all tasks.
pub(super) fn run(context: &Context, out: &mut Outcome, tasks: &'static [Task]) -> Result<()> {
    // `None` for a set that is not to be had, so that this is said once.
    let mut loaded: Option<(Set, Option<Rows>)> = None;
    for task in tasks {
        let values = match loaded.take() {
            Some((set, values)) if set == task.set => values,
            _ => task.set.load(context)?,
        };
        let (_, values) = loaded.insert((task.set, values));
        if let Some((values, dim)) = values {
            run_task(context, out, task, values, *dim)?;
        } else {
            out.keep("left_out", json!(task.set.name()));
        }
    }
    Ok(())
}

fn run_task(
    context: &Context,
    out: &mut Outcome,
    task: &'static Task,
    values: &[f64],
    dim: usize,
) -> Result<()> {
    let options = CentersOptions { epsilon: task.epsilon, ..CentersOptions::default() };
    let pool = context.pool()?;
    let mut table = Table::new(&format!("permutation | {TIME_COLUMNS} | nodes | {COLUMNS}"));
    let (mut judgements, mut clocks) = (vec![], vec![]);
    for permutation in 0..context.runs.min(task.permutations) as u64 {
        let rows = cities::permuted(values, dim, SEED + permutation)?;
        let points = Points::new(&rows, dim)?;
        let mut first = None;
        let solve = || Ok(centers(&points, task.k, &options)?);
        let rounds = rounds::run(context, 1, Opponents::default(), solve, |seen| {
            let Seen::Ours(answer) = seen else { return Ok(()) };
            let is_same = first.get_or_insert_with(|| answer.clone()) == answer;
            ensure!(is_same, "an answer differs from that with another number of threads");
            Ok(())
        })?;
        let judgement = pool.install(|| judge(&rounds.found, &points));
        let head = json!({
            "permutation": permutation, "nodes": rounds.found.trace.iterations, "times": rounds.json(),
        });
        table.push(joined([head, rounds.cells(), judgement.cells()]));
        clocks.extend(rounds.clock());
        judgements.push(judgement);
    }
    let (name, n) = (task.set.name(), values.len() / dim);
    let what = format!("{name}, {n} × {dim}, k = {}, ε = {:e}", task.k, task.epsilon);
    out.table(&what, table);
    let mut found = judgement::found(&judgements);
    found.median(SECONDS, Summary::of(&clocks), seconds);
    let radius = task.radius.map(|radius| RADIUS.near(radius, KNOWN_RADIUS_TOLERANCE));
    let known: Vec<Goal> = [GAP.at_most(task.epsilon)].into_iter().chain(radius).collect();
    out.judge_by([&known, &[]], &found);
    out.judge_by([task.must, task.aim], &found);
    out.close(&what);
    Ok(())
}
