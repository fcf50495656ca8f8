//! Certificates of robust and inscribed ellipsoids and of centers edited by any bytes: no check panics.
#![no_main]

#[path = "../../crates/taut-enclose/tests/enclose/certificates/edits.rs"]
mod edits;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| edits::edit_and_check(bytes));
