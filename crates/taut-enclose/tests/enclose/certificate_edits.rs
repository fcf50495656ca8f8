//! Certificates of robust and inscribed ellipsoids and of centers with one or two things changed in their structure: no check panics.

#[path = "certificates/edits.rs"]
mod edits;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

proptest! {
    #![proptest_config(Config {
        cases: 4000, rng_seed: RngSeed::Fixed(10), failure_persistence: None, ..Config::default()
    })]

    #[test]
    fn single_edits_never_panic(kind in 0u8..10, bytes in vec(any::<u8>(), 8)) {
        edits::edit_and_check(&[&[kind][..], &bytes].concat());
    }

    #[test]
    fn double_edits_never_panic(kind in 0u8..10, bytes in vec(any::<u8>(), 16)) {
        edits::edit_and_check(&[&[kind][..], &bytes].concat());
    }
}
