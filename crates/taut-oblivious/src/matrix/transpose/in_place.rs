//! Transposition in the matrix's own place.
//!
//! *Idea.* Square: a block and its mirror image change places, each turned on the way through a scratch block. Other
//! shapes: three passes of permutations within rows and within columns, see `rectangular`.
//! *Guarantee.* The same result as out of place, with little more memory than the matrix.
//! *Trap.* Lines are read before they are written, so writing past the caches would only cost.

use bytemuck::Pod;

use super::{check_length, rectangular, tiles};
use crate::level::Level;
use crate::{Error, NoProbe, Probe};

/// Bytes of a row of a block.
const BLOCK: usize = 256;

/// Transposes the row-major `rows` × `columns` matrix in place: afterwards it has `columns` rows.
///
/// O(rows · columns). Beside the matrix a square one takes two blocks of max(256 / w, 4)² elements of w bytes each: 16 KiB of
/// 8 bytes, 128 KiB of single bytes; others the room of the longer of a row and a column, or of eight times the shorter one
/// if that is more.
///
/// # Errors
/// [`Error::Option`] if the length of `matrix` is not `rows · columns`.
///
/// ```
/// let mut matrix = [1, 2, 3, 4, 5, 6];
/// taut_oblivious::transpose_in_place(&mut matrix, 2, 3)?;
/// assert_eq!(matrix, [1, 4, 2, 5, 3, 6]);
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
pub fn transpose_in_place<T: Pod>(
    matrix: &mut [T],
    rows: usize,
    columns: usize,
) -> Result<(), Error> {
    transpose_in_place_instrumented(matrix, rows, columns, &mut NoProbe)
}

/// As [`transpose_in_place`], and tells `probe` of every block, row or group of columns.
///
/// # Errors
/// As [`transpose_in_place`].
pub fn transpose_in_place_instrumented<T: Pod, P: Probe>(
    matrix: &mut [T],
    rows: usize,
    columns: usize,
    probe: &mut P,
) -> Result<(), Error> {
    check_length("matrix", matrix.len(), rows, columns)?;
    if size_of::<T>() == 0 || rows <= 1 || columns <= 1 {
        return Ok(());
    }
    probe.place(matrix);
    if rows == columns {
        square(Level::best(), matrix, rows, probe);
    } else {
        rectangular::transpose(matrix, rows, columns, probe);
    }
    probe.lift(matrix);
    Ok(())
}

pub(super) fn square<T: Pod, P: Probe>(level: Level, matrix: &mut [T], n: usize, probe: &mut P) {
    let side = (BLOCK / size_of::<T>()).max(4);
    let mut above = vec![T::zeroed(); side * side];
    let mut below = above.clone();
    probe.place(&above);
    probe.place(&below);
    for top in (0..n).step_by(side) {
        let height = side.min(n - top);
        for left in (top..n).step_by(side) {
            let width = side.min(n - left);
            let load =
                |matrix: &[T], at: usize, extent: (usize, usize), to: &mut [T], probe: &mut P| {
                    for i in 0..extent.0 {
                        probe.read(&matrix[at + i * n..][..extent.1]);
                    }
                    probe.write(&to[..extent.1 * side]);
                    tiles::turn(level, extent, (&matrix[at..], n), (to, side));
                };
            let store =
                |matrix: &mut [T], at: usize, extent: (usize, usize), from: &[T], probe: &mut P| {
                    for (i, row) in from.chunks(side).take(extent.0).enumerate() {
                        // What comes next on the right, and below its mirror image, is on its way meanwhile.
                        let ahead = at + i * n + if extent.0 == height { side } else { side * n };
                        if let Some(part) = matrix.get(ahead..ahead + extent.1) {
                            tiles::fetch(level, part);
                        }
                        let place = &mut matrix[at + i * n..][..extent.1];
                        probe.read(&row[..extent.1]);
                        probe.write(place);
                        place.copy_from_slice(&row[..extent.1]);
                    }
                };
            let (here, mirror) = (top * n + left, left * n + top);
            load(matrix, here, (height, width), &mut above, probe);
            if left > top {
                load(matrix, mirror, (width, height), &mut below, probe);
                store(matrix, here, (height, width), &below, probe);
            }
            store(matrix, mirror, (width, height), &above, probe);
        }
    }
    probe.lift(&below);
    probe.lift(&above);
}
