//! Small tiles turned in registers: the only part of a transposition that knows elements.
//!
//! *Guarantee.* Every level moves the same elements to the same places; bytes are copied, never computed with.
//! *Trap.* Of short rows only the elements that exist are read: masks, or one element at a time.

use bytemuck::Pod;

use crate::level::Level;

#[cfg(target_arch = "x86_64")]
mod x86;

/// Writes element (i, j) of a `rows` × `columns` block to `to[j · stride_to + i]`; row i begins at `from[i · stride]`.
///
/// Rows of the target may lie closer together than a vector is long: nothing beyond their `rows` elements is written.
pub(in crate::matrix) fn turn<T: Pod>(
    level: Level,
    (rows, columns): (usize, usize),
    (from, stride): (&[T], usize),
    (to, stride_to): (&mut [T], usize),
) {
    if rows == 0 || columns == 0 {
        return;
    }
    // The addresses of the vector kernels rest on this.
    assert!((rows - 1) * stride + columns <= from.len());
    assert!((columns - 1) * stride_to + rows <= to.len());
    match level {
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(yes) if x86::avx2(yes, (rows, columns), (from, stride), (to, stride_to)) => {}
        #[cfg(target_arch = "x86_64")]
        Level::Avx512(yes)
            if x86::avx512(yes, (rows, columns), (from, stride), (to, stride_to)) => {}
        _ => scalar((rows, columns), (from, stride), (to, stride_to)),
    }
}

/// Turns a strip of the source into rows of the target, `stride_to` apart, past the caches; whether there is a kernel that
/// does. [`fence`] must follow before another thread reads.
pub(super) fn walk<T: Pod>(
    level: Level,
    (rows, columns): (usize, usize),
    (from, stride): (&[T], usize),
    (to, stride_to): (&mut [T], usize),
) -> bool {
    // The addresses of the kernel rest on this.
    assert!((rows - 1) * stride + columns <= from.len());
    assert!((columns - 1) * stride_to + rows <= to.len());
    match level {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512(yes) => x86::walk(yes, (rows, columns), (from, stride), (to, stride_to)),
        _ => false,
    }
}

/// This many rows and columns are turned together one element at a time, so that lines are used whole.
const TILE_SIDE: usize = 8;

fn scalar<T: Copy>(
    (rows, columns): (usize, usize),
    (from, stride): (&[T], usize),
    (to, stride_to): (&mut [T], usize),
) {
    for top in (0..rows).step_by(TILE_SIDE) {
        for left in (0..columns).step_by(TILE_SIDE) {
            let right = columns.min(left + TILE_SIDE);
            for i in top..rows.min(top + TILE_SIDE) {
                let row = &from[i * stride + left..i * stride + right];
                for (j, &x) in (left..).zip(row) {
                    to[j * stride_to + i] = x;
                }
            }
        }
    }
}

/// Copies `from` to the equally long `to` past the caches, where the level and the alignment of the elements allow it.
///
/// [`fence`] must follow before another thread reads.
pub(in crate::matrix) fn stream<T: Pod>(level: Level, from: &[T], to: &mut [T]) {
    assert_eq!(from.len(), to.len());
    match level {
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(_) | Level::Avx512(_) => {
            x86::stream(level, bytemuck::cast_slice(from), bytemuck::cast_slice_mut(to));
        }
        _ => to.copy_from_slice(from),
    }
}

/// Asks for `part` before it is needed.
pub(in crate::matrix) fn fetch<T: Pod>(level: Level, part: &[T]) {
    #[cfg(target_arch = "x86_64")]
    if level != Level::Portable {
        x86::fetch(bytemuck::cast_slice(part));
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (level, part);
}

/// Orders what [`stream`] wrote before what this thread writes next.
pub(in crate::matrix) fn fence(level: Level) {
    #[cfg(target_arch = "x86_64")]
    if level != Level::Portable {
        x86::fence();
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = level;
}
