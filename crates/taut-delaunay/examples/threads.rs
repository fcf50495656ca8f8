//! One thread beside several: the time of builds in memory, and whether the simplices are the same.
//!
//! `cargo run --release -p taut-delaunay --example threads -- 2 7` prints a row for each set: the least time of 7 alternating rounds
//! of one thread over that of 2, by the clock, and ends with an error if a hash differs. Names of sets may follow.

use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use taut_certify::Fingerprint;
use taut_delaunay::{DelaunayOptions, Plane, Space};
use taut_points::generate::Parameters;
use taut_points::{Distribution, Monitor, Points, generate};

type Failed = Box<dyn std::error::Error>;

/// How a set is made from its size.
type Make = fn(usize) -> Result<Vec<f64>, Failed>;

/// Name, dimension, points.
const SETS: &[(&str, usize, usize, Make)] = &[
    ("uniform", 2, 1_000_000, |n| named("uniform", n, 2)),
    ("uniform, large", 2, 10_000_000, |n| named("uniform", n, 2)),
    ("clouds", 2, 1_000_000, |n| named("clouds", n, 2)),
    ("kuzmin", 2, 1_000_000, |n| named("kuzmin", n, 2)),
    ("roads", 2, 1_000_000, |n| named("roads", n, 2)),
    ("grid", 2, 1_000_000, |n| named("grid", n, 2)),
    ("spiral", 2, 1_000_000, |n| named("spiral", n, 2)),
    ("20 lines", 2, 1_000_000, |n| named("lines", n, 2)),
    ("line and apex", 2, 1_000_000, |n| named("fan", n, 2)),
    ("circle", 2, 1_000_000, |n| named("sphere", n, 2)),
    ("two circles", 2, 1_000_000, |n| Ok(circles(n))),
    ("uniform, space", 3, 1_000_000, |n| named("uniform", n, 3)),
    ("clouds, space", 3, 1_000_000, |n| named("clouds", n, 3)),
    ("grid, space", 3, 1_000_000, |n| named("grid", n, 3)),
    ("sphere", 3, 500_000, |n| named("sphere", n, 3)),
    ("torus", 3, 500_000, |n| named("torus", n, 3)),
    ("torus, exact", 3, 30_000, |n| torus(n, 0.0)),
    ("torus and noise", 3, 500_000, |n| torus(n, 1e-4)),
    ("skew lines", 3, 4000, |n| named("skew", n, 3)),
    ("uniform, small", 2, 100_000, |n| named("uniform", n, 2)),
    ("uniform, small, space", 3, 100_000, |n| named("uniform", n, 3)),
];

fn named(name: &str, n: usize, d: usize) -> Result<Vec<f64>, Failed> {
    let parameters = Parameters::default();
    Ok(generate(Distribution::named(name, n as u64, d, &parameters)?, n, d, 5)?)
}

fn circles(n: usize) -> Vec<f64> {
    let at = |i: usize| {
        let (s, c) = (TAU * i as f64 / n as f64).sin_cos();
        let r = [1.0, 2.0][i % 2];
        [r * c, r * s]
    };
    (0..n).flat_map(at).collect()
}

fn torus(n: usize, noise: f64) -> Result<Vec<f64>, Failed> {
    let lots = named("uniform", n, 3)?;
    let at = |lot: &[f64]| {
        let tube = 0.7 + noise * (lot[2] - 0.5);
        let r = 2.0 + tube * (TAU * lot[1]).cos();
        [r * (TAU * lot[0]).cos(), r * (TAU * lot[0]).sin(), tube * (TAU * lot[1]).sin()]
    };
    Ok(lots.chunks(3).flat_map(at).collect())
}

/// Builds, and returns the time; the hash if it is asked for.
fn build(
    points: &Points<'_, f64>,
    threads: usize,
    hash: bool,
) -> Result<(Duration, Option<Fingerprint>), Failed> {
    let options = DelaunayOptions { threads: Some(threads), ..DelaunayOptions::default() };
    let begin = Instant::now();
    macro_rules! built {
        ($kind:ident) => {{
            let built = $kind::build(points, &options)?;
            let took = begin.elapsed();
            let silent = Monitor::silent();
            let found = hash.then(|| built.solution(points, &silent)).transpose()?;
            (took, found.map(|found| found.certificate.fingerprint))
        }};
    }
    Ok(if points.dim() == 2 { built!(Plane) } else { built!(Space) })
}

fn main() -> Result<(), Failed> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [threads, rounds, names @ ..] = args.as_slice() else {
        return Err("expected: threads rounds [sets]".into());
    };
    let (threads, rounds): (usize, usize) = (threads.parse()?, rounds.parse()?);
    println!("| set | points | one thread, ms | {threads} threads | times | hash |");
    println!("|---|---|---|---|---|---|");
    let mut differ = 0;
    for &(name, dim, n, make) in SETS {
        if !names.is_empty() && !names.iter().any(|wanted| wanted == name) {
            continue;
        }
        let values = make(n)?;
        let points = Points::new(&values, dim)?;
        let hashes = [1, threads].map(|threads| build(&points, threads, true));
        let [one, several] = hashes;
        let is_equal = one?.1 == several?.1;
        differ += u32::from(!is_equal);
        let mut least = [Duration::MAX; 2];
        for _ in 0..rounds {
            for (least, threads) in least.iter_mut().zip([1, threads]) {
                *least = build(&points, threads, false)?.0.min(*least);
            }
        }
        let [one, several] = least.map(|least| least.as_secs_f64() * 1e3);
        let said = if is_equal { "equal" } else { "DIFFERS" };
        println!(
            "| {name} | {} | {one:.1} | {several:.1} | {:.2} | {said} |",
            points.len(),
            one / several
        );
    }
    if differ > 0 { Err(format!("{differ} hashes differ").into()) } else { Ok(()) }
}
