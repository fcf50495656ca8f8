//! The one-step crust: Delaunay edges with an empty circle that avoids the Voronoi vertices beside them.
//!
//! *Problem.* The crust without a second triangulation.
//! *Idea.* Of an edge of length 2a the circumcenters beside it lie a·cot A and −a·cot B along the bisector, A and B the angles
//! across. A circle through both ends that holds neither of them exists if and only if A + B ≤ 90°; Delaunay edges have
//! A + B ≤ 180°. Beyond an edge of the hull the angle counts as 0.
//! *Guarantee.* Holds the edges of smooth closed curves and no others for samples with ε < 0.42. One triangulation.
//! *Trap.* No angle is computed: A + B ≤ 90° is cos A cos B − sin A sin B ≥ 0, which dot and cross products tell up to a positive
//! factor.
//! *Reference.* Gold and Snoeyink, Algorithmica 30, 2001.

use taut_delaunay::Plane;

use super::graph::{Edge, visit_edges};

pub(super) fn edges(sites: &[[f64; 2]], plane: &Plane) -> Vec<[u32; 2]> {
    let mut edges = Vec::with_capacity(sites.len() + sites.len() / 2);
    visit_edges(plane, |edge| {
        if is_crust(sites, &edge) {
            edges.push(edge.ends);
        }
    });
    edges
}

/// Whether the angles across an edge are at most 90° together.
pub(super) fn is_crust(sites: &[[f64; 2]], edge: &Edge) -> bool {
    let [p, q] = edge.ends.map(|v| sites[v as usize]);
    // Cosine and sine of the angle across, up to a common positive factor.
    let [[cos_a, sin_a], [cos_b, sin_b]] = edge.apexes.map(|apex| {
        let Some(r) = apex.map(|v| sites[v as usize]) else { return [1.0, 0.0] };
        let (u, v) = ([p[0] - r[0], p[1] - r[1]], [q[0] - r[0], q[1] - r[1]]);
        [u[0] * v[0] + u[1] * v[1], (u[0] * v[1] - u[1] * v[0]).abs()]
    });
    cos_a * cos_b >= sin_a * sin_b
}
