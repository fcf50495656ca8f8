//! Searches and updates of the packed-memory array, which stands for the B-trees of the table.

use taut_reference::packed::PackedMap;

use super::{Shape, largest, log, misses, random, row};

const GRID: [Shape; 3] = [(128, 8), (1024, 8), (4096, 32)];

/// A map of the keys 0, 2, 4, … with values of a word.
fn evens(n: u64) -> PackedMap<u64, u64> {
    let entries: Vec<(u64, u64)> = (0..n).map(|i| (2 * i, i)).collect();
    let mut map = PackedMap::new();
    map.insert_batch(&entries);
    map
}

/// A search reads a line of separators for each factor 9, the count of the leaf, lines of its keys, and the value.
#[test]
fn searches_keep_the_bound() {
    let (n, searches) = (1 << 16, 20_000);
    let map = evens(n);
    let found = misses(&GRID, |probe| {
        map.place(probe);
        let mut state = 3;
        for _ in 0..searches {
            let i = random(&mut state) % n;
            assert_eq!(map.get_instrumented(2 * i, probe), Some(&i));
        }
    });
    let ratios = found
        .iter()
        .zip(GRID)
        .map(|(q, (_, b))| q / searches as f64 / (log(b as f64, n as f64) + 2.0));
    row("packed map, search, n = 65536", "log_B n + 2", largest(ratios), 1.0);
}

/// The keys of a pattern, in the order in which they come.
fn keys(pattern: &str, n: u64) -> Vec<u64> {
    let mut state = 5;
    match pattern {
        "ascending" => (0..n).collect(),
        "descending" => (0..n).rev().collect(),
        // All between the same two keys, from both sides by turns.
        "one place" => (0..n).map(|i| if i % 2 == 0 { i } else { (1 << 40) - i }).collect(),
        _ => (0..n).map(|_| random(&mut state)).collect(),
    }
}

/// Misses of an insertion and of a deletion, over the search, the share of a spreading and a constant. Leaves of 64 slots are spread in
/// windows of log₂(n/64) levels. Deletions of the least key cost most, as the first leaf runs empty again and again.
fn update_ratios(pattern: &str, n: u64) -> [f64; 2] {
    let keys = keys(pattern, n);
    let bound = |b: usize| {
        let levels = (n as f64 / 64.0).log2();
        n as f64 * (log(b as f64, n as f64) + 8.0 * levels * levels / b as f64 + 4.0)
    };
    let ratio = |found: Vec<f64>| largest(found.iter().zip(GRID).map(|(q, (_, b))| q / bound(b)));
    let mut map = PackedMap::new();
    let inserted = misses(&GRID, |probe| {
        map.place(probe);
        for &key in &keys {
            map.insert_instrumented(key, key, probe);
        }
    });
    assert!(map.check().is_ok());
    let removed = misses(&GRID, |probe| {
        map.place(probe);
        for &key in &keys {
            assert_eq!(map.remove_instrumented(key, probe), Some(key));
        }
    });
    [ratio(inserted), ratio(removed)]
}

fn updates_keep_the_bound(n: u64) {
    for pattern in ["random", "ascending", "descending", "one place"] {
        let formula = "log_B n + 8 lg²(n/64)/B + 4";
        for (name, ratio) in ["insertion", "deletion"].into_iter().zip(update_ratios(pattern, n)) {
            row(&format!("packed map, {name}, {pattern}, n = {n}"), formula, ratio, 1.0);
        }
    }
}

#[test]
fn updates_keep_the_bound_of_the_table() {
    updates_keep_the_bound(1 << 14);
}

#[test]
#[ignore = "seconds even when optimized"]
fn updates_keep_the_bound_of_the_table_at_full_size() {
    updates_keep_the_bound(1 << 17);
}
