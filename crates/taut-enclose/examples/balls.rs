//! Times the exact ball of hard and of ordinary inputs, with the counts that explain the time.
//!
//! Arguments are names of cases (none: all): `shell-300` is a sphere with noise of 1e-8 in 300 dimensions, `cube-300`
//! vertices of the cube, `normal-300` normal points. Each case is solved for several seeds; a line gives the median
//! and the range of seconds, and for the last seed passes, pivots, interior-point steps, working set and proved gap.

use std::time::Instant;

use taut_enclose::{BallOptions, ball};
use taut_points::{Distribution, Points, generate};

/// Seeds of one case, and times each is solved.
const SEEDS: u64 = 3;
const REPEATS: usize = 3;

fn main() {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let shell = Distribution::Shell { thickness: 1e-8 };
    let cases = [
        ("shell-100", shell, 10_000, 100),
        ("shell-300", shell, 10_000, 300),
        ("shell-500", shell, 10_000, 500),
        ("cube-100", Distribution::CubeVertices, 10_000, 100),
        ("cube-300", Distribution::CubeVertices, 10_000, 300),
        ("cube-500", Distribution::CubeVertices, 5_000, 500),
        ("cube-1500", Distribution::CubeVertices, 20_000, 1500),
        ("sphere-300", Distribution::Sphere, 10_000, 300),
        ("normal-300", Distribution::Normal, 10_000, 300),
        ("normal-1000", Distribution::Normal, 10_000, 1000),
        ("normal-2", Distribution::Normal, 1_000_000, 2),
        ("normal-10", Distribution::Normal, 1_000_000, 10),
    ];
    println!("case | s, median | least | most | passes | pivots | interior | set | support | gap");
    for (name, distribution, n, dim) in cases {
        if !names.is_empty() && !names.iter().any(|wanted| wanted == name) {
            continue;
        }
        let options = BallOptions { epsilon: 0.0, ..Default::default() };
        let mut seconds = vec![];
        let mut said = String::new();
        for seed in 1..=SEEDS {
            let values: Vec<f64> = generate(distribution, n, dim, seed).expect("a valid case");
            let points = Points::new(&values, dim).expect("whole rows");
            for _ in 0..REPEATS {
                let start = Instant::now();
                let found = ball(&points, &options).expect("finite points");
                seconds.push(start.elapsed().as_secs_f64());
                let trace = &found.trace;
                said = format!(
                    "{} | {} | {} | {} | {} | {:.1e}",
                    trace.passes,
                    trace.iterations,
                    trace.counters.get("interior").copied().unwrap_or(0),
                    trace.core_set,
                    found.certificate.support.len(),
                    found.certificate.gap,
                );
            }
        }
        seconds.sort_by(f64::total_cmp);
        let (median, most) = (seconds[seconds.len() / 2], seconds[seconds.len() - 1]);
        println!("{name} | {median:.4} | {:.4} | {most:.4} | {said}", seconds[0]);
    }
}
