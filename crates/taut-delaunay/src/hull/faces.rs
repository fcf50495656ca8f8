//! From triangles to faces: without needless vertices, in canonical order.
//!
//! Idea: triangles of one plane form a face, whose border is one loop; the vertices that lie on a line with their neighbors in the
//! loop go, and the rest is cut into a fan from the lowest row.
//! Guarantee: exact, and a function of the points and their rows.

use std::collections::HashMap;

use taut_predicates::Sign;
use taut_predicates::space::orient;

use super::ConvexHull;
use super::quickhull::{Facet, QuickHull};
use crate::affine::collinear;
use crate::groups::{join, root};

/// The polyhedron that quickhull ended with.
pub(super) fn finish(quick: &QuickHull) -> ConvexHull {
    let slots: Vec<(u32, &Facet)> = quick.facets().collect();
    let places: HashMap<u32, u32> = (0u32..).zip(&slots).map(|(i, (slot, _))| (*slot, i)).collect();
    let at = |v: u32| quick.sites[v as usize];
    let mut groups: Vec<u32> = (0..slots.len() as u32).collect();
    let mut is_simplicial = true;
    for (number, (_, facet)) in (0u32..).zip(&slots) {
        let [a, b, c] = facet.vertices.map(at);
        for i in 0..3 {
            let other = places[&facet.neighbors[i]];
            if other <= number {
                continue;
            }
            let edge = [facet.vertices[(i + 1) % 3], facet.vertices[(i + 2) % 3]];
            let beyond = slots[other as usize].1.vertices.into_iter().find(|v| !edge.contains(v));
            if beyond.is_some_and(|v| orient(a, b, c, at(v)) == Sign::Zero) {
                is_simplicial = false;
                join(&mut groups, number, other);
            }
        }
    }
    let row = |v: u32| quick.rows[v as usize];
    // Each facet as rows, the lowest first, with the lowest facet of its face.
    let mut facets: Vec<([u32; 3], u32)> = if is_simplicial {
        (0u32..).zip(&slots).map(|(i, (_, facet))| (facet.vertices.map(row), i)).collect()
    } else {
        let members = members(&mut groups);
        let mut facets = Vec::new();
        for face in members {
            let corners = border(quick, &face, &slots);
            let rows: Vec<u32> = corners.into_iter().map(row).collect();
            let first = (0..rows.len()).min_by_key(|&i| rows[i]).unwrap_or(0);
            for k in 1..rows.len().saturating_sub(1) {
                let of = |k: usize| rows[(first + k) % rows.len()];
                facets.push(([of(0), of(k), of(k + 1)], face[0]));
            }
        }
        facets
    };
    for (vertices, _) in &mut facets {
        let first = (0..3).min_by_key(|&i| vertices[i]).unwrap_or(0);
        vertices.rotate_left(first);
    }
    facets.sort_unstable();
    let mut numbers: HashMap<u32, u32> = HashMap::new();
    let faces = facets
        .iter()
        .map(|&(_, group)| {
            let next = numbers.len() as u32;
            *numbers.entry(group).or_insert(next)
        })
        .collect();
    let facets: Vec<[u32; 3]> = facets.into_iter().map(|(vertices, _)| vertices).collect();
    let mut vertices = facets.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    ConvexHull {
        dimension: 3,
        hull_dimension: Some(3),
        vertices,
        neighbors: neighbors(&facets),
        facets: facets.into_flattened(),
        faces,
    }
}

/// The facets of each face, ascending.
fn members(groups: &mut [u32]) -> Vec<Vec<u32>> {
    let mut faces: Vec<Vec<u32>> = vec![Vec::new(); groups.len()];
    for number in 0..groups.len() as u32 {
        let group = root(groups, number);
        faces[group as usize].push(number);
    }
    faces.retain(|face| !face.is_empty());
    faces
}

/// The corners of a face, counter-clockwise from outside.
fn border(quick: &QuickHull, face: &[u32], slots: &[(u32, &Facet)]) -> Vec<u32> {
    let edges = face.iter().flat_map(|&number| {
        let [a, b, c] = slots[number as usize].1.vertices;
        [(a, b), (b, c), (c, a)]
    });
    let mut next: HashMap<u32, Vec<u32>> = HashMap::new();
    for (from, to) in edges {
        // An edge between two facets of the face runs both ways, and is no part of the border.
        let back = next.get_mut(&to).and_then(|ends| {
            let place = ends.iter().position(|&end| end == from)?;
            Some(ends.swap_remove(place))
        });
        if back.is_none() {
            next.entry(from).or_default().push(to);
        }
    }
    next.retain(|_, ends| !ends.is_empty());
    let Some(&first) = next.keys().min() else { return Vec::new() };
    let (mut loop_of, mut here) = (vec![first], first);
    while let Some(&to) = next.get(&here).and_then(|ends| ends.first()) {
        if to == first {
            break;
        }
        loop_of.push(to);
        here = to;
    }
    let at = |i: usize| quick.sites[loop_of[i % loop_of.len()] as usize];
    let n = loop_of.len();
    (0..n).filter(|&i| !collinear(at(i + n - 1), at(i), at(i + 1))).map(|i| loop_of[i]).collect()
}

/// For each vertex of a facet the facet across the edge opposite it.
fn neighbors(facets: &[[u32; 3]]) -> Vec<u32> {
    let mut edges: Vec<(u32, u32, u32)> = (0u32..)
        .zip(facets.as_flattened())
        .map(|(place, _)| {
            let (facet, i) = (place as usize / 3, place as usize % 3);
            let (a, b) = (facets[facet][(i + 1) % 3], facets[facet][(i + 2) % 3]);
            (a.min(b), a.max(b), place)
        })
        .collect();
    edges.sort_unstable();
    let mut neighbors = vec![0; edges.len()];
    for pair in edges.chunks_exact(2) {
        neighbors[pair[0].2 as usize] = pair[1].2 / 3;
        neighbors[pair[1].2 as usize] = pair[0].2 / 3;
    }
    neighbors
}
