//! Mergesort of two halves, the yardstick of the optimal sorts.
//!
//! *Guarantee.* O((n/B)(1 + log₂(n/M))) misses, as each level is a scan until a part fits; n log₂ n comparisons; stable.
//! *Reference.* The thesis, 5.2.1, which stops at parts of B instead of M.

use super::{get, set};
use crate::{NoProbe, Probe};

/// Sorts; equal elements keep their order.
pub fn mergesort<T: Copy + Ord>(array: &mut [T]) {
    mergesort_instrumented(array, &mut NoProbe);
}

/// [`mergesort()`] under a probe.
pub fn mergesort_instrumented<T: Copy + Ord, P: Probe>(array: &mut [T], probe: &mut P) {
    probe.place(array);
    let mut scratch = array.to_vec();
    probe.place(&scratch);
    sort(array, &mut scratch, probe);
    probe.lift(&scratch);
}

fn sort<T: Copy + Ord, P: Probe>(array: &mut [T], scratch: &mut [T], probe: &mut P) {
    let n = array.len();
    if n < 2 {
        return;
    }
    let half = n / 2;
    let (left, right) = array.split_at_mut(half);
    let (scratch_left, scratch_right) = scratch.split_at_mut(half);
    sort(left, scratch_left, probe);
    sort(right, scratch_right, probe);
    merge(left, right, scratch, probe);
    for i in 0..n {
        let x = get(scratch, i, probe);
        set(array, i, x, probe);
    }
}

/// Merges two sorted arrays into a third; of equal elements those of the left come first.
pub(super) fn merge<T: Copy + Ord, P: Probe>(left: &[T], right: &[T], to: &mut [T], probe: &mut P) {
    let (mut i, mut j) = (0, 0);
    for k in 0..to.len() {
        let from_left =
            j == right.len() || (i < left.len() && get(left, i, probe) <= get(right, j, probe));
        let x = if from_left { get(left, i, probe) } else { get(right, j, probe) };
        (i, j) = if from_left { (i + 1, j) } else { (i, j + 1) };
        set(to, k, x, probe);
    }
}
