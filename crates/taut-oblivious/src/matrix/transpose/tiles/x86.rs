//! Tiles in the registers of x86-64.
//!
//! *Guarantee.* A value of [`Avx2`] or [`Avx512`] proves the instructions; the caller has checked that the block lies in
//! both slices. Elements are plain bytes (`Pod`), so any width may be read as an integer of that width.
#![allow(unsafe_code, reason = "loads, stores and shuffles of whole vectors")]

use std::arch::x86_64::*;

use bytemuck::Pod;

use crate::level::{Avx2, Avx512, Level};

pub(super) mod past;

/// [`super::turn`] where the width has a kernel; whether it had.
pub(super) fn avx2<T: Pod>(
    _: Avx2,
    (rows, columns): (usize, usize),
    (from, stride): (&[T], usize),
    (to, stride_to): (&mut [T], usize),
) -> bool {
    let (from, to) = (from.as_ptr(), to.as_mut_ptr());
    // SAFETY: the proof says that AVX2 is there; the caller has checked the extents of both sides.
    unsafe {
        match size_of::<T>() {
            1 => turn_1((rows, columns), (from.cast(), stride), (to.cast(), stride_to)),
            2 => turn_2((rows, columns), (from.cast(), stride), (to.cast(), stride_to)),
            4 => turn_4((rows, columns), (from.cast(), stride), (to.cast(), stride_to)),
            8 => turn_8((rows, columns), (from.cast(), stride), (to.cast(), stride_to)),
            _ => return false,
        }
    }
    true
}

/// [`super::turn`] where the width has a kernel; whether it had.
pub(super) fn avx512<T: Pod>(
    _: Avx512,
    (rows, columns): (usize, usize),
    (from, stride): (&[T], usize),
    (to, stride_to): (&mut [T], usize),
) -> bool {
    let (from, to) = (from.as_ptr(), to.as_mut_ptr());
    // SAFETY: the proof says that AVX-512F and AVX2 are there; the caller has checked the extents of both sides.
    unsafe {
        match size_of::<T>() {
            1 => turn_1((rows, columns), (from.cast(), stride), (to.cast(), stride_to)),
            2 => turn_2((rows, columns), (from.cast(), stride), (to.cast(), stride_to)),
            4 => turn_4((rows, columns), (from.cast(), stride), (to.cast(), stride_to)),
            8 => turn_8_wide((rows, columns), (from.cast(), stride), (to.cast(), stride_to)),
            _ => return false,
        }
    }
    true
}

/// The whole strip past the caches, see [`past`]; whether width, shape and alignment allow it.
pub(super) fn walk<T: Pod>(
    _: Avx512,
    (rows, columns): (usize, usize),
    (from, stride): (&[T], usize),
    (to, stride_to): (&mut [T], usize),
) -> bool {
    let (from, to) = (from.as_ptr().cast::<f64>(), to.as_mut_ptr().cast::<f64>());
    if size_of::<T>() != 8 || to.align_offset(8) != 0 || from.align_offset(8) != 0 {
        return false;
    }
    let dense = stride_to == rows;
    // SAFETY: the proof says that AVX-512F is there; the caller has checked the extents of both sides.
    unsafe {
        match (rows, columns) {
            (_, 2) if stride == 2 && dense => past::split::<2>(rows, from, to),
            (_, 3) if stride == 3 && dense => past::split::<3>(rows, from, to),
            (_, 4) if stride == 4 && dense => past::split::<4>(rows, from, to),
            (2, _) if dense => past::join::<2>(columns, (from, stride), to),
            (3, _) if dense => past::join::<3>(columns, (from, stride), to),
            (4, _) if dense => past::join::<4>(columns, (from, stride), to),
            _ if rows >= 64 && columns <= past::STRIP_COLUMNS_MAX => {
                past::walk((rows, columns), (from, stride), (to, stride_to));
            }
            _ => return false,
        }
    }
    true
}

macro_rules! turn {
    ($name:ident, $word:ty, $side:literal, $tile:ident) => {
        /// A block by square tiles of `$side`, and one element at a time where none fits.
        ///
        /// # Safety
        /// The processor has AVX2, and both sides hold the block.
        #[target_feature(enable = "avx2")]
        unsafe fn $name(
            (rows, columns): (usize, usize),
            (from, stride): (*const $word, usize),
            (to, stride_to): (*mut $word, usize),
        ) {
            let (whole_rows, whole_columns) = (rows / $side * $side, columns / $side * $side);
            for i in (0..whole_rows).step_by($side) {
                for j in (0..whole_columns).step_by($side) {
                    // SAFETY: the tile lies in the block, which lies in both slices.
                    unsafe {
                        let (tile, turned) = (from.add(i * stride + j), to.add(j * stride_to + i));
                        $tile((tile, stride), (turned, stride_to));
                    }
                }
            }
            for i in 0..rows {
                let first = if i < whole_rows { whole_columns } else { 0 };
                for j in first..columns {
                    // SAFETY: element (i, j) of the block, which lies in both slices; alignment is not assumed.
                    unsafe {
                        let x = from.add(i * stride + j).read_unaligned();
                        to.add(j * stride_to + i).write_unaligned(x);
                    }
                }
            }
        }
    };
}

