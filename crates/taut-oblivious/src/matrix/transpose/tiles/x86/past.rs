//! A strip turned in registers and written past the caches, without a stop in between.
//!
//! *Idea.* Eight rows of the strip give each row of the target eight more elements. A line of the target begins `head`
//! elements into a row, so the last eight elements of a row wait in `before`, and each line is put together from those
//! that waited and those that came.
//! *Guarantee.* Lines of the target are written whole, once; the elements before the first and after the last line of a
//! row go one at a time.
//! *Trap.* Each side walks over pages of 4 KiB, and the processor translates the address of a page only when it is accessed:
//! where narrow rows are split or joined, an access of each page two pages early makes 15 GB/s of 10⁷ × 3 into 19, above a plain
//! copy past the caches. Lines that are fetched early within their page gain nothing there.
//! *Trap.* Reading a block and then writing it costs the sum of both, not the longer: measured, copying in blocks of
//! 16 KiB runs at two thirds of copying line by line.
#![allow(unsafe_code, reason = "loads, stores and shuffles of whole vectors")]

use std::arch::x86_64::*;

use super::{eight, lanes, turn_8x8};

/// Most columns of a strip.
pub(in crate::matrix::transpose) const STRIP_COLUMNS_MAX: usize = 128;
/// This many columns lie between the tile and what is fetched early, in its own rows and, at the end of the strip, in
/// the next ones: rows whose stride is a power of two share a set of the cache, which eight lines fill.
const PREFETCH_COLUMNS: usize = 40;
/// Elements of a page of memory.
const PAGE: usize = 512;

/// Element (i, c) of a strip of `rows` rows, row i at `from + i · stride`, goes to `to[c · stride_to + i]`; any width.
///
/// # Safety
/// The processor has AVX-512F, both sides hold the strip, `to` is a multiple of 8, and there are at most [`STRIP_COLUMNS_MAX`] columns.
#[target_feature(enable = "avx512f")]
pub(super) unsafe fn walk(
    (rows, columns): (usize, usize),
    (from, stride): (*const f64, usize),
    (to, stride_to): (*mut f64, usize),
) {
    let mut before = [_mm512_setzero_pd(); STRIP_COLUMNS_MAX];
    let mut pick = [_mm512_setzero_si512(); STRIP_COLUMNS_MAX];
    let mut head = [0; STRIP_COLUMNS_MAX];
    for c in 0..columns {
        head[c] = to.wrapping_add(c * stride_to).align_offset(64);
        pick[c] = from_waiting(head[c]);
    }
    // Where all rows begin at the same place in a line, all tiles but the first read whole lines.
    let lead = if stride % 8 == 0 { from.align_offset(64) } else { 0 };
    // SAFETY: tiles are cut to the strip; a line of row c begins at `head[c]` and ends before the row does, as it
    // holds elements of the groups before.
    unsafe {
        for i in (0..rows / 8 * 8).step_by(8) {
            let mut j = 0;
            while j < columns {
                let width = if j < lead { lead } else { 8 }.min(columns - j);
                let tile = from.add(i * stride + j);
                let ahead = if j + PREFETCH_COLUMNS < columns {
                    j + PREFETCH_COLUMNS
                } else {
                    j + PREFETCH_COLUMNS - columns + 8 * stride
                };
                for k in 0..8 {
                    // An address, no access: beyond the matrix nothing happens.
                    let next = from.wrapping_add((i + k) * stride + ahead);
                    _mm_prefetch::<_MM_HINT_T0>(next.cast());
                }
                let turned = if width == 8 {
                    turn_8x8(eight(|k| _mm512_loadu_pd(tile.add(k * stride))))
                } else {
                    let mask = 0xFF >> (8 - width);
                    turn_8x8(eight(|k| _mm512_maskz_loadu_pd(mask, tile.add(k * stride))))
                };
                for k in 0..width {
                    let c = j + k;
                    if i > 0 {
                        let line = _mm512_permutex2var_pd(before[c], pick[c], turned[k]);
                        _mm512_stream_pd(to.add(c * stride_to + head[c] + i - 8), line);
                    }
                    before[c] = turned[k];
                }
                j += width;
            }
        }
        for c in 0..columns {
            ends((rows, c), (from, stride), (to, stride_to), head[c]);
        }
    }
}

/// [`walk`] over rows of `D` adjacent elements.
///
/// # Safety
/// As of [`walk`].
#[target_feature(enable = "avx512f")]
pub(super) unsafe fn split<const D: usize>(rows: usize, from: *const f64, to: *mut f64) {
    let table = split_table::<D>();
    let head: [usize; D] = std::array::from_fn(|c| to.wrapping_add(c * rows).align_offset(64));
    let pick: [__m512i; D] = std::array::from_fn(|c| from_waiting(head[c]));
    let mut before = [_mm512_setzero_pd(); D];
    // SAFETY: whole groups of eight rows; lines as in `walk`.
    unsafe {
        for i in (0..rows / 8 * 8).step_by(8) {
            if i % PAGE == 0 {
                for c in 0..D {
                    access_early(from.wrapping_add(i * D + (c + 2 * D) * PAGE));
                    access_early(to.wrapping_add(c * rows + i + 2 * PAGE));
                }
            }
            let columns = split_eight::<D>(&table, from.add(i * D));
            for c in 0..D {
                if i > 0 {
                    let line = _mm512_permutex2var_pd(before[c], pick[c], columns[c]);
                    _mm512_stream_pd(to.add(c * rows + head[c] + i - 8), line);
                }
                before[c] = columns[c];
            }
        }
        for c in 0..D {
            ends((rows, c), (from, D), (to, rows), head[c]);
        }
    }
}

