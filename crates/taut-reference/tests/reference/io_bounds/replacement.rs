//! LRU and FIFO beside the best replacement, and counts that another program found.

use taut_oblivious::Probe;
use taut_reference::algorithms::{
    distribution_sort_instrumented, funnelsort_instrumented, mergesort_instrumented,
    quicksort_instrumented, select_instrumented,
};
use taut_reference::simulate::{CacheShape, Trace};

use super::matrices::{product, transposition};
use super::{WORD, largest, misses, numbers, row, trace};

fn lru(trace: &Trace, m: usize) -> u64 {
    trace.simulate(CacheShape::lru(m * WORD, 8 * WORD)).expect("a cache").misses
}

fn fifo(trace: &Trace, m: usize) -> u64 {
    trace.simulate(CacheShape::fifo(m * WORD, 8 * WORD)).expect("a cache").misses
}

fn best(trace: &Trace, m: usize) -> u64 {
    trace.optimal(m * WORD, 8 * WORD).expect("a cache").misses
}

/// Lemma 5.1.1, which needs no regularity and holds for FIFO too.
#[test]
fn lru_of_m_is_within_twice_the_best_of_half() {
    let traces = [
        ("transposition", trace(8, |p| transposition(64, 1, p))),
        ("product", trace(8, |p| product(32, 1, p))),
        ("mergesort", trace(8, |p| mergesort_instrumented(&mut numbers(3000, 1), p))),
        ("quicksort", trace(8, |p| quicksort_instrumented(&mut numbers(3000, 1), 2, p))),
        ("funnelsort", trace(8, |p| funnelsort_instrumented(&mut numbers(3000, 1), p))),
        (
            "distribution sort",
            trace(8, |p| distribution_sort_instrumented(&mut numbers(3000, 1), 2, p)),
        ),
        (
            "median",
            trace(8, |p| assert!(select_instrumented(&mut numbers(3000, 1), 1500, p).is_some())),
        ),
    ];
    for (name, trace) in &traces {
        let ratios = [64, 128, 256, 512, 1024, 2048].map(|m| {
            let half = best(trace, m / 2) as f64;
            (lru(trace, m) as f64 / half).max(fifo(trace, m) as f64 / half)
        });
        row(&format!("lemma 5.1.1, {name}"), "OPT(M/2)", largest(ratios), 2.0);
    }
}

/// Found with a list and a hash map, and by a search tree for the best replacement.
#[test]
fn golden_counts() {
    let found = trace(8, |p| transposition(256, 1, p));
    assert_eq!((lru(&found, 4096), best(&found, 4096)), (16384, 16384));
    let found = trace(8, |p| product(64, 1, p));
    assert_eq!((lru(&found, 512), best(&found, 512), best(&found, 256)), (8192, 5120, 7680));
    let scan = misses(&[(4096, 8), (4096, 32), (32768, 64)], |probe| {
        let array = vec![0u64; 1 << 20];
        probe.place(&array);
        for i in 0..array.len() {
            probe.read(&array[i..=i]);
        }
    });
    assert_eq!(scan, [131072.0, 32768.0, 16384.0]);
}
