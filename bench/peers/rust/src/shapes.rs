//! Shapes inside others: the largest circle of the crate polylabel, and the convex parts of parry3d.

use std::error::Error;
use std::io::stdin;
use std::time::Instant;

use geo::{LineString, Polygon};
use parry3d_f64::math::Vector;
use parry3d_f64::transformation::vhacd::{VHACD, VHACDParameters};
use polylabel::polylabel;
use serde_json::json;

/// The tolerance of the circle where the longest side is 1.
const TOLERANCE: f64 = 1e-6;

/// The most parts, and the cells of its grid along the longest side.
const PARTS_MAX: u32 = 32;
const RESOLUTION: u32 = 128;

/// The circle in one ring, in the protocol of `bench/peers/protocol.hpp`: radius to standard output, center to `output`.
pub fn serve_circle(path: &str, output: &str) -> Result<(), Box<dyn Error>> {
    let ring: Vec<[f64; 2]> = rows(path)?;
    let polygon = Polygon::new(LineString::from(ring.clone()), vec![]);
    println!("{{\"ready\":true}}");
    for line in stdin().lines() {
        line?;
        let start = Instant::now();
        let center = polylabel(&polygon, &TOLERANCE)?;
        let seconds = start.elapsed().as_secs_f64();
        // It tells the center alone.
        let center = [center.x(), center.y()];
        let edges = ring.iter().zip(ring.iter().cycle().skip(1));
        let distance = |(a, b): (&[f64; 2], &[f64; 2])| distance_to_segment(center, *a, *b);
        let radius = edges.map(distance).fold(f64::INFINITY, f64::min);
        std::fs::write(output, center.map(f64::to_le_bytes).concat())?;
        println!("{{\"seconds\":{seconds},\"radius\":{radius},\"support\":1}}");
    }
    Ok(())
}

/// The parts of a mesh, whose rows are triangles: one line of JSON with the seconds and the vertices of each part.
pub fn convex_parts(path: &str) -> Result<serde_json::Value, Box<dyn Error>> {
    let triangles: Vec<[f64; 9]> = rows(path)?;
    let corners = triangles.as_flattened().as_chunks::<3>().0.to_vec();
    let mut vertices = corners.clone();
    vertices.sort_by(|a, b| a.partial_cmp(b).expect("no NaN in a mesh of the bench"));
    vertices.dedup();
    let at = |corner| vertices.partition_point(|vertex| vertex < corner) as u32;
    let faces: Vec<[u32; 3]> =
        corners.as_chunks::<3>().0.iter().map(|t| t.each_ref().map(at)).collect();
    let vertices: Vec<Vector> = vertices.iter().map(|&[x, y, z]| Vector::new(x, y, z)).collect();
    let parameters = VHACDParameters {
        resolution: RESOLUTION,
        max_convex_hulls: PARTS_MAX,
        ..Default::default()
    };
    let start = Instant::now();
    let parts = VHACD::decompose(&parameters, &vertices, &faces, true)
        .compute_exact_convex_hulls(&vertices, &faces);
    let seconds = start.elapsed().as_secs_f64();
    let of_part = |(vertices, _): &(Vec<Vector>, Vec<[u32; 3]>)| {
        vertices.iter().map(|p| [p.x, p.y, p.z]).collect::<Vec<_>>()
    };
    let hulls: Vec<_> = parts.iter().map(of_part).collect();
    Ok(json!({ "seconds": seconds, "hulls": hulls }))
}

/// The rows of a file of the protocol.
pub(crate) fn rows<const N: usize>(path: &str) -> Result<Vec<[f64; N]>, Box<dyn Error>> {
    let bytes = std::fs::read(path)?;
    let (words, _) = bytes.as_chunks::<8>();
    let [_, columns, values @ ..] = words else { return Err("no header".into()) };
    if u64::from_le_bytes(*columns) != N as u64 {
        return Err(format!("rows of {N} numbers expected").into());
    }
    let (rows, _) = values.as_chunks::<N>();
    Ok(rows.iter().map(|row| row.map(f64::from_le_bytes)).collect())
}

fn distance_to_segment(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (along, from) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let square = along[0] * along[0] + along[1] * along[1];
    let dot = along[0] * from[0] + along[1] * from[1];
    let t = if square > 0.0 { (dot / square).clamp(0.0, 1.0) } else { 0.0 };
    (from[0] - t * along[0]).hypot(from[1] - t * along[1])
}
