//! Transposition of doubles: out of place beside copying them, and in their own place beside a second array.

use super::*;

/// The crate, in the tables.
const CRATE: &str = "transpose";
/// The copy.
const COPY: &str = "memcpy";
/// To a new array and back.
const OUT_AND_BACK: &str = "out of place and back";

/// The four shapes.
fn shapes(context: &Context) -> [(usize, usize); 4] {
    context.size(
        [(4096, 4096), (10_000, 10_000), (8192, 16_384), (10_000_000, 3)],
        [(512, 512), (1000, 1000), (512, 1024), (100_000, 3)],
    )
}

/// One shape: rates of taut, the crate and another program, and how many times as long these took as taut.
fn row(shape: &str, lanes: &Lanes, doubles: usize, other: &str) -> Value {
    let [taut, theirs, beside] =
        ["taut", CRATE, other].map(|name| 8e-9 * doubles as f64 / lanes.of(name));
    let [ratio, ratio_beside] = [CRATE, other].map(|name| lanes.faster("taut", name));
    json!([shape, taut, theirs, beside, ratio, ratio_beside])
}

/// The four shapes, and squares whose side is off by one.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let mut table = Table::new(
        "shape | taut, GB/s:2 | transpose, GB/s:2 | memcpy, GB/s:2 | transpose ÷ taut:x | \
         memcpy ÷ taut:x",
    );
    for (rows, columns) in shapes(context) {
        let name = format!("{rows} × {columns}");
        let lanes = out_of_place(context, rows, columns)?;
        table.push(row(&name, &lanes, rows * columns, COPY));
        out.keep(&name, lanes.json(rows * columns));
        let [crates, copy] = [CRATE, COPY].map(|other| lanes.faster("taut", other));
        out.at_least(format!("{name}: the crate over taut"), crates, 1.5, Unit::Times);
        out.at_least(format!("{name}: memcpy over taut"), copy, [0.5, 0.8], Unit::Times);
    }
    out.table("matrix bytes per second", table);
    let mut table = Table::new("sides | each:ns");
    for (n, _) in &shapes(context)[..2] {
        let sides = [n - 1, *n, n + 1];
        let each = squares(context, sides)?;
        table.push(json!([sides, each]));
        let ratio = (each[1] / each[0]).max(each[1] / each[2]);
        let what = format!("{n}²: time per number over that of {n} ± 1");
        out.at_most(what, ratio, 1.3, Unit::Times);
    }
    out.table("squares of nearly the same side", table);
    Ok(())
}

/// The same shapes in place; no bound is set for them.
pub(super) fn run_in_place(context: &Context, out: &mut Outcome) -> Result<()> {
    let mut table = Table::new(
        "shape | taut, GB/s:2 | transpose, GB/s:2 | out of place and back, GB/s:2 | \
         transpose ÷ taut:x | and back ÷ taut:x",
    );
    for (rows, columns) in shapes(context) {
        let name = format!("{rows} × {columns}");
        let lanes = in_place(context, rows, columns)?;
        table.push(row(&name, &lanes, rows * columns, OUT_AND_BACK));
        out.keep(&name, lanes.json(rows * columns));
    }
    out.table("matrix bytes per second, in place", table);
    Ok(())
}

/// taut, the crate and a copy. Before each the target is filled, so that it is in memory and holds no earlier answer.
fn out_of_place(context: &Context, rows: usize, columns: usize) -> Result<Lanes> {
    let from = counted(rows * columns);
    let mut to = vec![f64::NAN; from.len()];
    let mut lanes = Lanes::default();
    // Short ones are disturbed more easily: they are repeated until they move as much as 10000².
    let repeats = context.size((100_000_000 / (rows * columns)).max(1), 1);
    for _ in 0..context.runs * repeats {
        to.fill(f64::NAN);
        lanes.time("taut", || taut_oblivious::transpose(&from, rows, columns, &mut to))?;
        check(&to, rows, columns, "taut")?;
        to.fill(f64::NAN);
        // The crate names the length of a row first.
        lanes.time(CRATE, || ::transpose::transpose(&from, &mut to, columns, rows));
        check(&to, rows, columns, CRATE)?;
        to.fill(f64::NAN);
        lanes.time(COPY, || to.copy_from_slice(&from));
        ensure!(to == from, "a wrong copy");
    }
    Ok(lanes)
}

/// Each on its own copy of the numbers; what a program needs beside them it takes within its time.
fn in_place(context: &Context, rows: usize, columns: usize) -> Result<Lanes> {
    let mut lanes = Lanes::default();
    for _ in 0..context.runs {
        let mut matrix = counted(rows * columns);
        lanes.time("taut", || taut_oblivious::transpose_in_place(&mut matrix, rows, columns))?;
        check(&matrix, rows, columns, "taut")?;
        count(&mut matrix);
        lanes.time(CRATE, || {
            let mut scratch = vec![0.0; rows.max(columns)];
            ::transpose::transpose_inplace(&mut matrix, &mut scratch, columns, rows);
        });
        check(&matrix, rows, columns, CRATE)?;
        count(&mut matrix);
        have_memory(size_of_val(&matrix[..]))?;
        lanes.time(OUT_AND_BACK, || -> Result<()> {
            let mut second = vec![0.0; matrix.len()];
            taut_oblivious::transpose(&matrix, rows, columns, &mut second)?;
            matrix.copy_from_slice(&second);
            Ok(())
        })?;
        check(&matrix, rows, columns, OUT_AND_BACK)?;
    }
    Ok(lanes)
}

/// Seconds per number of squares of these sides, by taut alone.
fn squares(context: &Context, sides: [usize; 3]) -> Result<[f64; 3]> {
    let room = sides[2] * sides[2];
    let (from, mut to) = (counted(room), vec![f64::NAN; room]);
    let mut lanes = Lanes::default();
    let names = ["less", "same", "more"];
    for _ in 0..context.runs {
        for (side, name) in sides.into_iter().zip(names) {
            let (from, to) = (&from[..side * side], &mut to[..side * side]);
            to.fill(f64::NAN);
            lanes.time(name, || taut_oblivious::transpose(from, side, side, to))?;
            check(to, side, side, "taut")?;
        }
    }
    Ok(std::array::from_fn(|at| lanes.of(names[at]) / (sides[at] * sides[at]) as f64))
}

/// The numbers 0, 1, 2, ….
fn counted(n: usize) -> Vec<f64> {
    let mut matrix = vec![0.0; n];
    count(&mut matrix);
    matrix
}

fn count(matrix: &mut [f64]) {
    matrix.iter_mut().enumerate().for_each(|(at, number)| *number = at as f64);
}

fn check(to: &[f64], rows: usize, columns: usize, who: &str) -> Result<()> {
    ensure!(right(to, rows, columns), "{who}: a wrong transpose of {rows} × {columns}");
    Ok(())
}

/// Whether `to` is the transpose of the matrix whose numbers are 0, 1, 2, …, row by row.
fn right(to: &[f64], rows: usize, columns: usize) -> bool {
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
