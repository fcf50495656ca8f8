//! Points so far from the origin that no `f64` is near enough to their center.

use robust::by;
use taut_certify::RobustMethod;
use taut_enclose::robust_ellipsoid;
use taut_points::Points;

use crate::robust;

/// n × d numbers of a generator with a fixed seed, around `at` and at most 1 away.
fn around(at: f64, n: usize, dim: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    let number = |_| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        at + (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    (0..n * dim).map(number).collect()
}

#[test]
fn a_fit_whose_center_lies_between_two_doubles_is_accepted() {
    let (mut refused, mut tails, mut needed) = (vec![], 0, 0);
    for at in [1e12, 1e14, 1e15, -1e15, 2e15] {
        for seed in 1..=10 {
            let values = around(at, 12, 3, seed);
            let points = Points::new(&values, 3).unwrap();
            for method in RobustMethod::ALL {
                let found = match robust_ellipsoid(&points, &by(method)) {
                    Ok(found) => found,
                    Err(error) => panic!("{method} at {at:e}: {error}"),
                };
                if let Err(error) = found.check(&points) {
                    refused.push(format!("{method} at {at:e}, seed {seed}: {error}"));
                }
                let is_far = method != RobustMethod::Trim && !found.answer.center_tail.is_empty();
                assert!(!is_far || at.abs() > 1e13, "{method} at {at:e} needs no tail");
                tails += usize::from(is_far);
                let mut rounded = found.clone();
                rounded.answer.center_tail.clear();
                needed += usize::from(is_far && rounded.check(&points).is_err());
            }
        }
    }
    println!("{tails} centers of mcd and mve have a tail, {needed} are refused without it");
    assert!(needed > 0 && refused.is_empty(), "{} refused: {refused:#?}", refused.len());
}
