//! What sorting a file allocates, on one thread and on many more than there are processors.

use std::alloc::{GlobalAlloc, Layout, System};
use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use taut_oblivious::external::{FileSortOptions, KeyKind, RecordLayout, sort_file};
use taut_points::Monitor;

/// The system's allocator, and what is allocated by it; where it moves a room, both are there for a moment.
struct Counting;

static NOW: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

fn add(bytes: usize) {
    PEAK.fetch_max(NOW.fetch_add(bytes, Relaxed) + bytes, Relaxed);
}

#[allow(unsafe_code, reason = "only an allocator sees what is allocated")]
// SAFETY: every call is the same call of the system's allocator, with numbers added beside it.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        add(layout.size());
        // SAFETY: the caller's promise is that of the system's allocator.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        NOW.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller's promise is that of the system's allocator, which `at` came from.
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Records in clusters, of which each is dealt again, on all threads at once.
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
    for (width, memory) in [(32, 16 << 20), (8, 16 << 20), (64, 16 << 20), (32, 64 << 20)] {
        // Nearly as much as fits into the memory, so that all of it is one run.
        let room = (6 << 20).max(memory / 16);
        let bytes = (memory - room) / 41 * 40 - (64 << 10);
        fs::write(&input, clusters(width, bytes, (bytes >> 21) as u64)).expect("written");
        for threads in [1, 8, 64] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let layout = RecordLayout { width, key: 0..8, kind: KeyKind::U64 };
            let options = FileSortOptions { memory, ..Default::default() };
            let before = NOW.load(Relaxed);
            PEAK.store(before, Relaxed);
            let found = pool
                .expect("a pool")
                .install(|| sort_file(&input, &output, &layout, &options, &Monitor::silent()));
            assert_eq!(found.expect("sorted").runs, 1);
            // The records lie in pages of their own, which the allocator does not see.
            let peak = PEAK.load(Relaxed) - before + bytes;
            assert!(peak <= memory, "{width} bytes, {threads} threads: {peak} of {memory} bytes");
            let found = fs::read(&output).expect("an output");
            assert!(threads == 1 || found == sorted, "{width} bytes, {threads} threads");
            sorted = found;
        }
    }
}
