//! Any bytes as items: all centers pass the checker, and so do the seeds of the fuzz target.

#[path = "centers_any/bytes.rs"]
mod bytes;

use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

proptest! {
    #![proptest_config(Config {
        cases: 600, rng_seed: RngSeed::Fixed(5), failure_persistence: None, ..Config::default()
    })]

    #[test]
    fn any_bytes(bytes in vec(any::<u8>(), 0..200)) {
        bytes::solve_and_check(&bytes);
    }

    /// A grid of few places: copies, ties and lines.
    #[test]
    fn few_places(head in 0u8..16, wish in any::<u8>(), places in vec(0u8..4, 1..48)) {
        bytes::solve_and_check(&[&[head, wish][..], &places].concat());
    }

    #[test]
    fn round_numbers_of_all_sizes(
        head in 16u8..32, wish in any::<u8>(), numbers in vec((-1020i32..1020, -3i32..4), 1..24)
    ) {
        let number = |&(e, digit): &(i32, i32)| (f64::from(digit) * 2f64.powi(e)).to_le_bytes();
        let numbers: Vec<u8> = numbers.iter().flat_map(number).collect();
        bytes::solve_and_check(&[&[head, wish][..], &numbers].concat());
    }
}

#[test]
fn the_seeds_pass() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/centers");
    if !folder.exists() {
        return println!("skipped the_seeds_pass: this package comes without its seeds");
    }
    let seeds: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|seed| seed.unwrap().path()).collect();
    assert!(seeds.len() >= 6);
    for seed in seeds {
        bytes::solve_and_check(&std::fs::read(seed).unwrap());
    }
}
