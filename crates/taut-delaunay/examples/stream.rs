//! Streams of uniform points: `cargo run --release -p taut-delaunay --example stream -- write sorted|cells 2 1000000 | … --
//! read sorted|cells 2 192`, or `memory` in the place of `read` to triangulate all points at once. Points come as raw `f64`, in
//! strips or in cells along a curve, each followed by a row that closes it; the hash and the figures are printed.

use std::io::{BufWriter, Read, Write};
use std::time::Instant;

use taut_delaunay::outofcore::{Coherence, Dim, Dimension, Stream, StreamOptions};
use taut_delaunay::{DelaunayOptions, delaunay};
use taut_points::{Monitor, Points};

type Failed = Box<dyn std::error::Error>;

/// Levels of the grid of cells.
fn levels(d: usize) -> u32 {
    if d == 2 { 7 } else { 4 }
}

/// Uniform numbers in [0, 1).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ z >> 31) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Writes about as many uniform points, sorted along x or cell by cell.
fn write(order: &str, d: usize, n: u64) -> Result<(), Failed> {
    let mut out = BufWriter::with_capacity(1 << 20, std::io::stdout().lock());
    let mut numbers = Numbers(n);
    if order == "sorted" {
        let strips = (n >> 12).max(1);
        for strip in 0..strips {
            let count = n * (strip + 1) / strips - n * strip / strips;
            let mut points: Vec<Vec<f64>> =
                (0..count).map(|_| (0..d).map(|_| numbers.next()).collect()).collect();
            points.iter_mut().for_each(|p| p[0] = (strip as f64 + p[0]) / strips as f64);
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            points.iter().flatten().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
        }
        return Ok(out.flush()?);
    }
    // Cells along the Z-order curve.
    let bits = levels(d);
    let cells = 1u64 << (bits * d as u32);
    for place in 0..cells {
        let mut at = vec![0u64; d];
        for bit in 0..bits * d as u32 {
            at[bit as usize % d] |= (place >> bit & 1) << (bit / d as u32);
        }
        for _ in n * place / cells..n * (place + 1) / cells {
            for &k in &at {
                let x = (k as f64 + numbers.next()) / (1u64 << bits) as f64;
                // The sum may be rounded up to the border.
                out.write_all(
                    &x.min(((k + 1) as f64 / (1u64 << bits) as f64).next_down()).to_le_bytes(),
                )?;
            }
        }
        let number = (0..d).rev().fold(0, |number, i| number << bits | at[i]);
        for i in 0..d {
            let x = [f64::NAN, number as f64, 0.0][i];
            out.write_all(&x.to_le_bytes())?;
        }
    }
    Ok(out.flush()?)
}

/// The next point of standard input.
fn next<const D: usize>(input: &mut impl Read) -> Result<Option<[f64; D]>, Failed> {
    let mut p = [0.0; D];
    for x in &mut p {
        let mut bytes = [0; 8];
        match input.read_exact(&mut bytes) {
            Err(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => return Ok(None),
            read => read?,
        }
        *x = f64::from_le_bytes(bytes);
    }
    Ok(Some(p))
}

fn read<const D: usize>(order: &str, memory: u64) -> Result<(), Failed>
where
    Dim<D>: Dimension<D>,
{
    let coherence = match order {
        "sorted" => Coherence::Sorted { axis: 0 },
        _ => Coherence::Cells { levels: levels(D) },
    };
    let options = StreamOptions {
        within: [[0.0; D], [1.0; D]],
        coherence,
        memory: memory << 20,
        vectors: true,
        monitor: Monitor::silent(),
    };
    let mut input = std::io::BufReader::with_capacity(1 << 20, std::io::stdin().lock());
    let mut written = std::io::sink();
    let mut take =
        |rows: &[u64]| rows.iter().try_for_each(|row| written.write_all(&row.to_le_bytes()));
    let begun = Instant::now();
    let mut stream = Stream::new(options)?;
    while let Some(p) = next::<D>(&mut input)? {
        if p[0].is_nan() {
            stream.close(p[1] as u64, &mut take)?;
        } else {
            stream.push(p, &mut take)?;
        }
    }
    let (rows, most, first) = (stream.rows(), stream.front_most(), stream.first_after());
    let totals = stream.end(&mut take)?;
    println!(
        "stream {order} {D}d {rows}: {} simplices, hull {}, hash {}, first after {first:?} points, at most {most} unfinished, {} sites again in {} chunks, {:.2} s wall, {}",
        totals.simplices,
        totals.hull,
        totals.fingerprint,
        totals.merged_sites,
        totals.tiles,
        begun.elapsed().as_secs_f64(),
        used(rows)
    );
    Ok(())
}

/// Processor time and peak memory, where the system tells.
fn used(n: u64) -> String {
    let text = |path| std::fs::read_to_string(path).unwrap_or_default();
    let stat = text("/proc/self/stat");
    let after = stat.rsplit(')').next().unwrap_or_default();
    let ticks = |i: usize| after.split_whitespace().nth(i).and_then(|t| t.parse::<f64>().ok());
    let seconds = (ticks(11).unwrap_or(0.0) + ticks(12).unwrap_or(0.0)) / 100.0;
    let status = text("/proc/self/status");
    let peak = status.lines().find(|line| line.starts_with("VmHWM")).unwrap_or_default();
    format!("{:.0} ns/pt processor, {}", seconds * 1e9 / n as f64, peak.trim())
}

fn memory<const D: usize>() -> Result<(), Failed> {
    let mut input = std::io::BufReader::with_capacity(1 << 20, std::io::stdin().lock());
    let mut values = Vec::new();
    while let Some(p) = next::<D>(&mut input)? {
        if !p[0].is_nan() {
            values.extend(p);
        }
    }
    let points = Points::new(&values, D)?;
    let found = delaunay(&points, &DelaunayOptions { threads: Some(1), ..Default::default() })?;
    let (n, hash) = (found.answer.len(), found.certificate.fingerprint);
    println!(
        "memory {D}d {}: {n} simplices, hash {hash}, {}",
        points.len(),
        used(points.len() as u64)
    );
    Ok(())
}

fn main() -> Result<(), Failed> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global()?;
    match args[..] {
        ["write", order, d, n] => write(order, d.parse()?, n.parse()?),
        ["read", order, "2", mib] => read::<2>(order, mib.parse()?),
        ["read", order, "3", mib] => read::<3>(order, mib.parse()?),
        ["memory", "2"] => memory::<2>(),
        ["memory", "3"] => memory::<3>(),
        _ => Err("expected: write ORDER D N, read ORDER D MIB, or memory D".into()),
    }
}
