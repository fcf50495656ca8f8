//! Eight lanes in one 512-bit register.

use std::arch::x86_64::*;

use taut_points::{Scalar, ScalarKind};

use crate::lanes::Lanes;

// Macros, as closures do not have the features of the function around them, and are then not always inlined: the
// instructions in them become calls.

/// Sums of neighboring lanes, those of a and b in turn.
macro_rules! pair {
    ($a:expr, $b:expr) => {
        _mm512_add_pd(_mm512_unpacklo_pd($a.0, $b.0), _mm512_unpackhi_pd($a.0, $b.0))
    };
}

/// The even quarters of both operands.
macro_rules! even {
    ($a:expr, $b:expr) => {
        _mm512_shuffle_f64x2::<0b10_00_10_00>($a, $b)
    };
}

/// The odd quarters of both operands.
macro_rules! odd {
    ($a:expr, $b:expr) => {
        _mm512_shuffle_f64x2::<0b11_01_11_01>($a, $b)
    };
}

/// Sums of neighboring quarters, those of a and b in turn.
macro_rules! quarters {
    ($a:expr, $b:expr) => {{
        let (a, b) = ($a, $b);
        _mm512_add_pd(even!(a, b), odd!(a, b))
    }};
}

/// Two values at each of four places. A load that is broadcast to one quarter needs no shuffle.
macro_rules! four_pairs {
    ($a:expr, $b:expr, $c:expr, $d:expr) => {{
        macro_rules! at {
            ($place:expr) => {
                _mm_castpd_ps(_mm_loadu_pd($place))
            };
        }
        let mut all = _mm512_castps128_ps512(at!($a));
        all = _mm512_mask_broadcast_f32x4(all, 0x00f0, at!($b));
        all = _mm512_mask_broadcast_f32x4(all, 0x0f00, at!($c));
        _mm512_castps_pd(_mm512_mask_broadcast_f32x4(all, 0xf000, at!($d)))
    }};
}

#[derive(Clone, Copy)]
pub(super) struct Avx512(__m512d);

// SAFETY (all blocks of this implementation): the caller promises AVX-512F, and readable memory where one is given.
// `T` is f32 or f64 and nothing else (the trait is sealed), so a cast guided by `KIND` keeps the type.
impl Lanes for Avx512 {
    const IN_REGISTERS: usize = 32;

    #[inline(always)]
    unsafe fn zero() -> Self {
        // SAFETY: see above.
        Avx512(unsafe { _mm512_setzero_pd() })
    }

    #[inline(always)]
    unsafe fn load<T: Scalar>(from: *const T) -> Self {
        // SAFETY: see above.
        Avx512(unsafe {
            match T::KIND {
                ScalarKind::F32 => _mm512_cvtps_pd(_mm256_loadu_ps(from.cast())),
                ScalarKind::F64 => _mm512_loadu_pd(from.cast()),
            }
        })
    }

    #[inline(always)]
    unsafe fn load_first<T: Scalar>(from: *const T, count: usize) -> Self {
        let mask = (1u16 << count) - 1;
        // SAFETY: see above; a masked load does not touch what the mask leaves out.
        Avx512(unsafe {
            match T::KIND {
                ScalarKind::F32 => _mm512_cvtps_pd(_mm512_castps512_ps256(_mm512_maskz_loadu_ps(
                    mask,
                    from.cast(),
                ))),
                ScalarKind::F64 => _mm512_maskz_loadu_pd(mask as u8, from.cast()),
            }
        })
    }

    #[inline(always)]
    unsafe fn sub(self, other: Self) -> Self {
        // SAFETY: see above.
        Avx512(unsafe { _mm512_sub_pd(self.0, other.0) })
    }

    #[inline(always)]
    unsafe fn add(self, other: Self) -> Self {
        // SAFETY: see above.
        Avx512(unsafe { _mm512_add_pd(self.0, other.0) })
    }

    #[inline(always)]
    unsafe fn square_add(self, sum: Self) -> Self {
        // SAFETY: see above.
        Avx512(unsafe { _mm512_fmadd_pd(self.0, self.0, sum.0) })
    }

