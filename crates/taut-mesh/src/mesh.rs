//! Triangle meshes of space, checked once on construction.

use crate::Error;

/// Most triangles of a mesh: with this many, the number of a corner still fits into 32 bits.
const TRIANGLES_MAX: usize = (u32::MAX / 3) as usize;

/// Triangles of space on common vertices, borrowed.
///
/// Vertices are known by their numbers: two vertices with the same coordinates are two vertices. A soup, in which each
/// triangle brings vertices of its own, has to be merged before it is a mesh worth asking about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleMesh<'a> {
    vertices: &'a [[f64; 3]],
    triangles: &'a [[u32; 3]],
}

impl<'a> TriangleMesh<'a> {
    /// A mesh of `triangles`, each three numbers of `vertices`, counted from 0.
    ///
    /// Vertices that no triangle uses, triangles without area, triangles that name a vertex twice and triangles given twice
    /// are all allowed: what is wrong with them is said by those who ask. O(n).
    ///
    /// ```
    /// use taut_mesh::{Error, TriangleMesh};
    /// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// assert!(TriangleMesh::new(&vertices, &[[0, 1, 2]]).is_ok());
    /// let beyond = Error::Index { triangle: 0, corner: 2, index: 3, vertices: 3 };
    /// assert_eq!(TriangleMesh::new(&vertices, &[[0, 1, 3]]), Err(beyond));
    /// ```
    ///
    /// # Errors
    /// [`Error::NonFinite`] for the first coordinate that is no finite number, [`Error::Index`] for the first corner without
    /// a vertex, [`Error::TooMany`] for more than 2³²/3 triangles.
    pub fn new(vertices: &'a [[f64; 3]], triangles: &'a [[u32; 3]]) -> Result<Self, Error> {
        if triangles.len() > TRIANGLES_MAX {
            return Err(Error::TooMany { triangles: triangles.len(), most: TRIANGLES_MAX });
        }
        let flat = vertices.as_flattened();
        if let Some(place) = flat.iter().position(|value| !value.is_finite()) {
            let (vertex, column) = (place / 3, place % 3);
            return Err(Error::NonFinite { vertex, column, value: flat[place] });
        }
        let flat = triangles.as_flattened();
        if let Some(place) = flat.iter().position(|&index| index as usize >= vertices.len()) {
            let (triangle, corner, vertices) = (place / 3, place % 3, vertices.len());
            return Err(Error::Index { triangle, corner, index: flat[place], vertices });
        }
        Ok(Self { vertices, triangles })
    }

    /// All vertices, used or not.
    pub fn vertices(&self) -> &'a [[f64; 3]] {
        self.vertices
    }

    /// All triangles, as numbers of vertices.
    pub fn triangles(&self) -> &'a [[u32; 3]] {
        self.triangles
    }

    pub(crate) fn corners(&self, triangle: u32) -> [[f64; 3]; 3] {
        self.triangles[triangle as usize].map(|index| self.vertices[index as usize])
    }
}

/// Tests whether a triangle names a vertex twice.
pub(crate) fn repeats([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_place() {
        let vertices = [[0.0; 3], [1.0, 2.0, f64::NEG_INFINITY]];
        let error = TriangleMesh::new(&vertices, &[]).unwrap_err();
        assert_eq!(error, Error::NonFinite { vertex: 1, column: 2, value: f64::NEG_INFINITY });
        assert_eq!(
            error.to_string(),
            "coordinate 2 of vertex 1, both counted from 0, is -inf: all must be finite"
        );
        assert!(TriangleMesh::new(&[[f64::NAN, 0.0, 0.0]], &[]).is_err());
        let error = TriangleMesh::new(&[[0.0; 3]; 4], &[[0, 1, 2], [3, u32::MAX, 9]]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "corner 1 of triangle 1, both counted from 0, is vertex 4294967295, but there are 4 vertices"
        );
        assert!(TriangleMesh::new(&[], &[[0, 0, 0]]).is_err());
        assert!(TriangleMesh::new(&[], &[]).is_ok());
    }
}
