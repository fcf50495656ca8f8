//! Four and eight numbers at a time, on x86-64, with `unsafe` code.
//!
//! *Guarantee.* What is called here needs a processor that has the instructions, and a value of [`Avx2`] or [`Avx512`] is
//! the proof: only asking the processor makes one. Addresses come from slices; the rows of a group are checked together. No other
//! thread changes a simplex of a group: its vertices are held, or those of a facet across which it was reached.
#![allow(unsafe_code)]

use std::arch::x86_64::*;
use std::ops::{Add, Mul, Sub};

use taut_points::{InstructionSet, instruction_set};

use crate::simplex::Simplex;
use crate::space::cavity::Facet;
use crate::space::pairs::{self, Pair};
use crate::space::signs::{Lane, Number, Signs, in_sphere, orientation};
use crate::space::{Site, View, Worker, insert_with, row, whole};
use crate::threads::{Hold, Inserted, Progress, Slot};

/// Proof that the processor has AVX2 and FMA: there is no other way to make one than to ask it.
#[derive(Clone, Copy, Debug)]
pub(in crate::space) struct Avx2(());

/// Proof that the processor has AVX-512 (F, DQ, VL) besides AVX2 and FMA.
#[derive(Clone, Copy, Debug)]
pub(in crate::space) struct Avx512(Avx2);

impl Avx2 {
    pub(super) fn detect() -> Option<Self> {
        (instruction_set() >= InstructionSet::Avx2).then_some(Avx2(()))
    }

    /// [`insert_with`], four numbers at a time.
    pub(super) fn insert<H: Hold>(
        self,
        view: &View<'_, H::Slot<4>, H::Mark>,
        worker: &mut Worker,
        hold: &mut H,
        sites: &[u32],
        progress: &mut Progress,
    ) -> Inserted {
        #[target_feature(enable = "avx2,fma,bmi1,bmi2")]
        fn compiled<H: Hold>(
            yes: Avx2,
            view: &View<'_, H::Slot<4>, H::Mark>,
            worker: &mut Worker,
            hold: &mut H,
            sites: &[u32],
            progress: &mut Progress,
        ) -> Inserted {
            insert_with(yes, view, worker, hold, sites, progress)
        }
        // SAFETY: `self` proves that the processor has the features.
        unsafe { compiled(self, view, worker, hold, sites, progress) }
    }
}

impl Avx512 {
    pub(super) fn detect() -> Option<Self> {
        (instruction_set() == InstructionSet::Avx512).then_some(Avx512(Avx2(())))
    }

    /// [`insert_with`], eight numbers at a time.
    pub(super) fn insert<H: Hold>(
        self,
        view: &View<'_, H::Slot<4>, H::Mark>,
        worker: &mut Worker,
        hold: &mut H,
        sites: &[u32],
        progress: &mut Progress,
    ) -> Inserted {
        #[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma,bmi1,bmi2")]
        fn compiled<H: Hold>(
            yes: Avx512,
            view: &View<'_, H::Slot<4>, H::Mark>,
            worker: &mut Worker,
            hold: &mut H,
            sites: &[u32],
            progress: &mut Progress,
        ) -> Inserted {
            insert_with(yes, view, worker, hold, sites, progress)
        }
        // SAFETY: `self` proves that the processor has the features.
        unsafe { compiled(self, view, worker, hold, sites, progress) }
    }
}

/// Four numbers; made only from an [`Avx2`].
#[derive(Clone, Copy)]
struct F64x4(__m256d);

/// Eight numbers; made only from an [`Avx512`].
#[derive(Clone, Copy)]
struct F64x8(__m512d);

/// |x|, which AVX2 has no instruction for.
#[inline]
#[target_feature(enable = "avx2")]
fn magnitude4(x: __m256d) -> __m256d {
    _mm256_andnot_pd(_mm256_set1_pd(-0.0), x)
}

