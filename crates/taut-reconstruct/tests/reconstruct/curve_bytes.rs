//! Any bytes as points of the plane: curves by every method pass the checker, and so do the seeds of the fuzz target.

#[path = "curve_any/bytes.rs"]
mod bytes;

use std::path::Path;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

proptest! {
    #![proptest_config(Config {
        cases: crate::test_length::long_or(200, 60), rng_seed: RngSeed::Fixed(6), failure_persistence: None, ..Config::default()
    })]

    #[test]
    fn any_bytes(bytes in vec(any::<u8>(), 0..130)) {
        bytes::solve_and_check(&bytes);
    }

    /// A grid of few places: copies, ties and lines.
    #[test]
    fn few_places(wish in 0u8..16, places in vec(0u8..4, 0..48)) {
        bytes::solve_and_check(&[&[0, wish][..], &places].concat());
    }
}

/// Each style with no point, one, two, three, four, and as many as count.
#[test]
fn few_points_and_many() {
    for style in 0..8 {
        for rows in [0, 1, 2, 3, 4, 64] {
            for wish in [0, 3, 14] {
                let rest = (0..2 * rows).map(|i| (i * 89 + 7 * i * i) as u8);
                let bytes: Vec<u8> = [style, wish].into_iter().chain(rest).collect();
                bytes::solve_and_check(&bytes);
            }
        }
    }
}

#[test]
fn the_seeds_pass() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/curve");
    if !folder.exists() {
        return println!("skipped the_seeds_pass: this package comes without its seeds");
    }
    let seeds: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|seed| seed.unwrap().path()).collect();
    assert!(seeds.len() >= 8);
    for seed in seeds {
        bytes::solve_and_check(&std::fs::read(seed).unwrap());
    }
}
