//! Eight 64-bit keys at a time: the partition and the sorting network under [`super::quick`], on x86-64 with AVX-512.
//!
//! *Idea.* Partition in place: eight keys are compared with the pivot at once, one look-up turns the mask into a
//! permutation that brings the smaller keys to the front, and the vector is stored whole at both ends of the gap;
//! what is stored too much lies in the gap and is overwritten later. Up to 128 keys are the columns of a matrix: a
//! network sorts all columns at once, bitonic merges join them two by two, a transposition puts them in order.
//! *Guarantee.* A value of [`Avx512`] proves that the processor has the instructions. Loads and stores stay within the
//! slice: the gap never shrinks below what is stored, as `partition` argues.
//! *Trap.* Storing compressed lanes to memory is microcode on several processors; permuting in a register is not.
//! *References.* B. Bramas, *A novel hybrid quicksort algorithm vectorized using AVX-512*, IJACSA 8(10), 2017;
//! M. Blacher, J. Giesen, P. Sanders, J. Wassenberg, *Vectorized and performance-portable quicksort*, Softw. Pract.
//! Exp. 52(12), 2022; D. Knuth, *The Art of Computer Programming* 3, 5.3.4 (M. Green's network of 60 comparators).
#![allow(
    unsafe_code,
    reason = "loads, stores and instructions of AVX-512, behind a proof that the processor has them"
)]

use std::arch::x86_64::*;

use crate::level::Avx512;

/// Keys in a vector.
const LANES: usize = 8;
/// Keys that are read from one end before the other end is looked at: four vectors.
const CHUNK: usize = 4 * LANES;
/// One network sorts at most this many keys.
pub(super) const NETWORK_KEYS_MAX: usize = 16 * LANES;
/// Fewest keys that [`Avx512::partition`] takes.
pub(super) const PARTITION_MIN: usize = 2 * CHUNK;

impl Avx512 {
    /// Brings the keys below `pivot`, with `inclusive` also those equal to it, to the front and returns their number.
    ///
    /// # Panics
    /// If there are fewer than [`PARTITION_MIN`] keys.
    pub(in crate::sort) fn partition(self, keys: &mut [u64], pivot: u64, inclusive: bool) -> usize {
        assert!(keys.len() >= PARTITION_MIN, "{} keys are too few", keys.len());
        // SAFETY: `self` proves that the processor has the features.
        unsafe {
            if inclusive { partition::<true>(keys, pivot) } else { partition::<false>(keys, pivot) }
        }
    }

    /// A key near the median: the median of the medians of eight columns of seven.
    pub(in crate::sort) fn near_median(self, sample: &[u64; 7 * LANES]) -> u64 {
        // SAFETY: `self` proves that the processor has the features.
        unsafe { near_median(sample) }
    }

    /// Sorts at most [`NETWORK_KEYS_MAX`] keys.
    ///
    /// # Panics
    /// If there are more.
    pub(in crate::sort) fn small(self, keys: &mut [u64]) {
        assert!(keys.len() <= NETWORK_KEYS_MAX, "{} keys are too many", keys.len());
        // SAFETY: `self` proves that the processor has the features.
        unsafe {
            if keys.len() <= NETWORK_KEYS_MAX / 2 {
                columns_8(keys);
            } else {
                columns_16(keys);
            }
        }
    }
}

/// For each mask, the lanes whose bit is set and then the others, a byte each.
static FRONT: [u64; 256] = {
    let mut table = [0; 256];
    let mut mask = 0;
    while mask < 256 {
        let (mut order, mut place, mut half) = (0u64, 0, 0);
        while half < 2 {
            let mut lane = 0;
            while lane < 8 {
                if (mask >> lane) & 1 != half {
                    order |= lane << (8 * place);
                    place += 1;
                }
                lane += 1;
            }
            half += 1;
        }
        table[mask as usize] = order;
        mask += 1;
    }
    table
};

/// Which of eight keys go to the front.
#[target_feature(enable = "avx512f")]
#[inline]
fn below<const INCLUSIVE: bool>(v: __m512i, pivots: __m512i) -> u8 {
    if INCLUSIVE { _mm512_cmple_epu64_mask(v, pivots) } else { _mm512_cmplt_epu64_mask(v, pivots) }
}

/// The free places `low..high`, as far as they have been told apart.
struct Gap {
    base: *mut u64,
    low: usize,
    high: usize,
}

