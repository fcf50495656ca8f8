//! Any bytes as records of a file: sorted, and compared with a sort in memory.
#![no_main]

#[allow(dead_code)]
#[path = "../../crates/taut-oblivious/tests/oblivious/bytes.rs"]
mod bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| bytes::sort_any(bytes));
