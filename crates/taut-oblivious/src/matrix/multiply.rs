//! Multiplication of matrices by recursion over a kernel in registers.
//!
//! *Problem.* C = A·B with m·k·n products, at the rate of the arithmetic units.
//! *Idea.* Halve the longest of m, k and n until the operands fit the last cache. There, A is packed in panels of a few
//! rows and B in panels of a few columns, 256 products deep, in the order in which the kernel reads them: a block of
//! panels of B stays in the second cache, a panel of A in the first, a tile of C in registers. Below a cut-off of the
//! caller's choice nothing changes; above it seven products of halves take the place of eight (`strassen`).
//! *Guarantee.* Element by element |C − Ĉ| ≤ γ·|A|·|B| with γ = k·u / (1 − k·u), u = 2⁻⁵³: each sum runs over k in order,
//! by fused multiply-add in stretches of 256, whose results are added in order. So the bits are the same for any number of
//! threads (which share rows, never sums), for any strides and on any processor.
//! *Trap.* Packing at the leaves of a recursion down to the caches would cost a seventh of the time; packed operands have
//! to be used for a thousand rows or columns.
//! *Reference.* Thesis, section 5.4; Frigo, Leiserson, Prokop, Ramachandran, *Cache-oblivious algorithms*, FOCS 1999; Goto,
//! van de Geijn, *Anatomy of High-Performance Matrix Multiplication*, 2008, for the packing; Higham, *Accuracy and
//! Stability of Numerical Algorithms*, 2nd ed., section 3.5, for the bound.

use rayon::prelude::*;

use super::transpose::tiles;
use super::view::{MatrixView, MatrixViewMut};
use crate::level::Level;
use crate::{Error, NoProbe, Probe};

mod kernel;
mod pack;
mod scratch;
mod strassen;
#[cfg(test)]
mod tests;

/// How to multiply. Write `MultiplyOptions { strassen_above: Some(2000), ..Default::default() }`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MultiplyOptions {
    /// While rows, columns and the sums are all longer than this, seven products of halves take the place of eight; at
    /// least 16. Default none: never. Each level loses about a decimal digit, see [`multiply`].
    pub strassen_above: Option<usize>,
}

/// What becomes of the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Update {
    /// C ← A·B.
    Set,
    /// C ← C + A·B.
    Add,
    /// C ← C − A·B.
    Subtract,
}

/// Products that a kernel adds up in registers: a panel of A of this depth is half of the first cache.
const PANEL_DEPTH: usize = 256;
/// Columns of a block of B: half of a second cache of 1 MiB.
const BLOCK: usize = 240;
/// Numbers in a line of the cache.
const LINE: usize = 8;
/// What is packed at once has sides of at most this many numbers: panels of A of 8 MiB.
const PACKED_SIDE_MAX: usize = 4096;
/// Threads share the rows from this many multiplications on.
const SHARED_WORK_MIN: usize = 1 << 21;

