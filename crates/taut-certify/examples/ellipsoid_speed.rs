//! Measures how fast one check of an ellipsoid runs: `cargo run --release -p taut-certify --example ellipsoid_speed`.
//!
//! The ellipsoid is given by a full triangular factor. Easy rows all lie well inside; on a shell all lie so near the
//! surface that only the bound on rounding tells; beyond that, each row needs doubled precision, as support rows always
//! do. A plain sum of the same memory stands beside each, and the multiplications of a triangular factor, nd(d + 1)/2, each second.

use std::time::Instant;

use taut_certify::{
    CheckError, Ellipsoid, EllipsoidCertificate, Items, Solution, Trace, Violation,
};
use taut_points::{Distribution, Monitor, Points, generate, hash_points};

fn main() {
    for (n, d) in [(1_000_000, 2), (1_000_000, 3), (100_000, 10), (100_000, 30), (10_000, 100)] {
        let normal = generate(Distribution::Normal, n, d, 1).expect("valid");
        let sphere = generate(Distribution::Sphere, n, d, 1).expect("valid");
        measure("normal", &normal, d, 3.0 * (d as f64).sqrt() + 10.0, 1);
        measure("shell 1e-9", &sphere, d, 1.0 + 1e-9, 1);
        measure("surface", &sphere, d, 1.0 + 1e-15, 1);
        // As many support rows as large sets of normal points have.
        measure("support", &sphere, d, 1.0 + 1e-9, 10 * d + d * d / 20);
    }
}

fn measure(name: &str, values: &[f64], d: usize, radius: f64, support: usize) {
    let points = Points::new(values, d).expect("whole rows");
    let n = values.len() / d;
    let factor: Vec<Vec<f64>> = (0..d)
        .map(|a| {
            let entry = |b: usize| if a == b { 1.0 / radius } else { 1e-30 };
            (0..d).map(|b| if b <= a { entry(b) } else { 0.0 }).collect()
        })
        .collect();
    let entry = |j: usize, k: usize| factor.iter().map(|row| row[j] * row[k]).sum::<f64>();
    let matrix = (0..d).map(|j| (0..d).map(|k| entry(j, k)).collect()).collect();
    let ball = |d: usize| {
        let steps = (2..=d).filter(|k| k % 2 == d % 2);
        (d % 2) as f64 * 2f64.ln()
            + steps.map(|k| (std::f64::consts::TAU / k as f64).ln()).sum::<f64>()
    };
    let solution = Solution {
        answer: Ellipsoid {
            center: vec![0.0; d],
            center_tail: vec![],
            matrix,
            factor,
            hull: None,
            log_volume: ball(d) + d as f64 * radius.ln(),
        },
        certificate: EllipsoidCertificate {
            items: Items::Points,
            support: (0..support as u64).collect(),
            multipliers: vec![1.0 / support as f64; support],
            directions: vec![],
            left_out: vec![],
            gap: 0.0,
            points_hash: hash_points(&points, &Monitor::silent()).expect("memory"),
        },
        trace: Trace::default(),
    };
    let best = |work: &dyn Fn()| {
        let once = || {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64() * 1e3
        };
        (0..5).map(|_| once()).fold(f64::INFINITY, f64::min)
    };
    // Every row is inside; only then does the checker come to the multipliers, which prove little.
    let outcome = solution.check(&points);
    assert!(matches!(outcome, Err(CheckError::Rejected(Violation::LogGap { .. }))), "{outcome:?}");
    let check = best(&|| drop(solution.check(&points)));
    let read = best(&|| {
        std::hint::black_box(values.iter().sum::<f64>());
    });
    let work = n as f64 * (d * (d + 1) / 2) as f64 / check * 1e-6;
    println!(
        "{n:>8} x {d:<4} {name:<10} check {check:8.2} ms, {work:5.2} G multiplications/s; plain sum {read:6.2} ms"
    );
}
