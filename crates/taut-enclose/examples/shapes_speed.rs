//! How long the ellipsoid and the ball of random ellipsoids take: `cargo run --release --example shapes_speed -- 1000 10 1e-6`.

use std::time::Instant;

use taut_enclose::{BallOptions, EllipsoidOptions, ball_of_ellipsoids, ellipsoid_of_ellipsoids};
use taut_points::{Distribution, Points, generate};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let n: usize = arguments.next().unwrap_or("1000".into()).parse()?;
    let dim: usize = arguments.next().unwrap_or("10".into()).parse()?;
    let epsilon: f64 = arguments.next().unwrap_or("1e-6".into()).parse()?;
    let size: f64 = arguments.next().unwrap_or("0.5".into()).parse()?;
    for seed in 0..3 {
        let centers: Vec<f64> = generate(Distribution::Normal, n, dim, seed)?;
        let factors: Vec<f64> = generate(Distribution::Normal, n * dim, dim, seed + 100)?;
        let mut values = vec![];
        for (center, g) in centers.chunks(dim).zip(factors.chunks(dim * dim)) {
            values.extend_from_slice(center);
            for a in 0..dim {
                for b in 0..=a {
                    let sum: f64 = (0..dim).map(|k| g[a * dim + k] * g[b * dim + k]).sum();
                    values.push(size * size * sum / dim as f64);
                }
            }
        }
        let rows = Points::new(&values, dim * (dim + 3) / 2)?;
        let options = EllipsoidOptions { epsilon, ..Default::default() };
        let start = Instant::now();
        let found = ellipsoid_of_ellipsoids(&rows, &options)?;
        let time = start.elapsed();
        let gap = found.check(&rows)?.gap;
        println!(
            "ellipsoid: {time:.1?}, gap {gap:.1e}, {} passes, {} steps, support {}, {:?}",
            found.trace.passes,
            found.trace.iterations,
            found.certificate.support.len(),
            found.trace.counters,
        );
        let options = BallOptions { epsilon, ..Default::default() };
        let start = Instant::now();
        let found = ball_of_ellipsoids(&rows, &options)?;
        let time = start.elapsed();
        let gap = found.check(&rows)?.gap;
        println!(
            "ball: {time:.1?}, gap {gap:.1e}, {} passes, {} steps, support {}",
            found.trace.passes,
            found.trace.iterations,
            found.certificate.support.len(),
        );
    }
    Ok(())
}
