//! Any bytes as points of space: triangulated in two ways, and the answer judged by the checker.
#![no_main]

#[path = "../../crates/taut-delaunay/tests/delaunay/common/bytes.rs"]
mod bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| bytes::solve_and_check(3, bytes));
