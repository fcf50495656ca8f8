//! Points near a sphere, of which an active set alone would take thousands of steps: the answer is as exact as any
//! other, and takes few.

use common::families::Random;
use common::{exact, exact_with, judge};
use taut_certify::{Ball, Solution, Stop};
use taut_enclose::{BallOptions, ball};
use taut_points::{Distribution, Points, generate};

use crate::common;
use crate::test_length::long_or;

const GAP: f64 = 1e-12;

fn shell(thickness: f64, n: usize, dim: usize, seed: u64) -> Vec<f64> {
    generate(Distribution::Shell { thickness }, n, dim, seed).expect("the parameters are in range")
}

/// The interior-point method had its part in it, and the active set few steps left.
fn took_few_steps(name: &str, found: &Solution<Ball>, dim: usize) {
    assert_eq!(found.trace.stop, Stop::Converged, "{name}");
    assert!(found.trace.counters.contains_key("interior"), "{name}: {:?}", found.trace);
    assert!(found.trace.iterations < 6 * dim as u64, "{name}: {:?}", found.trace);
    assert!(found.certificate.support.len() <= dim + 1, "{name}");
}

#[test]
fn noise_of_any_size() {
    for (round, thickness) in [1e-3, 1e-5, 1e-8, 1e-10].into_iter().enumerate() {
        for seed in 0..long_or(5, 1) {
            let dim = 90 + 10 * round;
            let values = shell(thickness, 2500, dim, 7000 + seed);
            let found = exact("a shell", &values, dim, GAP);
            took_few_steps("a shell", &found, dim);
        }
    }
}

/// In a subspace no support has d + 1 points, and all of its sums are as small as the noise.
#[test]
fn a_shell_in_a_subspace_far_from_the_origin() {
    let (inner, dim) = (90, 110);
    let values: Vec<f64> = shell(1e-8, 2000, inner, 7100)
        .chunks(inner)
        .flat_map(|row| row.iter().copied().chain(vec![0.0; dim - inner]))
        .map(|x| 3.0 * x + 5.0)
        .collect();
    let found = exact("a shell in a subspace", &values, dim, GAP);
    took_few_steps("a shell in a subspace", &found, inner);
}

#[test]
fn copies_are_as_one_point() {
    let dim = 90;
    let once = shell(1e-8, 1500, dim, 7200);
    let thrice = [&once[..], &once, &once].concat();
    let (one, three) = (exact("once", &once, dim, GAP), exact("thrice", &thrice, dim, GAP));
    took_few_steps("thrice", &three, dim);
    let radii = (one.answer.radius, three.answer.radius);
    assert!((radii.0 - radii.1).abs() <= GAP * radii.0, "{radii:?}");
}

#[test]
fn shells_of_all_sizes() {
    let dim = 90;
    let values = shell(1e-8, 1500, dim, 7300);
    let unit = exact("a shell of radius 1", &values, dim, GAP).answer.radius;
    for scale in [1e300, 1e-300, 1e154, 1e-160] {
        let scaled: Vec<f64> = values.iter().map(|x| x * scale).collect();
        let found = exact("a shell of another size", &scaled, dim, GAP);
        took_few_steps("a shell of another size", &found, dim);
        assert!((found.answer.radius / scale - unit).abs() <= 1e-11, "{scale:e}");
    }
}

/// Axes of different lengths leave a support far smaller than d + 1.
#[test]
fn an_ellipsoid_with_noise() {
    let dim = 120;
    let mut random = Random(7400);
    let mut values = shell(1e-8, 2000, dim, 7400);
    for row in values.chunks_mut(dim) {
        row.iter_mut().skip(dim / 2).for_each(|x| *x *= 0.3);
    }
    values.iter_mut().for_each(|x| *x += 1e-9 * random.unit());
    exact("an ellipsoid", &values, dim, GAP);
}

#[test]
fn the_answer_does_not_depend_on_threads() {
    let dim = 128;
    let values = shell(1e-8, 2500, dim, 7500);
    let points = Points::new(&values, dim).unwrap();
    let with = |threads: usize| {
        let options = BallOptions { threads: Some(threads), epsilon: 0.0, ..Default::default() };
        ball(&points, &options).unwrap()
    };
    let one = with(1);
    took_few_steps("one thread", &one, dim);
    for threads in [2, 3, 8] {
        assert_eq!(with(threads), one, "{threads} threads");
    }
}

#[test]
fn a_coarse_gap_is_reached() {
    let dim = 100;
    let values = shell(1e-8, 2000, dim, 7600);
    for epsilon in [1e-3, 1e-7, 1e-9] {
        let options = BallOptions { epsilon, ..Default::default() };
        let found = exact_with("a coarse gap", &values, dim, epsilon, &options);
        assert_eq!(found.trace.stop, Stop::Converged, "{epsilon}");
    }
}

#[test]
fn every_budget_of_passes_ends_in_a_proved_ball() {
    let dim = 90;
    let values = shell(1e-8, 1500, dim, 7700);
    let points = Points::new(&values, dim).unwrap();
    let mut least = f64::INFINITY;
    for max_passes in 3..20 {
        let options = BallOptions { max_passes, epsilon: 0.0, ..Default::default() };
        let found = ball(&points, &options).unwrap();
        let proof = judge(&values, dim, &found).unwrap();
        assert!(found.trace.passes <= max_passes, "{max_passes}: {:?}", found.trace);
        assert!(proof.gap <= found.certificate.gap + 1e-15, "{max_passes}");
        least = least.min(proof.gap);
        if found.trace.stop == Stop::Converged {
            assert!(proof.gap <= GAP, "{max_passes}: {:?}", found.trace);
            return;
        }
    }
    panic!("no budget was enough; a gap of {least:e} is the least");
}
