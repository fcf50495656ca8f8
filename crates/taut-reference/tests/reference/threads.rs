//! Batches into packed arrays give the same bytes for any number of threads: they are sorted as records are.

use taut_reference::packed::{PackedMap, PackedSet};

/// Words without pattern.
fn words(n: usize, seed: u64) -> impl Iterator<Item = u64> {
    (0..n as u64).map(move |i| {
        let x = (i ^ seed).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (x ^ x >> 31).wrapping_mul(0xbf58_476d_1ce4_e5b9)
    })
}

fn map() -> Vec<(u64, u64)> {
    let mut map = PackedMap::<u64, u64>::new();
    for seed in [8, !8] {
        let entries: Vec<_> = words(80_000, seed).map(|w| w >> 46).zip(0..).collect();
        map.insert_batch(&entries);
    }
    map.check().expect("densities within their bounds");
    map.iter().collect()
}

fn set() -> Vec<u64> {
    let mut set = PackedSet::<u64>::new();
    for seed in [8, !8] {
        set.insert_batch(&words(150_000, seed).collect::<Vec<_>>());
    }
    set.iter().chain([set.slots() as u64, set.moves()]).collect()
}

#[test]
fn one_two_and_eight_threads_give_the_same_arrays() {
    let [one, two, eight] = [1, 2, 8].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a pool").install(|| (map(), set()))
    });
    assert!(one.0.len() > 50_000 && one.1.len() > 250_000);
    assert!(one == two, "two threads");
    assert!(one == eight, "eight threads");
}
