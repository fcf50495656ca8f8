//! Transposition out of place by halving the longer side.
//!
//! *Problem.* `to[j][i] = from[i][j]` for a matrix of n × m in rows.
//! *Idea.* Halve the longer side until a piece is at most `base` wide and high.
//! *Guarantee.* O(1 + nm/B) misses in a tall cache; 2n²/B exactly for n a power of two and a multiple of B, arrays at
//! borders of blocks and M ≥ 4B².
//! *Trap.* Rows that do not begin at borders of blocks cost up to one block more for each row of a piece.
//! *Reference.* The thesis, 5.3 and figure 39, in which `xmid` is a length, and odd lengths go to the second half.

use super::{check_base, check_length, get, set};
use crate::{Error, NoProbe, Probe};

/// Writes the transpose of `from`, which has `rows` rows of `columns` elements, into `to`; the paper has `base` 1.
///
/// # Errors
/// [`Error::Option`] if an array has another length or `base` is 0.
pub fn transpose<T: Copy>(
    from: &[T],
    to: &mut [T],
    rows: usize,
    columns: usize,
    base: usize,
) -> Result<(), Error> {
    transpose_instrumented(from, to, rows, columns, base, &mut NoProbe)
}

/// [`transpose()`] under a probe.
///
/// # Errors
/// As there.
pub fn transpose_instrumented<T: Copy, P: Probe>(
    from: &[T],
    to: &mut [T],
    rows: usize,
    columns: usize,
    base: usize,
    probe: &mut P,
) -> Result<(), Error> {
    check_length("from", from.len(), rows, columns)?;
    check_length("to", to.len(), rows, columns)?;
    check_base(base)?;
    probe.place(from);
    probe.place(to);
    Matrices { from, to, rows, columns, base }.transpose((0, rows), (0, columns), probe);
    Ok(())
}

struct Matrices<'a, T> {
    from: &'a [T],
    to: &'a mut [T],
    rows: usize,
    columns: usize,
    base: usize,
}

impl<T: Copy> Matrices<'_, T> {
    /// The piece of `dx` rows from `x` on and `dy` columns from `y` on.
    fn transpose<P: Probe>(
        &mut self,
        (x, dx): (usize, usize),
        (y, dy): (usize, usize),
        probe: &mut P,
    ) {
        if dx == 0 || dy == 0 {
            // Nothing, however long the other side is.
        } else if dx <= self.base && dy <= self.base {
            for i in x..x + dx {
                for j in y..y + dy {
                    let element = get(self.from, i * self.columns + j, probe);
                    set(self.to, j * self.rows + i, element, probe);
                }
            }
        } else if dx >= dy {
            let half = dx / 2;
            self.transpose((x, half), (y, dy), probe);
            self.transpose((x + half, dx - half), (y, dy), probe);
        } else {
            let half = dy / 2;
            self.transpose((x, dx), (y, half), probe);
            self.transpose((x, dx), (y + half, dy - half), probe);
        }
    }
}

/// Transposes arrays that were announced and have the right length.
pub(super) fn transpose_within<T: Copy, P: Probe>(
    from: &[T],
    to: &mut [T],
    rows: usize,
    columns: usize,
    probe: &mut P,
) {
    Matrices { from, to, rows, columns, base: 1 }.transpose((0, rows), (0, columns), probe);
}
