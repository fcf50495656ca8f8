//! Small problems beside a conic solver, which knows nothing of core-sets: cvxpy with Clarabel.

use super::*;

/// The gap that taut is asked for; the solver is asked for the same.
const EPSILON: f64 = 1e-10;
/// Ellipsoids in a set.
const ELLIPSOIDS: usize = 20;
/// Their dimensions.
const DIMS: [usize; 3] = [2, 3, 5];
/// Seeds of each dimension.
const SEEDS: u64 = 3;
/// Numbers and dimensions of points.
const POINTS: [(usize, usize); 6] =
    [(100, 3), (300, 3), (1000, 3), (100, 10), (300, 10), (1000, 10)];

/// What is told of an answer: its log-volume or radius, and the gap that the checker proves.
type Told = (f64, Result<f64, String>);

/// A problem on one set of rows beside the solver. Values of other programs are off relatively, in volume or in radius.
fn add<T: Send>(
    context: &Context,
    table: &mut Table,
    peer: &str,
    what: &str,
    (values, columns): (&[f64], usize),
    solve: impl Fn(&Points<'_, f64>) -> Result<T> + Sync,
    tell: impl Fn(&T, &Points<'_, f64>) -> Told,
) -> Result<Found> {
    let rows = Points::new(values, columns)?;
    let beside = Opponents { peers: &[peer], rows: (values, columns), reads: None };
    let rounds = rounds::run(context, context.runs, beside, || solve(&rows), |_| Ok(()))?;
    let peer = rounds.peer().context("one peer")?;
    let theirs = peer.answer.as_ref().map(|answer| answer.radius);
    let (ours, gap) = tell(&rounds.found, &rows);
    let differs = theirs.map(|theirs| match peer.name.as_str() {
        BALL => (theirs / ours - 1.0).abs(),
        _ => (theirs - ours).exp_m1().abs(),
    });
    table.push(json!({
        "input": what, "least": rounds.clock(), "peer's least": peer.least(),
        "times faster": rounds.faster(peer).map(|(ratio, _)| ratio), "value": ours, "peer's": theirs,
        "differs": differs, "verified gap": shown_gap(&gap), "why": peer.silence, "times": rounds.json(),
    }));
    let mut found = Found::proved(gap);
    found.median(SECONDS, Summary::of(rounds.walls()), seconds);
    found.add(DIFFERS, differs);
    Ok(found)
}

/// The peers, one for each problem.
const POINTS_PEER: &str = "conic-points";
const ELLIPSOID: &str = "conic-ellipsoid";
const BALL: &str = "conic-ball";

/// Runs all problems.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    for (title, peer) in [
        ("smallest ellipsoid around points, normal", POINTS_PEER),
        ("smallest ellipsoid around 20 ellipsoids", ELLIPSOID),
        ("smallest ball around 20 ellipsoids", BALL),
    ] {
        let mut table = Table::new(
            "input | least:s | peer's least:s | times faster:x | value:10 | peer's:10 | differs:e | \
             verified gap | why",
        );
        let mut found = Found::default();
        let inputs = if peer == POINTS_PEER { Items::Points } else { Items::Ellipsoids };
        for (what, values, columns) in sets(inputs)? {
            let (table, rows) = (&mut table, (&values[..], columns));
            found.join(if peer == BALL {
                let options = BallOptions { epsilon: EPSILON, inputs, ..Default::default() };
                let solve = |rows: &Points<'_, f64>| Ok(ball(rows, &options)?);
                add(context, table, peer, &what, rows, solve, |found, rows| {
                    let gap = found.check(rows).map(|verdict| verdict.gap);
                    (found.answer.radius, gap.map_err(|why| why.to_string()))
                })?
            } else {
                let options = EllipsoidOptions { epsilon: EPSILON, inputs, ..Default::default() };
                let solve = |rows: &Points<'_, f64>| Ok(ellipsoid(rows, &options)?);
                add(context, table, peer, &what, rows, solve, |found, rows| {
                    let gap = found.check(rows).map(|verdict| verdict.gap);
                    (found.answer.log_volume, gap.map_err(|why| why.to_string()))
                })?
            });
        }
        out.table(title, table);
        out.judge(&found);
        out.close(title);
    }
    Ok(())
}

/// Names, rows and columns of the sets of points or of ellipsoids.
fn sets(inputs: Items) -> Result<Vec<(String, Vec<f64>, usize)>> {
    if inputs == Items::Points {
        let draw = |(n, d)| Ok((format!("{n} × {d}"), Law::Normal.draw(n, d, SEED)?, d));
        return POINTS.into_iter().map(draw).collect();
    }
    let sets = DIMS.into_iter().flat_map(|d| (SEED..SEED + SEEDS).map(move |seed| (d, seed)));
    let draw = |(d, seed)| {
        let values = shapes::draw(ELLIPSOIDS, d, seed)?;
        Ok((format!("d = {d}, seed {seed}"), values, d * (d + 3) / 2))
    };
    sets.map(draw).collect()
}
