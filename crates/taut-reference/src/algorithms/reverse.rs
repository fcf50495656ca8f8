//! Reversal of an array from both ends.
//!
//! *Guarantee.* Each block is read once and written once: ⌈n/B⌉ misses, one more if the array begins within a block, for
//! M ≥ 2B.

use super::swap;
use crate::{NoProbe, Probe};

/// Reverses the array.
pub fn reverse<T: Copy>(array: &mut [T]) {
    reverse_instrumented(array, &mut NoProbe);
}

/// [`reverse()`] under a probe.
pub fn reverse_instrumented<T: Copy, P: Probe>(array: &mut [T], probe: &mut P) {
    probe.place(array);
    for i in 0..array.len() / 2 {
        swap(array, i, array.len() - 1 - i, probe);
    }
}
