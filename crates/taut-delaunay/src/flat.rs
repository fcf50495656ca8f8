//! Points of space on one plane: their triangulation is what an auxiliary point off the plane sees.
//!
//! Idea: a sphere through three points of the plane and the apex cuts the plane in the circle through the three, so a
//! tetrahedron at the apex is empty exactly if its base is, ties included: the cofactor of the apex in a tie is the
//! orientation of four coplanar points, which is zero.
//! Guarantee: the bases of the apex' star are the Delaunay triangles, its ghosts the edges of the planar hull.

use crate::simplex::{Simplex, code, decode};

/// The places of the vertices that stay when the vertex at `apex` goes, in an order that keeps the orientation.
const OTHER_VERTICES: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// The simplices at vertex `apex` without it, joined to each other as before.
pub(crate) fn star_of_apex(simplices: &[Simplex<4>], apex: u32) -> Vec<Simplex<3>> {
    let place = |s: &Simplex<4>| s.vertices.iter().position(|&v| v == apex);
    let mut numbers = vec![u32::MAX; simplices.len()];
    let mut count = 0;
    for (t, s) in simplices.iter().enumerate() {
        if s.is_live() && place(s).is_some() {
            numbers[t] = count;
            count += 1;
        }
    }
    let star = simplices
        .iter()
        .filter(|s| s.is_live())
        .filter_map(|s| Some((s, OTHER_VERTICES[place(s)?])));
    star.map(|(s, rest)| Simplex {
        vertices: rest.map(|i| s.vertices[i]),
        neighbors: rest.map(|i| {
            let (other, facet) = decode(s.neighbors[i]);
            let there = place(&simplices[other as usize]).expect("across a facet at the apex");
            let facet = OTHER_VERTICES[there]
                .iter()
                .position(|&k| k == facet)
                .expect("opposite a facet at the apex");
            code(numbers[other as usize], facet as u32)
        }),
    })
    .collect()
}
