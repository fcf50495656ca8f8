//! Eight lanes in two 256-bit registers.

use std::arch::x86_64::*;

use taut_points::{Scalar, ScalarKind};

use crate::lanes::Lanes;

// Macros, as closures do not have the features of the function around them, and are then not always inlined: the
// instructions in them become calls.

/// Of two rows: [a₀₁, b₀₁, a₂₃, b₂₃] with both halves of each row already added.
macro_rules! pair {
    ($a:expr, $b:expr) => {
        _mm256_hadd_pd(_mm256_add_pd($a.0, $a.1), _mm256_add_pd($b.0, $b.1))
    };
}

/// Sums of the halves of two pairs.
macro_rules! four {
    ($a:expr, $b:expr) => {{
        let (a, b) = ($a, $b);
        _mm256_add_pd(_mm256_permute2f128_pd::<0x20>(a, b), _mm256_permute2f128_pd::<0x31>(a, b))
    }};
}

/// Lanes 0, 2, 1, 3.
macro_rules! in_order {
    ($v:expr) => {
        _mm256_permute4x64_pd::<0b11_01_10_00>($v)
    };
}

/// The columns of four rows of four.
macro_rules! square {
    ($a:expr, $b:expr, $c:expr, $d:expr) => {{
        let (ab_even, ab_odd) = (_mm256_unpacklo_pd($a, $b), _mm256_unpackhi_pd($a, $b));
        let (cd_even, cd_odd) = (_mm256_unpacklo_pd($c, $d), _mm256_unpackhi_pd($c, $d));
        [
            _mm256_permute2f128_pd::<0x20>(ab_even, cd_even),
            _mm256_permute2f128_pd::<0x20>(ab_odd, cd_odd),
            _mm256_permute2f128_pd::<0x31>(ab_even, cd_even),
            _mm256_permute2f128_pd::<0x31>(ab_odd, cd_odd),
        ]
    }};
}

/// Two values at each of two places.
macro_rules! two {
    ($a:expr, $b:expr) => {
        _mm256_insertf128_pd::<1>(_mm256_castpd128_pd256(_mm_loadu_pd($a)), _mm_loadu_pd($b))
    };
}

#[derive(Clone, Copy)]
pub(super) struct Avx2(__m256d, __m256d);

// SAFETY (all blocks of this implementation): the caller promises AVX2 and FMA, and readable memory where one is
// given. `T` is f32 or f64 and nothing else (the trait is sealed), so a cast guided by `KIND` keeps the type.
/// Four masks for `f64` from four for `f32`.
macro_rules! four_masks {
    ($from:expr) => {
        _mm256_cvtepi32_epi64(_mm_loadu_si128($from.cast()))
    };
}

/// Eight masks of a lane that is read, and eight of one that is not. A mask rather than a copy: a copy of single values is loaded back
/// as a vector before it is in the cache, which made rows of ten coordinates take four times as long.
const FIRST_LANES: [i32; 16] = [-1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0, 0, 0, 0, 0, 0];

impl Lanes for Avx2 {
    const IN_REGISTERS: usize = 8;

    #[inline(always)]
    unsafe fn zero() -> Self {
        // SAFETY: see above.
        unsafe { Avx2(_mm256_setzero_pd(), _mm256_setzero_pd()) }
    }

    #[inline(always)]
    unsafe fn load<T: Scalar>(from: *const T) -> Self {
        // SAFETY: see above.
        unsafe {
            match T::KIND {
                ScalarKind::F32 => {
                    let from: *const f32 = from.cast();
                    Avx2(
                        _mm256_cvtps_pd(_mm_loadu_ps(from)),
                        _mm256_cvtps_pd(_mm_loadu_ps(from.add(4))),
                    )
                }
                ScalarKind::F64 => {
                    let from: *const f64 = from.cast();
                    Avx2(_mm256_loadu_pd(from), _mm256_loadu_pd(from.add(4)))
                }
            }
        }
    }

    #[inline(always)]
    unsafe fn load_first<T: Scalar>(from: *const T, count: usize) -> Self {
        debug_assert!(count < 8);
        // SAFETY: see above; only `count` values are read, as lanes that a mask leaves out are not; both parts of the mask lie within
        // `FIRST_LANES`; `T` is f32 or f64 and nothing else, so a cast guided by `KIND` keeps the type.
        unsafe {
            let mask = FIRST_LANES.as_ptr().add(8 - count);
            match T::KIND {
                ScalarKind::F32 => {
                    let from = from.cast::<f32>();
                    let low = _mm_maskload_ps(from, _mm_loadu_si128(mask.cast()));
                    let high =
                        _mm_maskload_ps(from.wrapping_add(4), _mm_loadu_si128(mask.add(4).cast()));
                    Avx2(_mm256_cvtps_pd(low), _mm256_cvtps_pd(high))
                }
                ScalarKind::F64 => {
                    let from = from.cast::<f64>();
                    let low = _mm256_maskload_pd(from, four_masks!(mask));
                    Avx2(low, _mm256_maskload_pd(from.wrapping_add(4), four_masks!(mask.add(4))))
                }
            }
        }
    }

