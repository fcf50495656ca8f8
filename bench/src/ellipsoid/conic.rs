//! Small problems beside a conic solver, which knows nothing of core-sets: cvxpy with Clarabel.

use super::*;
use crate::rounds;

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

/// What is solved.
#[derive(Clone, Copy)]
enum Problem {
    Points,
    Ellipsoid,
    Ball,
}

impl Problem {
    fn peer(self) -> &'static str {
        match self {
            Problem::Points => "conic-points",
            Problem::Ellipsoid => "conic-ellipsoid",
            Problem::Ball => "conic-ball",
        }
    }
}

/// taut's answer.
enum Solved {
    Ellipsoid(Solution<Ellipsoid>),
    Ball(Solution<Ball>),
}

impl Solved {
    fn of(problem: Problem, rows: &Points<'_, f64>) -> Result<Self> {
        let options = EllipsoidOptions { epsilon: EPSILON, ..EllipsoidOptions::default() };
        Ok(match problem {
            Problem::Points => Solved::Ellipsoid(ellipsoid(rows, &options)?),
            Problem::Ellipsoid => Solved::Ellipsoid(ellipsoid(
                rows,
                &EllipsoidOptions { inputs: Items::Ellipsoids, ..options },
            )?),
            Problem::Ball => {
                let options = BallOptions { epsilon: EPSILON, ..BallOptions::default() };
                Solved::Ball(ball(rows, &BallOptions { inputs: Items::Ellipsoids, ..options })?)
            }
        })
    }

    /// The radius, or the log-volume.
    fn value(&self) -> f64 {
        match self {
            Solved::Ellipsoid(found) => found.answer.log_volume,
            Solved::Ball(found) => found.answer.radius,
        }
    }

    /// How far a value of another program is off, relatively: in volume or in radius.
    fn differs(&self, other: f64) -> f64 {
        match self {
            Solved::Ellipsoid(found) => (other - found.answer.log_volume).exp_m1().abs(),
            Solved::Ball(found) => (other / found.answer.radius - 1.0).abs(),
        }
    }

    /// The gap that the checker proves.
    fn gap(&self, rows: &Points<'_, f64>) -> Result<f64, String> {
        match self {
            Solved::Ellipsoid(found) => found.check(rows).map(|verdict| verdict.gap),
            Solved::Ball(found) => found.check(rows).map(|verdict| verdict.gap),
        }
        .map_err(|why| why.to_string())
    }
}

/// A problem on one set of rows beside the solver.
fn add(
    context: &Context,
    table: &mut Table,
    problem: Problem,
    what: &str,
    (values, columns): (&[f64], usize),
) -> Result<Found> {
    let rows = Points::new(values, columns)?;
    let peers = &[problem.peer()];
    let beside = Beside { peers, rows: (values, columns), reads: None };
    let solve = || Solved::of(problem, &rows);
    let rounds = rounds::run(context, context.runs, beside, solve, |_| Ok(()))?;
    let peer = rounds.peer().context("one peer")?;
    let theirs = peer.answer.as_ref().map(|answer| answer.radius);
    let ours = &rounds.found;
    let gap = ours.gap(&rows);
    let differs = theirs.map(|value| ours.differs(value));
    table.push(json!({
        "input": what, "clock": rounds.clock(), "peer's clock": peer.least(),
        "times faster": rounds.faster(peer).map(|(ratio, _)| ratio), "value": ours.value(), "peer's": theirs,
        "differs": differs, "verified gap": shown_gap(&gap), "why": peer.silence, "times": rounds.json(),
    }));
    let mut found = Found::proved(gap);
    found.say(SECONDS, rounds.said());
    found.add(DIFFERS, differs);
    Ok(found)
}

/// Runs all problems.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    for (title, problem) in [
        ("smallest ellipsoid around points, normal", Problem::Points),
        ("smallest ellipsoid around 20 ellipsoids", Problem::Ellipsoid),
        ("smallest ball around 20 ellipsoids", Problem::Ball),
    ] {
        let mut table = Table::new(
            "input | clock:s | peer's clock:s | times faster:x | value:10 | peer's:10 | \
                differs:e | verified gap | why",
        );
        let mut found = Found::default();
        if let Problem::Points = problem {
            for (n, d) in POINTS {
                let values = Law::Normal.draw(n, d, SEED)?;
                let what = format!("{n} × {d}");
                found.join(add(context, &mut table, problem, &what, (&values, d))?);
            }
        } else {
            for d in DIMS {
                for seed in SEED..SEED + SEEDS {
                    let values = shapes::draw(ELLIPSOIDS, d, seed)?;
                    let what = format!("d = {d}, seed {seed}");
                    let rows = (&values[..], d * (d + 3) / 2);
                    found.join(add(context, &mut table, problem, &what, rows)?);
                }
            }
        }
        out.table(title, table);
        out.judge(&found);
        out.close(title);
    }
    Ok(())
}
