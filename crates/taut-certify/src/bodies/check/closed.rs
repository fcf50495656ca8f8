//! Whether a mesh with its caps is closed, and each solid.

use std::collections::BTreeMap;

use taut_points::OrderBy;

use super::{BodiesViolation, MESH, Triangle};

/// A corner by the bits of its coordinates.
type Place = [u64; 3];

/// The two ends of an edge, in an order that does not depend on the triangle, and the triangle.
type Edge = ([Place; 2], u64);

/// Hashes in a bucket, about: as many as a sort by insertion and few comparisons takes.
const BUCKET_HASHES: usize = 32;

/// Checks that the mesh with its caps is closed, and each solid; returns how many solids there are. The first `rows` triangles are no
/// caps.
pub(super) fn are_closed(
    triangles: &[Triangle],
    surfaces: &[i32],
    rows: usize,
) -> Result<u64, BodiesViolation> {
    if surfaces.iter().all(|&surface| surface == MESH) {
        return is_closed(triangles, rows).map(|()| 0);
    }
    // Each surface by itself, and the row of each of its triangles.
    let mut parts: BTreeMap<i32, (Vec<Triangle>, Vec<u64>)> = BTreeMap::new();
    for (row, (&triangle, &surface)) in triangles.iter().zip(surfaces).enumerate() {
        if surface >= MESH {
            let (part, rows) = parts.entry(surface).or_default();
            part.push(triangle);
            rows.push(row as u64);
        }
    }
    for (part, of_part) in parts.values() {
        // Of the mesh the last ones are caps.
        let not_caps = of_part.partition_point(|&row| row < rows as u64);
        is_closed(part, not_caps).map_err(|violation| match violation {
            BodiesViolation::Open { row, from, to } => {
                BodiesViolation::Open { row: of_part[row as usize], from, to }
            }
            other => other,
        })?;
    }
    Ok(parts.keys().filter(|&&surface| surface > MESH).count() as u64)
}

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

/// The edges that belong to an odd number of triangles, in order of their ends.
///
/// A hash brings equal edges together, as it is sorted much faster than edges are; edges of one hash are compared. A hash that
/// many edges share costs time, and nothing else. The time is that of a sort, so the upper bits sort into buckets first, each of
/// which the cache holds.
fn odd(triangles: &[[[f64; 3]; 3]]) -> Vec<Edge> {
    // −0 and 0 are one number.
    let key = |[x, y, z]: [f64; 3]| [(x + 0.0).to_bits(), (y + 0.0).to_bits(), (z + 0.0).to_bits()];
    let edge = |number: usize| -> Edge {
        let (row, corner) = (number / 3, number % 3);
        let mut ends = [corner, (corner + 1) % 3].map(|corner| key(triangles[row][corner]));
        ends.sort_unstable();
        (ends, row as u64)
    };
    // The lower bits of a hash make room for the number of the edge.
    let numbers = (3 * triangles.len()).next_power_of_two() as u64 - 1;
    let mut hashes: Vec<u64> = Vec::with_capacity(3 * triangles.len());
    for (row, triangle) in triangles.iter().enumerate() {
        let [a, b, c] = *triangle;
        let of_corner = [hash(key(a)), hash(key(b)), hash(key(c))];
        for corner in 0..3 {
            let of_ends = of_corner[corner].wrapping_add(of_corner[(corner + 1) % 3]);
            hashes.push((of_ends & !numbers) | (3 * row + corner) as u64);
        }
    }
    let hashes = sorted(&hashes);
    let mut odd: Vec<Edge> = vec![];
    for same_hash in hashes.chunk_by(|one, other| (one ^ other) <= numbers) {
        let edge = |hash: u64| edge((hash & numbers) as usize);
        if let [one, other] = *same_hash
            && edge(one).0 == edge(other).0
        {
            continue;
        }
        let mut edges: Vec<Edge> = same_hash.iter().map(|&hash| edge(hash)).collect();
        edges.retain(|(ends, _)| ends[0] != ends[1]);
        edges.order();
        let same = edges.chunk_by(|one, other| one.0 == other.0);
        odd.extend(same.filter(|same| same.len() % 2 == 1).map(|same| same[0]));
    }
    odd.order();
    odd
}

/// Hashes in order: by buckets of the upper bits, and in each bucket by all bits.
fn sorted(hashes: &[u64]) -> Vec<u64> {
    let bits = (hashes.len() / BUCKET_HASHES).checked_ilog2().unwrap_or(0).max(1);
    let bucket = |hash: u64| (hash >> (64 - bits)) as usize;
    let mut ends = vec![0; 1 << bits];
    for &hash in hashes {
        ends[bucket(hash)] += 1;
    }
    let mut before = 0;
    for end in &mut ends {
        before += std::mem::replace(end, before);
    }
    let mut sorted = vec![0; hashes.len()];
    for &hash in hashes {
        let end = &mut ends[bucket(hash)];
        sorted[*end] = hash;
        *end += 1;
    }
    let mut first = 0;
    for end in ends {
        sorted[first..end].sort_unstable();
        first = end;
    }
    sorted
}

/// A hash of a corner: three rounds of a multiplication by an odd number and a shift, so that the upper half of a product gets
/// into the lower one.
fn hash(place: Place) -> u64 {
    place.iter().fold(0, |hash: u64, &bits| {
        let product = (hash ^ bits).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        product ^ (product >> 29)
    })
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

    /// The sum of hashes of an edge is that of its ends in any order, so edges between other ends may share it.
    #[test]
    fn edges_of_one_hash_are_told_apart() {
        let mut corners: Vec<[f64; 3]> = (0..200).map(|k| [f64::from(k), 0.5, -3.0]).collect();
        corners.extend((0..200).map(|k| [0.0, f64::from(k % 20), -0.0]));
        let triangle = |k: usize| [0, 7, 23].map(|step| corners[(k * k + step * k) % 400]);
        let all: Vec<[[f64; 3]; 3]> = (0..900).map(triangle).collect();
        let key = |corner: [f64; 3]| corner.map(|x| (x + 0.0).to_bits());
        let mut counts: BTreeMap<[Place; 2], u32> = BTreeMap::new();
        for t in &all {
            for (a, b) in [(0, 1), (1, 2), (2, 0)] {
                let mut ends = [key(t[a]), key(t[b])];
                ends.sort_unstable();
                *counts.entry(ends).or_default() += u32::from(ends[0] != ends[1]);
            }
        }
        let expected: Vec<[Place; 2]> =
            counts.into_iter().filter(|(_, count)| count % 2 == 1).map(|(ends, _)| ends).collect();
        let found: Vec<[Place; 2]> = odd(&all).into_iter().map(|(ends, _)| ends).collect();
        assert!(found.len() > 100 && found == expected, "{} edges", found.len());
    }

    #[test]
    fn buckets_sort_as_a_sort_does() {
        for count in [0, 1, 2, 31, 64, 65, 1_000, 40_000] {
            for spread in [u64::MAX, 0xffff, 0] {
                let place = |k: u64| [k, k % 7, k.wrapping_mul(k)];
                let hashes: Vec<u64> = (0..count).map(|k| hash(place(k)) & spread).collect();
                let mut expected = hashes.clone();
                expected.sort_unstable();
                assert!(sorted(&hashes) == expected, "{count} hashes");
            }
        }
    }

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
