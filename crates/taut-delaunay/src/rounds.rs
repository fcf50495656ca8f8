//! In which order sites are inserted.
//!
//! Idea: few sites all over the set first, then ever more, each round along the Hilbert curve: the walk from the last
//! simplex made to the next site is a few steps, and the working set of a round stays in the cache.
//! Guarantee: none on the result, which any order gives alike; random rounds have expected optimal cost for any input.
//! Trap: a single round along the curve is quadratic on points of two skew lines, and half again as slow on uniform
//! points, as the cavities of its moving front are large.
//! Reference: Amenta, Choi, Rote, *Incremental constructions con BRIO*, 2003, for random rounds and
//! for blocks of a random order that are located first (Local RIC).

use taut_points::{InputError, Monitor};

use crate::kernel::{Kernel, TooMany};
use crate::threads::{Owners, SharedMesh, insert_round};
use crate::{DelaunayOptions, Error, InsertionOrder};

/// Sites between two looks at the monitor.
const BATCH: usize = 1 << 16;
/// Each round has 2³ − 1 times the sites of all rounds before.
const RATIO_BITS: u32 = 3;

impl From<TooMany> for Error {
    fn from(_: TooMany) -> Self {
        Error::TooManySimplices
    }
}

/// Inserts all sites of the kernel but those of `started`, which are in the mesh already.
pub(crate) fn insert_all<const D: usize, const V: usize, K: Kernel<D, V>>(
    kernel: &mut K,
    started: &[u32; V],
    (order, seed): (InsertionOrder, u64),
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    let count = kernel.site_count();
    match order {
        InsertionOrder::Strided => feed(kernel, strided(count), started, monitor),
        InsertionOrder::Hilbert => feed(kernel, 0..count, started, monitor),
        InsertionOrder::Random => {
            let level = |&i: &u32| hash(kernel.site(i), seed).trailing_zeros() / RATIO_BITS;
            let mut rounds: Vec<u32> = (0..count).collect();
            rounds.sort_by_key(|i| std::cmp::Reverse(level(i)));
            feed(kernel, rounds.into_iter(), started, monitor)
        }
        InsertionOrder::LocalRic => local_ric(kernel, started, seed, monitor),
    }
}

/// The same on several threads of the current pool, in orders that have rounds: the larger ones are shared among threads, 255 at
/// most.
pub(crate) fn insert_all_in_parallel<const D: usize, const V: usize, K: SharedMesh<D, V>>(
    kernel: &mut K,
    started: &[u32; V],
    options: &DelaunayOptions<'_>,
    threads: usize,
) -> Result<(), Error> {
    let DelaunayOptions { order, seed, sites_per_thread, ref monitor, .. } = *options;
    let count = kernel.site_count();
    let least = sites_per_thread.unwrap_or(K::SITES_MIN);
    if least == 0 {
        let (value, expected) = ("0".into(), "at least 1");
        return Err(InputError::Option { name: "sites_per_thread", value, expected }.into());
    }
    let threads = threads.min(Owners::THREADS_MAX);
    // So many threads have a part in a round of `sites`.
    let sharing = |sites: usize| threads.min(sites / least);
    // Where a thread ended it begins.
    let mut turns = [false, true].into_iter().cycle();
    match order {
        InsertionOrder::Strided => {
            for round in strided_rounds(count) {
                let threads = sharing(round.len as usize);
                if threads > 1 {
                    let how = (threads, turns.next().unwrap_or(false));
                    insert_round(kernel, round.len, |i| round.nth(i), started, how, monitor)?;
                } else {
                    feed(kernel, (0..round.len).map(|i| round.nth(i)), started, monitor)?;
                }
            }
            Ok(())
        }
        InsertionOrder::Random => {
            let level = |i: u32| hash(kernel.site(i), seed).trailing_zeros() / RATIO_BITS;
            let mut sites: Vec<(u32, u32)> = (0..count).map(|i| (u32::MAX - level(i), i)).collect();
            sites.sort_unstable();
            for round in sites.chunk_by(|a, b| a.0 == b.0) {
                let threads = sharing(round.len());
                if threads > 1 {
                    let nth = |i: u32| round[i as usize].1;
                    let how = (threads, turns.next().unwrap_or(false));
                    insert_round(kernel, round.len() as u32, nth, started, how, monitor)?;
                } else {
                    feed(kernel, round.iter().map(|&(_, site)| site), started, monitor)?;
                }
            }
            Ok(())
        }
        _ => insert_all(kernel, started, (order, seed), monitor),
    }
}

