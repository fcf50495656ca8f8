//! Tiles in the registers of x86-64: 8 × 24 numbers in 24 registers of 8, or 4 × 12 in 12 registers of 4.
#![allow(unsafe_code)] // Loads and stores of whole vectors.

use std::arch::x86_64::*;
use std::array::from_fn;

use crate::level::{Avx2, Avx512};
use crate::matrix::multiply::Update;
use crate::matrix::view::MatrixViewMut;

/// Checks what the addresses rest on.
fn check(
    (rows, panel): (usize, usize),
    depth: usize,
    a: &[f64],
    b: &[f64],
    c: &MatrixViewMut<'_>,
    columns: usize,
) {
    assert!(a.len() == depth * rows && b.len() == depth * panel && columns <= panel);
    assert!((rows - 1) * c.stride + columns <= c.data.len());
}

pub(super) fn avx2(
    _: Avx2,
    depth: usize,
    a: &[f64],
    b: &[f64],
    c: MatrixViewMut<'_>,
    update: Update,
) {
    let columns = c.columns;
    check((4, 12), depth, a, b, &c, columns);
    let (a, b, c) = (a.as_ptr(), b.as_ptr(), (c.data.as_mut_ptr(), c.stride));
    // SAFETY: the proof says that AVX2 and FMA are there; extents were checked.
    unsafe {
        match columns {
            4 => tile_4_12::<1>(depth, a, b, c, update),
            8 => tile_4_12::<2>(depth, a, b, c, update),
            12 => tile_4_12::<3>(depth, a, b, c, update),
            _ => unreachable!("whole vectors"),
        }
    }
}

pub(super) fn avx512(
    _: Avx512,
    depth: usize,
    a: &[f64],
    b: &[f64],
    c: MatrixViewMut<'_>,
    update: Update,
) {
    let columns = c.columns;
    check((8, 24), depth, a, b, &c, columns);
    let (a, b, c) = (a.as_ptr(), b.as_ptr(), (c.data.as_mut_ptr(), c.stride));
    // SAFETY: the proof says that AVX-512F is there; extents were checked.
    unsafe {
        match columns {
            8 => tile_8_24::<1>(depth, a, b, c, update),
            16 => tile_8_24::<2>(depth, a, b, c, update),
            24 => tile_8_24::<3>(depth, a, b, c, update),
            _ => unreachable!("whole vectors"),
        }
    }
}

macro_rules! tile {
    ($name:ident, $feature:literal, $rows:literal, $lanes:literal,
     $zero:ident, $set:ident, $load:ident, $store:ident, $fused:ident, $add:ident, $subtract:ident) => {
        /// The first `VECTORS` vectors of each row.
        ///
        /// # Safety
        /// The processor has the instructions; `a` and `b` hold `depth` groups of packed rows and columns, `c` the tile.
        #[target_feature(enable = $feature)]
        unsafe fn $name<const VECTORS: usize>(
            depth: usize,
            mut a: *const f64,
            mut b: *const f64,
            (c, stride): (*mut f64, usize),
            update: Update,
        ) {
            let mut sums = [[$zero(); VECTORS]; $rows];
            // SAFETY: `depth` groups of the rows of a and of the columns of b; a tile of whole vectors of c.
            unsafe {
                // The tile of C is on its way while the products are added up: a row of it after each share, as all of
                // it at once takes a thirtieth of the time.
                let share = depth / (2 * $rows);
                for row in 0..=$rows {
                    let steps = if row < $rows {
                        let row = c.add(row * stride);
                        for v in 0..VECTORS {
                            _mm_prefetch::<_MM_HINT_T0>(row.add(v * $lanes).cast());
                        }
                        _mm_prefetch::<_MM_HINT_T0>(row.add(VECTORS * $lanes - 1).cast());
                        share
                    } else {
                        depth - $rows * share
                    };
                    for _ in 0..steps {
                        let columns: [_; VECTORS] = from_fn(|v| $load(b.add(v * $lanes)));
                        for i in 0..$rows {
                            let x = $set(*a.add(i));
                            for v in 0..VECTORS {
                                sums[i][v] = $fused(x, columns[v], sums[i][v]);
                            }
                        }
                        a = a.add($rows);
                        b = b.add(3 * $lanes);
                    }
                }
                for i in 0..$rows {
                    for v in 0..VECTORS {
                        let at = c.add(i * stride + v * $lanes);
                        let sum = match update {
                            Update::Set => sums[i][v],
                            Update::Add => $add($load(at), sums[i][v]),
                            Update::Subtract => $subtract($load(at), sums[i][v]),
                        };
                        $store(at, sum);
                    }
                }
            }
        }
    };
}

tile!(
    tile_4_12,
    "avx2,fma",
    4,
    4,
    _mm256_setzero_pd,
    _mm256_set1_pd,
    _mm256_loadu_pd,
    _mm256_storeu_pd,
    _mm256_fmadd_pd,
    _mm256_add_pd,
    _mm256_sub_pd
);
tile!(
    tile_8_24,
    "avx512f",
    8,
    8,
    _mm512_setzero_pd,
    _mm512_set1_pd,
    _mm512_loadu_pd,
    _mm512_storeu_pd,
    _mm512_fmadd_pd,
    _mm512_add_pd,
    _mm512_sub_pd
);
