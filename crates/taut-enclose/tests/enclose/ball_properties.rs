//! Laws that the smallest enclosing ball obeys, and agreement with a brute force, on random small sets.

use common::{brute_force, exact, judge};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use taut_certify::Items;
use taut_enclose::{BallOptions, ball};
use taut_points::{Distribution, Points, generate};

use crate::common;

const GAP: f64 = 1e-13;

fn seeded(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(20), failure_persistence: None, ..Config::default() }
}

/// Few points: small integers for ties, copies and lines, or reals; with their dimension.
fn few_points() -> impl Strategy<Value = (Vec<f64>, usize)> {
    (1usize..=3, 1usize..=8).prop_flat_map(|(dim, n)| {
        let integers = vec((-4i32..5).prop_map(f64::from), n * dim);
        let reals = vec(-1.0f64..1.0, n * dim);
        (prop_oneof![integers, reals], Just(dim))
    })
}

/// The four distributions of the literature.
const DISTRIBUTIONS: [Distribution; 4] = [
    Distribution::Uniform,
    Distribution::CubeVertices,
    Distribution::Normal,
    Distribution::Poisson,
];

/// More points in more dimensions: integers, reals, and the four distributions.
fn points() -> impl Strategy<Value = (Vec<f64>, usize)> {
    let few_dimensions = (1usize..=9, 1usize..=40).prop_flat_map(|(dim, n)| {
        let integers = vec((-9i32..10).prop_map(f64::from), n * dim);
        let reals = vec(-1.0f64..1.0, n * dim);
        (prop_oneof![integers, reals], Just(dim))
    });
    let drawn = (1usize..=60, 1usize..=150, 0usize..4, 0u64..1000).prop_map(|(dim, n, k, seed)| {
        (generate(DISTRIBUTIONS[k], n, dim, seed).expect("the parameters are in range"), dim)
    });
    prop_oneof![few_dimensions, drawn]
}

fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * a.abs().max(b.abs())
}

/// Radii just below a power of two, whose logarithm is rounded to that of the power in some units only.
#[test]
fn powers_of_two_are_exact_where_the_radius_is_next_to_one() {
    let mut next = 0;
    for seed in 0..60 {
        let values: Vec<f64> = generate(Distribution::CubeVertices, 96, 16, seed).unwrap();
        let plain = exact("plain", &values, 16, GAP);
        next += u32::from((plain.answer.radius - 2.0).abs() < 1e-14);
        for k in [-9, -3, -1, 1, 4] {
            let factor = 2f64.powi(k);
            let scaled: Vec<f64> = values.iter().map(|v| v * factor).collect();
            let found = exact("scaled", &scaled, 16, GAP);
            let wanted: Vec<f64> = plain.answer.center.iter().map(|c| c * factor).collect();
            assert_eq!(found.answer.center, wanted, "seed {seed}, 2^{k}");
        }
    }
    assert!(next >= 10, "{next}");
}

proptest! {
    #![proptest_config(seeded(400))]

    /// The radius is that of the best support.
    #[test]
    fn brute_force_agrees((values, dim) in few_points()) {
        let found = exact("few points", &values, dim, GAP);
        let wanted = brute_force(&values, dim);
        prop_assert!(close(found.answer.radius, wanted, 1e-10), "{} against {wanted}", found.answer.radius);
    }
}

