//! Any bytes as points of space: surfaces are found by every method, and judged by the checker.
#![no_main]

#[path = "../../crates/taut-reconstruct/tests/reconstruct/surface_any/bytes.rs"]
mod bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| bytes::solve_and_check(bytes));
