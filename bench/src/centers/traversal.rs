//! Farthest-first traversals of many points: time, distances evaluated, plain reads, and NumPy beside.

use anyhow::{Context as _, Result};
use serde_json::{Value, json};
use taut_certify::Placement;
use taut_enclose::{FarthestFirst, FarthestFirstOptions, farthest_first};
use taut_points::{Distribution, Points, Scalar, generate};

use super::Context;
use super::case::Case;
use super::goals::Measured;
use super::judgement::{self, COLUMNS, judge};
use crate::goals;
use crate::input::{SEED, write_rows};
use crate::meter::Meter;
use crate::peer::Peer;
use crate::read::plain_read;
use crate::stats::{Summary, seconds, times};
use crate::table::Table;

/// Points asked of taut.
const TAUT_COUNT: u64 = 1000;
/// Points asked of the peer, of a tenth of the points: it evaluates all distances.
const PEER_COUNT: u64 = 20;
/// How many plain reads come before each run. The shortest of them counts: a slow one would flatter taut.
const PLAIN_READS: usize = 5;

/// One input.
struct Cloud {
    n: usize,
    d: usize,
    law: Distribution,
    /// The peer in that precision.
    peer: &'static str,
}

/// Runs both inputs, one in each precision.
pub(super) fn run(context: &mut Context, case: &Case) -> Result<()> {
    let n = |n: usize| if context.quick { n / 10 } else { n };
    let law = Distribution::Uniform;
    let space = Cloud { n: n(10_000_000), d: 3, law, peer: "traversal-20" };
    let law = Distribution::Normal;
    let wide = Cloud { n: n(1_000_000), d: 128, law, peer: "traversal-single-20" };
    let all = [run_one::<f64>(context, case, &space)?, run_one::<f32>(context, case, &wide)?];
    context.report.add(json!({ "name": case.name, "inputs": all }));
    Ok(())
}

fn run_one<T: Scalar + bytemuck::Pod>(
    context: &Context,
    case: &Case,
    cloud: &Cloud,
) -> Result<Value> {
    let &Cloud { n, d, law, peer } = cloud;
    let values: Vec<T> = generate(law, n, d, SEED)?;
    let points = Points::new(&values, d)?;
    let all = n as u64 * TAUT_COUNT;
    let head = ["threads", "clock", "processors", "plain reads", "÷ k reads", "of n·k distances"];
    let mut table = Table::new(&head);
    let (mut bandwidth, mut found, mut clock, mut report) = (None, None, 0.0, vec![]);
    for &threads in &context.threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        // A run is long: the least of two says as much as the median of many short ones.
        let mut costs: Vec<(f64, f64, f64)> = vec![];
        for _ in 0..context.runs.min(2) {
            drop(found.take());
            let reads = (0..PLAIN_READS).map(|_| plain_read(bytemuck::cast_slice(&values), &pool));
            let read = reads.fold(f64::INFINITY, f64::min);
            let meter = Meter::start();
            let order = pool.install(|| {
                farthest_first(&points, TAUT_COUNT, &FarthestFirstOptions::default())
            })?;
            let cost = meter.stop();
            costs.push((cost.wall, cost.cpu, read));
            found = Some(order);
        }
        let least =
            |of: fn(&(f64, f64, f64)) -> f64| costs.iter().map(of).fold(f64::INFINITY, f64::min);
        let (wall, cpu, read) = (least(|c| c.0), least(|c| c.1), least(|c| c.2));
        let share = TAUT_COUNT as f64 * read / wall;
        let order = found.as_ref().context("no run")?;
        let evaluated = distances(order)?;
        table.push(vec![
            threads.to_string(),
            seconds(wall),
            seconds(cpu),
            times(wall / read),
            times(share),
            format!("{:.2} %", 100.0 * evaluated as f64 / all as f64),
        ]);
        report.push(json!({
            "threads": threads, "wall": costs.iter().map(|c| c.0).collect::<Vec<_>>(), "cpu": cpu,
            "plain_read": read, "distances": evaluated,
        }));
        (bandwidth, clock) = (Some(share), wall);
    }
    let precision = if size_of::<T>() == 4 { "f32" } else { "f64" };
    println!("{law}, {n} × {d}, {precision}, k = {TAUT_COUNT}\n\n{table}");
    let order = found.context("no run")?;
    let judgement = judge(&order.solution(TAUT_COUNT, Placement::Rows, &points)?, &points);
    let mut judged = Table::new(&COLUMNS);
    judged.push(judgement.cells());
    println!("{judged}");
    let differs = beside(context, &points.slice(0..n / 10), peer, clock / all as f64)?;
    let measured =
        Measured { bandwidth, differs, ..judgement::measured(std::slice::from_ref(&judgement)) };
    let goals = goals::print(&[case.must], &[], &measured);
    println!();
    Ok(json!({
        "n": n, "d": d, "k": TAUT_COUNT, "runs": report, "judgement": judgement.json(), "peer_differs": differs,
        "goals": goals,
    }))
}

/// The counter of distances.
fn distances(order: &FarthestFirst) -> Result<u64> {
    order.trace.counters.get("distances").copied().context("no counter `distances`")
}

/// The peer on some of the points, its time for a point and a centre beside `ours`, and how far its radius is off taut's.
fn beside<T: Scalar>(
    context: &Context,
    points: &Points<'_, T>,
    peer: &str,
    ours: f64,
) -> Result<Option<f64>> {
    let file = context.temp.path().join("rows");
    let rows: Vec<f64> =
        (0..points.len()).flat_map(|i| points.row(i).iter().map(|&x| x.into())).collect();
    write_rows(&file, &rows, points.dim())?;
    drop(rows);
    let mut running = match Peer::start(peer, &file, context.temp.path())? {
        Ok(running) => running,
        Err(silence) => {
            println!("{peer}: {silence}\n");
            return Ok(None);
        }
    };
    let (mut theirs, mut radius) = (vec![], f64::NAN);
    for _ in 0..context.runs {
        match running.solve(context.limit)? {
            Ok(answer) => {
                theirs.push(answer.seconds);
                radius = answer.radius;
            }
            Err(silence) => {
                println!("{peer}: {silence}\n");
                return Ok(None);
            }
        }
    }
    let own = farthest_first(points, PEER_COUNT, &FarthestFirstOptions::default())?;
    let off = own.radii.last().map(|own| (radius / own - 1.0).abs());
    if let Some(theirs) = Summary::of(&theirs) {
        let each = theirs.median / (points.len() as u64 * PEER_COUNT) as f64;
        println!(
            "{peer} on {} points, k = {PEER_COUNT}: {:.2} ns for each point and centre, {} times taut's {:.3} ns\n",
            points.len(),
            each * 1e9,
            times(each / ours),
            ours * 1e9
        );
    }
    Ok(off)
}
