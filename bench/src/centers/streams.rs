//! Points that come by once: the factor that is measured beside the one that is stated, and the time of a point.

use super::*;

const N: usize = 1_000_000;
const DIM: usize = 3;
const CENTERS: [usize; 2] = [10, 100];
const INSTANCES: [usize; 3] = [1, 8, 64];
/// Points that come by together.
const BLOCK: usize = 4096;

/// The points by their distance from the origin, so that each new one is farther out than all before: guesses fail as often
/// as they can.
fn from_inside(values: &[f64]) -> Vec<f64> {
    let mut rows: Vec<&[f64]> = values.chunks_exact(DIM).collect();
    let norm = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>();
    rows.sort_by(|a, b| norm(a).total_cmp(&norm(b)));
    rows.concat()
}

/// Runs both orders.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let n = context.count(N);
    let drawn: Vec<f64> = generate(Distribution::Normal, n, DIM, SEED)?;
    let sorted = from_inside(&drawn);
    let pool = context.pool()?;
    let mut table = Table::new(&format!(
        "order | k | instances | clock of a point:ns | factor stated:3 | while streaming:3 | \
            after a second pass:3 | {COLUMNS}"
    ));
    let (mut judgements, mut factors) = (vec![], vec![]);
    for (order, values) in [("as drawn", &drawn), ("from inside", &sorted)] {
        let points = Points::new(values, DIM)?;
        for (k, instances) in CENTERS.into_iter().flat_map(|k| INSTANCES.map(|i| (k, i))) {
            let options = StreamingOptions { instances };
            let (mut clocks, mut found) = (vec![], None);
            for _ in 0..context.runs {
                let mut cover = StreamingCenters::new(DIM, k, &options)?;
                let meter = Meter::start();
                pool.install(|| {
                    (0..n).step_by(BLOCK).try_for_each(|first| {
                        cover.add(&points.slice(first..(first + BLOCK).min(n)))
                    })
                })?;
                clocks.push(meter.stop().wall / n as f64);
                found = Some(cover);
            }
            let cover = found.context("no run")?;
            let covered = cover.covered();
            let measured = covered.radius / covered.lower_bound;
            let stated = options.factor();
            let judgement =
                judge(&cover.solution(Placement::Rows, &points, &Monitor::silent())?, &points);
            let head = json!({
                "order": order, "k": k, "instances": instances, "factor stated": stated, "while streaming": measured,
                "clock of a point": Summary::of(&clocks).map(|summary| summary.median), "clocks": clocks,
                "after a second pass": judgement.gap().map(|gap| 1.0 + gap),
                "streamed radius": covered.radius, "streamed lower bound": covered.lower_bound,
            });
            table.push(joined([head, judgement.cells()]));
            factors.push(measured / stated);
            judgements.push(judgement);
        }
    }
    let threads = context.last_threads();
    let caption = format!("normal, {n} × {DIM}, {threads} threads, in blocks of {BLOCK}");
    out.table(&caption, table);
    let mut found = judgement::found(&judgements);
    factors.into_iter().for_each(|factor| found.add(FACTOR, factor));
    out.judge(&found);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_order_goes_outwards_and_loses_nothing() {
        let sorted = from_inside(&[3.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0]);
        assert_eq!(sorted, [0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 3.0, 0.0, 0.0]);
    }
}