/// The operators and [`Lane`] of a vector from the intrinsics that do them.
macro_rules! lane {
    ($name:ident, $set1:ident, $add:ident, $sub:ident, $mul:ident, $fma:ident, $fms:ident, $max:ident, $abs:ident) => {
        // SAFETY (all blocks of this macro): the vectors were made from a proof that the processor has the features,
        // and `splat` is called by the filters alone, which hold other such vectors.
        impl Add for $name {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                // SAFETY: see above.
                Self(unsafe { $add(self.0, other.0) })
            }
        }
        impl Sub for $name {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                // SAFETY: see above.
                Self(unsafe { $sub(self.0, other.0) })
            }
        }
        impl Mul for $name {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                // SAFETY: see above.
                Self(unsafe { $mul(self.0, other.0) })
            }
        }
        impl Number for $name {
            #[inline(always)]
            fn mul_add(a: Self, b: Self, c: Self) -> Self {
                // SAFETY: see above.
                Self(unsafe { $fma(a.0, b.0, c.0) })
            }
            #[inline(always)]
            fn mul_sub(a: Self, b: Self, c: Self) -> Self {
                // SAFETY: see above.
                Self(unsafe { $fms(a.0, b.0, c.0) })
            }
        }
        impl Lane for $name {
            #[inline(always)]
            fn splat(value: f64) -> Self {
                // SAFETY: see above.
                Self(unsafe { $set1(value) })
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                // SAFETY: see above.
                Self(unsafe { $max(self.0, other.0) })
            }
            #[inline(always)]
            fn abs(self) -> Self {
                // SAFETY: see above.
                Self(unsafe { $abs(self.0) })
            }
        }
    };
}

lane!(
    F64x4,
    _mm256_set1_pd,
    _mm256_add_pd,
    _mm256_sub_pd,
    _mm256_mul_pd,
    _mm256_fmadd_pd,
    _mm256_fmsub_pd,
    _mm256_max_pd,
    magnitude4
);
lane!(
    F64x8,
    _mm512_set1_pd,
    _mm512_add_pd,
    _mm512_sub_pd,
    _mm512_mul_pd,
    _mm512_fmadd_pd,
    _mm512_fmsub_pd,
    _mm512_max_pd,
    _mm512_abs_pd
);

/// x, y and z of four sites.
#[inline]
#[target_feature(enable = "avx2")]
fn columns4(a: &Site, b: &Site, c: &Site, d: &Site) -> [F64x4; 3] {
    // SAFETY: a site is four aligned numbers.
    let (a, b) = unsafe { (_mm256_load_pd(a.0.as_ptr()), _mm256_load_pd(b.0.as_ptr())) };
    // SAFETY: as above.
    let (c, d) = unsafe { (_mm256_load_pd(c.0.as_ptr()), _mm256_load_pd(d.0.as_ptr())) };
    let (xz_ab, y_ab) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
    let (xz_cd, y_cd) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
    [
        F64x4(_mm256_permute2f128_pd(xz_ab, xz_cd, 0x20)),
        F64x4(_mm256_permute2f128_pd(y_ab, y_cd, 0x20)),
        F64x4(_mm256_permute2f128_pd(xz_ab, xz_cd, 0x31)),
    ]
}

/// Two sites in one vector.
#[inline]
#[target_feature(enable = "avx512f,avx2")]
fn pair(low: &Site, high: &Site) -> __m512d {
    // SAFETY: a site is four aligned numbers.
    let (low, high) = unsafe { (_mm256_load_pd(low.0.as_ptr()), _mm256_load_pd(high.0.as_ptr())) };
    _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1)
}

