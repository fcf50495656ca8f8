//! Any bytes as points, weighted points or balls: centers are found, and judged by the checker.
#![no_main]

#[path = "../../crates/taut-enclose/tests/enclose/centers_any/bytes.rs"]
mod bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| bytes::solve_and_check(bytes));
