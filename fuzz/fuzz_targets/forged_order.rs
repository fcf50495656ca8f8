//! Forged certificates of an order: an exact oracle judges what the checker lets pass.
#![no_main]

use taut_fuzz::{cases, forge_and_judge};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| forge_and_judge("order", cases::order::all, bytes));
