//! The conservative crust: edges with good reason, for curves with ends.
//!
//! *Problem.* Edges between neighbors on smooth curves that may have ends, where a missing edge is better than a wrong one.
//! *Idea.* A Gabriel edge, one whose smallest circle holds no other sample, is kept if the circle ρ times as large around the
//! same center holds no Voronoi vertex: then the medial axis is far off beside the length of the edge.
//! *Guarantee.* For each set of edges that it returns there is a curve of which the samples are dense, and of which these are
//! the edges between neighbors; all edges of a curve are there if its samples have spacings below about the ρ-th part of the
//! distance from the medial axis.
//! *Trap.* A sample with no edge is left aside, not joined to the next best.
//! *Reference.* Dey, Mehlhorn and Ramos, Computational Geometry 15, 2000.

use taut_oblivious::hilbert_order;
use taut_points::Monitor;
use taut_points::parallel::ParallelSlice;
use taut_predicates::plane::in_diametral_circle;

use super::graph::{self, triangulate, voronoi_vertices};
use super::near::{Near, distance2};
use crate::Error;

/// How much larger than the smallest circle of an edge the circle without Voronoi vertices has to be. At 2 an edge between two
/// branches at distance d, which is at most d / 2 from the medial axis between them, never passes; samples with ε ≤ 1/5 do.
const RHO: f64 = 2.0;

pub(super) fn edges(sites: &[[f64; 2]], monitor: &Monitor<'_>) -> Result<Vec<[u32; 2]>, Error> {
    let plane = triangulate(sites, monitor)?;
    let at = |site: u32| sites[site as usize];
    let vertices = voronoi_vertices(&plane, sites, f64::MAX);
    let order = hilbert_order(vertices.len(), |i| vertices[i]);
    let vertices: Vec<[f64; 2]> = order.iter().map(|&i| vertices[i as usize]).collect();
    let axis = Near::new(&vertices);
    let graph = graph::edges(&plane);
    monitor.check()?;
    let kept = graph.par_iter().with_min_len(1 << 12).filter(|edge| {
        let [p, q] = edge.ends.map(at);
        let gabriel =
            edge.apexes.iter().flatten().all(|&r| !in_diametral_circle(p, q, at(r)).is_positive());
        let middle = [p[0] + (q[0] - p[0]) / 2.0, p[1] + (q[1] - p[1]) / 2.0];
        gabriel && !axis.any_within(middle, RHO * RHO / 4.0 * distance2(p, q))
    });
    Ok(kept.map(|edge| edge.ends).collect())
}
