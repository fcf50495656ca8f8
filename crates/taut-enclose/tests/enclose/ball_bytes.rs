//! Any bytes as points: every answer passes the checker, whatever the sizes of the numbers.

#[path = "common/bytes.rs"]
mod bytes;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};

/// Numbers of all sizes with few digits: what random bits hardly ever are.
fn round_number() -> impl Strategy<Value = f64> {
    let exponents = prop_oneof![-1074i32..1024, -4i32..5, Just(1023), Just(-1074), Just(-1022)];
    (exponents, -3i32..4).prop_map(|(exponent, digit)| {
        let half = exponent / 2;
        f64::from(digit) * 2f64.powi(half) * 2f64.powi(exponent - half)
    })
}

proptest! {
    #![proptest_config(Config {
        cases: 3000, rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..Config::default()
    })]

    #[test]
    fn any_bytes(bytes in vec(any::<u8>(), 0..300)) {
        bytes::solve_and_check(&bytes);
    }

    #[test]
    fn round_numbers_of_all_sizes(head in 16u8..32, numbers in vec(round_number(), 1..40)) {
        let mut bytes = vec![head];
        bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        bytes::solve_and_check(&bytes);
    }
}
