//! Measures how fast one triangulation is proved: `cargo run --release -p taut-certify --example check_mesh D POINTS SIMPLICES
//! NEIGHBORS [plain]`; with `plain` also without neighbors.
//!
//! The files are raw: `f64` rows of D coordinates, and `u32` rows of D + 1 ids, the neighbor opposite each vertex in the
//! same place, −1 on the hull. SciPy's `Delaunay` gives such arrays of any general points; put its simplices in an order
//! that follows space first. Time of the processor, mean of ten, per row of the points; `RAYON_NUM_THREADS=1` for one thread.

use std::time::Instant;

use taut_certify::{
    NO_NEIGHBOR, Solution, Trace, Triangulation, TriangulationCertificate, check_simplices,
};
use taut_points::{Monitor, Points, hash_points};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let plain_too = arguments.len() == 5 && arguments.pop().is_some_and(|last| last == "plain");
    let [dimension, points, simplices, neighbors] = &arguments[..] else {
        return Err("give D, POINTS, SIMPLICES and NEIGHBORS, and `plain` for both ways".into());
    };
    let dimension: usize = dimension.parse()?;
    let values: Vec<f64> = read(points)?.into_iter().map(f64::from_le_bytes).collect();
    let ids = |path| Ok::<_, std::io::Error>(read(path)?.into_iter().map(u32::from_le_bytes));
    let simplices: Vec<u32> = ids(simplices)?.collect();
    let neighbors: Vec<u32> = ids(neighbors)?.collect();
    let points = Points::new(&values, dimension)?;
    let silent = Monitor::silent();

    let plain = || check_simplices(&points, &simplices, dimension + 1, &silent);
    let verdict = plain()?;
    let certified = Solution {
        answer: Triangulation {
            dimension: dimension as u8,
            hull_dimension: Some(dimension as u8),
            simplices: simplices.clone(),
            hull: hull(dimension, &simplices, &neighbors),
            duplicates: vec![],
        },
        certificate: TriangulationCertificate {
            neighbors,
            fingerprint: verdict.fingerprint,
            points_hash: hash_points(&points, &silent)?,
            counts: verdict.counts,
        },
        trace: Trace::default(),
    };
    assert_eq!(certified.check(&points)?, verdict);
    println!("{verdict:?}");
    let n = points.len() as f64;
    let time = |name: &str, work: &dyn Fn()| {
        let start = (processor_time(), Instant::now());
        (0..10).for_each(|_| work());
        let wall = start.1.elapsed().as_secs_f64();
        let spent = processor_time().zip(start.0).map_or(wall, |(end, start)| end - start);
        println!("{name}: {:.1} ns per point", spent / 10.0 * 1e9 / n);
    };
    time("with certificate", &|| drop(certified.check(&points)));
    if plain_too {
        time("simplices alone", &|| drop(plain()));
    }
    Ok(())
}

/// Seconds the processors have spent for this program, where Linux says so.
fn processor_time() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace().skip(11);
    let mut ticks = || fields.next()?.parse::<f64>().ok();
    Some((ticks()? + ticks()?) / 100.0)
}

fn read<const N: usize>(path: &str) -> std::io::Result<Vec<[u8; N]>> {
    Ok(std::fs::read(path)?.as_chunks().0.to_vec())
}

/// The facets without a neighbor, seen from outside.
fn hull(dimension: usize, simplices: &[u32], neighbors: &[u32]) -> Vec<u32> {
    let facets: &[&[usize]] = match dimension {
        2 => &[&[1, 2], &[2, 0], &[0, 1]],
        _ => &[&[1, 2, 3], &[0, 3, 2], &[0, 1, 3], &[0, 2, 1]],
    };
    let open = neighbors.iter().enumerate().filter(|&(_, &neighbor)| neighbor == NO_NEIGHBOR);
    open.flat_map(|(place, _)| {
        let row = place / (dimension + 1) * (dimension + 1);
        facets[place % (dimension + 1)].iter().map(move |&vertex| simplices[row + vertex])
    })
    .collect()
}
