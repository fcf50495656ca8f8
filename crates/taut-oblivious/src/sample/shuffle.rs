//! Uniformly random order, block by block.
//!
//! *Idea.* Deal each item into one of 256 buckets by a random byte; shuffle the buckets one by one, which fit the cache
//! sooner or later; where they do, exchange items.
//! *Guarantee.* Each order comes with the same probability: sort by long random numbers, of which only the digits that
//! are needed are ever drawn. O((n/B) log₂₅₆ (n/M)) misses, where exchanging all over the array has n.
//! *Trap.* Which items are exchanged must depend on their number and not on their size, or keys and values that are
//! shuffled apart with one seed part company. A stream of random numbers for each bucket makes threads no matter.
//! *References.* C. R. Rao, *Generation of random permutations of given number of elements using random sampling numbers*,
//! Sankhya A 23, 1961; M. Sandelius, *A simple randomization procedure*, J. Royal Stat. Soc. B 24(2), 1962;
//! R. Durstenfeld, *Algorithm 235*, CACM 7(7), 1964 (exchanging).

use taut_points::parallel::IntoParallel;

use super::random::Random;
use crate::deal::Dealt;
use crate::probe::{NoProbe, Probe};

/// Buckets: a byte of randomness for each item.
const BUCKETS: usize = 256;
/// Up to this many items are exchanged all over: up to 32 bytes each they fit the second-level cache.
const WHOLE_SHUFFLE_MAX: usize = 1 << 15;

/// Puts items into uniformly random order, which depends on the seed and their number alone: arrays of one length that are
/// shuffled with one seed keep their items side by side, whatever they hold.
///
/// Runs on the current rayon pool. More than 32 768 items take room for 257 blocks on each thread, of half a KiB to one or of
/// four items where these are wider, and for a thirtieth of the items at most.
///
/// ```
/// let mut cards: Vec<u8> = (0..52).collect();
/// taut_oblivious::shuffle(&mut cards, 1);
/// assert!(!cards.is_sorted());
/// ```
pub fn shuffle<T: Copy + Send + Sync>(items: &mut [T], seed: u64) {
    part::<T, NoProbe, WHOLE_SHUFFLE_MAX>(items, seed, 1, &mut NoProbe);
}

/// [`shuffle`], on one thread if the probe records.
pub fn shuffle_instrumented<T: Copy + Send + Sync, P: Probe>(
    items: &mut [T],
    seed: u64,
    probe: &mut P,
) {
    probe.place(items);
    part::<T, P, WHOLE_SHUFFLE_MAX>(items, seed, 1, probe);
}

/// Shuffles a bucket; up to `WHOLE_SHUFFLE_MAX` items, and at least three, are exchanged.
pub(super) fn part<T: Copy + Send + Sync, P: Probe, const WHOLE_SHUFFLE_MAX: usize>(
    items: &mut [T],
    seed: u64,
    node: u64,
    probe: &mut P,
) {
    let mut random = Random::new(seed, node);
    if items.len() <= WHOLE_SHUFFLE_MAX.max(3) {
        return exchange(items, &mut random, probe);
    }
    // Eight bytes of each word, one for each item.
    let mut left = (0, 0);
    let byte = |_: &T| {
        if left.1 == 0 {
            left = (random.next(), 8);
        }
        let byte = left.0 as u8;
        left = (left.0 >> 8, left.1 - 1);
        usize::from(byte)
    };
    let ends = Dealt::new(items, BUCKETS, byte, probe).put(probe);
    // The root of a tree of 256 children is 1; numbers wrap beyond 2⁶⁴ items, of which there are none.
    let child = |i: usize| node.wrapping_mul(BUCKETS as u64).wrapping_add(i as u64);
    let mut buckets = Vec::with_capacity(BUCKETS);
    let (mut rest, mut start) = (items, 0);
    for (i, end) in ends.into_iter().enumerate() {
        let bucket;
        (bucket, rest) = rest.split_at_mut(end - start);
        start = end;
        buckets.push((child(i), bucket));
    }
    if P::IS_RECORDING || rayon::current_num_threads() == 1 {
        for (node, bucket) in buckets {
            part::<T, P, WHOLE_SHUFFLE_MAX>(bucket, seed, node, probe);
        }
    } else {
        buckets.into_par_iter().for_each(|(node, bucket)| {
            part::<T, NoProbe, WHOLE_SHUFFLE_MAX>(bucket, seed, node, &mut NoProbe);
        });
    }
}

/// Each item in turn, from the last, changes places with one at or before it.
fn exchange<T, P: Probe>(items: &mut [T], random: &mut Random, probe: &mut P) {
    for last in (1..items.len()).rev() {
        let other = random.below(last as u64 + 1) as usize;
        items.swap(last, other);
        if P::IS_RECORDING {
            for i in [last, other] {
                probe.read(&items[i..=i]);
                probe.write(&items[i..=i]);
            }
        }
    }
}
