//! A tile of the product in registers.
//!
//! *Guarantee.* Element (i, j) of a tile is the sum over k of a(i, k)·b(k, j) in the order of k, each step one fused
//! multiply-add from zero, on every level; then it is set, added or subtracted with one rounding. So levels, whose tiles
//! differ in size, agree to the last bit.

use super::Update;
use crate::level::Level;
use crate::matrix::view::MatrixViewMut;

#[cfg(target_arch = "x86_64")]
mod x86;

/// Most rows of a tile.
pub(super) const ROWS_MAX: usize = 8;
/// Most elements of a tile.
const TILE_MAX: usize = 8 * 24;
/// Rows and columns of a tile without vectors.
const SCALAR: (usize, usize) = (4, 4);

/// Rows and columns of a tile.
pub(super) fn tile(level: Level) -> (usize, usize) {
    match level {
        Level::Portable => SCALAR,
        Level::Avx2(_) => (4, 12),
        Level::Avx512(_) => (8, 24),
    }
}

/// Columns of a tile that are computed together.
fn lanes(level: Level) -> usize {
    match level {
        Level::Portable => SCALAR.1,
        Level::Avx2(_) => 4,
        Level::Avx512(_) => 8,
    }
}

/// C ← C ± A·B for a panel of A and one of B, of the widths of [`tile`] and of one depth; C may be smaller than the tile.
#[inline]
pub(super) fn run(level: Level, a: &[f64], b: &[f64], mut c: MatrixViewMut<'_>, update: Update) {
    let (rows, columns) = tile(level);
    let depth = a.len() / rows;
    assert_eq!((a.len(), b.len()), (depth * rows, depth * columns), "panels of one depth");
    let used = c.columns.next_multiple_of(lanes(level));
    if (c.rows, c.columns) == (rows, used) {
        return whole(level, depth, a, b, c, update);
    }
    let mut tile = [0.0; TILE_MAX];
    let view = MatrixViewMut { data: &mut tile, rows, columns: used, stride: used };
    whole(level, depth, a, b, view, Update::Set);
    for i in 0..c.rows {
        for (x, &y) in c.row(i).iter_mut().zip(&tile[i * used..]) {
            *x = updated(*x, y, update);
        }
    }
}

/// All rows of a tile, and whole vectors of its columns.
#[inline]
fn whole(level: Level, depth: usize, a: &[f64], b: &[f64], c: MatrixViewMut<'_>, update: Update) {
    match level {
        #[cfg(target_arch = "x86_64")]
        Level::Avx2(yes) => x86::avx2(yes, depth, a, b, c, update),
        #[cfg(target_arch = "x86_64")]
        Level::Avx512(yes) => x86::avx512(yes, depth, a, b, c, update),
        _ => scalar(a, b, c, update),
    }
}

fn scalar(a: &[f64], b: &[f64], mut c: MatrixViewMut<'_>, update: Update) {
    let mut tile = [[0.0f64; SCALAR.1]; SCALAR.0];
    for (a, b) in a.chunks_exact(SCALAR.0).zip(b.chunks_exact(SCALAR.1)) {
        for (row, &x) in tile.iter_mut().zip(a) {
            for (sum, &y) in row.iter_mut().zip(b) {
                *sum = x.mul_add(y, *sum);
            }
        }
    }
    for (i, row) in tile.iter().enumerate() {
        for (x, &y) in c.row(i).iter_mut().zip(row) {
            *x = updated(*x, y, update);
        }
    }
}

fn updated(x: f64, y: f64, update: Update) -> f64 {
    match update {
        Update::Set => y,
        Update::Add => x + y,
        Update::Subtract => x - y,
    }
}
