//! Forged certificates of a rectangle of any direction in a polygon: an exact oracle judges what the checker lets pass.
#![no_main]

use taut_fuzz::{cases, forge_and_judge};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| forge_and_judge("oriented-rectangle", cases::oriented::all, bytes));
