//! One hash for all ways to triangulate a set: in memory, to a folder, as a stream.
//!
//! `cargo run --release -p taut-delaunay --example hashes -- 100000 FOLDER` prints a row for each set of about so many points: how
//! many ways were tried and how many gave the hash of the build in memory on one thread, and ends with an error if one did not.
//! The folder is used for tiles and is empty afterwards.

use std::f64::consts::TAU;
use std::path::Path;

use taut_certify::Fingerprint;
use taut_delaunay::outofcore::{
    Coherence, Dim, Dimension, FolderOptions, Stream, StreamOptions, delaunay_to_folder,
};
use taut_delaunay::{DelaunayOptions, delaunay};
use taut_points::generate::Parameters;
use taut_points::{Distribution, Monitor, Points, generate};

type Failed = Box<dyn std::error::Error>;

/// MiB of three limits; the first two cut sets of 10⁵ points and more.
const LIMITS: [u64; 3] = [64, 80, 512];

fn named(name: &str, n: usize, d: usize) -> Result<Vec<f64>, Failed> {
    let parameters = Parameters::default();
    Ok(generate(Distribution::named(name, n as u64, d, &parameters)?, n, d, 5)?)
}

/// The sets of the plane.
fn plane(n: usize) -> Result<Vec<(&'static str, Vec<f64>)>, Failed> {
    let side = (n as f64).sqrt().ceil() as usize;
    let lots = named("uniform", n, 2)?;
    let lots: &[[f64; 2]] = lots.as_chunks().0;
    let circles = (0..n / 10).flat_map(|i| {
        let (s, c) = (TAU * i as f64 / (n / 10) as f64).sin_cos();
        let r = [1.0, 2.0][i % 2];
        [r * c, r * s]
    });
    let lines = (0..n / 3).flat_map(|i| {
        let ([x, y], [v, w], t) = (lots[i % 20], lots[i % 20 + 20], lots[i][0]);
        [x + t * v, y + t * w + 1e-9 * lots[i][1]]
    });
    let apex = (0..n / 10).flat_map(|i| [i as f64, 0.0]).chain([n as f64 / 20.5, n as f64 / 10.0]);
    let twice = lots.iter().chain(&lots[..n / 2]).flatten();
    Ok(vec![
        ("uniform", lots.as_flattened().to_vec()),
        ("clusters", named("clusters", n, 2)?),
        ("clouds", named("clouds", n, 2)?),
        ("roads", named("roads", n, 2)?),
        ("kuzmin", named("kuzmin", n, 2)?),
        ("grid", (0..side * side).flat_map(|i| [(i % side) as f64, (i / side) as f64]).collect()),
        ("two circles", circles.collect()),
        ("20 lines", lines.collect()),
        ("line and apex", apex.collect()),
        ("with duplicates", twice.copied().collect()),
        ("all equal", vec![0.5; 2 * (n / 10)]),
        ("all collinear", (0..n / 10).flat_map(|i| [0.1 * i as f64; 2]).collect()),
    ])
}

/// The sets of space, of fewer points.
fn space(n: usize) -> Result<Vec<(&'static str, Vec<f64>)>, Failed> {
    let n = n / 2;
    let side = (n as f64).cbrt().ceil() as usize;
    let lots = named("uniform", n / 5, 3)?;
    let torus = lots.chunks(3).flat_map(|lot| {
        let r = 2.0 + 0.7 * (TAU * lot[1]).cos();
        [r * (TAU * lot[0]).cos(), r * (TAU * lot[0]).sin(), 0.7 * (TAU * lot[1]).sin()]
    });
    let grid = (0..side.pow(3))
        .flat_map(|i| [i % side, i / side % side, i / side / side].map(|k| k as f64));
    Ok(vec![
        ("uniform, space", named("uniform", n, 3)?),
        ("grid, space", grid.collect()),
        ("sphere", named("sphere", n / 5, 3)?),
        ("torus", torus.collect()),
        ("all equal, space", vec![0.25; 3 * (n / 10)]),
        ("all collinear, space", (0..n / 10).flat_map(|i| [0.1 * i as f64; 3]).collect()),
    ])
}