turn!(turn_1, u8, 16, tile_16_of_1);
turn!(turn_2, u16, 8, tile_8_of_2);
turn!(turn_4, u32, 8, tile_8_of_4);
turn!(turn_8, u64, 4, tile_4_of_8);

/// Sixteen by sixteen elements of one byte.
///
/// # Safety
/// The processor has AVX2, and both sides hold the tile.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn tile_16_of_1((from, stride): (*const u8, usize), (to, stride_to): (*mut u8, usize)) {
    // SAFETY: 16 rows of 16 bytes on both sides.
    unsafe {
        let mut r = [_mm_setzero_si128(); 16];
        for (k, r) in r.iter_mut().enumerate() {
            *r = _mm_loadu_si128(from.add(k * stride).cast());
        }
        // Four times: rows k and k + 8 interleaved become rows 2k and 2k + 1.
        for _ in 0..4 {
            let mut s = [_mm_setzero_si128(); 16];
            for k in 0..8 {
                s[2 * k] = _mm_unpacklo_epi8(r[k], r[k + 8]);
                s[2 * k + 1] = _mm_unpackhi_epi8(r[k], r[k + 8]);
            }
            r = s;
        }
        for (k, r) in r.into_iter().enumerate() {
            _mm_storeu_si128(to.add(k * stride_to).cast(), r);
        }
    }
}

/// Eight by eight elements of 2 bytes.
///
/// # Safety
/// The processor has AVX2, and both sides hold the tile.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn tile_8_of_2((from, stride): (*const u16, usize), (to, stride_to): (*mut u16, usize)) {
    // SAFETY: 8 rows of 8 elements on both sides.
    unsafe {
        let mut r = [_mm_setzero_si128(); 8];
        for (k, r) in r.iter_mut().enumerate() {
            *r = _mm_loadu_si128(from.add(k * stride).cast());
        }
        for _ in 0..3 {
            let mut s = [_mm_setzero_si128(); 8];
            for k in 0..4 {
                s[2 * k] = _mm_unpacklo_epi16(r[k], r[k + 4]);
                s[2 * k + 1] = _mm_unpackhi_epi16(r[k], r[k + 4]);
            }
            r = s;
        }
        for (k, r) in r.into_iter().enumerate() {
            _mm_storeu_si128(to.add(k * stride_to).cast(), r);
        }
    }
}

/// Eight by eight elements of 4 bytes.
///
/// # Safety
/// The processor has AVX2, and both sides hold the tile.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn tile_8_of_4((from, stride): (*const u32, usize), (to, stride_to): (*mut u32, usize)) {
    // SAFETY: 8 rows of 8 elements on both sides.
    unsafe {
        let row = |k: usize| _mm256_loadu_ps(from.add(k * stride).cast());
        let (mut r, mut s) = ([_mm256_setzero_ps(); 8], [_mm256_setzero_ps(); 8]);
        for k in 0..4 {
            let (a, b) = (row(2 * k), row(2 * k + 1));
            r[2 * k] = _mm256_unpacklo_ps(a, b);
            r[2 * k + 1] = _mm256_unpackhi_ps(a, b);
        }
        for k in 0..2 {
            s[4 * k] = _mm256_shuffle_ps::<0x44>(r[4 * k], r[4 * k + 2]);
            s[4 * k + 1] = _mm256_shuffle_ps::<0xEE>(r[4 * k], r[4 * k + 2]);
            s[4 * k + 2] = _mm256_shuffle_ps::<0x44>(r[4 * k + 1], r[4 * k + 3]);
            s[4 * k + 3] = _mm256_shuffle_ps::<0xEE>(r[4 * k + 1], r[4 * k + 3]);
        }
        for k in 0..4 {
            let low = _mm256_permute2f128_ps::<0x20>(s[k], s[k + 4]);
            let high = _mm256_permute2f128_ps::<0x31>(s[k], s[k + 4]);
            _mm256_storeu_ps(to.add(k * stride_to).cast(), low);
            _mm256_storeu_ps(to.add((k + 4) * stride_to).cast(), high);
        }
    }
}