/// `D` rows of `columns` elements, row c at `from + c · stride`, become `columns` rows of `D` adjacent elements.
///
/// # Safety
/// The processor has AVX-512F, both sides hold the matrix, and `to` is a multiple of 8.
#[target_feature(enable = "avx512f")]
pub(super) unsafe fn join<const D: usize>(
    columns: usize,
    (from, stride): (*const f64, usize),
    to: *mut f64,
) {
    let table = join_table::<D>();
    let head = to.align_offset(64);
    let pick = from_waiting(head);
    let mut before = _mm512_setzero_pd();
    let single = |e: usize| {
        // SAFETY: element e of the target, row e mod `D` of the source.
        unsafe { *to.add(e) = *from.add(e % D * stride + e / D) }
    };
    let groups = columns / 8;
    (0..head.min(columns * D)).for_each(single);
    // SAFETY: whole groups of eight columns; a line ends before the last element that came.
    unsafe {
        for j in 0..groups {
            if 8 * j % PAGE == 0 {
                for c in 0..D {
                    access_early(from.wrapping_add(c * stride + 8 * j + 2 * PAGE));
                    access_early(to.wrapping_add(8 * j * D + (c + 2 * D) * PAGE));
                }
            }
            let parts = join_eight::<D>(&table, (from.add(8 * j), stride));
            for m in 0..D {
                let at = 8 * (j * D + m);
                if at > 0 {
                    let line = _mm512_permutex2var_pd(before, pick, parts[m]);
                    _mm512_stream_pd(to.add(head + at - 8), line);
                }
                before = parts[m];
            }
        }
    }
    (head + (8 * groups * D).saturating_sub(8)..columns * D).for_each(single);
}

/// Has the processor translate an address, by asking for its line: no access, so that it may be beyond the matrix.
#[inline(always)]
fn access_early(address: *const f64) {
    // SAFETY: every x86-64 has the instruction, and it never faults.
    unsafe { _mm_prefetch::<_MM_HINT_NTA>(address.cast()) };
}

/// The elements of column c that are in no whole line.
///
/// # Safety
/// Both sides hold the strip, of which column c is one.
#[inline]
unsafe fn ends(
    (rows, c): (usize, usize),
    (from, stride): (*const f64, usize),
    (to, stride_to): (*mut f64, usize),
    head: usize,
) {
    let lines_end = head + (rows / 8 * 8).saturating_sub(8);
    for i in (0..head.min(rows)).chain(lines_end..rows) {
        // SAFETY: element (i, c) of the strip.
        unsafe { *to.add(c * stride_to + i) = *from.add(i * stride + c) }
    }
}

/// Indices that take what waited from lane `head` on, and then what came.
#[inline]
#[target_feature(enable = "avx512f")]
fn from_waiting(head: usize) -> __m512i {
    lanes(|i| head + i)
}

/// `table[c][m]`: where the elements of column c are in vector m of eight rows of `D` elements.
#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn split_table<const D: usize>() -> [[__m512i; D]; D] {
    std::array::from_fn(|c| {
        std::array::from_fn(|m| {
            lanes(|i| if (c + i * D) / 8 == m { 8 + (c + i * D) % 8 } else { i })
        })
    })
}

/// Eight rows of `D` adjacent elements as `D` vectors.
///
/// # Safety
/// The processor has AVX-512F, and 8 · `D` elements from `from` on are readable.
#[inline]
#[target_feature(enable = "avx512f")]
pub(super) unsafe fn split_eight<const D: usize>(
    table: &[[__m512i; D]; D],
    from: *const f64,
) -> [__m512d; D] {
    // SAFETY: the caller vouches for 8 · `D` elements.
    let v: [__m512d; D] = std::array::from_fn(|m| unsafe { _mm512_loadu_pd(from.add(8 * m)) });
    gather(table, v)
}

/// `table[m][c]`: where the elements of row c are in vector m of eight rows of `D` elements.
#[inline]
#[target_feature(enable = "avx512f")]
pub(super) fn join_table<const D: usize>() -> [[__m512i; D]; D] {
    std::array::from_fn(|m| {
        std::array::from_fn(|c| {
            lanes(|i| if (8 * m + i) % D == c { 8 + (8 * m + i) / D } else { i })
        })
    })
}

/// Eight columns of `D` rows as eight rows of `D` adjacent elements.
///
/// # Safety
/// The processor has AVX-512F, and 8 elements of each of `D` rows are readable.
#[inline]
#[target_feature(enable = "avx512f")]
pub(super) unsafe fn join_eight<const D: usize>(
    table: &[[__m512i; D]; D],
    (from, stride): (*const f64, usize),
) -> [__m512d; D] {
    // SAFETY: the caller vouches for `D` rows of 8 elements.
    let v: [__m512d; D] = std::array::from_fn(|c| unsafe { _mm512_loadu_pd(from.add(c * stride)) });
    gather(table, v)
}

/// Each vector of the answer collects its lanes from all of `v`.
#[inline]
#[target_feature(enable = "avx512f")]
fn gather<const D: usize>(table: &[[__m512i; D]; D], v: [__m512d; D]) -> [__m512d; D] {
    let mut all = [v[0]; D];
    for (answer, picks) in all.iter_mut().zip(table) {
        for (m, &pick) in picks.iter().enumerate() {
            *answer = _mm512_permutex2var_pd(*answer, pick, v[m]);
        }
    }
    all
}
