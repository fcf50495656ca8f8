//! Measures how fast one check runs: `cargo run --release -p taut-certify --example check_speed [rows] [columns]`.
//!
//! Each line is one kind of point set; the ball is the true one of the kind, so that all stages of the checker have
//! the work they have in life. A plain sum of the same memory stands beside it.

use std::time::Instant;

use rayon::prelude::*;
use taut_certify::{Ball, BallCertificate, CheckError, Items, Solution, Trace, Violation};
use taut_points::{Distribution, Monitor, Points, Scalar, generate, hash_points};

fn main() {
    let mut numbers = std::env::args().skip(1).map(|text| text.parse().expect("a number"));
    let n = numbers.next().unwrap_or(100_000);
    let d = numbers.next().unwrap_or(300);
    let normal: Vec<f64> = generate(Distribution::Normal, n, d, 1).expect("valid");
    let cube: Vec<f64> = generate(Distribution::CubeVertices, n, d, 1).expect("valid");
    let sphere: Vec<f64> = generate(Distribution::Sphere, n, d, 1).expect("valid");
    let narrow: Vec<f32> = normal.iter().map(|&v| v as f32).collect();
    let far = 2.0 * (d as f64).sqrt() + 10.0;
    measure("normal, f64", &normal, d, far, 0.0);
    measure("normal, f32", &narrow, d, far, 0.0);
    measure("cube, all tie, f64", &cube, d, (d as f64).sqrt() / 2.0, 0.5);
    measure("sphere, to rounding, f64", &sphere, d, 1.0 + 1e-15, 0.0);
}

/// Prints the best speed of seven of a check, of hashing alone and of reading.
fn measure<T: Scalar>(name: &str, values: &[T], d: usize, radius: f64, center: f64) {
    let points = Points::new(values, d).expect("whole rows");
    let bytes = size_of_val(values) as f64;
    let hash = hash_points(&points, &Monitor::silent()).expect("memory");
    let solution = Solution {
        answer: Ball { center: vec![center; d], center_tail: vec![], radius },
        certificate: BallCertificate {
            items: Items::Points,
            support: vec![0],
            multipliers: vec![1.0],
            directions: vec![],
            gap: 0.0,
            points_hash: hash,
        },
        trace: Trace::default(),
    };
    let speed = |work: &dyn Fn()| {
        let once = || {
            let start = Instant::now();
            work();
            bytes / start.elapsed().as_secs_f64() / 1e9
        };
        (0..7).map(|_| once()).fold(0.0, f64::max)
    };
    // Every row is inside; only then does the checker come to the multipliers, which have nothing to do with the center.
    let outcome = solution.check(&points);
    assert!(matches!(outcome, Err(CheckError::Rejected(Violation::Center { .. }))), "{outcome:?}");
    let check = speed(&|| drop(solution.check(&points)));
    let hash = speed(&|| drop(hash_points(&points, &Monitor::silent())));
    let read = speed(&|| {
        let sum: f64 =
            values.par_chunks(1 << 16).map(|c| c.iter().map(|&v| v.into()).sum::<f64>()).sum();
        std::hint::black_box(sum);
    });
    println!("{name:>26}: check {check:5.1} GB/s, hash alone {hash:5.1}, plain sum {read:5.1}");
}
