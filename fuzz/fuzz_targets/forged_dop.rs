//! Forged certificates of bounding dops: an exact oracle judges what the checker lets pass.
#![no_main]

use taut_fuzz::{cases, forge_and_judge};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| forge_and_judge("dop", cases::dop::all, bytes));
