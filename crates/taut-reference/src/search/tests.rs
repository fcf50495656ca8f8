//! All layouts against a plain search, on keys of all kinds.

use proptest::prelude::*;

use super::*;
use crate::Access;

/// Compares everything that an index can be asked with `partition_point`.
fn agrees<K: Key, I: SortedIndex<K>>(sorted: &[K], queries: &[K]) {
    let index = I::new(sorted).unwrap();
    let name = std::any::type_name::<I>();
    assert_eq!(index.len(), sorted.len());
    assert_eq!(index.is_empty(), sorted.is_empty());
    let lower = |key: K| sorted.partition_point(|other| other.word() < key.word());
    let upper = |key: K| sorted.partition_point(|other| other.word() <= key.word());
    let all: Vec<K> = sorted.iter().chain(queries).copied().collect();
    for &key in &all {
        assert_eq!(
            index.equal_range(key),
            lower(key)..upper(key),
            "{name} {key:?} {}",
            sorted.len()
        );
        assert_eq!(index.contains(key), lower(key) < upper(key), "{name} {key:?}");
    }
    let mut ranks = vec![7; 3];
    index.lower_bounds(&all, &mut ranks);
    assert!(ranks.iter().copied().eq(all.iter().map(|&key| lower(key))), "{name}");
    index.upper_bounds(&all, &mut ranks);
    assert!(ranks.iter().copied().eq(all.iter().map(|&key| upper(key))), "{name}");
}

/// A batch answers as many as both slices have places for, each in its own, and leaves the others alone.
fn answers_what_both_have_room_for<I: SortedIndex<u64>>() {
    let index = I::new(&(0..100).map(|i| 3 * i).collect::<Vec<u64>>()).unwrap();
    let most = if cfg!(miri) { 6 } else { 20 };
    for keys in 0..most {
        for places in 0..most {
            let asked: Vec<u64> = (0..keys as u64).map(|i| 31 * i % 290).collect();
            let mut ranks = vec![usize::MAX; places];
            index.ranks_of_words(&asked, |key| key, &mut ranks, &mut NoProbe);
            for (i, &rank) in ranks.iter().enumerate() {
                let want = asked.get(i).map_or(usize::MAX, |key| key.div_ceil(3) as usize);
                assert_eq!(rank, want, "{} {keys} {places}", std::any::type_name::<I>());
            }
        }
    }
}

#[test]
fn slices_of_unequal_length() {
    answers_what_both_have_room_for::<Sorted<u64>>();
    answers_what_both_have_room_for::<Eytzinger<u64>>();
    answers_what_both_have_room_for::<BlockedVanEmdeBoas<u64>>();
    answers_what_both_have_room_for::<SPlusTree<u64>>();
}

fn all_agree<K: Key>(sorted: &[K], queries: &[K]) {
    agrees::<K, Sorted<K>>(sorted, queries);
    agrees::<K, Eytzinger<K>>(sorted, queries);
    agrees::<K, BlockedVanEmdeBoas<K>>(sorted, queries);
    agrees::<K, SPlusTree<K>>(sorted, queries);
}

/// Sorts keys by their own order.
fn sorted<K: Key>(mut keys: Vec<K>) -> Vec<K> {
    keys.sort_by_key(|key| key.word());
    keys
}

#[test]
fn few_keys_and_sizes_around_powers() {
    let sizes = [0, 1, 2, 3, 4, 7, 8, 9, 15, 16, 17, 63, 64, 65, 71, 72, 73, 255, 256, 257, 447];
    let sizes = sizes.into_iter().chain([448, 449, 647, 648, 649]);
    // An interpreter has time for two levels.
    for n in sizes.filter(|n| !cfg!(miri) || [0, 1, 9, 73].contains(n)) {
        let keys: Vec<u64> = (0..n).map(|i| 2 * i + 1).collect();
        all_agree(&keys, &(0..2 * n + 2).collect::<Vec<_>>());
        let keys: Vec<u32> = (0..n as u32).map(|i| 2 * i + 1).collect();
        all_agree(&keys, &(0..2 * n as u32 + 2).collect::<Vec<_>>());
    }
}

#[test]
fn many_keys_of_several_levels() {
    let (n, queries) = if cfg!(miri) { (700, 99) } else { (300_000u64, 999) };
    let keys: Vec<u64> = (0..n).map(|i| i / 3 * 5).collect();
    let queries: Vec<u64> = (0..queries).map(|i| i * 7919 % (2 * n)).chain([u64::MAX]).collect();
    fn some<I: SortedIndex<u64>>(keys: &[u64], queries: &[u64]) {
        let index = I::new(keys).unwrap();
        let mut ranks = Vec::new();
        index.lower_bounds(queries, &mut ranks);
        for (&key, &rank) in queries.iter().zip(&ranks) {
            assert_eq!(rank, keys.partition_point(|&other| other < key));
            assert_eq!(index.lower_bound(key), rank);
            assert_eq!(index.contains(key), keys.get(rank) == Some(&key));
        }
    }
    some::<Sorted<u64>>(&keys, &queries);
    some::<Eytzinger<u64>>(&keys, &queries);
    some::<BlockedVanEmdeBoas<u64>>(&keys, &queries);
    some::<SPlusTree<u64>>(&keys, &queries);
}

