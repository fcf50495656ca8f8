//! Triangular products of many points at once: where solvers of ellipsoids spend their time.
//!
//! *Problem.* For a lower triangular T and a shift t: z = Tx − t for many points x, and |z|² or x·z for each.
//! *Idea.* [`POINTS`] points stand coordinate by coordinate, so that a register holds one coordinate of eight of them.
//! Two rows of T are worked on together: each load of points serves both, and eight accumulators, four with AVX2, hide the
//! latency of the multiply-add. Rows of a block of points are brought into that order, eight by eight, in registers.
//! *Guarantee.* What a point gets depends on it and on T, t alone, not on its neighbors.
//! *Trap.* The center is subtracted first: T(x − c), never Tx − Tc, which loses all digits far from the origin.
#![allow(unsafe_code)]

use taut_points::{Scalar, ScalarKind};

use super::lanes::Lanes;
use super::{Center, portable};

/// Points of one block: coordinate j of point i stands at 32·j + i.
pub const POINTS: usize = 32;
/// One coordinate of a block takes this many registers.
const REGISTERS: usize = POINTS / 8;

/// Memory is asked for this many bytes before it is read: at 1e6 × 10 a pass takes half the time with it.
const PREFETCH_BYTES: usize = 8192;

/// If a block is not aligned to them, a group of eight values spans two cache lines.
const CACHE_LINE_BYTES: usize = 64;
/// Values of a cache line.
const LINE_VALUES: usize = CACHE_LINE_BYTES / size_of::<f64>();

/// A lower triangular matrix by rows, d × d, of which nothing above the diagonal is read, and a shift.
#[derive(Clone, Copy, Debug)]
pub struct Triangle<'a> {
    /// T.
    pub matrix: &'a [f64],
    /// t.
    pub shift: &'a [f64],
}

impl Triangle<'_> {
    fn dim(&self) -> usize {
        self.shift.len()
    }
}

/// Tests whether two factors, whatever their size, have this product.
fn is_product(product: usize, a: usize, b: usize) -> bool {
    a.checked_mul(b) == Some(product)
}

/// z = Tx − t for the points of a block, and |z|² of each.
///
/// # Panics
/// If the lengths do not fit, or there are no coordinates.
pub fn images(triangle: Triangle<'_>, x: &[f64], z: &mut [f64], out: &mut [f64; POINTS]) {
    let dim = triangle.dim();
    assert!(dim > 0 && is_product(triangle.matrix.len(), dim, dim));
    assert!(is_product(x.len(), dim, POINTS) && z.len() == x.len());
    let z = z.as_mut_ptr();
    dispatch(Images { triangle, x: x.as_ptr(), z, out });
}

/// x·(Tx − t) for each point of a block.
///
/// # Panics
/// If the lengths do not fit, or there are no coordinates.
pub fn forms(triangle: Triangle<'_>, x: &[f64], out: &mut [f64; POINTS]) {
    let dim = triangle.dim();
    assert!(dim > 0 && is_product(triangle.matrix.len(), dim, dim));
    assert!(is_product(x.len(), dim, POINTS));
    dispatch(Forms { triangle, x: x.as_ptr(), out });
}

/// Σ wxx′, Σ wx and Σ w over the points of many blocks, the lower triangle with the diagonal, (d + 1) × (d + 1) by rows:
/// the points are taken to have a last coordinate 1. `weights` has one entry per point, 0 for those that fill a block.
///
/// # Panics
/// If the lengths do not fit, or there are no coordinates.
pub fn moments(dim: usize, x: &[f64], weights: &[f64]) -> Vec<f64> {
    assert!(dim > 0 && weights.len().is_multiple_of(POINTS));
    assert!(is_product(x.len(), dim, weights.len()));
    let m = dim + 1;
    // Eight partial sums for each entry.
    let mut sums = vec![0.0; 8 * m * (m + 1) / 2];
    dispatch(Moments { dim, x, weights, sums: &mut sums });
    let mut moments = vec![0.0; m * m];
    let mut entries = sums.as_chunks::<8>().0.iter();
    for a in 0..m {
        for (b, [p, q, r, s, t, u, v, w]) in entries.by_ref().take(a + 1).enumerate() {
            moments[a * m + b] = ((p + q) + (r + s)) + ((t + u) + (v + w));
        }
    }
    moments
}

