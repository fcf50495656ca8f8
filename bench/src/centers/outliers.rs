//! Centers of all but a few points, in the plane.

use super::*;

const N: usize = 2000;
/// Numbers of centers; one is the smallest ball of all points but a few.
const CENTERS: [usize; 3] = [1, 2, 3];
/// Numbers of points that may be left out.
const OUTLIERS: [u64; 4] = [0, 1, 3, 5];

/// Runs all pairs.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let n = context.count(N);
    let values: Vec<f64> = generate(Distribution::Uniform, n, 2, SEED)?;
    let points = Points::new(&values, 2)?;
    let columns = format!("k | left out | clock:s | processors:s | nodes | {COLUMNS}");
    let mut table = Table::new(&columns);
    let mut judgements = vec![];
    for k in CENTERS {
        for outliers in OUTLIERS {
            let options = CentersOptions { epsilon: 1e-6, outliers, ..CentersOptions::default() };
            let solve = || Ok(centers(&points, k, &options)?);
            let rounds =
                rounds::run(context, context.runs, Opponents::default(), solve, |_| Ok(()))?;
            let judgement = judge(&rounds.found, &points);
            let head = json!({
                "k": k, "left out": outliers, "clock": Summary::of(rounds.walls()).map(|all| all.median),
                "processors": rounds.processors(), "nodes": rounds.found.trace.iterations, "times": rounds.json(),
            });
            table.push(joined([head, judgement.cells()]));
            judgements.push(judgement);
        }
    }
    out.table(&format!("uniform, {n} × 2, medians of {} runs", context.runs), table);
    out.judge(&judgement::found(&judgements));
    Ok(())
}