/// Four by four elements of 8 bytes.
///
/// # Safety
/// The processor has AVX2, and both sides hold the tile.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn tile_4_of_8((from, stride): (*const u64, usize), (to, stride_to): (*mut u64, usize)) {
    // SAFETY: 4 rows of 4 elements on both sides.
    unsafe {
        let row = |k: usize| _mm256_loadu_pd(from.add(k * stride).cast());
        let (a, b, c, d) = (row(0), row(1), row(2), row(3));
        let (ab_even, ab_odd) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
        let (cd_even, cd_odd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
        let turned = [
            _mm256_permute2f128_pd::<0x20>(ab_even, cd_even),
            _mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd),
            _mm256_permute2f128_pd::<0x31>(ab_even, cd_even),
            _mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd),
        ];
        for (k, row) in turned.into_iter().enumerate() {
            _mm256_storeu_pd(to.add(k * stride_to).cast(), row);
        }
    }
}

/// Points to coordinates: rows of `D` adjacent elements of 8 bytes become `D` rows; `rows` is a multiple of 8.
///
/// # Safety
/// The processor has AVX-512F, and both sides hold the block.
#[target_feature(enable = "avx512f")]
unsafe fn split<const D: usize>(rows: usize, from: *const f64, (to, stride_to): (*mut f64, usize)) {
    let table = past::split_table::<D>();
    for i in (0..rows).step_by(8) {
        // SAFETY: 8 rows of `D` elements, which lie in both slices.
        unsafe {
            for (c, column) in
                past::split_eight::<D>(&table, from.add(i * D)).into_iter().enumerate()
            {
                _mm512_storeu_pd(to.add(c * stride_to + i), column);
            }
        }
    }
}

/// Coordinates to points: `D` rows of elements of 8 bytes become rows of `D` adjacent ones; `columns` is a multiple of 8.
///
/// # Safety
/// The processor has AVX-512F, and both sides hold the block.
#[target_feature(enable = "avx512f")]
unsafe fn join<const D: usize>(columns: usize, (from, stride): (*const f64, usize), to: *mut f64) {
    let table = past::join_table::<D>();
    for j in (0..columns).step_by(8) {
        // SAFETY: `D` rows of 8 elements, which lie in both slices.
        unsafe {
            for (m, part) in
                past::join_eight::<D>(&table, (from.add(j), stride)).into_iter().enumerate()
            {
                _mm512_storeu_pd(to.add(j * D + 8 * m), part);
            }
        }
    }
}

/// Indices of a permutation of two vectors: lane i is `pick(i)`, where 8 to 15 are lanes of the second one.
#[inline]
#[target_feature(enable = "avx512f")]
fn lanes(pick: impl Fn(usize) -> usize) -> __m512i {
    let index: [i64; 8] = std::array::from_fn(|i| pick(i) as i64);
    _mm512_setr_epi64(
        index[0], index[1], index[2], index[3], index[4], index[5], index[6], index[7],
    )
}

/// Eight by eight elements of 8 bytes; masks cut what is beyond the block.
///
/// # Safety
/// The processor has AVX-512F, and both sides hold the block.
#[target_feature(enable = "avx512f")]
unsafe fn turn_8_wide(
    (rows, columns): (usize, usize),
    (from, stride): (*const f64, usize),
    (to, stride_to): (*mut f64, usize),
) {
    let (mut top, mut left) = (0, 0);
    // SAFETY: whole groups of eight rows or columns of the block, whose other side is dense as the kernels want it.
    unsafe {
        match (rows, columns) {
            (_, 2) if stride == 2 => {
                top = rows / 8 * 8;
                split::<2>(top, from, (to, stride_to));
            }
            (_, 3) if stride == 3 => {
                top = rows / 8 * 8;
                split::<3>(top, from, (to, stride_to));
            }
            (_, 4) if stride == 4 => {
                top = rows / 8 * 8;
                split::<4>(top, from, (to, stride_to));
            }
            (2, _) if stride_to == 2 => {
                left = columns / 8 * 8;
                join::<2>(left, (from, stride), to);
            }
            (3, _) if stride_to == 3 => {
                left = columns / 8 * 8;
                join::<3>(left, (from, stride), to);
            }
            (4, _) if stride_to == 4 => {
                left = columns / 8 * 8;
                join::<4>(left, (from, stride), to);
            }
            _ => {}
        }
    }
    for i in (top..rows).step_by(8) {
        let height = (rows - i).min(8);
        for j in (left..columns).step_by(8) {
            let width = (columns - j).min(8);
            // SAFETY: the tile, cut to the block, lies in both slices; what a mask leaves out is not accessed.
            unsafe {
                let (tile, turned) = (from.add(i * stride + j), to.add(j * stride_to + i));
                if height == 8 && width == 8 {
                    let r = eight(|k| _mm512_loadu_pd(tile.add(k * stride)));
                    for (k, row) in turn_8x8(r).into_iter().enumerate() {
                        _mm512_storeu_pd(turned.add(k * stride_to), row);
                    }
                } else {
                    let mask = 0xFF >> (8 - width);
                    let r = eight(|k| {
                        if k < height {
                            _mm512_maskz_loadu_pd(mask, tile.add(k * stride))
                        } else {
                            _mm512_setzero_pd()
                        }
                    });
                    let mask = 0xFF >> (8 - height);
                    for (k, row) in turn_8x8(r).into_iter().enumerate().take(width) {
                        _mm512_mask_storeu_pd(turned.add(k * stride_to), mask, row);
                    }
                }
            }
        }
    }
}

