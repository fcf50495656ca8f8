//! Any bytes as operations of both queues: as a `BinaryHeap` has it.
#![no_main]

#[allow(dead_code)]
#[path = "../../crates/taut-reference/tests/reference/any_bytes/bytes.rs"]
mod bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| bytes::queue_any(bytes));
