//! What is allocated while wide records are sorted and shuffled.

mod counting;

use counting::peak;
use taut_oblivious::{shuffle, sort_records};

/// Numbers without pattern.
fn random(i: u64) -> u64 {
    let x = i.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    (x ^ x >> 31).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 8
}

/// A record of 64 KiB.
type Wide = [u64; 8192];

#[test]
fn wide_records_are_dealt_into_few_buckets() {
    let key = |i: u64| if i.is_multiple_of(20) { random(i) } else { random(i) % 1000 };
    let mut records: Vec<Wide> = (0..600).map(|i| [key(i); 8192]).collect();
    let mut expected: Vec<u64> = (0..600).map(key).collect();
    expected.sort_unstable();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("a pool");
    let ((), bytes) = peak(|| pool.install(|| sort_records(&mut records, |record| record[0])));
    assert!(records.iter().zip(&expected).all(|(record, &key)| *record == [key; 8192]));
    assert!(bytes <= 16 << 20, "{bytes} bytes");
    // The order of a shuffle must not depend on the width, so it always has 256 buckets; fewer records have none.
    let ((), bytes) = peak(|| pool.install(|| shuffle(&mut records, 1)));
    assert!(bytes < 1 << 20, "{bytes} bytes");
}
