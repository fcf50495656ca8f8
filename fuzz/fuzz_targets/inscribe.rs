//! Any bytes as rings or as a mesh, with one of the shapes looked for inside, and the answer judged by the checker.
#![no_main]

#[path = "../../crates/taut-inscribe/tests/inscribe/common/bytes.rs"]
mod bytes;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let [kind, rest @ ..] = bytes else { return };
    if kind % 2 == 0 {
        bytes::rings(rest);
    } else {
        bytes::mesh(rest);
    }
});
