//! Points that come by once: the factor that is measured beside the one that is stated, and the time of a point.

use anyhow::Result;
use serde_json::json;
use taut_certify::Placement;
use taut_enclose::{StreamingCenters, StreamingOptions};
use taut_points::{Distribution, Monitor, Points, generate};

use super::Context;
use super::case::Case;
use super::judgement::{self, judge};
use crate::goals;
use crate::input::SEED;
use crate::meter::Meter;
use crate::stats::{Summary, seconds};
use crate::table::Table;

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
pub(super) fn run(context: &mut Context, case: &Case) -> Result<()> {
    let n = if context.quick { N / 10 } else { N };
    let drawn: Vec<f64> = generate(Distribution::Normal, n, DIM, SEED)?;
    let sorted = from_inside(&drawn);
    let threads = context.threads.last().copied().unwrap_or(1);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let head = ["order", "k", "instances", "clock of a point", "factor stated", "while streaming"];
    let head = [&head[..], &["after a second pass", "verdict", "check"]].concat();
    let mut table = Table::new(&head);
    let (mut judgements, mut factor, mut all) = (vec![], 0.0f64, vec![]);
    for (order, values) in [("as drawn", &drawn), ("from inside", &sorted)] {
        let points = Points::new(values, DIM)?;
        for k in CENTERS {
            for instances in INSTANCES {
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
                let Some(cover) = found else { continue };
                let covered = cover.covered();
                let measured = covered.radius / covered.lower_bound;
                let solution = cover.solution(Placement::Rows, &points, &Monitor::silent())?;
                let judgement = judge(&solution, &points);
                let proved = judgement.gap().map(|gap| 1.0 + gap);
                let stated = options.factor();
                let clock = Summary::of(&clocks).map(|summary| summary.median);
                let [radius, lower] = [covered.radius, covered.lower_bound];
                table.push(vec![
                    order.to_owned(),
                    k.to_string(),
                    instances.to_string(),
                    clock.map(|clock| format!("{:.0} ns", 1e9 * clock)).unwrap_or_default(),
                    format!("{stated:.3}"),
                    format!("{measured:.3}"),
                    proved.map_or(String::new(), |factor| format!("{factor:.3}")),
                    judgement
                        .verdict
                        .as_ref()
                        .map_or_else(|why| format!("REJECTED: {why}"), |_| "proved".to_owned()),
                    seconds(judgement.seconds),
                ]);
                all.push(json!({
                    "order": order, "k": k, "instances": instances, "seconds_of_a_point": clocks, "stated": stated,
                    "radius": radius, "lower_bound": lower, "judgement": judgement.json(),
                }));
                // NaN has to be seen, and a maximum would lose it.
                let ratio = measured / stated;
                factor = if ratio.is_nan() { f64::INFINITY } else { factor.max(ratio) };
                judgements.push(judgement);
            }
        }
    }
    println!("normal, {n} × {DIM}, {threads} threads, in blocks of {BLOCK}\n\n{table}");
    let mut measured = judgement::measured(&judgements);
    measured.factor = Some(factor);
    let goals = goals::print(&[case.must], &[], &measured);
    context.report.add(json!({ "name": case.name, "streams": all, "goals": goals }));
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