/// One round of [`InsertionOrder::Strided`].
struct StridedRound {
    shift: u32,
    /// The first round has every place, the others all but those of rounds before.
    is_first: bool,
    len: u32,
}

impl StridedRound {
    /// Site number `i` of the round.
    fn nth(&self, i: u32) -> u32 {
        const SKIPPED: u32 = (1 << RATIO_BITS) - 1;
        let place = if self.is_first { i } else { i + i / SKIPPED + 1 };
        place << self.shift
    }
}

/// The rounds of 0 to `count`: every 8ᵏ-th number that is no 8ᵏ⁺¹-th, for k from large to 0.
fn strided_rounds(count: u32) -> impl Iterator<Item = StridedRound> {
    let top = count.max(1).ilog2() / RATIO_BITS;
    (0..=top).rev().map(move |level| {
        let shift = level * RATIO_BITS;
        let places = count.div_ceil(1 << shift);
        let is_first = level == top;
        let len = if is_first { places } else { places - places.div_ceil(1 << RATIO_BITS) };
        StridedRound { shift, is_first, len }
    })
}

/// The numbers of all rounds.
fn strided(count: u32) -> impl Iterator<Item = u32> {
    strided_rounds(count).flat_map(|round| (0..round.len).map(move |i| round.nth(i)))
}

/// Hands an order to the kernel in batches.
fn feed<const D: usize, const V: usize, K: Kernel<D, V>>(
    kernel: &mut K,
    order: impl Iterator<Item = u32>,
    started: &[u32; V],
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    let mut batch = Vec::with_capacity(BATCH.min(order.size_hint().1.unwrap_or(BATCH)));
    let mut order = order.filter(|i| !started.contains(i)).peekable();
    while order.peek().is_some() {
        batch.clear();
        batch.extend(order.by_ref().take(BATCH));
        kernel.insert(&batch)?;
        monitor.points(batch.len() as u64);
        monitor.check()?;
    }
    Ok(())
}

/// A hash of a point: the random order is a function of the coordinates, not of the input order.
fn hash<const D: usize>(site: [f64; D], seed: u64) -> u64 {
    site.iter().fold(seed ^ 0x9E37_79B9_7F4A_7C15, |h, x| {
        let mixed = (h ^ x.to_bits()).wrapping_mul(0xD6E8_FEB8_6659_FD93);
        (mixed ^ mixed >> 32).wrapping_mul(0xD6E8_FEB8_6659_FD93)
    })
}

/// Local RIC with blocks of 8, 8², 8³, … sites of a random order: locate all of a block, then insert simplex by simplex.
fn local_ric<const D: usize, const V: usize, K: Kernel<D, V>>(
    kernel: &mut K,
    started: &[u32; V],
    seed: u64,
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    let mut permutation: Vec<u32> =
        (0..kernel.site_count()).filter(|i| !started.contains(i)).collect();
    permutation.sort_by_cached_key(|&i| hash(kernel.site(i), seed));
    let (mut begin, mut size) = (0, 1usize << RATIO_BITS);
    while begin < permutation.len() {
        let end = permutation.len().min(begin + size);
        // (the simplex that holds it, by its place along the curve; the place in the permutation; the site)
        let mut located: Vec<(u32, u32, u32, u32)> = Vec::with_capacity(end - begin);
        let mut along: Vec<u32> = (begin as u32..end as u32).collect();
        along.sort_unstable_by_key(|&place| permutation[place as usize]);
        let mut hint = kernel.last();
        for place in along {
            let site = permutation[place as usize];
            hint = kernel.locate(kernel.site(site), hint);
            let first =
                kernel.simplices()[hint as usize].vertices.iter().copied().min().unwrap_or(0);
            located.push((first, hint, place, site));
        }
        located.sort_unstable();
        let order = located.iter().map(|&(_, _, _, site)| site);
        feed(kernel, order, started, monitor)?;
        (begin, size) = (end, size << RATIO_BITS);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strides_meet_every_site_once_in_growing_rounds() {
        for count in [1u32, 2, 7, 8, 9, 63, 64, 65, 1000, 4096] {
            let order: Vec<u32> = strided(count).collect();
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..count).collect::<Vec<_>>());
        }
        let order: Vec<u32> = strided(1000).collect();
        assert_eq!(order[..3], [0, 512, 64]);
        assert!(order[125..].is_sorted(), "the last round runs along the curve");
    }
}
