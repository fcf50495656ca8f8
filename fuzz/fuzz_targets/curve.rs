//! Any bytes as points of the plane: curves are found by every method, and judged by the checker.
#![no_main]

#[path = "../../crates/taut-reconstruct/tests/reconstruct/curve_any/bytes.rs"]
mod bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| bytes::solve_and_check(bytes));
