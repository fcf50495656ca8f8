//! Files of which the runs are dealt, and handed on by buckets.

use super::*;
use crate::test_length::long_or;

/// This is the least memory from which on records are dealt, in bytes.
const DEALT_MEMORY_MIN: usize = 16 << 20;

fn check(layout: &RecordLayout, bytes: &[u8], what: &str) -> FileSort {
    let folder = Folder::with(bytes);
    let (mut found, mut sorted) = (FileSort::default(), expected(bytes, layout));
    // More than two sort in place.
    for &threads in long_or(&[1, 2, 3][..], &[1, 3]) {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        found = pool.install(|| folder.sort(layout, DEALT_MEMORY_MIN)).expect("sorted");
        let output = fs::read(folder.path("out")).expect("an output");
        assert!(output == sorted, "{what}, width {}, {threads} threads", layout.width);
        sorted = output;
    }
    found
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn keys_that_spread_and_keys_that_crowd() {
    // One run of some buckets; more than fits, in runs of which the last is short.
    let sizes =
        [(8, 3 << 20), (32, long_or(20_000_000, 10_000_000)), (24, 8 << 20), (64, 12_345_664)];
    for (width, size) in sizes.into_iter().take(long_or(usize::MAX, 2)) {
        let (layout, n) = (whole_number(width), (size / width) as u64);
        for mask in [u64::MAX, 0xFFFF_0000, 0b1011, 0].into_iter().step_by(long_or(1, 2)) {
            check(&layout, &records(n, width, 0, mask), &format!("keys of {mask:#x}"));
        }
    }
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn a_sample_that_misleads() {
    let (layout, n) = (whole_number(32), long_or(200_000, 100_000));
    let mut bytes = records(n, 32, 0, u64::MAX);
    // Nearly all keys are close together, few are far away.
    for (i, record) in bytes.chunks_exact_mut(32).enumerate() {
        let key = if i % 1000 == 7 { word(i as u64) } else { word(i as u64) >> 40 };
        record[..8].copy_from_slice(&key.to_le_bytes());
    }
    check(&layout, &bytes, "clusters");
    let mut number = 0u64;
    for record in bytes.chunks_exact_mut(32) {
        number += 1;
        record[..8].copy_from_slice(&number.to_le_bytes());
    }
    check(&layout, &bytes, "rising");
    bytes.chunks_exact_mut(32).for_each(|record| record[..8].reverse());
    check(&layout, &bytes, "turned bytes");
}

/// Runs are as long as the blocks of all of them together, not as memory allows.
#[test]
#[cfg_attr(miri, ignore = "files")]
fn runs_are_no_longer_than_pays() {
    let bytes = records(500_000, 32, 0, u64::MAX);
    let found = check(&whole_number(32), &bytes, "16 MB");
    // √(16·10⁶·2²⁰) bytes are 4 095 966; in whole pages, 127 872 records.
    assert_eq!(found.runs, 4);
    assert_eq!(found.bytes_read + found.bytes_written, 4 * bytes.len() as u64);
}
