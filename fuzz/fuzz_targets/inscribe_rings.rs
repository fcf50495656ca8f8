//! Any bytes as rings, with one of the planar shapes looked for inside, and the answer judged by the checker.
#![no_main]

#[path = "../../crates/taut-inscribe/tests/inscribe/common/bytes.rs"]
#[allow(dead_code)] // of rings and meshes one is used here
mod bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    bytes::rings(bytes);
});
