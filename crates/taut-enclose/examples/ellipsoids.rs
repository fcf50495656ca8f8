//! Times the ellipsoid of ordinary and of hard points, with the counts that explain the time.
//!
//! Arguments are names of cases (none: all): `normal-5-10` is 10⁵ normal points in ten dimensions, `shell-2-4-30` 10⁴ points
//! within 1e-2 of an ellipsoid with axes from 1 to 1000 in thirty. A line gives the median and the range of seconds over
//! several seeds, and for the last seed passes, Newton steps, pivots, interior-point steps, working set and proved gap.

use std::time::Instant;

use taut_enclose::{EllipsoidOptions, ellipsoid};
use taut_points::{Distribution, Points, generate};

/// Seeds of one case, and times each is solved.
const SEEDS: u64 = 3;
const REPEATS: usize = 9;

fn main() {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let cases = [
        ("normal-5-10", None, 100_000, 10),
        ("normal-6-10", None, 1_000_000, 10),
        ("normal-5-30", None, 100_000, 30),
        ("normal-4-100", None, 10_000, 100),
        ("shell-2-4-30", Some(1e-2), 10_000, 30),
        ("shell-4-4-30", Some(1e-4), 10_000, 30),
        ("shell-8-4-30", Some(1e-8), 10_000, 30),
        ("shell-2-5-10", Some(1e-2), 100_000, 10),
        ("shell-8-5-10", Some(1e-8), 100_000, 10),
    ];
    println!("case | s, median | least | most | passes | steps | pivots | interior | set | gap");
    for (name, thickness, n, dim) in cases {
        if !names.is_empty() && !names.iter().any(|wanted| wanted == name) {
            continue;
        }
        let options = EllipsoidOptions { epsilon: 1e-12, ..Default::default() };
        let mut seconds = vec![];
        let mut said = String::new();
        for seed in 1..=SEEDS {
            let values = match thickness {
                None => generate(Distribution::Normal, n, dim, seed).expect("a valid case"),
                Some(thickness) => shell(thickness, n, dim, seed),
            };
            let points = Points::new(&values, dim).expect("whole rows");
            for _ in 0..REPEATS {
                let start = Instant::now();
                let found = ellipsoid(&points, &options).expect("finite points");
                seconds.push(start.elapsed().as_secs_f64());
                let trace = &found.trace;
                let count = |name: &str| trace.counters.get(name).copied().unwrap_or(0);
                said = format!(
                    "{} | {} | {} | {} | {} | {:.1e}",
                    trace.passes,
                    trace.iterations,
                    count("pivots"),
                    count("interior-steps"),
                    trace.core_set,
                    found.certificate.gap,
                );
            }
        }
        seconds.sort_by(f64::total_cmp);
        let (median, most) = (seconds[seconds.len() / 2], seconds[seconds.len() - 1]);
        println!("{name} | {median:.5} | {:.5} | {most:.5} | {said}", seconds[0]);
    }
}

/// Points of a sphere, less a part of up to `thickness` of the radius, on axes from 1 to 1000 that are turned by a reflection.
fn shell(thickness: f64, n: usize, dim: usize, seed: u64) -> Vec<f64> {
    let mut values: Vec<f64> =
        generate(Distribution::Shell { thickness }, n, dim, seed).expect("a valid case");
    let normal: Vec<f64> =
        generate(Distribution::Normal, 1, dim, seed + 1000).expect("a valid case");
    let square: f64 = normal.iter().map(|v| v * v).sum();
    for row in values.chunks_exact_mut(dim) {
        for (j, x) in row.iter_mut().enumerate() {
            *x *= 1000f64.powf(j as f64 / (dim - 1) as f64);
        }
        let along: f64 = row.iter().zip(&normal).map(|(x, v)| x * v).sum::<f64>() * 2.0 / square;
        row.iter_mut().zip(&normal).for_each(|(x, v)| *x -= along * v);
    }
    values
}