/// |T(x − c)|² for each row x of `values`. `scratch` is memory to work in, of any length.
///
/// The relative error is of the order of d·2⁻⁵³ times |T||x − c| over |T(x − c)|: large when T has to undo a strong
/// correlation of coordinates.
///
/// # Panics
/// If the lengths do not fit, or there are no coordinates.
pub fn leverages<T: Scalar>(
    values: &[T],
    matrix: &[f64],
    center: &Center,
    scratch: &mut Vec<f64>,
    out: &mut [f64],
) {
    match T::KIND {
        ScalarKind::F32 => of_singles(bytemuck::cast_slice(values), matrix, center, scratch, out),
        ScalarKind::F64 => of_doubles(bytemuck::cast_slice(values), matrix, center, scratch, out),
    }
}

/// Rows in single precision, widened some hundred at a time: one copy of the code serves both.
fn of_singles(
    values: &[f32],
    matrix: &[f64],
    center: &Center,
    scratch: &mut Vec<f64>,
    out: &mut [f64],
) {
    let dim = center.dim();
    assert!(dim > 0 && is_product(values.len(), dim, out.len()));
    let mut wide = vec![];
    let blocks = values.chunks(dim * 8 * POINTS).zip(out.chunks_mut(8 * POINTS));
    for (values, out) in blocks {
        wide.clear();
        wide.extend(values.iter().map(|&value| f64::from(value)));
        of_doubles(&wide, matrix, center, scratch, out);
    }
}

/// Not generic, so that it is compiled with the options of this crate, and not with those of the one that calls it.
fn of_doubles(
    values: &[f64],
    matrix: &[f64],
    center: &Center,
    scratch: &mut Vec<f64>,
    out: &mut [f64],
) {
    let dim = center.dim();
    assert!(dim > 0 && is_product(matrix.len(), dim, dim));
    assert!(is_product(values.len(), dim, out.len()));
    assert!(center.low.is_empty() || center.low.len() == dim);
    scratch.clear();
    // The second half is the shift, which is 0 here.
    let length = dim * POINTS + dim;
    scratch.resize(length + LINE_VALUES - 1, 0.0);
    let start = scratch.as_ptr().align_offset(CACHE_LINE_BYTES).min(LINE_VALUES - 1);
    let scratch = &mut scratch[start..start + length];
    dispatch(Leverages { values, matrix, center, scratch, out });
}

/// Bit i of entry k of `bits` says whether value 32k + i is above `bound`.
///
/// # Panics
/// If there are more or fewer entries than that.
pub fn above(values: &[f64], bound: f64, bits: &mut [u32]) {
    assert!(bits.len() == values.len().div_ceil(POINTS));
    dispatch(Above { values, bound, bits });
}

/// Work that is compiled once for each instruction set.
pub(super) trait Work {
    /// # Safety
    /// The processor has the features of `L`.
    unsafe fn run<L: Lanes>(self);
}

/// Does the work with the best registers there are.
pub(super) fn dispatch(work: impl Work) {
    #[cfg(target_arch = "x86_64")]
    let Some(work) = super::x86::run(work) else { return };
    // SAFETY: the portable lanes need no feature of the processor.
    unsafe { work.run::<portable::Portable>() }
}

pub(super) struct Images<'a> {
    pub(super) triangle: Triangle<'a>,
    pub(super) x: *const f64,
    pub(super) z: *mut f64,
    pub(super) out: &'a mut [f64; POINTS],
}

impl Work for Images<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(self) {
        // SAFETY: features are the caller's promise; `images` checked the lengths.
        unsafe { block::<L, true, false>(self.triangle, self.x, self.z, self.out) }
    }
}

pub(super) struct Forms<'a> {
    pub(super) triangle: Triangle<'a>,
    pub(super) x: *const f64,
    pub(super) out: &'a mut [f64; POINTS],
}

impl Work for Forms<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(self) {
        // SAFETY: features are the caller's promise; `forms` checked the lengths; nothing is stored to the null.
        unsafe { block::<L, false, true>(self.triangle, self.x, std::ptr::null_mut(), self.out) }
    }
}

