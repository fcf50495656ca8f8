//! Sorting by a distributor: n^(1/3) buckets of about n^(2/3), each sorted in the same way.
//!
//! *Guarantee.* O((n/B)(1 + log_M n)) misses expected in a tall cache; a bucket that holds more than three quarters by
//! bad luck is merge sorted.
//! *Trap.* Equal elements need parts of their own, see [`super::sample`].
//! *Reference.* The thesis, 6.1, which sketches it in one sentence.

use super::distributor::{Distributor, DistributorForm};
use super::median::insertion_sort;
use super::mergesort::mergesort_instrumented;
use super::sample::{bounds, draw, oversampling};
use super::{Random, set};
use crate::{NoProbe, Probe};

/// Up to this many elements are sorted by insertion.
const INSERTION_SORT_MAX: usize = 64;

/// Sorts; the order of equal elements is not kept. `seed` chooses the samples, and changes nothing but the cost.
pub fn distributor_sort<T: Copy + Ord>(array: &mut [T], form: DistributorForm, seed: u64) {
    distributor_sort_instrumented(array, form, seed, &mut NoProbe);
}

/// [`distributor_sort()`] under a probe.
pub fn distributor_sort_instrumented<T: Copy + Ord, P: Probe>(
    array: &mut [T],
    form: DistributorForm,
    seed: u64,
    probe: &mut P,
) {
    probe.place(array);
    sort(array, form, &mut Random::new(seed), probe);
}

fn sort<T: Copy + Ord, P: Probe>(
    array: &mut [T],
    form: DistributorForm,
    random: &mut Random,
    probe: &mut P,
) {
    let n = array.len();
    if n <= INSERTION_SORT_MAX {
        insertion_sort(array, probe);
        return;
    }
    let k = 1 << (n.ilog2() as usize).div_ceil(3);
    let mut sample = vec![array[0]; oversampling(n) * k];
    probe.place(&sample);
    draw(array, &mut sample, random, probe);
    sort(&mut sample, form, random, probe);
    let found = bounds(&sample, k, probe);
    probe.lift(&sample);
    let one_value = |j: usize| j > 0 && j < found.len() && found[j - 1] == found[j];
    let buckets =
        Distributor::between(&found, one_value, form).distribute_instrumented(array, probe);
    let mut end = 0;
    for j in 0..buckets.len() {
        buckets.visit(
            j,
            |x, probe| {
                set(array, end, x, probe);
                end += 1;
            },
            probe,
        );
    }
    buckets.lift(probe);
    let mut rest = array;
    for j in 0..buckets.len() {
        let (part, behind) = rest.split_at_mut(buckets.count(j));
        rest = behind;
        if one_value(j) {
            continue;
        }
        if part.len() > n - n / 4 {
            mergesort_instrumented(part, probe);
        } else {
            sort(part, form, random, probe);
        }
    }
}