/// x, y and z of vertex J of eight simplices.
///
/// # Safety
/// [`within`] holds.
#[inline]
#[target_feature(enable = "avx512f,avx2")]
unsafe fn columns8<const J: usize>(sites: &[Site], s: &[&impl Slot<4>; 8]) -> [F64x8; 3] {
    // SAFETY: the caller's promise.
    let (ac, bd, eg, fh) = unsafe {
        (
            pair(corner::<J>(sites, s[0]), corner::<J>(sites, s[2])),
            pair(corner::<J>(sites, s[1]), corner::<J>(sites, s[3])),
            pair(corner::<J>(sites, s[4]), corner::<J>(sites, s[6])),
            pair(corner::<J>(sites, s[5]), corner::<J>(sites, s[7])),
        )
    };
    let (xz_low, y_low) = (_mm512_unpacklo_pd(ac, bd), _mm512_unpackhi_pd(ac, bd));
    let (xz_high, y_high) = (_mm512_unpacklo_pd(eg, fh), _mm512_unpackhi_pd(eg, fh));
    [
        F64x8(_mm512_shuffle_f64x2(xz_low, xz_high, 0b10_00_10_00)),
        F64x8(_mm512_shuffle_f64x2(y_low, y_high, 0b10_00_10_00)),
        F64x8(_mm512_shuffle_f64x2(xz_low, xz_high, 0b11_01_11_01)),
    ]
}

/// Tests whether all vertices of these simplices have a row, asked once for all.
#[inline]
#[target_feature(enable = "avx2")]
fn within<const N: usize>(sites: &[Site], group: &[&impl Slot<4>; N]) -> bool {
    let one = _mm_set1_epi32(1);
    let mut last = _mm_setzero_si128();
    for simplex in group {
        // SAFETY: four numbers, at any address.
        let vertices = unsafe { _mm_loadu_si128(simplex.addresses()[0].cast()) };
        last = _mm_max_epu32(last, _mm_add_epi32(vertices, one));
    }
    let count = _mm_set1_epi32(u32::try_from(sites.len()).unwrap_or(u32::MAX) as i32);
    _mm_movemask_epi8(_mm_cmpeq_epi32(_mm_max_epu32(last, count), last)) == 0
}

/// Vertex J of a simplex.
///
/// # Safety
/// [`within`] holds.
#[inline(always)]
unsafe fn corner<'a, const J: usize>(sites: &'a [Site], simplex: &impl Slot<4>) -> &'a Site {
    // SAFETY: the caller's promise.
    unsafe { sites.get_unchecked(row(simplex.vertex(J))) }
}

/// The vertices of four simplices. Inlined by force: twelve vectors returned through memory cost a tenth of everything.
///
/// # Safety
/// The processor has AVX2.
#[inline(always)]
unsafe fn corners4(sites: &[Site], simplices: &[impl Slot<4>], group: &[u32]) -> [[F64x4; 3]; 4] {
    let s = &simplices[group[0] as usize];
    let t = &simplices[group[1] as usize];
    let u = &simplices[group[2] as usize];
    let v = &simplices[group[3] as usize];
    // SAFETY: the caller's promise; all rows are there before one is read.
    unsafe {
        assert!(within(sites, &[s, t, u, v]), "vertices are sites");
        macro_rules! columns {
            ($j:literal) => {
                columns4(
                    corner::<$j>(sites, s),
                    corner::<$j>(sites, t),
                    corner::<$j>(sites, u),
                    corner::<$j>(sites, v),
                )
            };
        }
        [columns!(0), columns!(1), columns!(2), columns!(3)]
    }
}

/// The vertices of eight simplices.
///
/// # Safety
/// The processor has AVX-512F and AVX2.
#[inline(always)]
unsafe fn corners8(sites: &[Site], simplices: &[impl Slot<4>], group: &[u32]) -> [[F64x8; 3]; 4] {
    let s = &[
        &simplices[group[0] as usize],
        &simplices[group[1] as usize],
        &simplices[group[2] as usize],
        &simplices[group[3] as usize],
        &simplices[group[4] as usize],
        &simplices[group[5] as usize],
        &simplices[group[6] as usize],
        &simplices[group[7] as usize],
    ];
    // SAFETY: the caller's promise; all rows are there before one is read.
    unsafe {
        assert!(within(sites, s), "vertices are sites");
        [
            columns8::<0>(sites, s),
            columns8::<1>(sites, s),
            columns8::<2>(sites, s),
            columns8::<3>(sites, s),
        ]
    }
}