#[test]
fn extreme_keys_are_keys() {
    for n in [1, 8, 9, 100].into_iter().filter(|&n| !cfg!(miri) || n < 10) {
        all_agree(&vec![u64::MAX; n], &[0, 1, u64::MAX - 1]);
        all_agree(&vec![0u64; n], &[1, u64::MAX]);
        all_agree(&vec![u32::MAX; n], &[0, u32::MAX - 1]);
    }
    let floats = [-f64::NAN, f64::NEG_INFINITY, -1.0, -0.0, 0.0, 5e-324, f64::INFINITY, f64::NAN];
    all_agree(&floats, &[f64::MAX, f64::MIN, 1.0]);
    all_agree(&floats[1..4], &floats);
    all_agree(&[f32::NAN; 5], &[0.0, f32::INFINITY]);
    all_agree(&[i64::MIN, -1, 0, i64::MAX], &[i64::MIN + 1, 1]);
}

#[test]
fn keys_out_of_order_are_named() {
    let place = |found: Result<(), Error>| match found {
        Err(Error::Option { name: "sorted", value, .. }) => value,
        other => panic!("{other:?}"),
    };
    assert_eq!(place(SPlusTree::new(&[1u64, 2, 1]).map(drop)), "descending from key 1 to key 2");
    assert_eq!(place(Sorted::new(&[0.0, -0.0]).map(drop)), "descending from key 0 to key 1");
    assert_eq!(place(Eytzinger::new(&[3i64, 2]).map(drop)), "descending from key 0 to key 1");
    assert_eq!(
        place(BlockedVanEmdeBoas::new(&[f64::NAN, 0.0]).map(drop)),
        "descending from key 0 to key 1"
    );
}

/// There are fewer keys than this, as many as an interpreter has time for.
const KEYS_MAX: usize = if cfg!(miri) { 40 } else { 200 };

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 1 } else { 256 }))]
    #[test]
    fn small_integers_bring_duplicates(
        keys in prop::collection::vec(0u64..40, 0..KEYS_MAX),
        queries in prop::collection::vec(0u64..42, 0..20),
    ) {
        all_agree(&sorted(keys), &queries);
    }

    #[test]
    fn any_bits_of_floats(
        keys in prop::collection::vec(any::<u64>().prop_map(f64::from_bits), 0..KEYS_MAX),
        queries in prop::collection::vec(any::<u64>().prop_map(f64::from_bits), 0..20),
    ) {
        all_agree(&sorted(keys), &queries);
    }

    #[test]
    fn any_integers(
        keys in prop::collection::vec(any::<i32>(), 0..KEYS_MAX),
        queries in prop::collection::vec(any::<i32>(), 0..20),
    ) {
        all_agree(&sorted(keys), &queries);
    }
}

/// Counts the distinct blocks that one search reads.
struct Blocks {
    bytes: usize,
    seen: Vec<usize>,
    placed: Vec<(usize, usize)>,
}

impl Probe for Blocks {
    const IS_RECORDING: bool = true;

    fn place_at(&mut self, address: usize, bytes: usize) {
        self.placed.push((address, bytes));
    }

    fn lift_from(&mut self, _: usize) {}

    fn record(&mut self, address: usize, bytes: usize, access: Access) {
        assert_eq!(access, Access::Read);
        let inside =
            |&(first, len): &(usize, usize)| address >= first && address + bytes <= first + len;
        assert!(self.placed.iter().any(inside), "an access outside the arrays that were told of");
        for block in address / self.bytes..=(address + bytes - 1) / self.bytes {
            if !self.seen.contains(&block) {
                self.seen.push(block);
            }
        }
    }
}

/// Blocks of `bytes` bytes that a search of 200 000 keys reads, on average.
fn blocks_read<I: SortedIndex<u64>>(bytes: usize) -> f64 {
    let keys: Vec<u64> = (0..200_000).collect();
    let index = I::new(&keys).unwrap();
    let mut probe = Blocks { bytes, seen: Vec::new(), placed: Vec::new() };
    index.place(&mut probe);
    let (searches, mut read) = (500, 0);
    for i in 0..searches {
        index.lower_bound_instrumented(i * 0x9e37_79b9 % 200_000, &mut probe);
        read += probe.seen.len();
        probe.seen.clear();
    }
    read as f64 / searches as f64
}

/// Lines and pages of one search, as the heads of the layouts promise.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn layouts_read_the_blocks_that_they_promise() {
    assert_eq!(blocks_read::<SPlusTree<u64>>(64), 6.0);
    assert_eq!(blocks_read::<BlockedVanEmdeBoas<u64>>(64), 6.0);
    assert_eq!(blocks_read::<BlockedVanEmdeBoas<u64>>(4096), 2.0);
    assert!(blocks_read::<Eytzinger<u64>>(4096) > 8.0);
    assert!(blocks_read::<Sorted<u64>>(4096) > 8.0);
}
