//! Freed memory that is kept: counted by the pages that the system makes for this thread. In a process of its own, as the thresholds
//! of the allocator hold for all of it.
#![cfg(all(target_os = "linux", target_env = "gnu", target_pointer_width = "64"))]

use std::fs;

use taut_points::keep_freed_memory;

/// The pages that the system has made for this thread without reading: the eighth word behind the name in parentheses.
fn page_faults() -> u64 {
    let stat = fs::read_to_string("/proc/thread-self/stat").expect("Linux tells of threads");
    let (_, behind_name) = stat.rsplit_once(')').expect("a name in parentheses");
    behind_name.split_whitespace().nth(7).and_then(|word| word.parse().ok()).expect("a count")
}

/// Takes 6 MB in blocks that are too small to be mapped, writes to each page, and frees them: so often.
fn faults_of_rounds(rounds: usize) -> u64 {
    let before = page_faults();
    for _ in 0..rounds {
        let blocks: Vec<Vec<u8>> = (0..64).map(|k| vec![k + 1; 100_000]).collect();
        std::hint::black_box(&blocks);
    }
    page_faults() - before
}

#[test]
fn memory_that_is_freed_and_taken_again_makes_no_new_pages() {
    const ROUNDS: usize = 20;
    let huge = fs::read_to_string("/sys/kernel/mm/transparent_hugepage/enabled");
    if huge.is_ok_and(|modes| modes.contains("[always]")) {
        println!("skipped: pages are huge, so that few are made");
        return;
    }
    let given_back = faults_of_rounds(ROUNDS);
    keep_freed_memory(1 << 30, 2);
    // The first round still makes its pages.
    let kept = faults_of_rounds(ROUNDS);
    assert!(5 * kept < given_back, "{kept} page faults, and {given_back} before");
}