/// C ← A·B.
///
/// Without Strassen's method, element by element |C − Ĉ| ≤ γ·|A|·|B| with γ = k·u / (1 − k·u), k the columns of A and
/// u = 2⁻⁵³. With ℓ levels of it the bound is on the largest elements only: max |C − Ĉ| ≤ (18^ℓ·(q² + 6q) − 6p)·u·max |A| ·
/// max |B| + O(u²), where p is the largest of the three dimensions and q = p / 2^ℓ (Higham, section 23.2.2). Runs on the
/// current rayon pool; the bits do not depend on it, nor on the processor. O(m·k·n), or O(n^2.81); 10 MiB of memory for
/// each thread, up to 2 of which it keeps for the next product, and with Strassen's method two thirds of an operand.
///
/// # Errors
/// [`Error::Option`] if the shapes do not match or the cut-off is below 16.
///
/// ```
/// use taut_oblivious::{MatrixView, MatrixViewMut, multiply};
///
/// let (a, b) = ([1.0, 2.0, 3.0, 4.0], [0.0, 1.0, 1.0, 0.0]);
/// let (a, b) = (MatrixView::new(&a, 2, 2)?, MatrixView::new(&b, 2, 2)?);
/// let mut c = [0.0; 4];
/// multiply(a, b, MatrixViewMut::new(&mut c, 2, 2)?, &Default::default())?;
/// assert_eq!(c, [2.0, 1.0, 4.0, 3.0]);
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
pub fn multiply(
    a: MatrixView<'_>,
    b: MatrixView<'_>,
    c: MatrixViewMut<'_>,
    options: &MultiplyOptions,
) -> Result<(), Error> {
    check(a, b, &c, options)?;
    let by = |a: MatrixView<'_>, b: MatrixView<'_>, c: MatrixViewMut<'_>| {
        shared(Level::best(), a, b, c, Update::Set);
    };
    match options.strassen_above {
        Some(above) => strassen::multiply(a, b, c, above, &by),
        None => by(a, b, c),
    }
    Ok(())
}

/// As [`multiply`] without Strassen's method and on one thread, and tells `probe` of panels and of rows of tiles.
///
/// # Errors
/// As [`multiply`].
pub fn multiply_probed<P: Probe>(
    a: MatrixView<'_>,
    b: MatrixView<'_>,
    c: MatrixViewMut<'_>,
    probe: &mut P,
) -> Result<(), Error> {
    check(a, b, &c, &MultiplyOptions::default())?;
    probe.place(a.data);
    probe.place(b.data);
    probe.place(c.data);
    let (data_a, data_b, data_c) = (a.data, b.data, c.data.as_ptr() as usize);
    recurse(Level::best(), a, b, c, Update::Set, probe);
    probe.lift_from(data_c);
    probe.lift(data_b);
    probe.lift(data_a);
    Ok(())
}

fn check(
    a: MatrixView<'_>,
    b: MatrixView<'_>,
    c: &MatrixViewMut<'_>,
    options: &MultiplyOptions,
) -> Result<(), Error> {
    if a.columns != b.rows || a.rows != c.rows || b.columns != c.columns {
        let value = format!("{:?} · {:?} = {:?}", a.shape(), b.shape(), (c.rows, c.columns));
        let expected = "(m, k) · (k, n) = (m, n)";
        return Err(Error::Option { name: "shapes", value, expected });
    }
    match options.strassen_above {
        Some(above @ ..16) => Err(Error::Option {
            name: "strassen_above",
            value: above.to_string(),
            expected: "at least 16",
        }),
        _ => Ok(()),
    }
}

/// The product, its rows shared by the threads of the pool.
pub(crate) fn shared(
    level: Level,
    a: MatrixView<'_>,
    b: MatrixView<'_>,
    c: MatrixViewMut<'_>,
    update: Update,
) {
    let threads = rayon::current_num_threads();
    let products = a.rows.saturating_mul(a.columns).saturating_mul(b.columns);
    if threads == 1 || products < SHARED_WORK_MIN || c.stride == 0 {
        return recurse(level, a, b, c, update, &mut NoProbe);
    }
    let band = a.rows.div_ceil(threads).next_multiple_of(kernel::ROWS_MAX);
    c.data.par_chunks_mut(band * c.stride).enumerate().for_each(|(k, data)| {
        let rows = (k * band).min(c.rows)..((k + 1) * band).min(c.rows);
        let part = MatrixViewMut { data, rows: rows.len(), columns: c.columns, stride: c.stride };
        recurse(level, a.part(rows, 0..a.columns), b, part, update, &mut NoProbe);
    });
}

