//! Any bytes as records to sort; the seeds of the fuzz target among them.

use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

use super::bytes;

proptest! {
    #![proptest_config(Config {
        cases: 60, rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..Config::default()
    })]

    #[test]
    fn any_bytes(bytes in vec(any::<u8>(), 0..300)) {
        bytes::sort_any(&bytes);
    }

    /// Few values: equal keys.
    #[test]
    fn few_bytes(bytes in vec(0u8..8, 0..300)) {
        bytes::sort_any(&bytes);
    }
}

#[test]
fn the_seeds_pass() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/sort_file");
    if !folder.exists() {
        return println!("skipped the_seeds_pass: this package comes without its seeds");
    }
    let seeds: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|seed| seed.unwrap().path()).collect();
    assert!(seeds.len() >= 3);
    seeds.iter().for_each(|seed| bytes::sort_any(&std::fs::read(seed).unwrap()));
}
