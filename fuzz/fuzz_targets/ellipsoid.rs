//! Any bytes as points: their ellipsoid is found, and judged by the checker.
#![no_main]

#[path = "../../crates/taut-enclose/tests/enclose/ellipsoids/bytes.rs"]
mod bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| bytes::solve_and_check(bytes));
