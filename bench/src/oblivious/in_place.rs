//! Transposition of doubles in their own place, beside the crate's and beside going through a second array.

use anyhow::{Result, ensure};
use serde_json::{Value, json};

use super::lanes::{Lanes, have_memory};
use super::transpose::right;
use crate::context::Context;
use crate::stats::times;
use crate::table::Table;

/// The crate, in the tables.
const CRATE: &str = "transpose";
/// To a new array and back.
const OUT_AND_BACK: &str = "out of place and back";

/// The shapes of the section `transpose`; no bound is set for them.
pub(super) fn run(context: &Context) -> Result<Value> {
    let shapes = match context.quick {
        true => [(512, 512), (1000, 1000), (512, 1024), (100_000, 3)],
        false => [(4096, 4096), (10_000, 10_000), (8192, 16_384), (10_000_000, 3)],
    };
    let mut table = Table::new(&[
        "shape",
        "taut, GB/s",
        "transpose, GB/s",
        "out of place and back, GB/s",
        "transpose ÷ taut",
        "and back ÷ taut",
    ]);
    let mut measured = vec![];
    for (rows, columns) in shapes {
        let name = format!("{rows} × {columns}");
        let lanes = take_turns(context, rows, columns)?;
        let bytes = (rows * columns * 8) as f64;
        let rate = |name| format!("{:.2}", bytes / lanes.of(name) * 1e-9);
        table.push(vec![
            name.clone(),
            rate("taut"),
            rate(CRATE),
            rate(OUT_AND_BACK),
            times(lanes.faster("taut", CRATE)),
            times(lanes.faster("taut", OUT_AND_BACK)),
        ]);
        measured.push(json!({ "shape": name, "lanes": lanes.json(rows * columns) }));
    }
    println!("matrix bytes per second, in place\n\n{table}");
    Ok(json!({ "shapes": measured }))
}

/// Each on the numbers 0, 1, 2, …, which are written before; what a program needs beside them it takes within its time.
fn take_turns(context: &Context, rows: usize, columns: usize) -> Result<Lanes> {
    let mut matrix = vec![0.0; rows * columns];
    let mut lanes = Lanes::default();
    for _ in 0..context.runs {
        count(&mut matrix);
        lanes.time("taut", || taut_oblivious::transpose_in_place(&mut matrix, rows, columns))?;
        ensure!(right(&matrix, rows, columns), "taut: a wrong transpose of {rows} × {columns}");
        count(&mut matrix);
        // The crate names the length of a row first.
        lanes.time(CRATE, || {
            let mut scratch = vec![0.0; rows.max(columns)];
            transpose::transpose_inplace(&mut matrix, &mut scratch, columns, rows);
        });
        ensure!(
            right(&matrix, rows, columns),
            "the crate: a wrong transpose of {rows} × {columns}"
        );
        count(&mut matrix);
        have_memory(size_of_val(&matrix[..]))?;
        lanes.time(OUT_AND_BACK, || -> Result<()> {
            let mut second = vec![0.0; matrix.len()];
            taut_oblivious::transpose(&matrix, rows, columns, &mut second)?;
            matrix.copy_from_slice(&second);
            Ok(())
        })?;
        ensure!(right(&matrix, rows, columns), "a wrong transpose of {rows} × {columns}");
    }
    Ok(lanes)
}

fn count(matrix: &mut [f64]) {
    matrix.iter_mut().enumerate().for_each(|(at, number)| *number = at as f64);
}
