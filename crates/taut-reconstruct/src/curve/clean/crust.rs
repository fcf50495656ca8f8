//! The crust: edges that stay Delaunay when the Voronoi vertices are added.
//!
//! *Problem.* The edges between neighbours on smooth closed curves, of any number.
//! *Idea.* Voronoi vertices of the samples are near the medial axis. An edge between samples that are not neighbours has only circles
//! that cross the medial axis, and in the triangulation of samples and Voronoi vertices together it is gone.
//! *Guarantee.* Exactly the edges of the curves for samples with ε < 0.252.
//! *Trap.* Triples nearly on a line have their centre almost anywhere; those beyond 2²⁰ times the extent of the set are left
//! out, as they would take all exactness of the filters with them and no circle through two samples is as large that matters.
//! *Reference.* Amenta, Bern and Eppstein, Graphical Models and Image Processing 60(2), 1998.

use taut_points::Monitor;

use super::graph::{self, triangulate, voronoi_vertices};
use crate::Error;
use crate::curve::boxes::Bounds;

pub(super) fn edges(sites: &[[f64; 2]], monitor: &Monitor<'_>) -> Result<Vec<[u32; 2]>, Error> {
    let plane = triangulate(sites, monitor)?;
    let Bounds([x, y, right, top]) =
        sites.iter().fold(Bounds::EMPTY, |sum, &site| sum.join(Bounds::of(site)));
    let reach = (1u32 << 20) as f64 * (right - x).max(top - y);
    let mut both = sites.to_vec();
    both.extend(voronoi_vertices(&plane, sites, reach));
    drop(plane);
    // Of equal points the first stands for all: a site, if there is one.
    let refined = triangulate(&both, monitor)?;
    let samples = sites.len() as u32;
    let edges = graph::edges(&refined);
    Ok(edges
        .iter()
        .map(|edge| edge.ends)
        .filter(|ends| ends.iter().all(|&v| v < samples))
        .collect())
}
