//! Smallest ellipsoids of points: solved by rounds, then proved.

use super::*;

/// The gap that is asked for.
const EPSILON: f64 = 1e-12;

/// One set of points, solved and judged.
pub(super) struct Solved {
    /// The answers and times.
    pub(super) rounds: Rounds<Solution<Ellipsoid>>,
    /// What the checker says.
    pub(super) verdict: Result<EllipsoidVerdict, String>,
}

/// Solves `values`, rows of d numbers, beside peers.
pub(super) fn solve(
    context: &Context,
    runs: usize,
    values: &[f64],
    d: usize,
    peers: &[&str],
) -> Result<Solved> {
    let points = Points::new(values, d)?;
    let options = EllipsoidOptions { epsilon: EPSILON, ..EllipsoidOptions::default() };
    // As for balls, the pool reads the rows once before each run, which wakes its threads; but not beside peers, whose processes do not.
    let reads = peers.is_empty().then(|| bytemuck::cast_slice(values));
    let beside = Opponents { peers, rows: (values, d), reads };
    let solve = || Ok(ellipsoid(&points, &options)?);
    let rounds = rounds::run(context, runs, beside, solve, |_| Ok(()))?;
    let verdict = rounds.found.check(&points).map_err(|why| why.to_string());
    Ok(Solved { rounds, verdict })
}

/// What the checker says, for a table.
pub(super) fn shown_gap(gap: &Result<f64, String>) -> String {
    gap.as_ref().map_or_else(|why| format!("REJECTED: {why}"), |gap| Unit::Power.show(*gap))
}

impl Solved {
    fn gap(&self) -> Result<f64, String> {
        self.verdict.as_ref().map(|verdict| verdict.gap).map_err(String::clone)
    }

    /// What goals ask for.
    pub(super) fn found(&self) -> Found {
        let mut found = Found::proved(self.gap());
        found.add(PASSES, self.rounds.found.trace.passes as f64);
        found.median(SECONDS, Summary::of(self.rounds.walls()), seconds);
        let faster = self.rounds.peer().and_then(|peer| self.rounds.faster(peer));
        found.add(FASTER, faster.map(|(ratio, _)| ratio));
        found
    }

    /// Cells under [`columns`].
    pub(super) fn cells(&self) -> Value {
        let found = &self.rounds.found;
        let cells = json!({
            "verified gap": shown_gap(&self.gap()), "stop": found.trace.stop, "passes": found.trace.passes,
            "steps": found.trace.iterations, "support": found.certificate.support.len(),
        });
        joined([self.rounds.cells(), cells])
    }

    /// Everything, for the report.
    pub(super) fn json(&self) -> Value {
        let found = &self.rounds.found;
        json!({
            "times": self.rounds.json(), "gap": self.gap(), "log_volume": found.answer.log_volume,
            "trace": &found.trace,
        })
    }
}

/// Columns of [`Solved::cells`].
pub(super) fn columns() -> String {
    format!("{TIME_COLUMNS} | verified gap | stop | passes | steps | support")
}

/// Runs all inputs of a case, each under all of its seeds.
pub(super) fn run(context: &Context, out: &mut Outcome, inputs: &[Input]) -> Result<()> {
    for input in inputs {
        let n = context.count(input.n);
        let what = format!("{}, {n} × {}", input.law, input.d);
        let mut table = Table::new(&format!("seed | {}", columns()));
        let mut found = Found::default();
        for seed in SEED..SEED + input.seeds {
            let values = input.law.draw(n, input.d, seed)?;
            let solved = solve(context, context.runs, &values, input.d, &[])?;
            let head = json!({ "seed": seed, "solved": solved.json() });
            table.push(joined([head, solved.cells()]));
            found.join(solved.found());
        }
        out.table(&what, table);
        out.judge(&found);
        out.judge_by([input.must, input.aim], &found);
        out.close(&what);
    }
    Ok(())
}
