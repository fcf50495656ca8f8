//! Sorting: numbers, records by a number in them, and files of records by a key.
//!
//! | you want | call | order | room |
//! |---|---|---|---|
//! | numbers in order | [`sort`] | total, NaN at the ends | none; one word each for 32-bit numbers |
//! | records in order of a number | [`sort_records`] | stable | some megabytes a thread, and a thirtieth of the records at most |
//! | a file of records in order of a key | [`external::sort_file`] | stable | a limit that is given |
//!
//! The result is a function of the input alone: vectors, their absence and threads change no byte.
#[cfg(target_arch = "x86_64")]
mod avx512;
pub mod external;
mod quick;
mod records;
#[cfg(test)]
mod tests;

use crate::Key;
use crate::key::{of_rank, rank};
use crate::probe::{NoProbe, Probe};

/// Up to this many numbers are compared with each other instead of being turned into ranks.
const COMPARISON_SORT_MAX: usize = 16;

/// Sorts numbers in place, floating-point numbers in the total order of [`f64::total_cmp`].
///
/// With AVX-512 by a quicksort of eight keys at a time, else by the standard library. Numbers of 32 bits are widened to
/// words, for which memory is allocated. Runs on the current rayon pool. O(n log n) whatever the input; O(n) if it rises
/// or falls.
///
/// ```
/// let mut numbers = [1.0, f64::NAN, -0.0, 0.0, f64::NEG_INFINITY];
/// taut_oblivious::sort(&mut numbers);
/// assert_eq!(format!("{numbers:?}"), "[-inf, -0.0, 0.0, 1.0, NaN]");
/// ```
pub fn sort<K: Key>(keys: &mut [K]) {
    sort_instrumented(keys, &mut NoProbe);
}

/// [`sort`], on one thread if the probe records.
///
/// # Panics
/// If the probe does; the numbers are then other ones.
pub fn sort_instrumented<K: Key, P: Probe>(keys: &mut [K], probe: &mut P) {
    probe.place(keys);
    probe.read(keys);
    if keys.len() <= COMPARISON_SORT_MAX {
        keys.sort_unstable_by_key(|&key| rank(key));
        return probe.write(keys);
    }
    if let Some(run) = run(keys, &|&key: &K| rank(key)) {
        if run == Run::Falls {
            keys.reverse();
            probe.write(keys);
        }
        return;
    }
    if let Some(ranks) = into_ranks(keys) {
        quick::sort(ranks, probe);
        out_of_ranks::<K>(ranks);
        probe.read(ranks);
        probe.write(ranks);
    } else {
        let mut words: Vec<u64> = keys.iter().map(|&key| rank(key)).collect();
        probe.place(&words);
        probe.write(&words);
        quick::sort(&mut words, probe);
        for (key, &word) in keys.iter_mut().zip(&words) {
            *key = of_rank(word);
        }
        probe.read(&words);
        probe.lift(&words);
        probe.write(keys);
    }
}

/// Keys of the size of words turned into words that are ranks, in place; none for keys that are smaller.
fn into_ranks<K: Key>(keys: &mut [K]) -> Option<&mut [u64]> {
    if size_of::<K>() < size_of::<u64>() {
        return None;
    }
    for key in keys.iter_mut() {
        *key = bytemuck::cast(rank(*key));
    }
    Some(bytemuck::cast_slice_mut(keys))
}

/// Ranks turned back into keys.
fn out_of_ranks<K: Key>(ranks: &mut [u64]) {
    for rank in ranks {
        *rank = bytemuck::cast(of_rank::<K>(*rank));
    }
}

/// The order of a whole input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Run {
    /// No rank is below the one before.
    Rises,
    /// Each rank is below the one before.
    Falls,
}

/// Tests whether the ranks of at least one item only rise or only fall.
fn run<T>(items: &[T], rank: &impl Fn(&T) -> u64) -> Option<Run> {
    // Blocks without an exit in them compile to vectors.
    let (front, back) = (&items[..items.len() - 1], &items[1..]);
    let blocks = || front.chunks(256).zip(back.chunks(256));
    let each = |a: &[T], b: &[T], holds: fn(u64, u64) -> bool| {
        a.iter().zip(b).fold(true, |yes, (a, b)| yes & holds(rank(a), rank(b)))
    };
    if rank(&items[0]) <= rank(&items[items.len() - 1]) {
        blocks().all(|(a, b)| each(a, b, |a, b| a <= b)).then_some(Run::Rises)
    } else {
        blocks().all(|(a, b)| each(a, b, |a, b| a > b)).then_some(Run::Falls)
    }
}

/// Sorts records in place by a number in each; records with equal numbers keep their order.
///
/// The order of numbers is that of [`sort`]. Some megabytes for each thread are allocated while it runs, and the records are moved five
/// times, four of them in blocks; for records above some 256 bytes, sort numbers of them instead. Runs on the current
/// rayon pool, where dealing is the work of one thread. O(n) passes over memory for numbers that spread, O(n log n) whatever the input.
///
/// # Panics
/// If `key` does; the records are then in some order, and some may be doubled at the cost of others.
///
/// ```
/// let mut points = [(2.0, 'b'), (-1.0, 'a'), (2.0, 'a')];
/// taut_oblivious::sort_records(&mut points, |point| point.0);
/// assert_eq!(points, [(-1.0, 'a'), (2.0, 'b'), (2.0, 'a')]);
/// ```
pub fn sort_records<T: Copy + Send + Sync, K: Key>(
    records: &mut [T],
    key: impl Fn(&T) -> K + Sync,
) {
    sort_records_instrumented(records, key, &mut NoProbe);
}

/// [`sort_records`], on one thread if the probe records.
pub fn sort_records_instrumented<T: Copy + Send + Sync, K: Key, P: Probe>(
    records: &mut [T],
    key: impl Fn(&T) -> K + Sync,
    probe: &mut P,
) {
    records::sort(records, &|record: &T| rank(key(record)), &records::BucketBuffers::any(), probe);
}
