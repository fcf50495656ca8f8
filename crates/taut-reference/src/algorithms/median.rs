//! The k-th smallest of n by the median of medians of five.
//!
//! *Idea.* Split at the median of the medians of groups of five, which is above and below 3n/10 − 6 elements at least,
//! and go on in the part that has the place wanted.
//! *Guarantee.* Q(n) = Q(n/5) + Q(7n/10 + 6) + O(1 + n/B) = O(1 + n/B) misses and O(n) time, in place, for every input:
//! the leaves number (n/B)^0.84, as (1/5)^c + (7/10)^c = 1 for c = 0.84.
//! *Trap.* Without a part for equal elements an array of equal ones takes n²/5 steps.
//! *Reference.* Blum, Floyd, Pratt, Rivest, Tarjan, J. Computer and System Sciences 7(4), 1973; the thesis, 5.2.1.

use std::cmp::Ordering;

use super::{get, set, swap};
use crate::{NoProbe, Probe};

/// Fewer elements than this are sorted by insertion.
const INSERTION_SORT_LIMIT: usize = 10;

/// The element that is at place `k` when the array is sorted, which is where it is put, those before it not larger and
/// those behind it not smaller; `None` if there is no such place.
pub fn select<T: Copy + Ord>(array: &mut [T], k: usize) -> Option<T> {
    select_instrumented(array, k, &mut NoProbe)
}

/// [`select()`] under a probe.
pub fn select_instrumented<T: Copy + Ord, P: Probe>(
    array: &mut [T],
    k: usize,
    probe: &mut P,
) -> Option<T> {
    probe.place(array);
    (k < array.len()).then(|| place(array, k, probe))
}

fn place<T: Copy + Ord, P: Probe>(mut array: &mut [T], mut k: usize, probe: &mut P) -> T {
    loop {
        let n = array.len();
        if n < INSERTION_SORT_LIMIT {
            insertion_sort(array, probe);
            return get(array, k, probe);
        }
        let groups = n / 5;
        for group in 0..groups {
            insertion_sort(&mut array[5 * group..5 * group + 5], probe);
            swap(array, group, 5 * group + 2, probe);
        }
        let pivot = place(&mut array[..groups], groups / 2, probe);
        let (low, high) = split(array, pivot, probe);
        if k < low {
            array = &mut array[..low];
        } else if k < high {
            return pivot;
        } else {
            array = &mut array[high..];
            k -= high;
        }
    }
}

/// Puts the smaller elements first and the larger ones last; returns where the equal ones begin and end.
fn split<T: Copy + Ord, P: Probe>(array: &mut [T], pivot: T, probe: &mut P) -> (usize, usize) {
    let (mut low, mut next, mut high) = (0, 0, array.len());
    while next < high {
        match get(array, next, probe).cmp(&pivot) {
            Ordering::Less => {
                swap(array, low, next, probe);
                low += 1;
                next += 1;
            }
            Ordering::Equal => next += 1,
            Ordering::Greater => {
                high -= 1;
                swap(array, next, high, probe);
            }
        }
    }
    (low, high)
}

/// Sorts a few elements; stable.
pub(super) fn insertion_sort<T: Copy + Ord, P: Probe>(array: &mut [T], probe: &mut P) {
    for i in 1..array.len() {
        let x = get(array, i, probe);
        let mut j = i;
        while j > 0 {
            let y = get(array, j - 1, probe);
            if y <= x {
                break;
            }
            set(array, j, y, probe);
            j -= 1;
        }
        set(array, j, x, probe);
    }
}
