//! Any bytes as an answer about files and the files: no check panics.
#![no_main]

#[path = "../../crates/taut-certify/tests/certify/files_any/bytes.rs"]
mod bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| bytes::check_any(bytes));
