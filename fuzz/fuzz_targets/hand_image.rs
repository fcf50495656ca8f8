//! Any bytes to the reader of images, and what it reads to the measures of a hand.
#![no_main]

use taut::recognize::hand::{Gate, Hand, HandOptions};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    for gate in [Gate::Refuse, Gate::Report] {
        let options = HandOptions {
            pixels_max: 1 << 20,
            dots_per_inch: Some(90.0),
            gate,
            ..HandOptions::default()
        };
        let _ = Hand::from_image(bytes, &options);
    }
});
