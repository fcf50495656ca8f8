//! Ellipsoids as items: the smallest ellipsoid around them, the smallest ball.

use anyhow::Result;
use serde_json::json;
use taut_certify::Items;
use taut_enclose::{BallOptions, EllipsoidOptions, ball, ellipsoid};
use taut_points::{Distribution, Points, generate};

use super::case::Case;
use super::goals::Measured;
use super::{Context, rounds};
use crate::goals;
use crate::input::SEED;
use crate::table::Table;

const N: usize = 1000;
const D: usize = 10;
const EPSILON: f64 = 1e-6;

/// n ellipsoids with normal centres and shapes S = AAᵀ, A normal: each a centre and the lower triangle of S.
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

/// Runs both problems.
pub(super) fn run(context: &mut Context, case: &Case) -> Result<()> {
    let n = if context.quick { N / 10 } else { N };
    let values = draw(n, D, SEED)?;
    let items = Points::new(&values, D * (D + 3) / 2)?;
    let mut table =
        Table::new(&[&["answer"], &rounds::TIME_COLUMNS[..], &["verified gap", "passes"]].concat());
    let mut all = Vec::new();

    let options = EllipsoidOptions { epsilon: EPSILON, ..EllipsoidOptions::default() };
    let rounds = rounds::run(context, &context.threads, None, || {
        Ok(ellipsoid(&items, &EllipsoidOptions { inputs: Items::Ellipsoids, ..options })?)
    })?;
    let gap = rounds.found.check(&items).map(|verdict| verdict.gap).map_err(|e| e.to_string());
    all.push((
        "smallest ellipsoid",
        gap,
        (rounds.measured(), rounds.cells()),
        rounds.found.trace.passes,
        rounds.json(),
    ));

    let options = BallOptions { epsilon: EPSILON, ..BallOptions::default() };
    let rounds = rounds::run(context, &context.threads, None, || {
        Ok(ball(&items, &BallOptions { inputs: Items::Ellipsoids, ..options })?)
    })?;
    let gap = rounds.found.check(&items).map(|verdict| verdict.gap).map_err(|e| e.to_string());
    all.push((
        "smallest ball",
        gap,
        (rounds.measured(), rounds.cells()),
        rounds.found.trace.passes,
        rounds.json(),
    ));

    let mut answers = Vec::new();
    for (what, gap, (found, cells), passes, times) in all {
        let mut row = vec![what.to_owned()];
        row.extend(cells);
        row.extend([
            gap.as_ref().map_or_else(|e| format!("REJECTED: {e}"), |gap| format!("{gap:.1e}")),
            passes.to_string(),
        ]);
        table.push(row);
        let found = Measured { gap: gap.as_ref().ok().copied(), rejected: gap.err(), ..found };
        answers.push((what, found, times));
    }
    println!("{n} ellipsoids, d = {D}, ε = {EPSILON:e}\n\n{table}");
    let mut lines = Vec::new();
    for (what, found, times) in &answers {
        println!("{what}");
        let goals = goals::print(&[case.must], &[case.aim], found);
        println!();
        lines.push(json!({ "answer": what, "gap": found.gap, "times": times, "goals": goals }));
    }
    context.report.add(json!({ "name": case.name, "answers": lines }));
    Ok(())
}