/// Where the determinant is certainly positive, and where it is open.
#[inline]
#[target_feature(enable = "avx2")]
fn masks4(F64x4(det): F64x4, F64x4(bound): F64x4) -> (u32, u32) {
    let positive = _mm256_movemask_pd(_mm256_cmp_pd(det, bound, _CMP_GT_OQ)) as u32;
    let least = _mm256_xor_pd(bound, _mm256_set1_pd(-0.0));
    let negative = _mm256_movemask_pd(_mm256_cmp_pd(det, least, _CMP_LT_OQ)) as u32;
    (positive, !(positive | negative) & 0b1111)
}

/// p − q.
#[inline(always)]
fn less<L: Lane>(p: [L; 3], q: [L; 3]) -> [L; 3] {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

/// p − q without error.
#[inline(always)]
fn pairs<L: Lane>(p: [L; 3], q: [L; 3]) -> [Pair<L>; 3] {
    [Pair::difference(p[0], q[0]), Pair::difference(p[1], q[1]), Pair::difference(p[2], q[2])]
}

/// A site in all lanes.
#[inline(always)]
fn splat<L: Lane>(q: &Site) -> [L; 3] {
    [L::splat(q.0[0]), L::splat(q.0[1]), L::splat(q.0[2])]
}

/// Returns which of four simplices are surely in conflict with q, and which are open. Always inlined: the insertion is compiled once for
/// one thread and once for several, and the compiler would make a call of it.
///
/// # Safety
/// The processor has AVX2 and FMA.
#[inline(always)]
unsafe fn conflicts4(
    sites: &[Site],
    simplices: &[impl Slot<4>],
    group: &[u32],
    q: &Site,
) -> (u32, u32) {
    // SAFETY: the caller's promise.
    let [a, b, c, d] = unsafe { corners4(sites, simplices, group) };
    let q = splat(q);
    let (det, bound) = in_sphere([less(a, q), less(b, q), less(c, q), less(d, q)]);
    // SAFETY: the caller's promise.
    unsafe { masks4(det, bound) }
}

#[inline(never)]
#[target_feature(enable = "avx2,fma")]
fn pairs4(sites: &[Site], simplices: &[impl Slot<4>], group: &[u32], q: &Site) -> (u32, u32) {
    // SAFETY: this function has the features.
    let [a, b, c, d] = unsafe { corners4(sites, simplices, group) };
    let q = splat(q);
    let (det, bound) = pairs::in_sphere([pairs(a, q), pairs(b, q), pairs(c, q), pairs(d, q)]);
    masks4(det, bound)
}

/// Besides inside and open: which are ties.
#[inline(never)]
#[target_feature(enable = "avx2,fma")]
fn whole4(sites: &[Site], simplices: &[impl Slot<4>], group: &[u32], q: &Site) -> (u32, u32, u32) {
    // SAFETY: this function has the features.
    let [a, b, c, d] = unsafe { corners4(sites, simplices, group) };
    let q = splat(q);
    let (det, perturbed, bound) =
        whole::in_sphere([less(a, q), less(b, q), less(c, q), less(d, q)]);
    let (inside, open) = masks4(perturbed, bound);
    let (_, ties) = masks4(det, bound);
    (inside, open, ties)
}

/// Where the determinant is certainly positive, and where it is open.
#[inline]
#[target_feature(enable = "avx512f")]
fn masks8(F64x8(det): F64x8, F64x8(bound): F64x8) -> (u32, u32) {
    let positive = u32::from(_mm512_cmp_pd_mask(det, bound, _CMP_GT_OQ));
    let least = _mm512_sub_pd(_mm512_setzero_pd(), bound);
    let negative = u32::from(_mm512_cmp_pd_mask(det, least, _CMP_LT_OQ));
    (positive, !(positive | negative) & 0xff)
}

/// Tests eight simplices as [`conflicts4`] tests four.
///
/// # Safety
/// The processor has what [`Avx512`] proves.
#[inline(always)]
unsafe fn conflicts8(
    sites: &[Site],
    simplices: &[impl Slot<4>],
    group: &[u32],
    q: &Site,
) -> (u32, u32) {
    // SAFETY: the caller's promise.
    let [a, b, c, d] = unsafe { corners8(sites, simplices, group) };
    let q = splat(q);
    let (det, bound) = in_sphere([less(a, q), less(b, q), less(c, q), less(d, q)]);
    // SAFETY: the caller's promise.
    unsafe { masks8(det, bound) }
}

#[inline(never)]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
fn pairs8(sites: &[Site], simplices: &[impl Slot<4>], group: &[u32], q: &Site) -> (u32, u32) {
    // SAFETY: this function has the features.
    let [a, b, c, d] = unsafe { corners8(sites, simplices, group) };
    let q = splat(q);
    let (det, bound) = pairs::in_sphere([pairs(a, q), pairs(b, q), pairs(c, q), pairs(d, q)]);
    masks8(det, bound)
}

/// Besides inside and open: which are ties.
#[inline(never)]
#[target_feature(enable = "avx512f,avx512dq,avx512vl,avx2,fma")]
fn whole8(sites: &[Site], simplices: &[impl Slot<4>], group: &[u32], q: &Site) -> (u32, u32, u32) {
    // SAFETY: this function has the features.
    let [a, b, c, d] = unsafe { corners8(sites, simplices, group) };
    let q = splat(q);
    let (det, perturbed, bound) =
        whole::in_sphere([less(a, q), less(b, q), less(c, q), less(d, q)]);
    let (inside, open) = masks8(perturbed, bound);
    let (_, ties) = masks8(det, bound);
    (inside, open, ties)
}

/// The four orientations of q with the facets of a simplex, lane i for the facet opposite vertex i.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn beyond4([a, b, c, d]: [&Site; 4], q: &Site) -> (u32, u32) {
    // The columns of `FACETS`: 1 0 3 2, then 2 3 0 1, then 3 2 1 0.
    const A: i32 = 0b10_11_00_01;
    const B: i32 = 0b01_00_11_10;
    const C: i32 = 0b00_01_10_11;
    let [F64x4(x), F64x4(y), F64x4(z)] = less(columns4(a, b, c, d), splat(q));
    let a = [
        F64x4(_mm256_permute4x64_pd(x, A)),
        F64x4(_mm256_permute4x64_pd(y, A)),
        F64x4(_mm256_permute4x64_pd(z, A)),
    ];
    let b = [
        F64x4(_mm256_permute4x64_pd(x, B)),
        F64x4(_mm256_permute4x64_pd(y, B)),
        F64x4(_mm256_permute4x64_pd(z, B)),
    ];
    let c = [
        F64x4(_mm256_permute4x64_pd(x, C)),
        F64x4(_mm256_permute4x64_pd(y, C)),
        F64x4(_mm256_permute4x64_pd(z, C)),
    ];
    let (det, bound) = orientation([a, b, c]);
    let (positive, open) = masks4(det, bound);
    (!(positive | open) & 0b1111, open)
}

