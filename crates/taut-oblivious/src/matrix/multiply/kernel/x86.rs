//! Tiles in the registers of x86-64: 8 × 24 numbers in 24 registers of 8, or 4 × 12 in 12 registers of 4.
#![allow(unsafe_code)] // Loads and stores of whole vectors.

use std::arch::x86_64::*;

use crate::level::{Avx2, Avx512};
use crate::matrix::multiply::Update;
use crate::matrix::view::MatrixViewMut;

/// Checks what the addresses rest on.
fn check(
    (rows, columns): (usize, usize),
    depth: usize,
    a: &[f64],
    b: &[f64],
    c: &MatrixViewMut<'_>,
) {
    assert!(a.len() == depth * rows && b.len() == depth * columns);
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
    check((4, 12), depth, a, b, &c);
    // SAFETY: the proof says that AVX2 and FMA are there; extents were checked.
    unsafe { tile_4_12(depth, a.as_ptr(), b.as_ptr(), (c.data.as_mut_ptr(), c.stride), update) }
}

pub(super) fn avx512(
    _: Avx512,
    depth: usize,
    a: &[f64],
    b: &[f64],
    c: MatrixViewMut<'_>,
    update: Update,
) {
    check((8, 24), depth, a, b, &c);
    // SAFETY: the proof says that AVX-512F is there; extents were checked.
    unsafe { tile_8_24(depth, a.as_ptr(), b.as_ptr(), (c.data.as_mut_ptr(), c.stride), update) }
}

macro_rules! tile {
    ($name:ident, $feature:literal, $rows:literal, $lanes:literal,
     $zero:ident, $set:ident, $load:ident, $store:ident, $fused:ident, $add:ident, $subtract:ident) => {
        #[target_feature(enable = $feature)]
        unsafe fn $name(
            depth: usize,
            mut a: *const f64,
            mut b: *const f64,
            (c, stride): (*mut f64, usize),
            update: Update,
        ) {
            let mut sums = [[$zero(); 3]; $rows];
            // SAFETY: `depth` groups of the rows of a and of the columns of b; a tile of whole vectors of c.
            unsafe {
                for i in 0..$rows {
                    // On its way while the products are added up.
                    _mm_prefetch::<_MM_HINT_T0>(c.add(i * stride).cast());
                    _mm_prefetch::<_MM_HINT_T0>(c.add(i * stride + $lanes).cast());
                    _mm_prefetch::<_MM_HINT_T0>(c.add(i * stride + 3 * $lanes - 1).cast());
                }
                for _ in 0..depth {
                    let columns = [$load(b), $load(b.add($lanes)), $load(b.add(2 * $lanes))];
                    for i in 0..$rows {
                        let x = $set(*a.add(i));
                        for v in 0..3 {
                            sums[i][v] = $fused(x, columns[v], sums[i][v]);
                        }
                    }
                    a = a.add($rows);
                    b = b.add(3 * $lanes);
                }
                for i in 0..$rows {
                    for v in 0..3 {
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
