//! Uniformly random order, block by block.
//!
//! *Idea.* Deal each item into one of 256 buckets by a random byte; shuffle the buckets one by one, which fit the cache
//! sooner or later; where they do, exchange items.
//! *Guarantee.* Each order comes with the same probability: sort by long random numbers, of which only the digits that
//! are needed are ever drawn. O((n/B) log₂₅₆ (n/M)) misses, where exchanging all over the array has n.
//! *Trap.* The bytes are drawn twice, to count and to deal, from the same stream; a stream for each block of the input and
//! each bucket makes the order a function of the seed.
//! *References.* C. R. Rao, *Generation of random permutations of given number of elements using random sampling numbers*,
//! Sankhya A 23, 1961; M. Sandelius, *A simple randomization procedure*, J. Royal Stat. Soc. B 24(2), 1962;
//! R. Durstenfeld, *Algorithm 235*, CACM 7(7), 1964 (exchanging).

use rayon::prelude::*;

use super::random::Random;
use crate::probe::{NoProbe, Probe};
use crate::room;

/// Buckets: a byte of randomness for each item.
const BUCKETS: usize = 256;
/// Bytes that fit the second-level cache with ease.
const CACHE_BYTES: usize = 1 << 18;

/// Puts items into uniformly random order, which depends on the seed and their number alone.
///
/// Runs on the current rayon pool. Memory for as many items again is allocated if they are more than some 256 KiB.
///
/// ```
/// let mut cards: Vec<u8> = (0..52).collect();
/// taut_oblivious::shuffle(&mut cards, 1);
/// assert!(!cards.is_sorted());
/// ```
pub fn shuffle<T: Copy + Send + Sync>(items: &mut [T], seed: u64) {
    part::<T, NoProbe, CACHE_BYTES>(items, seed, 1, &mut NoProbe);
}

/// [`shuffle`], on one thread if anybody listens to the touches.
pub fn shuffle_probed<T: Copy + Send + Sync, P: Probe>(items: &mut [T], seed: u64, probe: &mut P) {
    probe.place(items);
    part::<T, P, CACHE_BYTES>(items, seed, 1, probe);
}

/// Shuffles a bucket; `CACHE` bytes are exchanged.
pub(super) fn part<T: Copy + Send + Sync, P: Probe, const CACHE: usize>(
    items: &mut [T],
    seed: u64,
    node: u64,
    probe: &mut P,
) {
    let mut random = Random::new(seed, node);
    if size_of_val(items) <= CACHE || items.len() < 4 {
        return exchange(items, &mut random, probe);
    }
    let ends = deal(items, &random, probe);
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
    if P::LISTENS || rayon::current_num_threads() == 1 {
        for (node, bucket) in buckets {
            part::<T, P, CACHE>(bucket, seed, node, probe);
        }
    } else {
        buckets.into_par_iter().for_each(|(node, bucket)| {
            part::<T, NoProbe, CACHE>(bucket, seed, node, &mut NoProbe);
        });
    }
}

/// Each item in turn, from the last, changes places with one at or before it.
fn exchange<T, P: Probe>(items: &mut [T], random: &mut Random, probe: &mut P) {
    for last in (1..items.len()).rev() {
        let other = random.below(last as u64 + 1) as usize;
        items.swap(last, other);
        if P::LISTENS {
            for i in [last, other] {
                probe.read(&items[i..=i]);
                probe.write(&items[i..=i]);
            }
        }
    }
}

/// Deals items into buckets; returns where each ends.
fn deal<T: Copy, P: Probe>(items: &mut [T], random: &Random, probe: &mut P) -> [usize; BUCKETS] {
    let mut next = [0; BUCKETS];
    bytes(random, items.len(), |bucket, _| next[bucket] += 1);
    let mut start = 0;
    for next in &mut next {
        (start, *next) = (start + *next, start);
    }
    let copy = room::filled(items.iter().copied());
    probe.place(&copy);
    probe.read(items);
    probe.write(&copy);
    bytes(random, items.len(), |bucket, i| {
        let place = &mut next[bucket];
        items[*place] = copy[i];
        if P::LISTENS {
            probe.read(&copy[i..=i]);
            probe.write(&items[*place..=*place]);
        }
        *place += 1;
    });
    probe.lift(&copy);
    next
}

/// Calls `each` with a random byte for each of `n` items, eight of them from one word.
fn bytes(random: &Random, n: usize, mut each: impl FnMut(usize, usize)) {
    let mut random = random.clone();
    for first in (0..n).step_by(8) {
        let word = random.next().to_le_bytes();
        for (i, byte) in (first..n).zip(word) {
            each(usize::from(byte), i);
        }
    }
}
