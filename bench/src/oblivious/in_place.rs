//! Transposition of doubles in their own place, beside the crate's and beside going through a second array.

use super::lanes::{Lanes, have_memory};
use super::transpose::{gigabytes_per_second, right, shapes};
use crate::prelude::*;

/// The crate, in the tables.
const CRATE: &str = "transpose";
/// To a new array and back.
const OUT_AND_BACK: &str = "out of place and back";

/// The shapes of the section `transpose`; no bound is set for them.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let mut table = Table::new(
        "shape | taut, GB/s:2 | transpose, GB/s:2 | out of place and back, GB/s:2 | transpose ÷ \
            taut:x | and back ÷ taut:x",
    );
    for (rows, columns) in shapes(context) {
        let lanes = take_turns(context, rows, columns)?;
        let rate = |name| gigabytes_per_second(&lanes, rows * columns, name);
        table.push(json!({
            "shape": format!("{rows} × {columns}"), "taut, GB/s": rate("taut"), "transpose, GB/s": rate(CRATE),
            "out of place and back, GB/s": rate(OUT_AND_BACK), "transpose ÷ taut": lanes.faster("taut", CRATE),
            "and back ÷ taut": lanes.faster("taut", OUT_AND_BACK), "lanes": lanes.json(rows * columns),
        }));
    }
    out.table("matrix bytes per second, in place", table);
    Ok(())
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