    /// A tree of shuffles: pairs of lanes, then pairs of 128-bit quarters, twice; row i ends in lane i.
    #[inline(always)]
    unsafe fn sum_each(rows: [Self; 8]) -> [f64; 8] {
        // SAFETY: see above.
        unsafe {
            let low = quarters!(pair!(rows[0], rows[1]), pair!(rows[2], rows[3]));
            let high = quarters!(pair!(rows[4], rows[5]), pair!(rows[6], rows[7]));
            let mut sums = [0.0; 8];
            _mm512_storeu_pd(sums.as_mut_ptr(), quarters!(low, high));
            sums
        }
    }

    #[inline(always)]
    unsafe fn broadcast(value: f64) -> Self {
        // SAFETY: see above.
        Avx512(unsafe { _mm512_set1_pd(value) })
    }

    #[inline(always)]
    unsafe fn multiply_add(self, factor: Self, sum: Self) -> Self {
        // SAFETY: see above.
        Avx512(unsafe { _mm512_fmadd_pd(self.0, factor.0, sum.0) })
    }

    #[inline(always)]
    unsafe fn multiply_add_one(a: f64, b: f64, sum: f64) -> f64 {
        a.mul_add(b, sum)
    }

    #[inline(always)]
    unsafe fn store(self, to: *mut f64) {
        // SAFETY: see above.
        unsafe { _mm512_storeu_pd(to, self.0) }
    }

    #[inline(always)]
    unsafe fn prefetch(at: *const u8) {
        // SAFETY: see above; a prefetch reads nothing that the program sees.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(at.cast()) }
    }

    #[inline(always)]
    unsafe fn bits_above(self, bound: Self) -> u32 {
        // SAFETY: see above.
        u32::from(unsafe { _mm512_cmp_pd_mask::<_CMP_GT_OQ>(self.0, bound.0) })
    }

    #[inline(always)]
    unsafe fn split(first: Self, second: Self) -> (Self, Self) {
        // SAFETY: see above.
        unsafe {
            let even = _mm512_setr_epi64(0, 2, 4, 6, 8, 10, 12, 14);
            let odd = _mm512_setr_epi64(1, 3, 5, 7, 9, 11, 13, 15);
            (
                Avx512(_mm512_permutex2var_pd(first.0, even, second.0)),
                Avx512(_mm512_permutex2var_pd(first.0, odd, second.0)),
            )
        }
    }

    /// Each row is put into its quarter as it is loaded.
    #[inline(always)]
    unsafe fn pairs(starts: [*const f64; 8]) -> (Self, Self) {
        // SAFETY: see above.
        unsafe {
            let first = four_pairs!(starts[0], starts[1], starts[2], starts[3]);
            let second = four_pairs!(starts[4], starts[5], starts[6], starts[7]);
            Self::split(Avx512(first), Avx512(second))
        }
    }

    /// Pairs of rows are interleaved, then quarters put together, twice.
    #[inline(always)]
    unsafe fn transpose(rows: [Self; 8]) -> [Self; 8] {
        // SAFETY: see above.
        unsafe {
            // Of the even lanes of each row, or of the odd: lanes 0, 2, 4, 6 of all eight rows.
            macro_rules! four {
                ($unpack:ident) => {{
                    let pairs = [
                        $unpack(rows[0].0, rows[1].0),
                        $unpack(rows[2].0, rows[3].0),
                        $unpack(rows[4].0, rows[5].0),
                        $unpack(rows[6].0, rows[7].0),
                    ];
                    let (a, b) = (even!(pairs[0], pairs[1]), even!(pairs[2], pairs[3]));
                    let (c, d) = (odd!(pairs[0], pairs[1]), odd!(pairs[2], pairs[3]));
                    [even!(a, b), even!(c, d), odd!(a, b), odd!(c, d)]
                }};
            }
            let of_even = four!(_mm512_unpacklo_pd);
            let of_odd = four!(_mm512_unpackhi_pd);
            [
                Avx512(of_even[0]),
                Avx512(of_odd[0]),
                Avx512(of_even[1]),
                Avx512(of_odd[1]),
                Avx512(of_even[2]),
                Avx512(of_odd[2]),
                Avx512(of_even[3]),
                Avx512(of_odd[3]),
            ]
        }
    }
}