proptest! {
    #![proptest_config(seeded(150))]

    /// The order of the points decides nothing.
    #[test]
    fn order_does_not_matter((values, dim) in points(), turn in 0usize..40) {
        let plain = exact("plain", &values, dim, GAP);
        let mut turned = values.clone();
        let n = values.len() / dim;
        turned.rotate_left(turn % n * dim);
        let turned = exact("turned", &turned, dim, GAP);
        prop_assert!(close(plain.answer.radius, turned.answer.radius, 2e-13));
        let mut reversed: Vec<f64> = values.chunks_exact(dim).rev().flatten().copied().collect();
        reversed.extend_from_slice(&values);
        let doubled = exact("twice", &reversed, dim, GAP);
        prop_assert!(close(plain.answer.radius, doubled.answer.radius, 2e-13));
        for (a, b) in plain.answer.center.iter().zip(&doubled.answer.center) {
            prop_assert!((a - b).abs() <= 1e-6 * plain.answer.radius, "{a} against {b}");
        }
    }

    /// Powers of two scale every number exactly.
    #[test]
    fn powers_of_two_are_exact((values, dim) in points(), k in prop_oneof![-900i32..900, -3i32..3, 180i32..220, -220i32..-180, 480i32..540, -560i32..-500]) {
        let plain = exact("plain", &values, dim, GAP);
        let factor = 2f64.powi(k);
        let scaled: Vec<f64> = values.iter().map(|v| v * factor).collect();
        let found = exact("scaled", &scaled, dim, GAP);
        prop_assert_eq!(found.answer.radius, plain.answer.radius * factor);
        prop_assert_eq!(&found.certificate.support, &plain.certificate.support);
        prop_assert_eq!(&found.certificate.multipliers, &plain.certificate.multipliers);
        for (a, b) in found.answer.center.iter().zip(&plain.answer.center) {
            prop_assert_eq!(*a, b * factor);
        }
    }

    /// A turn keeps the radius; a shift, too, when the points can be shifted exactly.
    #[test]
    fn turns_and_shifts((values, dim) in points(), angle in 0.0f64..std::f64::consts::TAU, offset in prop_oneof![Just(1e8), Just(-3e5), Just(1e11)]) {
        // Multiples of 2⁻¹⁰ survive the shift.
        let values: Vec<f64> = values.iter().map(|v| (v * 1024.0).round() / 1024.0).collect();
        let plain = exact("plain", &values, dim, GAP);
        let shifted: Vec<f64> = values.iter().map(|v| v + offset).collect();
        let moved = exact("shifted", &shifted, dim, GAP);
        prop_assert!(close(plain.answer.radius, moved.answer.radius, 2e-13));
        let mut turned = values.clone();
        let (sin, cos) = angle.sin_cos();
        for row in turned.chunks_exact_mut(dim) {
            for j in 1..dim {
                (row[j - 1], row[j]) = (cos * row[j - 1] - sin * row[j], sin * row[j - 1] + cos * row[j]);
            }
        }
        let turned = exact("turned", &turned, dim, GAP);
        prop_assert!(close(plain.answer.radius, turned.answer.radius, 1e-12));
    }

    /// Points inside change nothing, a point outside makes the ball larger, and a part has a smaller ball.
    #[test]
    fn only_the_outermost_matter((values, dim) in points(), weight in 0.0f64..0.9) {
        let plain = exact("plain", &values, dim, GAP);
        let center = &plain.answer.center;
        let mut more = values.clone();
        for row in values.chunks_exact(dim) {
            more.extend(row.iter().zip(center).map(|(x, c)| c + weight * (x - c)));
        }
        let with_inner = exact("with inner points", &more, dim, GAP);
        prop_assert!(close(plain.answer.radius, with_inner.answer.radius, 2e-13));
        let part = exact("a part", &values[..values.len().div_ceil(dim).div_ceil(2) * dim], dim, GAP);
        prop_assert!(part.answer.radius <= plain.answer.radius * (1.0 + 1e-13));
        let support: Vec<f64> = plain.certificate.support.iter().flat_map(|&i| values[i as usize * dim..][..dim].to_vec()).collect();
        let of_support = exact("the support alone", &support, dim, GAP);
        prop_assert!(close(plain.answer.radius, of_support.answer.radius, 2e-13));
    }

    /// Single precision is widened first: the same values give the same bytes.
    #[test]
    fn both_precisions_are_one((values, dim) in points()) {
        let single: Vec<f32> = values.iter().map(|&v| v as f32).collect();
        let double: Vec<f64> = single.iter().map(|&v| f64::from(v)).collect();
        let options = BallOptions::default();
        let a = ball(&Points::new(&single, dim).unwrap(), &options).unwrap();
        let b = ball(&Points::new(&double, dim).unwrap(), &options).unwrap();
        prop_assert_eq!(a.to_json(), b.to_json());
    }

    /// The gap wanted is the gap proved, at every ε; and a looser ε never costs more passes than an exact answer.
    #[test]
    fn the_gap_is_kept((values, dim) in points(), epsilon in prop_oneof![Just(0.5), Just(1e-2), Just(1e-6), Just(1e-9), Just(1e-12)]) {
        let options = BallOptions { epsilon, batch: Some(1), ..Default::default() };
        let found = ball(&Points::new(&values, dim).unwrap(), &options).unwrap();
        let proof = judge(&values, dim, &found).map_err(TestCaseError::fail)?;
        prop_assert!(proof.gap <= epsilon);
        let exact = ball(&Points::new(&values, dim).unwrap(), &BallOptions { epsilon: 0.0, ..options }).unwrap();
        prop_assert!(exact.answer.radius <= found.answer.radius * (1.0 + 1e-13));
        prop_assert!(found.trace.passes <= exact.trace.passes);
        prop_assert!(found.trace.history.windows(2).all(|w| w[0].lower <= w[1].lower * (1.0 + 1e-12)));
    }

    /// Balls of radius 0 are points, and the same radius added to all is added to the answer.
    #[test]
    fn balls_and_points((values, dim) in points(), radius in prop_oneof![Just(0.0), 0.0f64..100.0]) {
        let plain = exact("points", &values, dim, GAP);
        let balls: Vec<f64> = values.chunks_exact(dim).flat_map(|row| row.iter().copied().chain([radius]).collect::<Vec<_>>()).collect();
        let options = BallOptions { epsilon: 0.0, ..Default::default() };
        let found = ball(&Points::new(&balls, dim + 1).unwrap(), &BallOptions { inputs: Items::Balls, ..options.clone() }).unwrap();
        let proof = judge(&balls, dim + 1, &found).map_err(TestCaseError::fail)?;
        prop_assert!(proof.gap <= GAP);
        prop_assert!(close(found.answer.radius, plain.answer.radius + radius, 2e-13));
    }
}
