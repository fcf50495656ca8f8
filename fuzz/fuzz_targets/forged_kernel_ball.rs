//! Forged certificates of balls of a kernel: an exact oracle judges what the checker lets pass.
#![no_main]

use taut_fuzz::{cases, forge_and_judge};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| forge_and_judge("kernel-ball", cases::kernel_ball::all, bytes));