struct Moments<'a> {
    dim: usize,
    x: &'a [f64],
    weights: &'a [f64],
    sums: &'a mut [f64],
}

impl Work for Moments<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(self) {
        let dim = self.dim;
        let blocks = self.weights.as_chunks::<POINTS>().0;
        debug_assert_eq!(self.sums.len(), 4 * (dim + 1) * (dim + 2));
        for (x, weights) in self.x.chunks_exact(dim * POINTS).zip(blocks) {
            // SAFETY: features are the caller's promise; a block has d·POINTS values and POINTS weights, and there are
            // eight sums for each of the (d + 1)(d + 2)/2 entries.
            unsafe {
                let weights: [L; REGISTERS] = wide(weights.as_ptr());
                let mut sum = self.sums.as_mut_ptr();
                let mut add = |terms: [L; REGISTERS], with: [L; REGISTERS]| {
                    let mut total = L::load(sum.cast_const());
                    for i in 0..REGISTERS {
                        total = terms[i].multiply_add(with[i], total);
                    }
                    total.store(sum);
                    sum = sum.add(8);
                };
                for a in 0..dim {
                    let mut row: [L; REGISTERS] = wide(x.as_ptr().add(a * POINTS));
                    for i in 0..REGISTERS {
                        row[i] = row[i].multiply_add(weights[i], L::zero());
                    }
                    for b in 0..=a {
                        add(row, wide(x.as_ptr().add(b * POINTS)));
                    }
                }
                for b in 0..dim {
                    add(weights, wide(x.as_ptr().add(b * POINTS)));
                }
                add(weights, [L::broadcast(1.0); REGISTERS]);
            }
        }
    }
}

pub(super) struct Above<'a> {
    pub(super) values: &'a [f64],
    pub(super) bound: f64,
    pub(super) bits: &'a mut [u32],
}

impl Work for Above<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(self) {
        // SAFETY: features are the caller's promise; eight values are read where there are eight, or what is left.
        unsafe {
            let bound = L::broadcast(self.bound);
            for (values, bits) in self.values.chunks(POINTS).zip(self.bits) {
                *bits = 0;
                for (k, eight) in values.chunks(8).enumerate() {
                    let from = eight.as_ptr();
                    let (lanes, real) = if eight.len() == 8 {
                        (L::load(from), 0xff)
                    } else {
                        (L::load_first(from, eight.len()), (1 << eight.len()) - 1)
                    };
                    *bits |= (lanes.bits_above(bound) & real) << (8 * k);
                }
            }
        }
    }
}

pub(super) struct Leverages<'a> {
    pub(super) values: &'a [f64],
    pub(super) matrix: &'a [f64],
    pub(super) center: &'a Center,
    /// A block and, behind it, a shift of zeros.
    pub(super) scratch: &'a mut [f64],
    pub(super) out: &'a mut [f64],
}

impl Work for Leverages<'_> {
    #[inline(always)]
    unsafe fn run<L: Lanes>(self) {
        let dim = self.center.dim();
        let (x, shift) = self.scratch.split_at_mut(dim * POINTS);
        let triangle = Triangle { matrix: self.matrix, shift };
        let none = std::ptr::null_mut();
        let (blocks, rest) = self.out.as_chunks_mut::<POINTS>();
        let (values, last) = self.values.split_at(blocks.len() * POINTS * dim);
        for (values, out) in values.chunks_exact(dim * POINTS).zip(blocks) {
            // SAFETY: features are the caller's promise; `x` has room for a block, and `values` is one.
            unsafe {
                arrange::<L>(values, self.center, x);
                block::<L, false, false>(triangle, x.as_ptr(), none, out);
            }
        }
        if !rest.is_empty() {
            let mut sums = [0.0; POINTS];
            // SAFETY: as above; `last` holds a row for each place of `rest`, which is not empty.
            unsafe {
                arrange::<L>(last, self.center, x);
                block::<L, false, false>(triangle, x.as_ptr(), none, &mut sums);
            }
            rest.copy_from_slice(&sums[..rest.len()]);
        }
    }
}

