//! Rings and meshes of any bytes: no panic, and no answer that the checker rejects. The fuzz target `inscribe` searches the same
//! with a view of what the code does.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::common::bytes;
use crate::test_length::long_or;

/// Cases of each kind; in the long tests 3400 times as many, which are at least half a million.
fn cases(few: u64) -> u64 {
    long_or(3400 * few, few)
}

/// The bytes of a case: the numbers of SplitMix64.
fn bytes_of(case: u64, length: usize) -> Vec<u8> {
    let mut state = case.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let next = std::iter::repeat_with(|| {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    });
    next.flat_map(u64::to_le_bytes).take(length).collect()
}

/// Runs all cases and returns how many have answers. Long runs tell how far they are, so that one that is ended has counted something;
/// a case that fails is named and does not end the others.
fn answered(kind: &str, count: u64, is_answered: impl Fn(u64) -> bool + Sync) -> u64 {
    let [done, answers] = [const { AtomicU64::new(0) }; 2];
    let run = |case: u64| {
        let outcome = catch_unwind(AssertUnwindSafe(|| is_answered(case)));
        answers.fetch_add(u64::from(matches!(outcome, Ok(true))), Ordering::Relaxed);
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        if done.is_multiple_of(5000) {
            println!("{done} of {count} {kind}");
        }
        outcome.err().map(|_| case)
    };
    let failed: Vec<u64> = (0..count).into_par_iter().filter_map(run).collect();
    let answers = answers.into_inner();
    println!("{answers} of {count} {kind} have answers, {} fail", failed.len());
    assert!(failed.is_empty(), "{kind} {failed:?} fail");
    answers
}

#[test]
fn rings_of_any_bytes() {
    let count = cases(300);
    let length = |case: u64| 8 + (case % 45) as usize;
    let answered = answered("rings", count, |case| bytes::rings(&bytes_of(case, length(case))));
    assert!(answered > count / 8, "{answered} of {count}");
}

#[test]
fn meshes_of_any_bytes() {
    let count = cases(150);
    // One mesh in four gets as many bytes as several tetrahedra need.
    let length = |case: u64| {
        if case.is_multiple_of(4) { 41 + (case % 96) as usize } else { (case % 41) as usize }
    };
    let answered = answered("meshes", count, |case| bytes::mesh(&bytes_of(case, length(case))));
    assert!(answered > count / 50, "{answered} of {count}");
}
