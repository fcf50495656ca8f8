//! Any bytes to the parser of npz.
#![no_main]

#[allow(dead_code)]
#[path = "../../crates/taut-io/tests/io/parsers.rs"]
mod parsers;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| parsers::npz(bytes));