/// One coordinate of some points. A loop: closures handed to `array::from_fn` are not always inlined, and calls of
/// single instructions are what is left then.
///
/// # Safety
/// The processor has the features of `L`; eight values for each of the `R` can be read at `from`.
#[inline(always)]
unsafe fn wide<L: Lanes, const R: usize>(from: *const f64) -> [L; R] {
    // SAFETY: passed on.
    unsafe {
        let mut lanes = [L::zero(); R];
        for (i, lanes) in lanes.iter_mut().enumerate() {
            *lanes = L::load(from.add(8 * i));
        }
        lanes
    }
}

/// z = Tx − t for a block; |z|² or, if `FORM`, x·z for each point; z itself if `STORE`.
///
/// All points at once where their twelve accumulators of eight lanes have registers, else half of them and then the others: with
/// AVX2, leverages of rows of ten coordinates in the cache take four fifths of the time.
///
/// # Safety
/// The processor has the features of `L`; T is d × d for a shift of length d, and d blocks of [`POINTS`] values can be
/// read at `x` and, if `STORE`, written at `z`.
#[inline(always)]
unsafe fn block<L: Lanes, const STORE: bool, const FORM: bool>(
    triangle: Triangle<'_>,
    x: *const f64,
    z: *mut f64,
    out: &mut [f64; POINTS],
) {
    const HALF_BLOCK: usize = POINTS / 2;
    // SAFETY: passed on; both halves are parts of the block.
    unsafe {
        if L::IN_REGISTERS > 3 * REGISTERS {
            part::<L, REGISTERS, STORE, FORM>(triangle, x, z, out);
        } else {
            let (first, second) = out.split_at_mut(HALF_BLOCK);
            part::<L, { REGISTERS / 2 }, STORE, FORM>(triangle, x, z, first);
            let (x, z) = (x.add(HALF_BLOCK), z.wrapping_add(HALF_BLOCK));
            part::<L, { REGISTERS / 2 }, STORE, FORM>(triangle, x, z, second);
        }
    }
}

/// The same for eight points of a block for each of the `R`, of which `x` and `z` are the first.
///
/// # Safety
/// The processor has the features of `L`; T is d × d for a shift of length d; for each j < d, 8·`R` values can be read at
/// x + [`POINTS`]·j and, if `STORE`, written at z + [`POINTS`]·j; `out` has room for 8·`R`.
#[inline(always)]
unsafe fn part<L: Lanes, const R: usize, const STORE: bool, const FORM: bool>(
    triangle: Triangle<'_>,
    x: *const f64,
    z: *mut f64,
    out: &mut [f64],
) {
    debug_assert_eq!(out.len(), 8 * R);
    let dim = triangle.dim();
    debug_assert_eq!(triangle.matrix.len(), dim * dim);
    let (matrix, shift) = (triangle.matrix.as_ptr(), triangle.shift.as_ptr());
    // SAFETY: rows a < dim of T and of the block; columns b ≤ a.
    unsafe {
        // Macros, as closures are not always inlined where they are called more than once.
        macro_rules! row {
            ($b:expr) => {
                wide::<L, R>(x.add($b * POINTS))
            };
        }
        macro_rules! start {
            ($a:expr) => {
                [L::broadcast(-*shift.add($a)); R]
            };
        }
        let mut sums = [L::zero(); R];
        macro_rules! finish {
            ($a:expr, $values:expr) => {{
                let (a, values): (usize, [L; R]) = ($a, $values);
                let with = if FORM { row!(a) } else { values };
                for i in 0..R {
                    sums[i] = values[i].multiply_add(with[i], sums[i]);
                    if STORE {
                        values[i].store(z.add(a * POINTS + 8 * i));
                    }
                }
            }};
        }
        let mut a = 0;
        while a + 1 < dim {
            let (upper, lower) = (matrix.add(a * dim), matrix.add((a + 1) * dim));
            let (mut first, mut second) = (start!(a), start!(a + 1));
            for b in 0..=a {
                let x = row!(b);
                let (t, s) = (L::broadcast(*upper.add(b)), L::broadcast(*lower.add(b)));
                for i in 0..R {
                    first[i] = x[i].multiply_add(t, first[i]);
                    second[i] = x[i].multiply_add(s, second[i]);
                }
            }
            let (x, s) = (row!(a + 1), L::broadcast(*lower.add(a + 1)));
            for i in 0..R {
                second[i] = x[i].multiply_add(s, second[i]);
            }
            finish!(a, first);
            finish!(a + 1, second);
            a += 2;
        }
        if a < dim {
            let upper = matrix.add(a * dim);
            let mut first = start!(a);
            for b in 0..=a {
                let (x, t) = (row!(b), L::broadcast(*upper.add(b)));
                for i in 0..R {
                    first[i] = x[i].multiply_add(t, first[i]);
                }
            }
            finish!(a, first);
        }
        for (i, sum) in sums.into_iter().enumerate() {
            sum.store(out.as_mut_ptr().add(8 * i));
        }
    }
}