/// Facet I in one store: its vertices, and the code in the last place.
#[inline]
#[target_feature(enable = "avx2")]
fn put<const I: usize>(simplex: &impl Slot<4>, facet: &mut Facet) {
    const { assert!(size_of::<Facet>() == 16 && size_of::<Simplex<4>>() == 32) };
    // SAFETY: four numbers each, at any address.
    let (vertices, neighbors) = unsafe {
        (
            _mm_loadu_si128(simplex.addresses()[0].cast()),
            _mm_loadu_si128(simplex.addresses()[1].cast()),
        )
    };
    // The rows of `FACETS`; in the last place the neighbor of the same number.
    let (vertices, code) = match I {
        0 => (
            _mm_shuffle_epi32(vertices, 0b00_11_10_01),
            _mm_shuffle_epi32(neighbors, 0b00_00_00_00),
        ),
        1 => (
            _mm_shuffle_epi32(vertices, 0b00_10_11_00),
            _mm_shuffle_epi32(neighbors, 0b01_00_00_00),
        ),
        2 => (
            _mm_shuffle_epi32(vertices, 0b00_01_00_11),
            _mm_shuffle_epi32(neighbors, 0b10_00_00_00),
        ),
        _ => (_mm_shuffle_epi32(vertices, 0b00_00_01_10), neighbors),
    };
    let all = _mm_blend_epi32(vertices, code, 0b1000);
    // SAFETY: a facet is four numbers, at any address.
    unsafe { _mm_storeu_si128(std::ptr::from_mut(facet).cast(), all) };
}

