//! The algorithms of the literature, as short as their papers have them, to be measured under a probe.
//!
//! They recurse to the bottom and access one element at a time, which is what the bounds are stated for and what makes
//! them slow. Each function `f` has a twin `f_instrumented` that tells of every access.
//!
//! | problem | call | misses, tall cache |
//! |---|---|---|
//! | transposition | [`transpose()`] | O(1 + nm/B) |
//! | matrix product | [`multiply()`] | O(1 + (nm + mp + np)/B + nmp/(B√M)) |
//! | matrix product, seven for eight | [`strassen()`] | O(1 + n²/B + n^lg 7/(B·M^(lg 7/2 − 1))) |
//! | LU factors | [`lu()`] | O(n²/B·log n + n³/(B√M)) |
//! | Fourier transform | [`fft()`] | O((n/B)(1 + log_M n)) |
//! | search | [`VebTree`] | O(log_B n) |
//! | ranks in linked lists | [`list_ranks()`] | O(sort(n)) |
//! | the k-th smallest | [`select()`] | O(1 + n/B) |
//! | reversal | [`reverse()`] | ⌈n/B⌉ + 1 |
//! | sorting | [`funnelsort()`], [`distribution_sort()`] | O((n/B)(1 + log_{M/B}(n/B))) |
//! | dealing k³ elements to k intervals | [`Distributor`] | O((k³/B)(1 + log_M k) + k) |
//! | sorting by that | [`distributor_sort()`] | O((n/B)(1 + log_M n)) |
//! | sorting with the same trace for all data | [`columnsort()`] | O((n/B)(log n/log M)^3.42) |
//! | sorting, not optimally | [`mergesort()`], [`quicksort()`] | O((n/B)(1 + log₂(n/M))) |

mod buckets;
mod buffer_tree;
mod columnsort;
mod distribution_sort;
mod distributor;
mod distributor_sort;
mod fft;
mod funnelsort;
mod list_ranking;
mod lu;
mod median;
mod mergesort;
mod multiply;
mod quicksort;
pub(crate) mod random;
mod reverse;
mod sample;
mod strassen;
mod transpose;
mod veb;

use std::slice::from_ref;

pub use buckets::Buckets;
pub use columnsort::{columnsort, columnsort_instrumented};
pub use distribution_sort::{
    distribution_sort, distribution_sort_instrumented, distribution_sort_over_library,
};
pub use distributor::{Distributor, DistributorForm};
pub use distributor_sort::{distributor_sort, distributor_sort_instrumented};
pub use fft::{Direction, fft, fft_instrumented};
pub use funnelsort::{funnelsort, funnelsort_instrumented};
pub use list_ranking::{LIST_END, list_ranks, list_ranks_instrumented};
pub use lu::{Lu, lu, lu_instrumented};
pub use median::{select, select_instrumented};
pub use mergesort::{mergesort, mergesort_instrumented};
pub use multiply::{MatrixSizes, multiply, multiply_instrumented};
pub use quicksort::{quicksort, quicksort_instrumented};
pub use reverse::{reverse, reverse_instrumented};
pub use strassen::{strassen, strassen_instrumented};
pub use transpose::{transpose, transpose_instrumented};
pub use veb::{VebIndex, VebTree};

use self::random::Random;
use crate::{Error, Probe};

/// `array[i]`, told to the probe; one check of the index and not two, as `probe.read(&array[i..=i])` would have.
#[inline(always)]
fn get<T: Copy, P: Probe>(array: &[T], i: usize, probe: &mut P) -> T {
    let element = &array[i];
    probe.read(from_ref(element));
    *element
}

/// `array[i] = value`, told to the probe.
#[inline(always)]
fn set<T, P: Probe>(array: &mut [T], i: usize, value: T, probe: &mut P) {
    let element = &mut array[i];
    *element = value;
    probe.write(from_ref(element));
}

/// Exchanges two elements, told to the probe.
#[inline(always)]
fn swap<T: Copy, P: Probe>(array: &mut [T], i: usize, j: usize, probe: &mut P) {
    let (x, y) = (get(array, i, probe), get(array, j, probe));
    set(array, i, y, probe);
    set(array, j, x, probe);
}

/// Refuses an array that has not as many elements as its matrix.
fn check_length(
    name: &'static str,
    length: usize,
    rows: usize,
    columns: usize,
) -> Result<(), Error> {
    if rows.checked_mul(columns) == Some(length) {
        return Ok(());
    }
    Err(Error::Option {
        name,
        value: format!("{length} elements for {rows} x {columns}"),
        expected: "as many elements as rows times columns",
    })
}

/// Refuses a recursion that would not end.
fn check_base(base: usize) -> Result<(), Error> {
    if base > 0 {
        return Ok(());
    }
    Err(Error::Option { name: "base", value: "0".to_owned(), expected: "at least 1" })
}
