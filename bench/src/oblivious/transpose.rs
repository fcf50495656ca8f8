//! Transposition of doubles out of place, beside copying them.

use anyhow::{Result, ensure};
use serde_json::{Value, json};

use super::lanes::Lanes;
use crate::context::Context;
use crate::goals::Goals;
use crate::stats::times;
use crate::table::Table;

/// The crate, in the tables.
const CRATE: &str = "transpose";
/// The copy.
const COPY: &str = "memcpy";

/// The four shapes, and squares whose side is off by one.
pub(super) fn run(context: &Context) -> Result<Value> {
    let shapes = match context.quick {
        true => [(512, 512), (1000, 1000), (512, 1024), (100_000, 3)],
        false => [(4096, 4096), (10_000, 10_000), (8192, 16_384), (10_000_000, 3)],
    };
    let mut table = Table::new(&[
        "shape",
        "taut, GB/s",
        "transpose, GB/s",
        "memcpy, GB/s",
        "transpose ÷ taut",
        "memcpy ÷ taut",
    ]);
    let mut goals = Goals::default();
    let mut measured = vec![];
    let mut lines = vec![];
    for (rows, columns) in shapes {
        let name = format!("{rows} × {columns}");
        let lanes = take_turns(context, rows, columns)?;
        let bytes = (rows * columns * 8) as f64;
        let rate = |name| format!("{:.2}", bytes / lanes.of(name) * 1e-9);
        let [crates, copy] = [CRATE, COPY].map(|other| lanes.faster("taut", other));
        table.push(vec![
            name.clone(),
            rate("taut"),
            rate(CRATE),
            rate(COPY),
            times(crates),
            times(copy),
        ]);
        measured.push(json!({ "shape": name, "lanes": lanes.json(rows * columns) }));
        lines.push((name, crates, copy));
    }
    println!("matrix bytes per second\n\n{table}");
    for (name, crates, copy) in lines {
        goals.at_least(&format!("{name}: the crate over taut"), crates, (1.5, None));
        goals.at_least(&format!("{name}: memcpy over taut"), copy, (0.5, Some(0.8)));
    }
    for (n, _) in &shapes[..2] {
        let sides = [n - 1, *n, n + 1];
        let each = by_turns(context, sides)?;
        let ratio = (each[1] / each[0]).max(each[1] / each[2]);
        let what = format!("{n}²: time per number over that of {n} ± 1");
        goals.at_most(&what, Some(ratio), (1.3, None), times);
        measured.push(json!({ "sides": sides, "ns": each.map(|seconds| seconds * 1e9) }));
    }
    Ok(json!({ "shapes": measured, "goals": goals.json() }))
}

/// taut, the crate and a copy. Before each the target is filled, so that it is in memory and holds no earlier answer.
fn take_turns(context: &Context, rows: usize, columns: usize) -> Result<Lanes> {
    let from: Vec<f64> = (0..rows * columns).map(|i| i as f64).collect();
    let mut to = vec![f64::NAN; from.len()];
    let mut lanes = Lanes::default();
    // Short ones are disturbed more easily: they are repeated until they move as much as 10000².
    let repeats = if context.quick { 1 } else { (100_000_000 / (rows * columns)).max(1) };
    for _ in 0..context.runs * repeats {
        to.fill(f64::NAN);
        lanes.time("taut", || taut_oblivious::transpose(&from, rows, columns, &mut to))?;
        ensure!(right(&to, rows, columns), "taut: a wrong transpose of {rows} × {columns}");
        to.fill(f64::NAN);
        // The crate names the length of a row first.
        lanes.time(CRATE, || transpose::transpose(&from, &mut to, columns, rows));
        ensure!(right(&to, rows, columns), "the crate: a wrong transpose of {rows} × {columns}");
        to.fill(f64::NAN);
        lanes.time(COPY, || to.copy_from_slice(&from));
        ensure!(to == from, "a wrong copy");
    }
    Ok(lanes)
}

/// Seconds per number of squares of these sides, by taut alone.
fn by_turns(context: &Context, sides: [usize; 3]) -> Result<[f64; 3]> {
    let room = sides[2] * sides[2];
    let from: Vec<f64> = (0..room).map(|i| i as f64).collect();
    let mut to = vec![f64::NAN; room];
    let mut lanes = Lanes::default();
    let names = ["less", "same", "more"];
    for _ in 0..context.runs {
        for (side, name) in sides.into_iter().zip(names) {
            let (from, to) = (&from[..side * side], &mut to[..side * side]);
            to.fill(f64::NAN);
            lanes.time(name, || taut_oblivious::transpose(from, side, side, to))?;
            ensure!(right(to, side, side), "a wrong transpose of {side}²");
        }
    }
    Ok(std::array::from_fn(|at| lanes.of(names[at]) / (sides[at] * sides[at]) as f64))
}

/// Whether `to` is the transpose of the matrix whose numbers are 0, 1, 2, …, row by row.
pub(super) fn right(to: &[f64], rows: usize, columns: usize) -> bool {
    to.len() == rows * columns
        && to.chunks_exact(rows).enumerate().all(|(column, run)| {
            run.iter().enumerate().all(|(row, &number)| number == (row * columns + column) as f64)
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_transpose_is_told_from_a_copy() {
        assert!(right(&[0.0, 3.0, 1.0, 4.0, 2.0, 5.0], 2, 3));
        assert!(!right(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0], 2, 3));
    }
}