impl Gap {
    /// Puts a vector's keys where they belong.
    ///
    /// # Safety
    /// The eight places from `low` and the eight places up to `high` are free and belong to the slice.
    #[target_feature(enable = "avx512f,popcnt")]
    #[inline]
    unsafe fn put<const INCLUSIVE: bool>(&mut self, v: __m512i, pivots: __m512i) {
        let mask = below::<INCLUSIVE>(v, pivots);
        let order = _mm512_cvtepu8_epi64(_mm_cvtsi64_si128(FRONT[mask as usize] as i64));
        let sorted = _mm512_permutexvar_epi64(order, v);
        let less = mask.count_ones() as usize;
        // SAFETY: the caller promises the eight places from `low` on and those up to `high`.
        unsafe {
            _mm512_storeu_si512(self.base.add(self.low).cast(), sorted);
            _mm512_storeu_si512(self.base.add(self.high - LANES).cast(), sorted);
        }
        self.low += less;
        self.high -= LANES - less;
    }
}

#[target_feature(enable = "avx512f,popcnt")]
fn partition<const INCLUSIVE: bool>(keys: &mut [u64], pivot: u64) -> usize {
    let (pivots, n) = (_mm512_set1_epi64(pivot as i64), keys.len());
    let tail = n % CHUNK;
    let rest = load::<4>(&keys[n - tail..]);
    let base = keys.as_mut_ptr();
    // `low..high` is still to be read; `gap.low..low` and `high..gap.high` are free.
    let (mut low, mut high) = (CHUNK, n - tail - CHUNK);
    let mut gap = Gap { base, low: 0, high: n };
    // SAFETY: all of `base..base + n` is the slice, and n ≥ 2·CHUNK. The first chunk, the last
    // whole chunk and the keys behind it are read before anything is written. In the loop `high − low` is a positive
    // multiple of CHUNK. At the head of a round the two gaps together hold 2·CHUNK + tail places; the smaller one is
    // read from, after which both hold CHUNK at least: this one as it grew by that much, the other as it is no less
    // than half of 2·CHUNK. The four stores of a round take 4·8 places of both together, so each finds 8 in either.
    // After the loop there is one gap of 2·CHUNK + tail places, of which each whole vector takes 8. Where fewer than
    // 16 are left, they are 8, as the partial vector went first, and both stores are the same.
    unsafe {
        let load = |at: usize| {
            let lane = |i: usize| _mm512_loadu_si512(base.add(at + i * LANES).cast());
            [lane(0), lane(1), lane(2), lane(3)]
        };
        let (held, mut chunk) = (load(0), load(high));
        while low < high {
            // Which end is a coin toss that no processor predicts: arithmetic instead of a jump. What is read is put
            // a round later, so that the toss does not wait for it.
            let from_high = usize::from(low - gap.low > gap.high - high);
            high -= from_high * CHUNK;
            let next = load(low + from_high * (high - low));
            low += (1 - from_high) * CHUNK;
            for v in chunk {
                gap.put::<INCLUSIVE>(v, pivots);
            }
            chunk = next;
        }
        let (whole, partial) = (tail / LANES, tail % LANES);
        if partial > 0 {
            let valid = (1u8 << partial) - 1;
            let v = rest[whole];
            let less = valid & below::<INCLUSIVE>(v, pivots);
            let more = valid & !less;
            let ones = |count: u32| ((1u16 << count) - 1) as u8;
            let (less_keys, more_keys) =
                (_mm512_maskz_compress_epi64(less, v), _mm512_maskz_compress_epi64(more, v));
            let (less, more) = (less.count_ones(), more.count_ones());
            _mm512_mask_storeu_epi64(base.add(gap.low).cast(), ones(less), less_keys);
            gap.low += less as usize;
            gap.high -= more as usize;
            _mm512_mask_storeu_epi64(base.add(gap.high).cast(), ones(more), more_keys);
        }
        for &v in &rest[..whole] {
            gap.put::<INCLUSIVE>(v, pivots);
        }
        for v in chunk.into_iter().chain(held) {
            gap.put::<INCLUSIVE>(v, pivots);
        }
    }
    gap.low
}

/// Lanes `i ^ BY`: a reversal of groups if `BY + 1` is a power of two, an exchange of columns if `BY` is one.
#[target_feature(enable = "avx512f")]
#[inline]
fn exchange<const BY: i64>(v: __m512i) -> __m512i {
    let order = _mm512_setr_epi64(BY, 1 ^ BY, 2 ^ BY, 3 ^ BY, 4 ^ BY, 5 ^ BY, 6 ^ BY, 7 ^ BY);
    _mm512_permutexvar_epi64(order, v)
}

/// Puts the smaller key of each lane first.
#[target_feature(enable = "avx512f")]
#[inline]
fn compare(a: &mut __m512i, b: &mut __m512i) {
    (*a, *b) = (_mm512_min_epu64(*a, *b), _mm512_max_epu64(*a, *b));
}