/// Halves the longest dimension, down to leaves. Halves of a sum meet at a whole stretch, so they change no bit.
pub(crate) fn recurse<P: Probe>(
    level: Level,
    a: MatrixView<'_>,
    b: MatrixView<'_>,
    mut c: MatrixViewMut<'_>,
    update: Update,
    probe: &mut P,
) {
    let (m, k, n) = (a.rows, a.columns, b.columns);
    let longest = m.max(k).max(n);
    if m == 0 || n == 0 {
        return;
    }
    if k == 0 {
        if update == Update::Set {
            (0..m).for_each(|i| c.row(i).fill(0.0));
        }
        return;
    }
    if longest <= PACKED_SIDE_MAX {
        return leaf(level, a, b, c, update, probe);
    }
    let half = (longest / 2).next_multiple_of(BLOCK);
    if m == longest {
        recurse(level, a.part(0..half, 0..k), b, c.part(0..half, 0..n), update, probe);
        recurse(level, a.part(half..m, 0..k), b, c.part(half..m, 0..n), update, probe);
    } else if n == longest {
        recurse(level, a, b.part(0..k, 0..half), c.part(0..m, 0..half), update, probe);
        recurse(level, a, b.part(0..k, half..n), c.part(0..m, half..n), update, probe);
    } else {
        let half = (k / 2).next_multiple_of(PANEL_DEPTH);
        recurse(level, a.part(0..m, 0..half), b.part(0..half, 0..n), c.again(), update, probe);
        let update = if update == Update::Set { Update::Add } else { update };
        recurse(level, a.part(0..m, half..k), b.part(half..k, 0..n), c, update, probe);
    }
}

/// A product that is packed, a stretch of the sums and a block of columns at a time.
fn leaf<P: Probe>(
    level: Level,
    a: MatrixView<'_>,
    b: MatrixView<'_>,
    mut c: MatrixViewMut<'_>,
    update: Update,
    probe: &mut P,
) {
    let (m, k, n) = (a.rows, a.columns, b.columns);
    let (tile_rows, tile_columns) = kernel::tile(level);
    let depth = k.min(PANEL_DEPTH);
    let room_a = pack::Panels::room(tile_rows, m, depth).next_multiple_of(LINE);
    let room = room_a + pack::Panels::room(tile_columns, n.min(BLOCK), depth);
    let mut scratch = scratch::Scratch::of(room);
    let (room_a, room_b) = scratch.numbers().split_at_mut(room_a);
    let mut packed_a = pack::Panels::new(tile_rows, room_a);
    let mut packed_b = pack::Panels::new(tile_columns, room_b);
    probe.place(packed_a.all());
    probe.place(packed_b.all());
    for first in (0..k).step_by(PANEL_DEPTH) {
        let stretch = first..k.min(first + PANEL_DEPTH);
        let update = if first > 0 && update == Update::Set { Update::Add } else { update };
        packed_a.pack(level, a.part(0..m, stretch.clone()), probe);
        for left in (0..n).step_by(BLOCK) {
            let block = left..n.min(left + BLOCK);
            packed_b.pack(level, b.part(stretch.clone(), block.clone()).transposed(), probe);
            let share = (tile_rows * stretch.len()).div_ceil(block.len().div_ceil(tile_columns));
            for (top, panel_a) in packed_a.panels() {
                // The next panel comes from the last cache, or from memory, while this one is used.
                let mut coming = packed_a.after(top).chunks(share);
                for (right, panel_b) in packed_b.panels() {
                    tiles::fetch(level, coming.next().unwrap_or(&[]));
                    let rows = top..m.min(top + tile_rows);
                    let columns = left + right..block.end.min(left + right + tile_columns);
                    let mut tile = c.part(rows, columns);
                    if P::LISTENS {
                        probe.read(panel_a);
                        probe.read(panel_b);
                        for i in 0..tile.rows {
                            probe.read(tile.row(i));
                            probe.write(tile.row(i));
                        }
                    }
                    kernel::run(level, panel_a, panel_b, tile, update);
                }
            }
        }
    }
    probe.lift(packed_b.all());
    probe.lift(packed_a.all());
}