/// Coordinate j of some points less that of the center.
///
/// # Safety
/// The processor has the features of `L`.
#[inline(always)]
unsafe fn less<L: Lanes>(column: L, center: &Center, j: usize) -> L {
    // SAFETY: passed on.
    unsafe {
        let once = column.sub(L::broadcast(center.high[j]));
        match center.low.get(j) {
            Some(&low) => once.sub(L::broadcast(low)),
            None => once,
        }
    }
}

/// x − c of up to [`POINTS`] rows, coordinate by coordinate; missing rows repeat the last.
///
/// # Safety
/// The processor has the features of `L`; `values` holds between 1 and [`POINTS`] rows of `center.dim()` values, and
/// `x` has room for [`POINTS`].
#[inline(always)]
unsafe fn arrange<L: Lanes>(values: &[f64], center: &Center, x: &mut [f64]) {
    let dim = center.dim();
    let rows = values.len() / dim;
    debug_assert!((1..=POINTS).contains(&rows) && x.len() >= dim * POINTS);
    let x = x.as_mut_ptr();
    let ahead = values.as_ptr().cast::<u8>().wrapping_add(PREFETCH_BYTES);
    for line in (0..size_of_val(values)).step_by(64) {
        // SAFETY: features are the caller's promise.
        unsafe { L::prefetch(ahead.wrapping_add(line)) };
    }
    if dim == 1 {
        for group in 0..REGISTERS {
            let mut column = [0.0; 8];
            for (i, value) in column.iter_mut().enumerate() {
                *value = values[(8 * group + i).min(rows - 1)];
            }
            // SAFETY: there is room for [`POINTS`] values at `x`.
            unsafe { less(L::load(column.as_ptr()), center, 0).store(x.add(8 * group)) };
        }
        return;
    }
    if dim == 2 && rows == POINTS {
        for group in 0..REGISTERS {
            // SAFETY: `values` holds 64 values, of which these are 16; there is room for as many at `x`.
            unsafe {
                let from = values.as_ptr().add(16 * group);
                let (first, second) = L::split(L::load(from), L::load(from.add(8)));
                less(first, center, 0).store(x.add(8 * group));
                less(second, center, 1).store(x.add(POINTS + 8 * group));
            }
        }
        return;
    }
    for group in 0..REGISTERS {
        // SAFETY: each start is that of a row within `values`; eights end at or below dim, and a pair at j and j + 1 < dim, which is at least 2.
        unsafe {
            let mut starts = [values.as_ptr(); 8];
            for (i, start) in starts.iter_mut().enumerate() {
                *start = start.add((group * 8 + i).min(rows - 1) * dim);
            }
            let eights = dim / 8 * 8;
            for j in (0..eights).step_by(8) {
                let mut eight = [L::zero(); 8];
                for i in 0..8 {
                    eight[i] = L::load(starts[i].add(j));
                }
                let columns = L::transpose(eight);
                for k in 0..8 {
                    less(columns[k], center, j + k).store(x.add((j + k) * POINTS + 8 * group));
                }
            }
            for j in (eights..dim).step_by(2) {
                // The last of an odd number comes with the one before it, which is stored once more.
                let j = j.min(dim - 2);
                let mut places = starts;
                for place in &mut places {
                    *place = place.add(j);
                }
                let (first, second) = L::pairs(places);
                less(first, center, j).store(x.add(j * POINTS + 8 * group));
                less(second, center, j + 1).store(x.add((j + 1) * POINTS + 8 * group));
            }
        }
    }
}
