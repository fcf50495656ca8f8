//! Any bytes to the svg parser.
#![no_main]

#[allow(dead_code)]
#[path = "../../crates/taut-io/tests/io/parsers.rs"]
mod parsers;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| parsers::svg(bytes));
