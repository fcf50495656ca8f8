//! Time, processor time and peak memory of one triangulation, in memory or to a folder:
//! `cargo run --release -p taut-delaunay --example outofcore -- uniform 2 10000000 512 2 /tmp/folder`, or `memory` in the
//! place of the folder. The first call writes the points to a file of the temporary folder; a folder that was begun is
//! resumed. After a folder comes its check.

use std::path::Path;
use std::time::Instant;

use taut_certify::{TilesOptions, check_tiles};
use taut_delaunay::outofcore::{FolderOptions, delaunay_to_folder};
use taut_delaunay::{DelaunayOptions, Plane, Space};
use taut_points::{Distribution, FileSource, GeneratedSource, Points, Rows, Scratch};
use taut_points::{Monitor, PointSource, ScalarKind};

/// Seconds of processor time of this process, and its peak memory in MiB, where the system tells.
fn used() -> (f64, u64) {
    let text = |path| std::fs::read_to_string(path).unwrap_or_default();
    let stat = text("/proc/self/stat");
    let after = stat.rsplit(')').next().unwrap_or_default();
    let ticks = |i: usize| after.split_whitespace().nth(i).and_then(|t| t.parse::<f64>().ok());
    let seconds = (ticks(11).unwrap_or(0.0) + ticks(12).unwrap_or(0.0)) / 100.0;
    let status = text("/proc/self/status");
    let peak = status.lines().find(|line| line.starts_with("VmHWM")).unwrap_or_default();
    let peak = peak.split_whitespace().nth(1).and_then(|k| k.parse::<u64>().ok());
    (seconds, peak.unwrap_or(0) >> 10)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [set, dim, n, memory, threads, target] = args.as_slice() else {
        return Err("expected: set dimension n MiB threads folder|memory".into());
    };
    let (dim, n, threads) = (dim.parse::<usize>()?, n.parse::<u64>()?, threads.parse::<usize>()?);
    let side = (n as f64).powf(1.0 / dim as f64).round() as u64;
    let distribution = match set.as_str() {
        "uniform" => Distribution::Uniform,
        "kuzmin" => Distribution::Kuzmin,
        "clusters" => Distribution::Clouds { count: 1000 },
        "grid" => Distribution::Grid { side, angle: 0.0 },
        "spiral" => Distribution::Spiral { turns: 1000.0 },
        "sphere" => Distribution::Sphere,
        _ => return Err("sets: uniform, kuzmin, clusters, grid, spiral, sphere".into()),
    };
    // A file of raw values first: to generate points is no part of the work.
    let raw = std::env::temp_dir().join(format!("taut-{set}-{dim}-{n}.raw"));
    if !raw.exists() {
        use std::io::Write;
        let source = GeneratedSource::new(distribution, n, dim, 1, ScalarKind::F64)?;
        let mut out = std::io::BufWriter::new(std::fs::File::create(&raw)?);
        let mut scratch = Scratch::new();
        let mut row = vec![0.0; dim];
        for begin in (0..n).step_by(1 << 16) {
            let rows = source.read(begin..n.min(begin + (1 << 16)), &mut scratch)?;
            for i in 0..rows.len() {
                rows.copy_row(i, &mut row);
                row.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
            }
        }
        out.flush()?;
        println!("wrote {}", raw.display());
        return Ok(());
    }
    let source = FileSource::open(&raw, 0, n, dim, ScalarKind::F64)?;
    let begun = Instant::now();
    let note = |pass: u64, _: u64| {
        let (wall, cpu) = (begun.elapsed().as_secs_f64(), used().0);
        println!("pass {pass} begins at {wall:.2} s wall, {cpu:.2} s processor");
    };
    let monitor = Monitor { on_pass: Some(&note), ..Monitor::silent() };
    if target == "memory" {
        let mut scratch = Scratch::new();
        let Rows::F64(points) = source.read(0..n, &mut scratch)? else { return Ok(()) };
        let points: Points<'_, f64> = points;
        let (before, _) = used();
        let begun = Instant::now();
        let options = DelaunayOptions { threads: Some(threads), ..DelaunayOptions::default() };
        let simplices = match dim {
            2 => Plane::build(&points, &options)?.simplices().count(),
            _ => Space::build(&points, &options)?.simplices().count(),
        };
        let wall = begun.elapsed().as_secs_f64();
        let (after, peak) = used();
        let cpu = (after - before) * 1e9 / n as f64;
        println!(
            "memory {set} {dim}d {n}: {simplices} simplices, {wall:.2} s wall, {cpu:.0} ns/pt processor, {peak} MiB"
        );
        return Ok(());
    }
    let memory = memory.parse::<u64>()? << 20;
    let resume = Path::new(target).join("manifest.txt").exists();
    let pool = taut_points::thread_pool(threads)?;
    let threads = Some(threads);
    let options = FolderOptions { memory, threads, resume, monitor, ..FolderOptions::default() };
    let found = delaunay_to_folder(&source, Path::new(target), &options)?;
    let wall = begun.elapsed().as_secs_f64();
    let (cpu, peak) = used();
    let share = found.totals.front_sites as f64 * 100.0 / n as f64;
    let cpu = cpu * 1e9 / n as f64;
    println!(
        "folder {set} {dim}d {n}: {} simplices, {wall:.2} s wall, {cpu:.0} ns/pt processor, {peak} MiB, front {share:.2} %, root {} sites, {} tiles, {} merged",
        found.totals.simplices,
        found.totals.root_sites,
        found.totals.tiles,
        found.totals.merged_sites
    );
    let begun = Instant::now();
    let options = TilesOptions { memory, monitor, ..TilesOptions::default() };
    let verdict = pool.install(|| check_tiles(Path::new(target), &source, &options))?;
    let wall = begun.elapsed().as_secs_f64();
    println!("check: {} points, {wall:.2} s wall", verdict.points);
    Ok(())
}