/// The first step of joining columns two by two, four by four or all: row `a` against the row as far from the other
/// end, in which the order of the columns of a group is reversed. `UPPER` has a bit for each lane in the second half
/// of its group, where the larger keys go.
#[target_feature(enable = "avx512f")]
#[inline]
fn cross<const REVERSE: i64, const UPPER: u8>(a: &mut __m512i, b: &mut __m512i) {
    let reversed = exchange::<REVERSE>(*b);
    let (low, high) = (_mm512_min_epu64(*a, reversed), _mm512_max_epu64(*a, reversed));
    *a = _mm512_mask_mov_epi64(low, UPPER, high);
    *b = exchange::<REVERSE>(_mm512_mask_mov_epi64(high, UPPER, low));
}

/// Compares columns whose numbers differ in one bit.
#[target_feature(enable = "avx512f")]
#[inline]
fn beside<const BY: i64, const UPPER: u8>(row: &mut __m512i) {
    let other = exchange::<BY>(*row);
    *row = _mm512_mask_max_epu64(_mm512_min_epu64(*row, other), UPPER, *row, other);
}

/// Applies a step to rows, or to pairs of rows, that are named one by one: a loop would keep them in memory.
macro_rules! each {
    ($step:path, $v:ident: $($i:literal $j:literal),+) => {$(
        let (front, back) = $v.split_at_mut($j);
        $step(&mut front[$i], &mut back[0]);
    )+};
    ($step:path, $v:ident, $($i:literal)+) => {$( $step(&mut $v[$i]); )+};
}

/// Defines the sort of up to `$rows` · 8 keys: a network for a column, and joins of two, four and eight columns.
macro_rules! columns {
    ($name:ident, $rows:literal, column: $column:tt, ends: $ends:tt, bitonic: $bitonic:tt, all: $all:tt) => {
        #[target_feature(enable = "avx512f")]
        fn $name(keys: &mut [u64]) {
            let mut v = load::<$rows>(keys);
            columns!(@pairs compare, v $column);
            columns!(@pairs cross::<1, 0xAA>, v $ends);
            columns!(@pairs compare, v $bitonic);
            columns!(@pairs cross::<3, 0xCC>, v $ends);
            columns!(@rows beside::<1, 0xAA>, v $all);
            columns!(@pairs compare, v $bitonic);
            columns!(@pairs cross::<7, 0xF0>, v $ends);
            columns!(@rows beside::<2, 0xCC>, v $all);
            columns!(@rows beside::<1, 0xAA>, v $all);
            columns!(@pairs compare, v $bitonic);
            store::<$rows>(keys, &v);
        }
    };
    (@pairs $step:path, $v:ident { $($pairs:tt)+ }) => { each!($step, $v: $($pairs)+) };
    (@rows $step:path, $v:ident { $($rows:tt)+ }) => { each!($step, $v, $($rows)+) };
}

columns! {
    columns_8, 8,
    column: {
        0 1, 2 3, 4 5, 6 7, 0 2, 1 3, 4 6, 5 7, 1 2, 5 6,
        0 4, 3 7, 1 5, 2 6, 1 4, 3 6, 2 4, 3 5, 3 4
    },
    ends: { 0 7, 1 6, 2 5, 3 4 },
    bitonic: { 0 4, 1 5, 2 6, 3 7, 0 2, 1 3, 4 6, 5 7, 0 1, 2 3, 4 5, 6 7 },
    all: { 0 1 2 3 4 5 6 7 }
}

columns! {
    columns_16, 16,
    column: {
        0 1, 2 3, 4 5, 6 7, 8 9, 10 11, 12 13, 14 15,
        0 2, 4 6, 8 10, 12 14, 1 3, 5 7, 9 11, 13 15,
        0 4, 8 12, 1 5, 9 13, 2 6, 10 14, 3 7, 11 15,
        0 8, 1 9, 2 10, 3 11, 4 12, 5 13, 6 14, 7 15,
        5 10, 6 9, 3 12, 13 14, 4 8, 7 11, 1 2,
        1 4, 7 13, 2 8, 11 14, 5 6, 9 10,
        2 4, 11 13, 3 8, 7 12,
        6 8, 10 12, 3 5, 7 9,
        3 4, 5 6, 7 8, 9 10, 11 12,
        6 7, 8 9
    },
    ends: { 0 15, 1 14, 2 13, 3 12, 4 11, 5 10, 6 9, 7 8 },
    bitonic: {
        0 8, 1 9, 2 10, 3 11, 4 12, 5 13, 6 14, 7 15,
        0 4, 1 5, 2 6, 3 7, 8 12, 9 13, 10 14, 11 15,
        0 2, 1 3, 4 6, 5 7, 8 10, 9 11, 12 14, 13 15,
        0 1, 2 3, 4 5, 6 7, 8 9, 10 11, 12 13, 14 15
    },
    all: { 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 }
}

