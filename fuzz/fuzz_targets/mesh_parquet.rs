//! Any bytes to the parquet parser of meshes.
#![no_main]

#[allow(dead_code)]
#[path = "../../crates/taut-io/tests/io/parsers.rs"]
mod parsers;

libfuzzer_sys::fuzz_target!(
    // The reader catches the panics of the decoder crates; only those that leave it may end the run.
    init: std::panic::set_hook(Box::new(|_| {})),
    |bytes: &[u8]| parsers::mesh_parquet(bytes)
);
