//! Whether a mesh with its caps is closed.

use std::collections::BTreeMap;

use super::BodiesViolation;

/// A corner by the bits of its coordinates.
type Place = [u64; 3];

/// The two ends of an edge, in an order that does not depend on the triangle, and the triangle.
type Edge = ([Place; 2], u64);

/// Checks that each edge belongs to an even number of triangles, and that there are no more caps than holes need. The first
/// `rows` triangles are those of the mesh. Corners with equal coordinates are one vertex.
///
/// A hole with m edges is filled by m − 2 triangles. So holes whose edges hang together in c parts, with m edges in all, need at
/// most m − 2c caps; a closed mesh has none.
///
/// An edge between equal corners is no edge: of a triangle that has one the other two edges are the same.
pub(super) fn is_closed(triangles: &[[[f64; 3]; 3]], rows: usize) -> Result<(), BodiesViolation> {
    if let Some((ends, row)) = odd(triangles).first() {
        let [from, to] = ends.map(|end| end.map(f64::from_bits));
        return Err(BodiesViolation::Open { row: *row, from, to });
    }
    let caps = triangles.len() - rows;
    if caps > 0 {
        let boundary = odd(&triangles[..rows]);
        if caps + 2 * parts(&boundary) > boundary.len() {
            return Err(BodiesViolation::Caps {
                problem: "are more than the holes of the mesh need",
            });
        }
    }
    Ok(())
}

/// The edges that belong to an odd number of triangles.
fn odd(triangles: &[[[f64; 3]; 3]]) -> Vec<Edge> {
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
    let same = edges.chunk_by(|one, other| one.0 == other.0);
    same.filter(|same| same.len() % 2 == 1).map(|same| same[0]).collect()
}

/// In how many parts edges hang together.
fn parts(edges: &[Edge]) -> usize {
    let mut next: BTreeMap<Place, Vec<Place>> = BTreeMap::new();
    for ([from, to], _) in edges {
        next.entry(*from).or_default().push(*to);
        next.entry(*to).or_default().push(*from);
    }
    let mut parts = 0;
    while let Some((first, _)) = next.first_key_value() {
        parts += 1;
        let mut stack = vec![*first];
        while let Some(at) = stack.pop() {
            stack.extend(next.remove(&at).unwrap_or_default());
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn caps_fill_holes_and_nothing_else() {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [2.0; 3]];
        let triangle = |t: [usize; 3]| t.map(|k| corners[k]);
        let check = |faces: &[[usize; 3]], rows: usize| {
            let all: Vec<_> = faces.iter().map(|&t| triangle(t)).collect();
            is_closed(&all, rows)
        };
        let tetrahedron = [[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        for rows in [3, 4] {
            assert_eq!(check(&tetrahedron, rows), Ok(()));
        }
        // Two caps for one triangle: two holes that hang together, or one.
        assert!(check(&tetrahedron, 2).is_ok());
        // Three caps and a boundary of three edges: a tip on the hole.
        assert!(matches!(check(&tetrahedron, 1), Err(BodiesViolation::Caps { .. })));
        let twice = [[0, 1, 2], [0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 1, 4], [0, 1, 4]];
        assert!(matches!(check(&twice, 4), Err(BodiesViolation::Caps { .. })));
        assert!(matches!(check(&twice[..5], 4), Err(BodiesViolation::Open { .. })));
        // Holes that touch in a corner hang together.
        assert_eq!(parts(&odd(&[triangle([0, 1, 2]), triangle([0, 3, 4])])), 1);
        assert_eq!(parts(&odd(&[triangle([0, 1, 2])])), 1);
    }
}