#[inline(always)]
fn eight<V>(row: impl Fn(usize) -> V) -> [V; 8] {
    [row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7)]
}

#[inline]
#[target_feature(enable = "avx512f")]
fn turn_8x8(r: [__m512d; 8]) -> [__m512d; 8] {
    // Pairs of rows: quarter q of `even` is (row 2p column 2q, row 2p + 1 column 2q), of `odd` the columns 2q + 1.
    let even = [0, 2, 4, 6].map(|p| _mm512_unpacklo_pd(r[p], r[p + 1]));
    let odd = [0, 2, 4, 6].map(|p| _mm512_unpackhi_pd(r[p], r[p + 1]));
    let [c0, c2, c4, c6] = turn_quarters(even);
    let [c1, c3, c5, c7] = turn_quarters(odd);
    [c0, c1, c2, c3, c4, c5, c6, c7]
}

/// Turns a 4 × 4 tile of quarters of vectors.
#[inline]
#[target_feature(enable = "avx512f")]
fn turn_quarters([a, b, c, d]: [__m512d; 4]) -> [__m512d; 4] {
    let (ab_low, ab_high) =
        (_mm512_shuffle_f64x2::<0x44>(a, b), _mm512_shuffle_f64x2::<0xEE>(a, b));
    let (cd_low, cd_high) =
        (_mm512_shuffle_f64x2::<0x44>(c, d), _mm512_shuffle_f64x2::<0xEE>(c, d));
    [
        _mm512_shuffle_f64x2::<0x88>(ab_low, cd_low),
        _mm512_shuffle_f64x2::<0xDD>(ab_low, cd_low),
        _mm512_shuffle_f64x2::<0x88>(ab_high, cd_high),
        _mm512_shuffle_f64x2::<0xDD>(ab_high, cd_high),
    ]
}

/// Copies past the caches; the ends that are no whole line are copied as always.
pub(super) fn stream(level: Level, from: &[u8], to: &mut [u8]) {
    let head = to.as_ptr().align_offset(64).min(to.len());
    let body = (to.len() - head) / 64 * 64;
    to[..head].copy_from_slice(&from[..head]);
    match level {
        // SAFETY: the value proves that the processor has AVX-512F.
        Level::Avx512(_) => unsafe {
            stream_avx512(&from[head..head + body], &mut to[head..head + body]);
        },
        // SAFETY: the value proves that the processor has AVX2.
        Level::Avx2(_) => unsafe {
            stream_avx2(&from[head..head + body], &mut to[head..head + body]);
        },
        Level::Portable => to[head..head + body].copy_from_slice(&from[head..head + body]),
    }
    to[head + body..].copy_from_slice(&from[head + body..]);
}

#[target_feature(enable = "avx512f")]
fn stream_avx512(from: &[u8], to: &mut [u8]) {
    for (from, to) in from.chunks_exact(64).zip(to.chunks_exact_mut(64)) {
        // SAFETY: 64 bytes each; `to` starts at a multiple of 64.
        unsafe {
            _mm512_stream_si512(to.as_mut_ptr().cast(), _mm512_loadu_si512(from.as_ptr().cast()));
        }
    }
}

#[target_feature(enable = "avx2")]
fn stream_avx2(from: &[u8], to: &mut [u8]) {
    for (from, to) in from.chunks_exact(32).zip(to.chunks_exact_mut(32)) {
        // SAFETY: 32 bytes each; `to` starts at a multiple of 64.
        unsafe {
            _mm256_stream_si256(to.as_mut_ptr().cast(), _mm256_loadu_si256(from.as_ptr().cast()));
        }
    }
}

/// Asks for the lines of `part` before they are needed: strides of a matrix are beyond what the processor foresees.
pub(super) fn fetch(part: &[u8]) {
    let begin = part.as_ptr() as usize % 64;
    for at in (0..begin + part.len()).step_by(64) {
        // SAFETY: every x86-64 has the instruction, and it never faults.
        unsafe {
            _mm_prefetch::<_MM_HINT_T0>(part.as_ptr().wrapping_sub(begin).wrapping_add(at).cast())
        };
    }
}

pub(super) fn fence() {
    // SAFETY: every x86-64 has the instruction.
    unsafe { _mm_sfence() }
}
