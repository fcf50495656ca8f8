//! Any bytes as points of the plane or of space, triangulated in two ways and judged.

use taut_certify::{Solution, Triangulation};
use taut_delaunay::{DelaunayOptions, InsertionOrder, delaunay};
use taut_points::Points;

/// Most points: small sets are the degenerate ones, and fast.
const POINTS_MAX: usize = 96;

/// Returns what a byte means as a coordinate: mostly small integers, so that points coincide and lie on common lines, circles,
/// planes and spheres; and the ends of what a double holds.
fn coordinate(byte: u8, style: u8) -> f64 {
    let small = f64::from(byte % 8);
    match style % 8 {
        0..=3 => small,
        // Ties that are no integers.
        4 => small * 0.1,
        // Almost ties.
        5 => small + f64::from(byte / 64) * f64::EPSILON,
        6 => 2f64.powi(i32::from(byte) * 8 - 1024),
        _ => [0.0, -0.0, 5e-324, 1e-300, 1.0, 1e150, -1e300, f64::MAX][usize::from(byte % 8)],
    }
}

/// Triangulates the points of the plane or of space that the bytes mean, twice, and has the answer checked.
///
/// # Panics
/// If the two answers differ, or the checker rejects.
pub(crate) fn solve_and_check(dim: usize, bytes: &[u8]) {
    let [style, way, seed, rest @ ..] = bytes else { return };
    let rows = (rest.len() / dim).min(POINTS_MAX);
    let values: Vec<f64> =
        rest[..rows * dim].iter().map(|&byte| coordinate(byte, *style)).collect();
    let points = Points::new(&values, dim).expect("whole rows");
    let one = DelaunayOptions { threads: Some(1), ..DelaunayOptions::default() };
    let other = DelaunayOptions {
        order: InsertionOrder::ALL[usize::from(*way) % 4],
        seed: u64::from(*seed),
        threads: Some(1 + usize::from(way >> 2) % 4),
        sites_per_thread: Some(1),
        vectors: way & 128 == 0,
        ..one.clone()
    };
    let solve = |options| -> Solution<Triangulation> {
        delaunay(&points, options).expect("finite points have a triangulation")
    };
    let found = solve(&one);
    if let Err(violation) = found.check(&points) {
        panic!("{violation}: {points:?}");
    }
    let again = solve(&other);
    assert!(
        again.answer == found.answer && again.certificate == found.certificate,
        "{other:?}: {points:?}"
    );
}
