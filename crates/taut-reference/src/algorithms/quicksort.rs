//! Quicksort at random elements, the yardstick of the optimal sorts.
//!
//! *Guarantee.* O((n/B)(1 + log₂(n/M))) misses expected, in place: Q(n) = (1/n) Σ (Q(i) + Q(n − i)) + O(1 + n/B) down to
//! parts that fit. The thesis goes on to parts of B, which costs it log₂(M/B) levels in the bound.
//! *Trap.* Both cursors stop at elements equal to the pivot, or an array of equal ones would take n² steps.
//! *Reference.* Hoare, Computer Journal 5(1), 1962; the thesis, lemma 5.2.1, corrected.

use super::{get, swap};
use crate::{NoProbe, Probe};

/// Sorts; the order of equal elements is not kept. `seed` chooses the pivots.
pub fn quicksort<T: Copy + Ord>(array: &mut [T], seed: u64) {
    quicksort_instrumented(array, seed, &mut NoProbe);
}

/// [`quicksort()`] under a probe.
pub fn quicksort_instrumented<T: Copy + Ord, P: Probe>(array: &mut [T], seed: u64, probe: &mut P) {
    probe.place(array);
    let mut random = super::Random::new(seed);
    let mut rest = array;
    // Recursion into the smaller part only: the stack stays at log₂ n whatever the pivots.
    let mut open: Vec<&mut [T]> = Vec::new();
    loop {
        if rest.len() < 2 {
            match open.pop() {
                Some(part) => rest = part,
                None => return,
            }
            continue;
        }
        let (left, right) = split(rest, &mut random, probe);
        let (smaller, larger) =
            if left.len() < right.len() { (left, right) } else { (right, left) };
        open.push(larger);
        rest = smaller;
    }
}

/// Splits in two parts, neither of them empty, at a random element.
fn split<'a, T: Copy + Ord, P: Probe>(
    array: &'a mut [T],
    random: &mut super::Random,
    probe: &mut P,
) -> (&'a mut [T], &'a mut [T]) {
    let n = array.len();
    let pivot = get(array, random.below(n), probe);
    let (mut i, mut j) = (0, n);
    let middle = loop {
        while get(array, i, probe) < pivot {
            i += 1;
        }
        j -= 1;
        while get(array, j, probe) > pivot {
            j -= 1;
        }
        if i >= j {
            break j + 1;
        }
        swap(array, i, j, probe);
        i += 1;
    };
    array.split_at_mut(middle.clamp(1, n - 1))
}
