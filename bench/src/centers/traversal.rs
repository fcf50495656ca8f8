//! Farthest-first traversals of many points: time, distances evaluated, plain reads, and NumPy beside.

use super::*;

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
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let law = Distribution::Uniform;
    let n = context.count(10_000_000);
    run_one::<f64>(context, out, &Cloud { n, d: 3, law, peer: "traversal-20" })?;
    let law = Distribution::Normal;
    let n = context.count(1_000_000);
    run_one::<f32>(context, out, &Cloud { n, d: 128, law, peer: "traversal-single-20" })
}

fn run_one<T: Scalar + bytemuck::Pod>(
    context: &Context,
    out: &mut Outcome,
    cloud: &Cloud,
) -> Result<()> {
    let &Cloud { n, d, law, peer } = cloud;
    let values: Vec<T> = generate(law, n, d, SEED)?;
    let points = Points::new(&values, d)?;
    let all = n as u64 * TAUT_COUNT;
    let mut table = Table::new(
        "threads | clock:s | processors:s | plain reads:x | ÷ k reads:x | of n·k distances:%",
    );
    let (mut bandwidth, mut last, mut clock) = (None, None, 0.0);
    for &threads in &context.threads {
        let pool = pool(threads)?;
        // A run is long: the least of two says as much as the median of many short ones.
        let [mut wall, mut cpu, mut read] = [f64::INFINITY; 3];
        for _ in 0..context.runs.min(2) {
            drop(last.take());
            for _ in 0..PLAIN_READS {
                read = read.min(plain_read(bytemuck::cast_slice(&values), &pool));
            }
            let meter = Meter::start();
            let order = pool.install(|| {
                farthest_first(&points, TAUT_COUNT, &FarthestFirstOptions::default())
            })?;
            let cost = meter.stop();
            (wall, cpu) = (wall.min(cost.wall), cpu.min(cost.cpu));
            last = Some(order);
        }
        let share = TAUT_COUNT as f64 * read / wall;
        let evaluated = distances(last.as_ref().context("no run")?)?;
        table.push(json!({
            "threads": threads, "clock": wall, "processors": cpu, "plain reads": wall / read, "÷ k reads": share,
            "of n·k distances": evaluated as f64 / all as f64, "plain read": read, "distances": evaluated,
        }));
        (bandwidth, clock) = (Some(share), wall);
    }
    let precision = if size_of::<T>() == 4 { "f32" } else { "f64" };
    let what = format!("{law}, {n} × {d}, {precision}, k = {TAUT_COUNT}");
    out.table(&what, table);
    let order = last.context("no run")?;
    let judgement = judge(&order.solution(TAUT_COUNT, Placement::Rows, &points)?, &points);
    let mut judged = Table::new(COLUMNS);
    judged.push(judgement.cells());
    out.table("", judged);
    let mut found = judgement::found(&[judgement]);
    found.add(BANDWIDTH, bandwidth);
    found.add(DIFFERS, beside(context, &points.slice(0..n / 10), peer, clock / all as f64)?);
    out.judge(&found);
    out.close(&what);
    Ok(())
}

/// The counter of distances.
fn distances(order: &FarthestFirst) -> Result<u64> {
    order.trace.counters.get("distances").copied().context("no counter `distances`")
}

/// The peer on some of the points, its time for a point and a center beside `ours`, and how far its radius is off taut's.
fn beside<T: Scalar>(
    context: &Context,
    points: &Points<'_, T>,
    peer: &str,
    ours: f64,
) -> Result<Option<f64>> {
    let rows: Vec<f64> =
        (0..points.len()).flat_map(|i| points.row(i).iter().map(|&x| x.into())).collect();
    let (answers, silence) = peer::ask_often(context, peer, (&rows, points.dim()), context.runs)?;
    drop(rows);
    if let Some(silence) = silence {
        println!("{peer}: {silence}\n");
        return Ok(None);
    }
    let own = farthest_first(points, PEER_COUNT, &FarthestFirstOptions::default())?;
    let radius = answers.last().map_or(f64::NAN, |answer| answer.radius);
    let off = own.radii.last().map(|own| (radius / own - 1.0).abs());
    let theirs: Vec<f64> = answers.iter().map(|answer| answer.seconds).collect();
    if let Some(theirs) = Summary::of(&theirs) {
        let each = theirs.median / (points.len() as u64 * PEER_COUNT) as f64;
        println!(
            "{peer} on {} points, k = {PEER_COUNT}: {:.2} ns for each point and center, {} times \
                taut's {:.3} ns\n",
            points.len(),
            each * 1e9,
            times(each / ours),
            ours * 1e9
        );
    }
    Ok(off)
}
