//! Tests what sorting a file allocates, on one thread and on many more than there are processors.

mod counting;
#[path = "oblivious/test_length.rs"]
mod test_length;

use std::fs;

use counting::peak;
use taut_oblivious::external::{FileSortOptions, KeyKind, RecordLayout, sort_file};
use taut_points::Monitor;
use test_length::long_or;

/// Records in clusters, of which each is dealt again, on all threads at once; with 2¹⁶ of them, keys spread.
fn clusters(width: usize, bytes: usize, clusters: u64) -> Vec<u8> {
    let mut records = vec![0; bytes / width * width];
    let mut state = 1u64;
    for record in records.chunks_exact_mut(width) {
        state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
        let random = state ^ state >> 31;
        let key = (random % clusters) << 48 | random >> 24;
        record[..8].copy_from_slice(&key.to_le_bytes());
    }
    records
}

#[test]
fn the_limit_holds_for_any_number_of_threads() {
    let folder = tempfile::tempdir().expect("a folder");
    let (input, output) = (folder.path().join("in"), folder.path().join("out"));
    let mut sorted: Vec<u8> = vec![];
    let cases = [(32, 16 << 20), (8, 16 << 20), (64, 16 << 20), (32, 64 << 20)];
    for (width, memory) in cases.into_iter().take(long_or(usize::MAX, 3)) {
        // Nearly as much as fits into the memory, so that all of it is one run.
        let room = (7 << 20).max(memory / 16);
        let bytes = (memory - room) / 41 * 40 - (64 << 10);
        for groups in [(bytes >> 21) as u64, 1 << 16] {
            fs::write(&input, clusters(width, bytes, groups)).expect("written");
            for &threads in long_or(&[1, 2, 64][..], &[1, 64]) {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
                let layout = RecordLayout { width, key: 0..8, kind: KeyKind::U64 };
                let options = FileSortOptions { memory, ..Default::default() };
                let sort = || sort_file(&input, &output, &layout, &options, &Monitor::silent());
                let pool = pool.expect("a pool");
                let (found, peak) = peak(|| pool.install(sort));
                assert_eq!(found.expect("sorted").runs, 1);
                // The records lie in pages of their own, which the allocator does not see.
                let peak = peak + bytes;
                assert!(
                    peak <= memory,
                    "{width} bytes, {threads} threads: {peak} of {memory} bytes"
                );
                let found = fs::read(&output).expect("an output");
                assert!(threads == 1 || found == sorted, "{width} bytes, {threads} threads");
                sorted = found;
            }
        }
    }
}
