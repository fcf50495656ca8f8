//! Whether a mesh is closed.

use super::BodiesViolation;

/// The two ends of an edge, in an order that does not depend on the triangle, and the triangle.
type Edge = ([[u64; 3]; 2], u64);

/// Checks that each edge belongs to an even number of triangles. Corners with equal coordinates are one vertex.
///
/// An edge between equal corners is no edge: of a triangle that has one the other two edges are the same.
pub(super) fn is_closed(triangles: &[[[f64; 3]; 3]]) -> Result<(), BodiesViolation> {
    // −0 and 0 are one number.
    let key = |corner: [f64; 3]| corner.map(|x| (x + 0.0).to_bits());
    let mut edges: Vec<Edge> = vec![];
    for (row, triangle) in triangles.iter().enumerate() {
        for corner in 0..3 {
            let mut ends = [key(triangle[corner]), key(triangle[(corner + 1) % 3])];
            if ends[0] != ends[1] {
                ends.sort_unstable();
                edges.push((ends, row as u64));
            }
        }
    }
    edges.sort_unstable();
    match edges.chunk_by(|one, other| one.0 == other.0).find(|same| same.len() % 2 == 1) {
        None => Ok(()),
        Some(same) => {
            let [from, to] = same[0].0.map(|end| end.map(f64::from_bits));
            Err(BodiesViolation::Open { row: same[0].1, from, to })
        }
    }
}
