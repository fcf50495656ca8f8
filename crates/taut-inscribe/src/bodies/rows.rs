//! The rows of which a search for bodies reads its mesh, and what bodies may not contain.

use std::collections::HashSet;

use crate::Error;

/// The rows of a mesh, as [`inscribed_bodies`](crate::inscribed_bodies) reads them: for each triangle the coordinates of its corners.
///
/// ```
/// let vertices = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let rows = taut_inscribe::triangle_rows(&vertices, &[[0, 2, 1]])?;
/// assert_eq!(rows, [0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0]);
/// # Ok::<(), taut_inscribe::Error>(())
/// ```
///
/// # Errors
/// [`Error::NoVertex`] for a triangle that names a vertex that does not exist.
pub fn triangle_rows(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Vec<f64>, Error> {
    let mut rows = Vec::with_capacity(9 * triangles.len());
    for (row, triangle) in triangles.iter().enumerate() {
        for &vertex in triangle {
            let Some(place) = vertices.get(vertex as usize) else {
                let vertices = vertices.len();
                return Err(Error::NoVertex { row: row as u64, vertex, vertices });
            };
            rows.extend(place);
        }
    }
    Ok(rows)
}

/// The rows of points that no body may contain, to come after those of a mesh: triangles with three equal corners. Equal points come once.
///
/// ```
/// let rows = taut_inscribe::point_rows(&[[1.0, 2.0, 3.0]; 2]);
/// assert_eq!(rows, [1.0, 2.0, 3.0, 1.0, 2.0, 3.0, 1.0, 2.0, 3.0]);
/// ```
pub fn point_rows(points: &[[f64; 3]]) -> Vec<f64> {
    let mut seen = HashSet::with_capacity(points.len());
    // −0 and 0 are one number.
    let is_new = |point: &&[f64; 3]| seen.insert(point.map(|x| (x + 0.0).to_bits()));
    points.iter().filter(is_new).flat_map(|&point| [point; 3]).flatten().collect()
}

/// The rows of the bounding box of points, as a mesh of 12 triangles, turned outward: a mesh in which bodies among the points are found.
/// Of no points there are none.
pub fn box_rows(points: &[[f64; 3]]) -> Vec<f64> {
    if points.is_empty() {
        return vec![];
    }
    let end = |pick: fn(f64, f64) -> f64| {
        [0, 1, 2].map(|c| points.iter().map(|p| p[c]).fold(points[0][c], pick))
    };
    let (low, high) = (end(f64::min), end(f64::max));
    let corner = |k: usize| [0, 1, 2].map(|c| if k >> c & 1 == 0 { low[c] } else { high[c] });
    FACES.into_iter().flat_map(|[a, b, c, d]| [a, b, c, a, c, d]).flat_map(corner).collect()
}

/// The faces of a box. Corner k is at the upper end of axis c if bit c of k is set.
const FACES: [[usize; 4]; 6] =
    [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
