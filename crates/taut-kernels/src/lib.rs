//! The inner loops of the solvers of enclosing shapes. At this level: squared distances of many rows to one center, in
//! which every one of them spends its time.
//!
//! *Problem.* For each row x of a block, |x − c|² in `f64`, from `f32` or `f64` coordinates, at the speed at which
//! memory delivers them.
//! *Idea.* Eight lanes of `f64` (`Lanes`), one file per instruction set, chosen at run time. Rows of up to
//! `EIGHT_ROWS_MAX` coordinates are taken eight at a time, which shares the loads of the center and leaves one
//! transposing sum for eight rows; longer rows are taken one at a time with four accumulators.
//! *Guarantee.* A row's value depends on the row and the center alone, not on its neighbors or on threads. Its
//! relative error is at most [`relative_error`]. `f32` rows are widened first, so every pass is a certificate:
//! out of cache this costs nothing, because memory is the bottleneck.
//! *Trap.* |x|² − 2x·c + |c|² would save a subtraction and lose all digits far from the origin; it is no faster.
//! A center that needs more than one `f64` per coordinate is subtracted in two terms, which costs one more load and
//! subtraction, so it is only done where it matters.

pub mod columns;
pub mod compensated;
mod exact;
pub mod extremes;
mod lanes;
pub mod matrix;
mod portable;
pub mod substitution;
pub mod triangle;
pub mod vector;
#[cfg(target_arch = "x86_64")]
mod x86;

use taut_points::{Scalar, ScalarKind};

pub use exact::{Difference, DoubleDouble, vanishes};
use lanes::{Lanes, eight_rows, one_row, one_short_row};

/// Up to this many coordinates eight rows are taken together. Beyond, eight streams of memory are more than the
/// hardware prefetchers follow, and rows near a multiple of 4096 bytes fall on the same cache sets.
const EIGHT_ROWS_MAX: usize = 96;

/// Memory is asked for this many bytes before it is read. Measured at d = 5 and 10 beside other work on the machine: a fifth
/// to a third faster; from 4 KiB on, the size of a page, nothing is left of that.
const PREFETCH_BYTES: usize = 1024;

/// A center as `high`, or as `high + low` where one `f64` per coordinate is too coarse.
#[derive(Clone, Debug, PartialEq)]
pub struct Center {
    /// The coordinates, rounded.
    pub high: Vec<f64>,
    /// The part that rounding took away; empty stands for zeros.
    pub low: Vec<f64>,
}

impl Center {
    /// The number of coordinates.
    pub fn dim(&self) -> usize {
        self.high.len()
    }
}

/// Bound on the relative error of a squared distance in d dimensions, and of the squared reach of a ball from it.
///
/// In units of the rounding 2⁻⁵³: each lane sums at most d/8 squares in turn and eight lanes are summed in three steps;
/// the two differences of a term count twice, its square once; the root, the radius and the square of a reach add five.
/// That makes d/8 + 13; the rest is room for second-order terms.
pub fn relative_error(dim: usize) -> f64 {
    (dim.div_ceil(8) as f64 + 16.0) * (f64::EPSILON / 2.0)
}

/// Writes |x − c|² for each row of `values` to `out`.
///
/// Rows are `stride` values long, of which the first `center.dim()` are coordinates; `out` has one place per row.
///
/// # Panics
/// If the lengths do not fit, or the center has no coordinates.
pub fn squared_distances<T: Scalar>(values: &[T], stride: usize, center: &Center, out: &mut [f64]) {
    match T::KIND {
        ScalarKind::F32 => of_singles(bytemuck::cast_slice(values), stride, center, out),
        ScalarKind::F64 => of_doubles(bytemuck::cast_slice(values), stride, center, out),
    }
}

// Not generic, so that they are compiled with the options of this crate, and not with those of the one that calls them.

fn of_singles(values: &[f32], stride: usize, center: &Center, out: &mut [f64]) {
    of_rows(values, stride, center, out);
}

fn of_doubles(values: &[f64], stride: usize, center: &Center, out: &mut [f64]) {
    of_rows(values, stride, center, out);
}

fn of_rows<T: Scalar>(values: &[T], stride: usize, center: &Center, out: &mut [f64]) {
    assert!(center.dim() <= stride && center.dim() > 0);
    assert_eq!(Some(values.len()), stride.checked_mul(out.len()));
    assert!(center.low.is_empty() || center.low.len() == center.dim());
    #[cfg(target_arch = "x86_64")]
    if x86::squared_distances(values, stride, center, out) {
        return;
    }
    if short_rows(values, stride, center, out) {
        return;
    }
    // SAFETY: the portable lanes need no feature of the processor; the lengths were checked above.
    #[allow(unsafe_code)]
    unsafe {
        all_rows::<portable::Portable, T>(values, stride, center, out)
    }
}

/// The loop over rows, inlined once for each instruction set.
///
/// # Safety
/// The processor must have the features of `L`; lengths must be as [`squared_distances`] checks them.
#[inline(always)]
#[allow(unsafe_code)]
unsafe fn all_rows<L: Lanes, T: Scalar>(
    values: &[T],
    stride: usize,
    center: &Center,
    out: &mut [f64],
) {
    let dim = center.dim();
    if dim <= EIGHT_ROWS_MAX {
        for (group, out) in out.chunks_mut(8).enumerate() {
            let rows = &values[group * 8 * stride..(group * 8 + out.len()) * stride];
            let ahead = rows.as_ptr().cast::<u8>().wrapping_add(PREFETCH_BYTES);
            for line in (0..size_of_val(rows)).step_by(64) {
                // SAFETY: features are the caller's promise.
                unsafe { L::prefetch(ahead.wrapping_add(line)) };
            }
            // SAFETY: features are the caller's promise; `rows` holds as many rows as `out` has places.
            let sums = unsafe { eight_rows::<L, T>(rows, out.len(), stride, center) };
            out.copy_from_slice(&sums[..out.len()]);
        }
    } else {
        for (row, out) in values.chunks_exact(stride).zip(out) {
            // SAFETY: features are the caller's promise; the slice has as many coordinates as the center.
            *out = unsafe { one_row::<L, T>(&row[..dim], center) };
        }
    }
}

/// Plain loops for rows of few coordinates, which the compiler turns into shuffles and full registers.
#[inline(always)]
fn short_rows<T: Scalar>(values: &[T], stride: usize, center: &Center, out: &mut [f64]) -> bool {
    match (center.dim(), stride, center.low.is_empty()) {
        (1, 1, true) => one_short_row::<1, T>(values, center, out),
        (2, 2, true) => one_short_row::<2, T>(values, center, out),
        (3, 3, true) => one_short_row::<3, T>(values, center, out),
        (4, 4, true) => one_short_row::<4, T>(values, center, out),
        _ => return false,
    }
    true
}

#[cfg(test)]
mod tests;
