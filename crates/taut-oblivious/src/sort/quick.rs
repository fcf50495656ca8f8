//! Quicksort of 64-bit keys over vector kernels.
//!
//! *Idea.* The median of 64 keys from all over the array is the pivot; a vector partition; networks below 129 keys.
//! *Guarantee.* O(n log n): after 2 log₂ n levels the standard library's sort takes over. Equal keys are no trap: a
//! pivot that is known to be the smallest key is partitioned from what is larger, and is done.
//! *References.* Those of the kernels; O. Peters, *Pattern-defeating quicksort*, arXiv 2106.05123 (equal keys).

#[cfg(target_arch = "x86_64")]
use crate::level::{Avx512, Level};
#[cfg(target_arch = "x86_64")]
use crate::probe::NoProbe;
use crate::probe::Probe;

/// Up to this many keys are sorted by the standard library: a network would be filled with nothing.
#[cfg(target_arch = "x86_64")]
const STANDARD_SORT_MAX: usize = 16;

/// Sorts; on the current rayon pool if the probe does not record.
pub(super) fn sort<P: Probe>(keys: &mut [u64], probe: &mut P) {
    #[cfg(target_arch = "x86_64")]
    if !P::IS_RECORDING
        && keys.len() >= vector::SHARED_KEYS_MIN
        && rayon::current_num_threads() > 1
        && let Level::Avx512(kernel) = Level::best()
    {
        return vector::share(kernel, keys, None, 2 * keys.len().ilog2());
    }
    alone(keys, probe);
}

/// Sorts on one thread.
pub(super) fn alone<P: Probe>(keys: &mut [u64], probe: &mut P) {
    #[cfg(target_arch = "x86_64")]
    if keys.len() > STANDARD_SORT_MAX
        && let Level::Avx512(kernel) = Level::best()
    {
        return vector::descend(kernel, keys, None, 2 * keys.len().ilog2(), probe);
    }
    compare(keys, probe);
}

/// Sorts by the standard library.
fn compare<P: Probe>(keys: &mut [u64], probe: &mut P) {
    keys.sort_unstable();
    probe.read(keys);
    probe.write(keys);
}

/// The parts that need the vector kernels.
#[cfg(target_arch = "x86_64")]
mod vector {
    use super::{Avx512, NoProbe, Probe, compare};
    use crate::sort::avx512::NETWORK_KEYS_MAX;

    /// From this many keys on, the two sides of a pivot may go to two threads.
    pub(super) const SHARED_KEYS_MIN: usize = 1 << 16;
    /// From this many keys on, the pivot is the median of more than one sample.
    const MANY_SAMPLES_MIN: usize = 1 << 12;

    /// The pivot: nearly the median of 56 keys, seven times eight neighbors; where there are many keys, the median of
    /// 128 from as many places.
    fn pivot(kernel: Avx512, keys: &[u64]) -> u64 {
        if keys.len() < MANY_SAMPLES_MIN {
            let mut sample = [0; 56];
            let step = (keys.len() - 8) / 6;
            for (i, eight) in sample.chunks_exact_mut(8).enumerate() {
                eight.copy_from_slice(&keys[i * step..][..8]);
            }
            return kernel.near_median(&sample);
        }
        let mut sample = [0; 128];
        // Steps of an irrational share of the length fall in with no period of the input.
        let mut place = 0.0;
        for key in &mut sample {
            place += 0.618_033_988_749_894_9;
            place -= f64::trunc(place);
            *key = keys[(place * keys.len() as f64) as usize];
        }
        kernel.small(&mut sample);
        sample[64]
    }

    /// Partitions; `keys[..a]` and `keys[b..]` are then to be sorted, none of the latter being below the pivot, which
    /// comes third. No key is below `floor`.
    fn split(kernel: Avx512, keys: &mut [u64], floor: Option<u64>) -> (usize, usize, u64) {
        let pivot = pivot(kernel, keys);
        let below = if floor == Some(pivot) { 0 } else { kernel.partition(keys, pivot, false) };
        if below > 0 {
            return (below, below, pivot);
        }
        (0, kernel.partition(keys, pivot, true), pivot)
    }

    /// Sorts on one thread.
    pub(super) fn descend<P: Probe>(
        kernel: Avx512,
        mut keys: &mut [u64],
        mut floor: Option<u64>,
        mut levels: u32,
        probe: &mut P,
    ) {
        while keys.len() > NETWORK_KEYS_MAX {
            if levels == 0 {
                return compare(keys, probe);
            }
            levels -= 1;
            let (low, high, pivot) = split(kernel, keys, floor);
            probe.read(keys);
            probe.write(keys);
            let (below, rest) = keys.split_at_mut(low);
            descend(kernel, below, floor, levels, probe);
            (keys, floor) = (&mut rest[high - low..], Some(pivot));
        }
        kernel.small(keys);
        probe.read(keys);
        probe.write(keys);
    }

    /// Sorts on all threads of the pool.
    pub(super) fn share(kernel: Avx512, keys: &mut [u64], floor: Option<u64>, levels: u32) {
        if keys.len() < SHARED_KEYS_MIN || levels == 0 {
            return descend(kernel, keys, floor, levels, &mut NoProbe);
        }
        let (low, high, pivot) = split(kernel, keys, floor);
        let (below, rest) = keys.split_at_mut(low);
        let above = &mut rest[high - low..];
        taut_points::parallel::join(
            || share(kernel, below, floor, levels - 1),
            || share(kernel, above, Some(pivot), levels - 1),
        );
    }
}
