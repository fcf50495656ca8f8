//! A tile of elements of any width turned in memory.

use bytemuck::Pod;

use crate::matrix::transpose;

/// Writes the transpose of a `rows` × `columns` tile of elements of `width` bytes to `to`.
pub(super) fn turn(from: &[u8], (rows, columns): (usize, usize), width: usize, to: &mut [u8]) {
    match width {
        1 => typed::<[u8; 1]>(from, (rows, columns), to),
        2 => typed::<[u8; 2]>(from, (rows, columns), to),
        4 => typed::<[u8; 4]>(from, (rows, columns), to),
        8 => typed::<[u8; 8]>(from, (rows, columns), to),
        16 => typed::<[u8; 16]>(from, (rows, columns), to),
        _ => bytes(from, (rows, columns), width, to),
    }
}

fn typed<T: Pod + Send + Sync>(from: &[u8], (rows, columns): (usize, usize), to: &mut [u8]) {
    let (from, to) = (bytemuck::cast_slice::<_, T>(from), bytemuck::cast_slice_mut(to));
    transpose::transpose(from, rows, columns, to).expect("both sides are cut to the tile");
}

/// This many rows and columns are turned together, so that lines are used whole.
const TILE_SIDE: usize = 16;

fn bytes(from: &[u8], (rows, columns): (usize, usize), width: usize, to: &mut [u8]) {
    for top in (0..rows).step_by(TILE_SIDE) {
        for left in (0..columns).step_by(TILE_SIDE) {
            for i in top..rows.min(top + TILE_SIDE) {
                for j in left..columns.min(left + TILE_SIDE) {
                    to[(j * rows + i) * width..][..width]
                        .copy_from_slice(&from[(i * columns + j) * width..][..width]);
                }
            }
        }
    }
}
