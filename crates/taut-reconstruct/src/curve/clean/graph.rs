//! The edges of a Delaunay triangulation, each with what lies across from it.

use taut_delaunay::{Complex, DelaunayOptions, GHOST, Plane, decode};
use taut_points::{Monitor, Points};

use crate::Error;

/// An edge between two sites, and the third sites of the triangles beside it; none where it is an edge of the hull.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) ends: [u32; 2],
    pub(super) apexes: [Option<u32>; 2],
}

/// The triangulation of these points; its rows are their numbers.
pub(super) fn triangulate(sites: &[[f64; 2]], monitor: &Monitor<'_>) -> Result<Plane, Error> {
    let points = Points::new(sites.as_flattened(), 2).expect("pairs are whole rows");
    let options = DelaunayOptions { monitor: *monitor, ..DelaunayOptions::default() };
    // Circumcenters are rounded, so in which order their corners are named must not depend on threads.
    Ok(Plane::build(&points, &options)?.renumbered())
}

/// All edges, in an order that depends on how the triangulation was built. Sites on a line are joined along it.
pub(super) fn edges(plane: &Plane) -> Vec<Edge> {
    let mut edges = Vec::with_capacity(3 * plane.site_count());
    visit_edges(plane, |edge| edges.push(edge));
    edges
}

/// The same, one at a time.
pub(super) fn visit_edges(plane: &Plane, mut visit: impl FnMut(Edge)) {
    let row = |site: u32| plane.row(site);
    if let Complex::Line(sites) = plane.complex() {
        for pair in sites.windows(2) {
            visit(Edge { ends: [row(pair[0]), row(pair[1])], apexes: [None; 2] });
        }
        return;
    }
    let slots = plane.slots();
    for (number, triangle) in (0u32..).zip(slots.iter()).filter(|(_, t)| t.is_live()) {
        for i in 0..3 {
            let (neighbor, facet) = decode(triangle.neighbors[i]);
            let [a, b] = [triangle.vertices[(i + 1) % 3], triangle.vertices[(i + 2) % 3]];
            if number < neighbor && a != GHOST && b != GHOST {
                let apexes = [triangle.vertices[i], slots[neighbor as usize].vertices[facet]];
                let apexes = apexes.map(|v| (v != GHOST).then(|| row(v)));
                visit(Edge { ends: [row(a), row(b)], apexes });
            }
        }
    }
}

/// The circumcenters of all triangles, the Voronoi vertices, to rounding. Left out are those that are not finite or farther than
/// `reach` from the triangle.
pub(super) fn voronoi_vertices(plane: &Plane, sites: &[[f64; 2]], reach: f64) -> Vec<[f64; 2]> {
    let center = |triangle: u32| {
        let [a, b, c] = plane.vertices(triangle).map(|v| sites[plane.row(v) as usize]);
        let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
        let (u2, v2) = (u[0] * u[0] + u[1] * u[1], v[0] * v[0] + v[1] * v[1]);
        let twice = 2.0 * (u[0] * v[1] - u[1] * v[0]);
        let offset = [(v[1] * u2 - u[1] * v2) / twice, (u[0] * v2 - v[0] * u2) / twice];
        let near = offset[0].abs() <= reach && offset[1].abs() <= reach;
        near.then(|| [a[0] + offset[0], a[1] + offset[1]])
    };
    plane.simplices().filter_map(center).collect()
}