/// In memory.
fn in_memory<const D: usize>(points: &[[f64; D]], threads: usize) -> Result<Fingerprint, Failed> {
    let view = Points::new(points.as_flattened(), D)?;
    let options = DelaunayOptions { threads: Some(threads), ..DelaunayOptions::default() };
    Ok(delaunay(&view, &options)?.certificate.fingerprint)
}

fn to_folder<const D: usize>(
    points: &[[f64; D]],
    (mib, threads): (u64, usize),
    folder: &Path,
) -> Result<Fingerprint, Failed> {
    let view = Points::new(points.as_flattened(), D)?;
    let options =
        FolderOptions { memory: mib << 20, threads: Some(threads), ..FolderOptions::default() };
    let tiles = folder.join("tiles");
    let found = delaunay_to_folder(&view, &tiles, &options)?;
    std::fs::remove_dir_all(&tiles)?;
    Ok(found.totals.fingerprint)
}

/// Sorted along an axis.
fn streamed<const D: usize>(points: &[[f64; D]], axis: usize) -> Result<Fingerprint, Failed>
where
    Dim<D>: Dimension<D>,
{
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[axis].total_cmp(&b[axis]));
    let mut within = [[f64::INFINITY; D], [f64::NEG_INFINITY; D]];
    for p in points {
        for i in 0..D {
            within[0][i] = within[0][i].min(p[i]);
            within[1][i] = within[1][i].max(p[i]);
        }
    }
    let options = StreamOptions {
        within,
        coherence: Coherence::Sorted { axis },
        memory: 1 << 30,
        vectors: true,
        monitor: Monitor::silent(),
    };
    let take = &mut |_: &[u64]| Ok(());
    let mut stream = Stream::new(options)?;
    sorted.into_iter().try_for_each(|p| stream.push(p, take))?;
    Ok(stream.end(take)?.fingerprint)
}

/// All ways; returns how many there are and how many gave the same hash.
fn compare<const D: usize>(
    values: &[f64],
    folder: &Path,
) -> Result<(usize, usize, Fingerprint), Failed>
where
    Dim<D>: Dimension<D>,
{
    let given: Vec<[f64; D]> = values.as_chunks::<D>().0.to_vec();
    let expected = in_memory(&given, 1)?;
    let mut sorted = given.clone();
    sorted.sort_by(|a, b| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal));
    let reversed: Vec<[f64; D]> = sorted.iter().rev().copied().collect();
    let mut found = Vec::new();
    for threads in [2, 3, 8] {
        found.push(in_memory(&given, threads)?);
    }
    for order in [&given, &sorted, &reversed] {
        for (mib, threads) in LIMITS.into_iter().zip([1, 2, 3]) {
            found.push(to_folder(order, (mib, threads), folder)?);
        }
    }
    found.push(to_folder(&given, (LIMITS[0], 8), folder)?);
    for axis in 0..D {
        found.push(streamed(&given, axis)?);
    }
    Ok((found.len(), found.iter().filter(|&&hash| hash == expected).count(), expected))
}

fn main() -> Result<(), Failed> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [n, folder] = args.as_slice() else { return Err("expected: points folder".into()) };
    let (n, folder) = (n.parse::<usize>()?, Path::new(folder));
    std::fs::create_dir_all(folder)?;
    let mut differ = 0;
    println!("| set | points | ways | equal | hash |\n|---|---|---|---|---|");
    let mut row = |name: &str, points: usize, (ways, equal, hash): (usize, usize, Fingerprint)| {
        println!("| {name} | {points} | {ways} | {equal} | {hash} |");
        differ += ways - equal;
    };
    for (name, values) in plane(n)? {
        row(name, values.len() / 2, compare::<2>(&values, folder)?);
    }
    for (name, values) in space(n)? {
        row(name, values.len() / 3, compare::<3>(&values, folder)?);
    }
    if differ > 0 { Err(format!("{differ} hashes differ").into()) } else { Ok(()) }
}
