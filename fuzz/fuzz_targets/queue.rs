//! Any bytes as operations of both queues: as a `BinaryHeap` has it.
#![no_main]

#[allow(dead_code)]
#[path = "../../crates/taut-oblivious/tests/memory_any/bytes.rs"]
mod bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| bytes::queue_any(bytes));
