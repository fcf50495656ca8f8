//! Centres of all but a few points, in the plane.

use anyhow::Result;
use serde_json::json;
use taut_enclose::{CentersOptions, centers};
use taut_points::{Distribution, Points, generate};

use super::Context;
use super::case::Case;
use super::judgement::{self, COLUMNS, judge};
use crate::goals;
use crate::input::SEED;
use crate::meter::Meter;
use crate::stats::{Summary, seconds};
use crate::table::Table;

const N: usize = 2000;
/// Numbers of centres; one is the smallest ball of all points but a few.
const CENTERS: [usize; 3] = [1, 2, 3];
/// Numbers of points that may be left out.
const OUTLIERS: [u64; 4] = [0, 1, 3, 5];

/// Runs all pairs.
pub(super) fn run(context: &mut Context, case: &Case) -> Result<()> {
    let n = if context.quick { N / 10 } else { N };
    let values: Vec<f64> = generate(Distribution::Uniform, n, 2, SEED)?;
    let points = Points::new(&values, 2)?;
    let head = ["k", "left out", "clock", "processors", "nodes"];
    let mut table = Table::new(&[&head[..], &COLUMNS[..]].concat());
    let (mut judgements, mut all) = (vec![], vec![]);
    let threads = context.threads.last().copied();
    for k in CENTERS {
        for outliers in OUTLIERS {
            let options =
                CentersOptions { epsilon: 1e-6, outliers, threads, ..CentersOptions::default() };
            let (mut wall, mut cpu, mut found) = (vec![], vec![], None);
            for _ in 0..context.runs {
                let meter = Meter::start();
                let answer = centers(&points, k, &options)?;
                let cost = meter.stop();
                wall.push(cost.wall);
                cpu.push(cost.cpu);
                found = Some(answer);
            }
            let Some(found) = found else { continue };
            let judgement = judge(&found, &points);
            let shown =
                |all: &[f64]| Summary::of(all).map(|s| seconds(s.median)).unwrap_or_default();
            let nodes = found.trace.iterations;
            let row = [k.to_string(), outliers.to_string(), shown(&wall), shown(&cpu)];
            table.push([&row[..], &[nodes.to_string()], &judgement.cells()].concat());
            all.push(json!({
                "k": k, "outliers": outliers, "wall": wall, "cpu": cpu, "nodes": nodes,
                "judgement": judgement.json(),
            }));
            judgements.push(judgement);
        }
    }
    println!("uniform, {n} × 2, medians of {} runs\n\n{table}", context.runs);
    let goals = goals::print(&[case.must], &[], &judgement::measured(&judgements));
    context.report.add(json!({ "name": case.name, "pairs": all, "goals": goals }));
    Ok(())
}
