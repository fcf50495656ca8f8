//! The Voronoi diagram of a triangulation of the plane, as it is drawn: rounded, and cut at the frame.
//!
//! Each edge joins the circumcenters of two triangles with a common edge; that of an edge of the hull runs outward for
//! ever.

use taut_certify::NO_NEIGHBOR;

use super::Picture;
use super::clip::Frame;
use crate::axes::unit;

impl Picture<'_> {
    /// The edges of the diagram in `frame`; `None` where the certificate names no neighbors, or wrong ones.
    pub(super) fn voronoi(&self, frame: &Frame) -> Option<Vec<Vec<[f64; 2]>>> {
        let (answer, neighbors) = (self.answer(), &self.solution.certificate.neighbors);
        if answer.vertices_per_simplex() != 3 || neighbors.len() != answer.simplices.len() {
            return None;
        }
        // In multiples of a unit, so that products neither overflow nor vanish.
        let unit = unit(self.places.iter().flatten().copied());
        let at = |id: u32| {
            let [x, y, _] = self.places[id as usize];
            [x / unit, y / unit]
        };
        let frame = Frame { low: frame.low.map(|x| x / unit), high: frame.high.map(|x| x / unit) };
        let center = |triangle: &[u32]| circumcenter([0, 1, 2].map(|i| at(triangle[i])));
        let centers: Vec<[f64; 2]> = answer.rows().map(center).collect();
        let mut edges = Vec::new();
        for (number, (triangle, across)) in answer.rows().zip(neighbors.chunks_exact(3)).enumerate()
        {
            for i in 0..3 {
                let part = if across[i] == NO_NEIGHBOR {
                    // The triangle is to the left of the edge that is opposite vertex i.
                    let [a, b] = [at(triangle[(i + 1) % 3]), at(triangle[(i + 2) % 3])];
                    frame.ray(centers[number], [b[1] - a[1], a[0] - b[0]])
                } else {
                    let other = *centers.get(across[i] as usize)?;
                    let once = (number as u32) < across[i];
                    once.then(|| frame.segment(centers[number], other)).flatten()
                };
                edges.extend(part.map(|ends| ends.map(|at| at.map(|x| x * unit)).to_vec()));
            }
        }
        Some(edges)
    }
}

/// The center of the circle through three points; not finite where they are on a line.
fn circumcenter([a, b, c]: [[f64; 2]; 3]) -> [f64; 2] {
    let ([bx, by], [cx, cy]) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
    let twice = 2.0 * (bx * cy - by * cx);
    let (bb, cc) = (bx * bx + by * by, cx * cx + cy * cy);
    [a[0] + (cy * bb - by * cc) / twice, a[1] + (bx * cc - cx * bb) / twice]
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_circumcenter_is_as_far_from_each_corner() {
        let corners = [[1.0, 2.0], [4.0, 2.5], [2.0, 7.0]];
        let at = super::circumcenter(corners);
        let far = corners.map(|p| (p[0] - at[0]).hypot(p[1] - at[1]));
        assert!((far[0] - far[1]).abs() < 1e-12 && (far[0] - far[2]).abs() < 1e-12, "{far:?}");
    }
}
