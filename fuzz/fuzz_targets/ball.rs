//! Any bytes as points or balls: solved, and the answer judged by the checker.
#![no_main]

#[path = "../../crates/taut-enclose/tests/enclose/common/bytes.rs"]
mod bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| bytes::solve_and_check(bytes));
