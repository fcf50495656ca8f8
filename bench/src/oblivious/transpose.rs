//! Transposition of doubles out of place, beside copying them.

use super::lanes::Lanes;
use crate::prelude::*;

/// The crate, in the tables.
const CRATE: &str = "transpose";
/// The copy.
const COPY: &str = "memcpy";

/// The four shapes.
pub(super) fn shapes(context: &Context) -> [(usize, usize); 4] {
    context.size(
        [(4096, 4096), (10_000, 10_000), (8192, 16_384), (10_000_000, 3)],
        [(512, 512), (1000, 1000), (512, 1024), (100_000, 3)],
    )
}

/// The rate at which a program takes so many doubles.
pub(super) fn gigabytes_per_second(lanes: &Lanes, doubles: usize, name: &str) -> f64 {
    8e-9 * doubles as f64 / lanes.of(name)
}

/// The four shapes, and squares whose side is off by one.
pub(super) fn run(context: &Context, out: &mut Outcome) -> Result<()> {
    let mut table = Table::new(
        "shape | taut, GB/s:2 | transpose, GB/s:2 | memcpy, GB/s:2 | transpose ÷ taut:x | memcpy \
            ÷ taut:x",
    );
    for (rows, columns) in shapes(context) {
        let name = format!("{rows} × {columns}");
        let lanes = take_turns(context, rows, columns)?;
        let rate = |name| gigabytes_per_second(&lanes, rows * columns, name);
        let [crates, copy] = [CRATE, COPY].map(|other| lanes.faster("taut", other));
        table.push(json!({
            "shape": name, "taut, GB/s": rate("taut"), "transpose, GB/s": rate(CRATE), "memcpy, GB/s": rate(COPY),
            "transpose ÷ taut": crates, "memcpy ÷ taut": copy, "lanes": lanes.json(rows * columns),
        }));
        out.at_least(format!("{name}: the crate over taut"), crates, 1.5, Unit::Times);
        out.at_least(format!("{name}: memcpy over taut"), copy, [0.5, 0.8], Unit::Times);
    }
    out.table("matrix bytes per second", table);
    let mut sides = Table::new("sides | each:ns");
    for (n, _) in &shapes(context)[..2] {
        let three = [n - 1, *n, n + 1];
        let each = by_turns(context, three)?;
        sides.push(json!([three, each]));
        let ratio = (each[1] / each[0]).max(each[1] / each[2]);
        let what = format!("{n}²: time per number over that of {n} ± 1");
        out.at_most(what, ratio, 1.3, Unit::Times);
    }
    out.table("squares of nearly the same side", sides);
    Ok(())
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
