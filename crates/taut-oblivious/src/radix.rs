//! Sorting of packed records `key << 32 | payload` by key, in two buffers.
//!
//! Idea: one pass deals the records into about 2000 buckets by their leading bits; a bucket then fits the cache, where
//! short passes by trailing bits finish it. Buckets are independent, so they are shared among threads.
//! Guarantee: stable; O(n) for 32-bit keys; the result does not depend on the number of threads.
//! Trap: passes by trailing bits cost a table of counts each; below a hundred records comparing is faster.
//! Reference: Knuth, *The Art of Computer Programming* 3, 5.2.5 (distribution sorting).

use rayon::prelude::*;

/// Leading bits dealt at first.
const LEADING: u32 = 11;
/// Bits of one trailing pass; three of them and the leading bits make up 32.
const TRAILING: u32 = 7;
/// Buckets shorter than this are sorted by comparing.
const COMPARE_BELOW: usize = 96;
/// Below this many records nothing is shared among threads.
const ALONE_BELOW: usize = 1 << 16;

fn key(record: u64) -> u32 {
    (record >> 32) as u32
}

/// Sorts `records` by their upper 32 bits; records with equal keys keep their order.
///
/// `scratch` has the same length; what it holds afterwards is of no use.
pub(crate) fn sort(records: &mut [u64], scratch: &mut [u64]) {
    if records.len() < 2 * COMPARE_BELOW {
        records.sort_by_key(|&r| key(r));
        return;
    }
    let largest = records.iter().fold(0, |largest, &r| largest.max(key(r)));
    let shift = (32 - largest.leading_zeros()).saturating_sub(LEADING);
    let starts = deal(records, scratch, |r| (key(r) >> shift) as usize);
    let finish = |(sorted, dealt): (&mut [u64], &mut [u64])| finish_bucket(sorted, dealt, shift);
    if records.len() < ALONE_BELOW || rayon::current_num_threads() == 1 {
        buckets(records, scratch, &starts).into_iter().for_each(finish);
    } else {
        buckets(records, scratch, &starts).into_par_iter().with_min_len(16).for_each(finish);
    }
}

/// Deals `from` into `to` by bucket and returns where each bucket starts, and the end.
fn deal(from: &[u64], to: &mut [u64], bucket: impl Fn(u64) -> usize) -> Vec<usize> {
    let mut starts = vec![0; (1 << LEADING) + 1];
    for &r in from {
        starts[bucket(r) + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut next = starts.clone();
    for &r in from {
        let place = &mut next[bucket(r)];
        to[*place] = r;
        *place += 1;
    }
    starts
}

/// Both buffers cut at the same places, empty buckets left out.
fn buckets<'a>(
    mut sorted: &'a mut [u64],
    mut dealt: &'a mut [u64],
    starts: &[usize],
) -> Vec<(&'a mut [u64], &'a mut [u64])> {
    let mut cut = Vec::new();
    for ends in starts.windows(2) {
        let length = ends[1] - ends[0];
        if length > 0 {
            let (sorted_head, dealt_head);
            (sorted_head, sorted) = sorted.split_at_mut(length);
            (dealt_head, dealt) = dealt.split_at_mut(length);
            cut.push((sorted_head, dealt_head));
        }
    }
    cut
}

/// Sorts what was dealt into one bucket by the `bits` trailing bits of the keys.
fn finish_bucket(sorted: &mut [u64], dealt: &mut [u64], bits: u32) {
    if dealt.len() < COMPARE_BELOW || bits == 0 {
        sorted.copy_from_slice(dealt);
        if bits > 0 {
            sorted.sort_by_key(|&r| key(r));
        }
        return;
    }
    let passes = bits.div_ceil(TRAILING);
    for pass in 0..passes {
        let digit = |r: u64| (key(r) >> (pass * TRAILING)) as usize & ((1 << TRAILING) - 1);
        let (from, to): (&[u64], &mut [u64]) =
            if pass % 2 == 0 { (dealt, sorted) } else { (sorted, dealt) };
        let mut next = [0u32; 1 << TRAILING];
        for &r in from {
            next[digit(r)] += 1;
        }
        let mut start = 0;
        for place in &mut next {
            (start, *place) = (start + *place, start);
        }
        for &r in from {
            let place = &mut next[digit(r)];
            to[*place as usize] = r;
            *place += 1;
        }
    }
    if passes.is_multiple_of(2) {
        sorted.copy_from_slice(dealt);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn equals_a_stable_sort(
            length in 0usize..5000,
            spread in 0u32..32,
            seed in any::<u64>(),
        ) {
            let mut state = seed | 1;
            let mut records: Vec<u64> = (0..length as u64)
                .map(|i| {
                    state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                    (state >> 32 >> spread) << 32 | i
                })
                .collect();
            let mut expected = records.clone();
            expected.sort_by_key(|&r| key(r));
            sort(&mut records, &mut vec![0; length]);
            prop_assert_eq!(records, expected);
        }
    }

    #[test]
    fn threads_do_not_change_the_result() {
        let records: Vec<u64> = (0..300_000u64)
            .map(|i| (i.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) << 32 | i)
            .collect();
        let on = |threads| {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let mut sorted = records.clone();
            pool.install(|| sort(&mut sorted, &mut vec![0; records.len()]));
            sorted
        };
        let alone = on(1);
        assert!(alone.is_sorted());
        assert_eq!(alone, on(3));
    }
}
