//! The I/O bounds of the literature as tests: misses counted by the simulator beside the formula, over grids of n, M, B.
//!
//! `cargo test -p taut-reference --test reference io_bounds -- --nocapture --test-threads 1` prints a row for each: the algorithm,
//! the formula, the largest ratio of misses to it, and what is allowed. What takes more than a second or two without
//! optimization is ignored there; all of it runs by
//! `cargo test --release -p taut-reference --test reference io_bounds -- --include-ignored --nocapture --test-threads 1`.
//! Sizes are in words of 8 bytes.

mod distributor;
mod matrices;
mod packed;
mod replacement;
mod search;
mod sorts;

use std::sync::Once;

use taut_reference::simulate::{CacheShape, Simulator, Trace};

/// Bytes of a word.
const WORD: usize = 8;

/// M and B in words.
type Shape = (usize, usize);

/// Prints a row and fails where the largest ratio is above the allowed one.
fn row(algorithm: &str, formula: &str, largest: f64, allowed: f64) {
    static HEADER: Once = Once::new();
    HEADER.call_once(|| {
        let (ratio, limit) = ("largest", "allowed");
        println!("\n{:<40} | {:<36} | {ratio:>7} | {limit:>7}", "algorithm", "formula");
    });
    println!("{algorithm:<40} | {formula:<36} | {largest:>7.3} | {allowed:>7.3}");
    assert!(largest <= allowed, "{algorithm}: {largest} of {formula}, allowed {allowed}");
}

/// Misses of LRU memories of these shapes, in one run; each access must have been announced.
fn misses(grid: &[Shape], run: impl FnOnce(&mut Simulator)) -> Vec<f64> {
    let shapes: Vec<_> = grid.iter().map(|&(m, b)| CacheShape::lru(m * WORD, b * WORD)).collect();
    let mut simulator = Simulator::new(&shapes).expect("caches");
    run(&mut simulator);
    assert_eq!(simulator.unannounced(), 0);
    (0..grid.len()).map(|cache| simulator.counts(cache).misses as f64).collect()
}

/// The trace of a run, for blocks of up to `align` words.
fn trace(align: usize, run: impl FnOnce(&mut Trace)) -> Trace {
    let mut trace = Trace::new(align * WORD).expect("a power of two");
    run(&mut trace);
    assert_eq!(trace.unannounced(), 0);
    trace
}

/// splitmix64.
fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut x = *state;
    x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    x ^ (x >> 31)
}

fn numbers(n: usize, mut seed: u64) -> Vec<u64> {
    (0..n).map(|_| random(&mut seed)).collect()
}

fn largest(ratios: impl IntoIterator<Item = f64>) -> f64 {
    ratios.into_iter().fold(0.0, f64::max)
}

/// log_base x.
fn log(base: f64, x: f64) -> f64 {
    x.ln() / base.ln()
}
