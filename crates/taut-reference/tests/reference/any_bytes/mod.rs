//! Any bytes as operations of a map and of a queue; the seeds of the fuzz targets among them.

mod bytes;

use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

type Target = (&'static str, fn(&[u8]));

const TARGETS: [Target; 2] = [("packed_map", bytes::packed_any), ("queue", bytes::queue_any)];

proptest! {
    #![proptest_config(Config {
        cases: 60, rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..Config::default()
    })]

    #[test]
    fn any_bytes(bytes in vec(any::<u8>(), 0..300)) {
        TARGETS.iter().for_each(|(_, run)| run(&bytes));
    }

    /// Few values: equal keys, the same operation many times.
    #[test]
    fn few_bytes(bytes in vec(0u8..8, 0..300)) {
        TARGETS.iter().for_each(|(_, run)| run(&bytes));
    }
}

#[test]
fn the_seeds_pass() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds");
    if !folder.exists() {
        return println!("skipped the_seeds_pass: this package comes without its seeds");
    }
    for (name, run) in TARGETS {
        let seeds: Vec<_> = std::fs::read_dir(folder.join(name))
            .unwrap()
            .map(|seed| seed.unwrap().path())
            .collect();
        assert!(seeds.len() >= 3, "{name}");
        seeds.iter().for_each(|seed| run(&std::fs::read(seed).unwrap()));
    }
}
