//! Small problems beside a conic solver, which knows nothing of core-sets: cvxpy with Clarabel.

use anyhow::Result;
use serde_json::json;
use taut_certify::{Ball, Ellipsoid, Items, Solution};
use taut_enclose::{BallOptions, EllipsoidOptions, ball, ellipsoid};
use taut_points::Points;

use super::case::Case;
use super::goals::Measured;
use super::laws::Law;
use super::{Context, rounds, shapes};
use crate::goals;
use crate::input::{SEED, write_rows};
use crate::stats::{seconds, times};
use crate::table::Table;

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
enum Found {
    Ellipsoid(Solution<Ellipsoid>),
    Ball(Solution<Ball>),
}

impl Found {
    fn of(problem: Problem, rows: &Points<'_, f64>) -> Result<Found> {
        let options = EllipsoidOptions { epsilon: EPSILON, ..EllipsoidOptions::default() };
        Ok(match problem {
            Problem::Points => Found::Ellipsoid(ellipsoid(rows, &options)?),
            Problem::Ellipsoid => Found::Ellipsoid(ellipsoid(
                rows,
                &EllipsoidOptions { inputs: Items::Ellipsoids, ..options },
            )?),
            Problem::Ball => {
                let options = BallOptions { epsilon: EPSILON, ..BallOptions::default() };
                Found::Ball(ball(rows, &BallOptions { inputs: Items::Ellipsoids, ..options })?)
            }
        })
    }

    /// The radius, or the log-volume.
    fn value(&self) -> f64 {
        match self {
            Found::Ellipsoid(found) => found.answer.log_volume,
            Found::Ball(found) => found.answer.radius,
        }
    }

    /// How far a value of another program is off, relatively: in volume or in radius.
    fn differs(&self, other: f64) -> f64 {
        match self {
            Found::Ellipsoid(found) => (other - found.answer.log_volume).exp_m1().abs(),
            Found::Ball(found) => (other / found.answer.radius - 1.0).abs(),
        }
    }

    /// The gap that the checker proves.
    fn gap(&self, rows: &Points<'_, f64>) -> Result<f64, String> {
        match self {
            Found::Ellipsoid(found) => {
                found.check(rows).map(|verdict| verdict.gap).map_err(|why| why.to_string())
            }
            Found::Ball(found) => {
                found.check(rows).map(|verdict| verdict.gap).map_err(|why| why.to_string())
            }
        }
    }
}

/// Sets of one problem, and the table they are shown in.
struct Sets {
    table: Table,
    measured: Vec<Measured>,
    report: Vec<serde_json::Value>,
}

impl Sets {
    fn new() -> Self {
        let head = ["input", "clock", "peer's clock", "times faster", "value", "peer's", "differs"];
        let table = Table::new(&[&head[..], &["verified gap"]].concat());
        Sets { table, measured: vec![], report: vec![] }
    }

    fn add(
        &mut self,
        context: &Context,
        problem: Problem,
        what: String,
        values: &[f64],
        columns: usize,
    ) -> Result<()> {
        let file = context.temp.path().join("rows");
        write_rows(&file, values, columns)?;
        let rows = Points::new(values, columns)?;
        let peer = Some((problem.peer(), file.as_path()));
        let rounds = rounds::run(context, &context.threads, peer, || Found::of(problem, &rows))?;
        let found = &rounds.found;
        let gap = found.gap(&rows);
        let (theirs, differs, said) = match &rounds.peer {
            Some(Ok((answer, _))) => {
                let differs = found.differs(answer.radius);
                (format!("{:.10}", answer.radius), Some(differs), format!("{differs:.1e}"))
            }
            Some(Err(silence)) => (silence.to_string(), None, String::new()),
            None => Default::default(),
        };
        self.table.push(vec![
            what.clone(),
            rounds.clock().map(seconds).unwrap_or_default(),
            rounds.peer_seconds().map(seconds).unwrap_or_default(),
            rounds.faster().map(|(ratio, _)| times(ratio)).unwrap_or_default(),
            format!("{:.10}", found.value()),
            theirs,
            said,
            gap.as_ref().map_or_else(|why| format!("REJECTED: {why}"), |gap| format!("{gap:.1e}")),
        ]);
        self.report.push(json!({
            "input": what, "value": found.value(), "differs": differs, "gap": gap.as_ref().ok(),
            "times": rounds.json(),
        }));
        let measured = Measured {
            gap: gap.as_ref().ok().copied(),
            rejected: gap.err(),
            differs,
            ..rounds.measured()
        };
        self.measured.push(measured);
        Ok(())
    }
}

/// Runs all problems.
pub(super) fn run(context: &mut Context, case: &Case) -> Result<()> {
    let mut all = vec![];
    for (title, problem) in [
        ("smallest ellipsoid around points, normal", Problem::Points),
        ("smallest ellipsoid around 20 ellipsoids", Problem::Ellipsoid),
        ("smallest ball around 20 ellipsoids", Problem::Ball),
    ] {
        let mut sets = Sets::new();
        if let Problem::Points = problem {
            for (n, d) in POINTS {
                let values = Law::Normal.draw(n, d, SEED)?;
                sets.add(context, problem, format!("{n} × {d}"), &values, d)?;
            }
        } else {
            for d in DIMS {
                for seed in SEED..SEED + SEEDS {
                    let values = shapes::draw(ELLIPSOIDS, d, seed)?;
                    let what = format!("d = {d}, seed {seed}");
                    sets.add(context, problem, what, &values, d * (d + 3) / 2)?;
                }
            }
        }
        println!("{title}\n\n{}", sets.table);
        let worst = Measured::worst(sets.measured).unwrap_or_default();
        let goals = goals::print(&[case.must], &[case.aim], &worst);
        println!();
        all.push(json!({ "problem": title, "sets": sets.report, "goals": goals }));
    }
    context.report.add(json!({ "name": case.name, "problems": all }));
    Ok(())
}