#[target_feature(enable = "avx512f")]
fn near_median(sample: &[u64; 7 * LANES]) -> u64 {
    let mut v = load::<7>(sample);
    columns!(@pairs compare, v {
        0 6, 2 3, 4 5, 0 2, 1 4, 3 6, 0 1, 2 5, 3 4, 1 2, 4 6, 2 3, 4 5, 1 2, 3 4, 5 6
    });
    // A bitonic sort of the lanes of one vector.
    let mut medians = v[3];
    beside::<1, 0xAA>(&mut medians);
    beside::<3, 0xCC>(&mut medians);
    beside::<1, 0xAA>(&mut medians);
    beside::<7, 0xF0>(&mut medians);
    beside::<2, 0xCC>(&mut medians);
    beside::<1, 0xAA>(&mut medians);
    let mut sorted = [0; LANES];
    store_one(&mut sorted, medians);
    sorted[LANES / 2]
}

#[target_feature(enable = "avx512f")]
#[inline]
fn store_one(to: &mut [u64; LANES], v: __m512i) {
    // SAFETY: eight keys of room.
    unsafe { _mm512_storeu_si512(to.as_mut_ptr().cast(), v) };
}

/// The lanes of vector `i` that `n` keys fill.
#[inline]
fn filled(n: usize, i: usize) -> u8 {
    match n.saturating_sub(i * LANES) {
        left @ 0..LANES => (1u8 << left) - 1,
        _ => u8::MAX,
    }
}

/// The keys, filled up with the largest number.
#[target_feature(enable = "avx512f")]
#[inline]
fn load<const ROWS: usize>(keys: &[u64]) -> [__m512i; ROWS] {
    let largest = _mm512_set1_epi64(-1);
    let mut v = [largest; ROWS];
    for (i, v) in v.iter_mut().enumerate() {
        let from = keys.as_ptr().wrapping_add(i * LANES).cast();
        // SAFETY: the mask leaves out what lies behind the slice.
        *v = unsafe { _mm512_mask_loadu_epi64(largest, filled(keys.len(), i), from) };
    }
    v
}

/// Writes sorted keys column by column, as many as there is room for.
#[target_feature(enable = "avx512f")]
#[inline]
fn store<const ROWS: usize>(keys: &mut [u64], v: &[__m512i; ROWS]) {
    for block in 0..ROWS / LANES {
        let square = v[block * LANES..][..LANES].try_into().expect("eight rows");
        for (column, line) in transpose(square).into_iter().enumerate() {
            let i = column * (ROWS / LANES) + block;
            let to = keys.as_mut_ptr().wrapping_add(i * LANES).cast();
            // SAFETY: the mask leaves out what lies behind the slice.
            unsafe { _mm512_mask_storeu_epi64(to, filled(keys.len(), i), line) };
        }
    }
}

/// Eight columns of eight rows as eight vectors.
#[target_feature(enable = "avx512f")]
#[inline]
fn transpose(v: &[__m512i; LANES]) -> [__m512i; LANES] {
    let pair =
        |i: usize| (_mm512_unpacklo_epi64(v[i], v[i + 1]), _mm512_unpackhi_epi64(v[i], v[i + 1]));
    // `a[k]`: rows 2k and 2k + 1; the first of a pair has the even columns, the second the odd ones.
    let a = [pair(0), pair(2), pair(4), pair(6)];
    let even = [a[0].0, a[1].0, a[2].0, a[3].0];
    let odd = [a[0].1, a[1].1, a[2].1, a[3].1];
    let [c0, c2, c4, c6] = squares(even);
    let [c1, c3, c5, c7] = squares(odd);
    [c0, c1, c2, c3, c4, c5, c6, c7]
}

/// Transposes a matrix of four by four blocks of 128 bits.
#[target_feature(enable = "avx512f")]
#[inline]
fn squares(v: [__m512i; 4]) -> [__m512i; 4] {
    let low = _mm512_shuffle_i64x2::<0x88>(v[0], v[1]);
    let high = _mm512_shuffle_i64x2::<0xDD>(v[0], v[1]);
    let low_2 = _mm512_shuffle_i64x2::<0x88>(v[2], v[3]);
    let high_2 = _mm512_shuffle_i64x2::<0xDD>(v[2], v[3]);
    [
        _mm512_shuffle_i64x2::<0x88>(low, low_2),
        _mm512_shuffle_i64x2::<0x88>(high, high_2),
        _mm512_shuffle_i64x2::<0xDD>(low, low_2),
        _mm512_shuffle_i64x2::<0xDD>(high, high_2),
    ]
}