impl Signs for Avx2 {
    const FILTERED: bool = true;
    const WIDTH: usize = 4;

    #[inline(always)]
    fn conflicts(
        self,
        sites: &[Site],
        simplices: &[impl Slot<4>],
        group: &[u32],
        q: &Site,
    ) -> (u32, u32) {
        // SAFETY: `self` proves that the processor has the features.
        unsafe { conflicts4(sites, simplices, group, q) }
    }

    #[inline(always)]
    fn conflicts_in_pairs(
        self,
        sites: &[Site],
        simplices: &[impl Slot<4>],
        group: &[u32],
        q: &Site,
    ) -> Option<(u32, u32)> {
        // SAFETY: as above.
        Some(unsafe { pairs4(sites, simplices, group, q) })
    }

    #[inline(always)]
    fn conflicts_in_whole(
        self,
        sites: &[Site],
        simplices: &[impl Slot<4>],
        group: &[u32],
        q: &Site,
    ) -> Option<(u32, u32, u32)> {
        // SAFETY: as above.
        Some(unsafe { whole4(sites, simplices, group, q) })
    }

    #[inline(always)]
    fn beyond(self, corners: [&Site; 4], q: &Site) -> (u32, u32) {
        // SAFETY: as above.
        unsafe { beyond4(corners, q) }
    }

    #[inline(always)]
    fn fetch<T>(self, address: *const T) {
        // SAFETY: every x86-64 has the instruction, and it never faults.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast()) }
    }

    #[inline(always)]
    fn put<const I: usize>(self, simplex: &impl Slot<4>, facet: &mut Facet) {
        // SAFETY: as above.
        unsafe { put::<I>(simplex, facet) }
    }
}

impl Signs for Avx512 {
    const FILTERED: bool = true;
    const WIDTH: usize = 8;

    #[inline(always)]
    fn conflicts(
        self,
        sites: &[Site],
        simplices: &[impl Slot<4>],
        group: &[u32],
        q: &Site,
    ) -> (u32, u32) {
        // SAFETY: `self` proves that the processor has the features.
        unsafe { conflicts8(sites, simplices, group, q) }
    }

    #[inline(always)]
    fn conflicts_in_pairs(
        self,
        sites: &[Site],
        simplices: &[impl Slot<4>],
        group: &[u32],
        q: &Site,
    ) -> Option<(u32, u32)> {
        // SAFETY: as above.
        Some(unsafe { pairs8(sites, simplices, group, q) })
    }

    #[inline(always)]
    fn conflicts_in_whole(
        self,
        sites: &[Site],
        simplices: &[impl Slot<4>],
        group: &[u32],
        q: &Site,
    ) -> Option<(u32, u32, u32)> {
        // SAFETY: as above.
        Some(unsafe { whole8(sites, simplices, group, q) })
    }

    #[inline(always)]
    fn beyond(self, corners: [&Site; 4], q: &Site) -> (u32, u32) {
        self.0.beyond(corners, q)
    }

    #[inline(always)]
    fn fetch<T>(self, address: *const T) {
        // SAFETY: every x86-64 has the instruction, and it never faults.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast()) }
    }

    #[inline(always)]
    fn put<const I: usize>(self, simplex: &impl Slot<4>, facet: &mut Facet) {
        // SAFETY: as above.
        unsafe { put::<I>(simplex, facet) }
    }
}
