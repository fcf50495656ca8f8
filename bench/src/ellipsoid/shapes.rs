//! Ellipsoids as inputs: the smallest ellipsoid around them, the smallest ball.

use super::*;

const N: usize = 1000;
const D: usize = 10;
const EPSILON: f64 = 1e-6;

/// n ellipsoids with normal centers and shapes S = AAᵀ, A normal: each a center and the lower triangle of S.
pub(super) fn draw(n: usize, d: usize, seed: u64) -> Result<Vec<f64>> {
    let centers: Vec<f64> = generate(Distribution::Normal, n, d, seed)?;
    // Far from the seeds of other sets.
    let shapes: Vec<f64> = generate(Distribution::Normal, n, d * d, seed ^ (1 << 40))?;
    let mut values = Vec::with_capacity(n * d * (d + 3) / 2);
    for (center, shape) in centers.chunks_exact(d).zip(shapes.chunks_exact(d * d)) {
        values.extend(center);
        for j in 0..d {
            for k in 0..=j {
                let (a, b) = (&shape[j * d..(j + 1) * d], &shape[k * d..(k + 1) * d]);
                values.push(a.iter().zip(b).map(|(a, b)| a * b).sum());
            }
        }
    }
    Ok(values)
}

/// Solves one problem by rounds; `check` is what the checker and the trace say of an answer.
fn add<T: Send>(
    context: &Context,
    out: &mut Outcome,
    what: &str,
    solve: impl Fn() -> Result<T> + Sync,
    check: impl Fn(&T) -> (Result<f64, String>, u64),
) -> Result<()> {
    let rounds = rounds::run(context, context.runs, Opponents::default(), solve, |_| Ok(()))?;
    let (gap, passes) = check(&rounds.found);
    let mut table = Table::new(&format!("{TIME_COLUMNS} | verified gap | passes"));
    let cells = json!({
        "verified gap": shown_gap(&gap), "passes": passes, "times": rounds.json(),
    });
    table.push(joined([rounds.cells(), cells]));
    out.table(what, table);
    let mut found = Found::proved(gap);
    found.median(SECONDS, Summary::of(rounds.walls()), seconds);
    out.judge(&found);
    out.close(what);
    Ok(())
}

/// Runs both problems.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let n = context.count(N);
    let values = draw(n, D, SEED)?;
    let items = Points::new(&values, D * (D + 3) / 2)?;
    let of = format!("{n} ellipsoids, d = {D}, ε = {EPSILON:e}");
    let inputs = Items::Ellipsoids;
    let options = EllipsoidOptions { epsilon: EPSILON, inputs, ..EllipsoidOptions::default() };
    add(
        context,
        out,
        &format!("smallest ellipsoid of {of}"),
        || Ok(ellipsoid(&items, &options)?),
        |found| {
            let gap = found.check(&items).map(|verdict| verdict.gap);
            (gap.map_err(|why| why.to_string()), found.trace.passes)
        },
    )?;
    let options = BallOptions { epsilon: EPSILON, inputs, ..BallOptions::default() };
    add(
        context,
        out,
        &format!("smallest ball of {of}"),
        || Ok(ball(&items, &options)?),
        |found| {
            let gap = found.check(&items).map(|verdict| verdict.gap);
            (gap.map_err(|why| why.to_string()), found.trace.passes)
        },
    )
}
