//! The crust: edges that stay Delaunay when the Voronoi vertices are added.
//!
//! *Problem.* The edges between neighbors on smooth closed curves, of any number.
//! *Idea.* Voronoi vertices of the samples are near the medial axis. An edge between samples that are not neighbors has only circles
//! that cross the medial axis, and in the triangulation of samples and Voronoi vertices together it is gone. That triangulation is
//! not built: the circles through both ends of an edge have their centers on a line, each point beside the edge shuts out those
//! beyond one place on it, and what the points on the left and on the right leave is looked for with a tree over the Voronoi vertices.
//! *Guarantee.* Exactly the edges of the curves for samples with ε < 0.252. One triangulation, and a look or two per edge of the
//! one-step crust.
//! *Trap.* Triples nearly on a line have their center almost anywhere; those beyond 2²⁰ times the extent of the set are left
//! out, as no circle through two samples is as large that matters. Centers of circles are rounded, so they only say where to look: which of
//! two points shuts out more, and whether anything is left, is decided exactly.
//! *Reference.* Amenta, Bern and Eppstein, Graphical Models and Image Processing 60(2), 1998.

use taut_delaunay::Plane;
use taut_oblivious::hilbert_order;
use taut_points::Monitor;
use taut_points::parallel::ParallelSlice;
use taut_predicates::Sign;
use taut_predicates::plane::{in_circle, orient};

use super::graph::{self, Edge, triangulate, voronoi_vertices};
use super::near::{Near, distance2};
use super::one_step_crust::is_crust as is_one_step_crust;
use crate::Error;
use crate::curve::boxes::Bounds;

pub(super) fn edges(sites: &[[f64; 2]], monitor: &Monitor<'_>) -> Result<Vec<[u32; 2]>, Error> {
    let plane = triangulate(sites, monitor)?;
    let vertices = axis(&plane, sites);
    // Two of the Voronoi vertices are at hand without a search, and rule out all edges but a few more than there are sites.
    let mut edges = Vec::with_capacity(sites.len() + sites.len() / 2);
    graph::visit_edges(&plane, |edge| {
        if is_one_step_crust(sites, &edge) {
            edges.push(edge);
        }
    });
    drop(plane);
    monitor.check()?;
    let order = hilbert_order(vertices.len(), |i| vertices[i]);
    let vertices: Vec<[f64; 2]> = order.into_iter().map(|i| vertices[i as usize]).collect();
    let axis = Near::new(&vertices);
    let stays = |edge: &Edge| has_empty_circle(sites, edge, &axis).then_some(edge.ends);
    Ok(edges.par_iter().with_min_len(1 << 10).filter_map(stays).collect())
}

/// The Voronoi vertices that matter.
fn axis(plane: &Plane, sites: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let Bounds([x, y, right, top]) =
        sites.iter().fold(Bounds::EMPTY, |sum, &site| sum.join(Bounds::of(site)));
    voronoi_vertices(plane, sites, (1u32 << 20) as f64 * (right - x).max(top - y))
}

/// Whether some circle through both ends of a Delaunay edge holds neither a site nor a Voronoi vertex.
fn has_empty_circle(sites: &[[f64; 2]], edge: &Edge, axis: &Near<'_>) -> bool {
    let mut circles = Circles::of(sites, edge);
    loop {
        let (center, radius2) = circles.middle();
        let Some(inside) = axis.nearest_within(center, radius2) else { return true };
        match circles.shut_out(axis.sites[inside as usize]) {
            Some(true) => (),
            Some(false) => return false,
            // It lies on the circle, but for roundings.
            None => return true,
        }
    }
}

/// The circles through two points that hold none of the points known so far.
struct Circles {
    p: [f64; 2],
    q: [f64; 2],
    /// Of the points on the left of pq and on the right of it, the one that shuts out most.
    nearest: [Option<[f64; 2]>; 2],
}

impl Circles {
    /// Those that hold no site.
    fn of(sites: &[[f64; 2]], edge: &Edge) -> Self {
        let [p, q] = edge.ends.map(|v| sites[v as usize]);
        let [mut left, mut right] = [None; 2];
        for apex in edge.apexes.into_iter().flatten().map(|v| sites[v as usize]) {
            *if orient(p, q, apex).is_positive() { &mut left } else { &mut right } = Some(apex);
        }
        Self { p, q, nearest: [left, right] }
    }

    /// The height over pq, in lengths of it and positive on the left, of the center of the circle through p, q and r.
    fn height(&self, [x, y]: [f64; 2]) -> f64 {
        let ([px, py], [qx, qy]) = (self.p, self.q);
        let cross = (qx - px) * (y - py) - (qy - py) * (x - px);
        0.5 * ((x - px) * (x - qx) + (y - py) * (y - qy)) / cross
    }

    /// The center and the squared radius of one of them: the smallest, or one well within the rest.
    fn middle(&self) -> ([f64; 2], f64) {
        let [high, low] = self.nearest.map(|r| r.map(|r| self.height(r)));
        let (low, high) = (low.unwrap_or(f64::NEG_INFINITY), high.unwrap_or(f64::INFINITY));
        let height = match (low > 0.0, high < 0.0) {
            (true, _) => (0.5 * (low + high)).min(2.0 * low),
            (_, true) => (0.5 * (low + high)).max(2.0 * high),
            _ => 0.0,
        };
        let ([px, py], [qx, qy]) = (self.p, self.q);
        let center = [0.5 * (px + qx) - height * (qy - py), 0.5 * (py + qy) + height * (qx - px)];
        (center, distance2(center, self.p))
    }

    /// Leaves only circles that do not hold r, which is in one of them: whether there are any. None if r shuts out no more than the
    /// points before it.
    fn shut_out(&mut self, r: [f64; 2]) -> Option<bool> {
        let side = match orient(self.p, self.q, r) {
            Sign::Positive => 0,
            Sign::Negative => 1,
            Sign::Zero => return self.is_between(r).then_some(false),
        };
        let (p, q) = if side == 0 { (self.p, self.q) } else { (self.q, self.p) };
        if self.nearest[side].is_some_and(|before| !in_circle(p, q, before, r).is_positive()) {
            return None;
        }
        self.nearest[side] = Some(r);
        let other = self.nearest[1 - side];
        Some(other.is_none_or(|other| !in_circle(p, q, r, other).is_positive()))
    }

    /// Whether a point on the line through p and q lies between them.
    fn is_between(&self, [x, y]: [f64; 2]) -> bool {
        let ([px, py], [qx, qy]) = (self.p, self.q);
        let strictly = |a: f64, x: f64, b: f64| a < x && x < b || b < x && x < a;
        if px == qx { strictly(py, y, qy) } else { strictly(px, x, qx) }
    }
}
