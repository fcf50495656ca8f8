//! The border of a convex body as a triangle mesh, for programs that read meshes.

use std::collections::BTreeMap;

use crate::{ConvexBody, InscribedBodies};

impl InscribedBodies {
    /// The border of a body in the coordinates of the mesh: its vertices, and its facets as triangles on them, each
    /// counter-clockwise from outside. Vertices are the exact ones, rounded to the nearest numbers, so that a facet of more than
    /// three corners is flat up to rounding. Each edge belongs to two triangles, in either direction. Both lists are empty for what
    /// is no body.
    ///
    /// ```
    /// use taut_certify::{ConvexBody, InscribedBodies};
    /// let normals = vec![[-1, 0, 0], [0, -1, 0], [0, 0, -1], [1, 1, 1]];
    /// let body = ConvexBody { normals, offsets: vec![0, 0, 0, 6], volume: 36.0 };
    /// let answer = InscribedBodies { exponent: 0, origin: [0; 3], disjoint: false, caps: vec![], at: vec![], ends: vec![], bodies: vec![body] };
    /// let (vertices, triangles) = answer.mesh(&answer.bodies[0]);
    /// assert_eq!((vertices.len(), triangles.len()), (4, 4));
    /// ```
    pub fn mesh(&self, body: &ConvexBody) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let mut ids: BTreeMap<[u64; 3], u32> = BTreeMap::new();
        let (mut vertices, mut triangles) = (vec![], vec![]);
        for polygon in self.polygons(body) {
            let mut corners: Vec<u32> = polygon
                .into_iter()
                .map(|at| {
                    // −0 and 0 are one number.
                    *ids.entry(at.map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
                        vertices.push(at);
                        vertices.len() as u32 - 1
                    })
                })
                .collect();
            // Vertices that rounding made equal are one, and an edge between them is none.
            corners.dedup();
            if corners.len() > 1 && corners.first() == corners.last() {
                corners.pop();
            }
            let fan = |k: usize| [corners[0], corners[k - 1], corners[k]];
            triangles.extend((2..corners.len()).map(fan));
        }
        (vertices, triangles)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six times the volume that a closed mesh bounds, positive where triangles are counter-clockwise from outside.
    fn sixfold_volume(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> f64 {
        let of = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|id| vertices[id as usize]);
            a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                + a[2] * (b[0] * c[1] - b[1] * c[0])
        };
        triangles.iter().map(of).sum()
    }

    fn assert_closed(triangles: &[[u32; 3]]) {
        let mut edges: BTreeMap<[u32; 2], i32> = BTreeMap::new();
        for &[a, b, c] in triangles {
            for [from, to] in [[a, b], [b, c], [c, a]] {
                assert_ne!(from, to);
                *edges.entry([from.min(to), from.max(to)]).or_default() +=
                    if from < to { 1 } else { -1 };
            }
        }
        assert!(edges.values().all(|&turns| turns == 0), "{edges:?}");
    }

    #[test]
    fn a_box_with_a_corner_cut_off_is_closed_and_faces_outward() {
        let mut normals = vec![[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
        let mut offsets = vec![3, 0, 4, 0, 5, 0];
        // The last one touches a corner and is no facet.
        normals.extend([[1, 1, 1], [-1, -1, 0]]);
        offsets.extend([11, 0]);
        let volume = 60.0 - 1.0 / 6.0;
        let body = ConvexBody { normals, offsets, volume };
        let answer = InscribedBodies {
            exponent: -1,
            origin: [7, 0, -9],
            disjoint: false,
            caps: vec![],
            at: vec![],
            ends: vec![],
            bodies: vec![body],
        };
        let (vertices, triangles) = answer.mesh(&answer.bodies[0]);
        // Ten vertices of a simple polytope of seven facets: 2·10 − 4 triangles.
        assert_eq!((vertices.len(), triangles.len()), (10, 16));
        assert_closed(&triangles);
        let found = sixfold_volume(&vertices, &triangles) / 6.0;
        assert!((found - volume / 8.0).abs() < 1e-12, "{found}");
    }

    #[test]
    fn vertices_that_rounding_makes_equal_are_one() {
        // Far from the origin a unit of 2^-1 is lost: an edge of one unit may vanish, and the mesh stays closed.
        let normals = vec![[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
        let body = ConvexBody { normals, offsets: vec![1, 0, 1 << 20, 0, 1 << 20, 0], volume: 0.0 };
        let origin = [1 << 60, 0, 0];
        let answer = InscribedBodies {
            exponent: -1,
            origin,
            disjoint: false,
            caps: vec![],
            at: vec![],
            ends: vec![],
            bodies: vec![body],
        };
        let (vertices, triangles) = answer.mesh(&answer.bodies[0]);
        assert_eq!((vertices.len(), triangles.len()), (4, 4));
        assert_closed(&triangles);
    }

    #[test]
    fn what_is_no_body_has_no_mesh() {
        let body = ConvexBody { normals: vec![[2, 0, 0]], offsets: vec![], volume: 0.0 };
        let answer = InscribedBodies {
            exponent: 0,
            origin: [0; 3],
            disjoint: false,
            caps: vec![],
            at: vec![],
            ends: vec![],
            bodies: vec![body],
        };
        assert_eq!(answer.mesh(&answer.bodies[0]), (vec![], vec![]));
    }
}
