//! How long a robust ellipsoid takes: `robust_speed FILE DIM METHOD THREADS REPEATS`, FILE of raw little-endian `f64`.

use std::time::Instant;

use taut_certify::Answer;
use taut_enclose::{RobustOptions, robust_ellipsoid};
use taut_points::{Monitor, Points};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, dim, method, threads, repeats] = &arguments[..] else {
        return Err("usage: robust_speed FILE DIM METHOD THREADS REPEATS".into());
    };
    let bytes = std::fs::read(file)?;
    let values: Vec<f64> =
        bytes.as_chunks::<8>().0.iter().map(|eight| f64::from_le_bytes(*eight)).collect();
    let points = Points::new(&values, dim.parse()?)?;
    let options = RobustOptions {
        method: method.parse()?,
        threads: Some(threads.parse()?),
        ..Default::default()
    };
    let mut best = f64::INFINITY;
    let mut found = robust_ellipsoid(&points, &options)?;
    for _ in 0..repeats.parse()? {
        let start = Instant::now();
        found = robust_ellipsoid(&points, &options)?;
        best = best.min(start.elapsed().as_secs_f64());
    }
    let start = Instant::now();
    let verdict = found.answer.check(&found.certificate, &points, &Monitor::silent())?;
    println!(
        "{:.1} ms, objective {:.9}, {} outliers, {} passes, {} steps; checked in {:.1} ms: {verdict:?}",
        best * 1e3,
        found.certificate.objective,
        found.answer.flagged.len(),
        found.trace.passes,
        found.trace.iterations,
        start.elapsed().as_secs_f64() * 1e3,
    );
    Ok(())
}