    #[inline(always)]
    unsafe fn sub(self, other: Self) -> Self {
        // SAFETY: see above.
        unsafe { Avx2(_mm256_sub_pd(self.0, other.0), _mm256_sub_pd(self.1, other.1)) }
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        // SAFETY: see above.
        unsafe { Avx2(_mm256_add_pd(self.0, other.0), _mm256_add_pd(self.1, other.1)) }
    }

    #[inline(always)]
    unsafe fn square_add(self, sum: Self) -> Self {
        // SAFETY: see above.
        unsafe {
            Avx2(_mm256_fmadd_pd(self.0, self.0, sum.0), _mm256_fmadd_pd(self.1, self.1, sum.1))
        }
    }

    #[inline(always)]
    unsafe fn sum_each(rows: [Self; 8]) -> [f64; 8] {
        // SAFETY: see above.
        unsafe {
            let mut sums = [0.0; 8];
            _mm256_storeu_pd(
                sums.as_mut_ptr(),
                four!(pair!(rows[0], rows[1]), pair!(rows[2], rows[3])),
            );
            _mm256_storeu_pd(
                sums.as_mut_ptr().add(4),
                four!(pair!(rows[4], rows[5]), pair!(rows[6], rows[7])),
            );
            sums
        }
    }

    #[inline(always)]
    unsafe fn broadcast(value: f64) -> Self {
        // SAFETY: see above.
        unsafe { Avx2(_mm256_set1_pd(value), _mm256_set1_pd(value)) }
    }

    #[inline(always)]
    unsafe fn multiply_add(self, factor: Self, sum: Self) -> Self {
        // SAFETY: see above.
        unsafe {
            Avx2(_mm256_fmadd_pd(self.0, factor.0, sum.0), _mm256_fmadd_pd(self.1, factor.1, sum.1))
        }
    }

    #[inline(always)]
    unsafe fn multiply_add_one(a: f64, b: f64, sum: f64) -> f64 {
        a.mul_add(b, sum)
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f64) {
        // SAFETY: see above.
        unsafe {
            _mm256_storeu_pd(to, self.0);
            _mm256_storeu_pd(to.add(4), self.1);
        }
    }

    #[inline(always)]
    unsafe fn prefetch(at: *const u8) {
        // SAFETY: see above; a prefetch reads nothing that the program sees.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(at.cast()) }
    }

    #[inline(always)]
    unsafe fn bits_above(self, bound: Self) -> u32 {
        // SAFETY: see above.
        unsafe {
            let low = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(self.0, bound.0));
            let high = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(self.1, bound.1));
            (low | high << 4) as u32
        }
    }

    #[inline(always)]
    unsafe fn split(first: Self, second: Self) -> (Self, Self) {
        // SAFETY: see above.
        unsafe {
            (
                Avx2(
                    in_order!(_mm256_unpacklo_pd(first.0, first.1)),
                    in_order!(_mm256_unpacklo_pd(second.0, second.1)),
                ),
                Avx2(
                    in_order!(_mm256_unpackhi_pd(first.0, first.1)),
                    in_order!(_mm256_unpackhi_pd(second.0, second.1)),
                ),
            )
        }
    }

    #[inline(always)]
    unsafe fn pairs(starts: [*const f64; 8]) -> (Self, Self) {
        // SAFETY: see above.
        unsafe {
            // Rows 0, 2, 1, 3 of four: interleaved with the other two they are in order.
            let (first, last) = (two!(starts[0], starts[2]), two!(starts[4], starts[6]));
            let (second, fourth) = (two!(starts[1], starts[3]), two!(starts[5], starts[7]));
            (
                Avx2(_mm256_unpacklo_pd(first, second), _mm256_unpacklo_pd(last, fourth)),
                Avx2(_mm256_unpackhi_pd(first, second), _mm256_unpackhi_pd(last, fourth)),
            )
        }
    }

    /// Four squares of four rows and four columns.
    #[inline(always)]
    unsafe fn transpose(rows: [Self; 8]) -> [Self; 8] {
        // SAFETY: see above.
        unsafe {
            let first = [
                square!(rows[0].0, rows[1].0, rows[2].0, rows[3].0),
                square!(rows[4].0, rows[5].0, rows[6].0, rows[7].0),
            ];
            let last = [
                square!(rows[0].1, rows[1].1, rows[2].1, rows[3].1),
                square!(rows[4].1, rows[5].1, rows[6].1, rows[7].1),
            ];
            [
                Avx2(first[0][0], first[1][0]),
                Avx2(first[0][1], first[1][1]),
                Avx2(first[0][2], first[1][2]),
                Avx2(first[0][3], first[1][3]),
                Avx2(last[0][0], last[1][0]),
                Avx2(last[0][1], last[1][1]),
                Avx2(last[0][2], last[1][2]),
                Avx2(last[0][3], last[1][3]),
            ]
        }
    }
}
