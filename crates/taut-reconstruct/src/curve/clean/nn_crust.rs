//! NN-Crust: nearest neighbors, and nearest ones on the other side.
//!
//! *Problem.* The edges between samples that are neighbors on smooth closed curves.
//! *Idea.* A sample's nearest neighbor is its neighbor on the curve. Where that gives it one edge only, pq, the other one leads
//! to the nearest r with an angle qpr of more than 90°.
//! *Guarantee.* Exactly the edges of the curves, for samples with ε < 1/3 (every point of a curve has a sample within ε times its
//! distance from the medial axis). O(n log n), and no triangulation.
//! *Trap.* Degrees are those after *all* nearest edges, also the ones that others drew; ties go by coordinates, as on a grid all
//! four neighbors are nearest.
//! *Reference.* Dey and Kumar, SODA 1999.

use taut_points::Monitor;
use taut_predicates::plane::in_diametral_circle;

use super::near::{NONE, Near};
use crate::Error;
use crate::curve::boxes::Bounds;

pub(super) fn edges(near: &Near<'_>, monitor: &Monitor<'_>) -> Result<Vec<[u32; 2]>, Error> {
    let sites = near.sites;
    let first = near.nearest(|_| true, |_| |_, d2| d2, |_| |_: &Bounds| true);
    monitor.check()?;
    // Whether somebody else drew an edge to it.
    let mut drawn = vec![false; sites.len()];
    for (p, &q) in (0u32..).zip(&first) {
        if q != NONE && first[q as usize] != p {
            drawn[q as usize] = true;
        }
    }
    // From p to its neighbor.
    let ray = |p: u32| {
        let [p, q] = [p, first[p as usize]].map(|site| sites[site as usize]);
        (p, q, [q[0] - p[0], q[1] - p[1]])
    };
    let behind = |p: u32| {
        let (p, q, u) = ray(p);
        move |r: [f64; 2], d2: f64| {
            // Four roundings of half an ulp each; what they leave open is decided exactly.
            let (along, across) = (u[0] * (r[0] - p[0]), u[1] * (r[1] - p[1]));
            if (along + across).abs() > 1e-15 * (along.abs() + across.abs()) {
                return if along + across < 0.0 { d2 } else { f64::INFINITY };
            }
            if in_diametral_circle(q, r, p).is_positive() { d2 } else { f64::INFINITY }
        }
    };
    // The corner of a box that is farthest behind p.
    let reaches_behind = |p: u32| {
        let (p, _, u) = ray(p);
        move |&Bounds([x, y, right, top]): &Bounds| {
            let along = u[0] * (if u[0] > 0.0 { x } else { right } - p[0]);
            let across = u[1] * (if u[1] > 0.0 { y } else { top } - p[1]);
            along + across <= 1e-15 * (along.abs() + across.abs())
        }
    };
    let half =
        near.nearest(|p| first[p as usize] != NONE && !drawn[p as usize], behind, reaches_behind);
    monitor.check()?;
    // Each edge once: of two sites that name each other the smaller one gives it.
    let mut edges = Vec::with_capacity(sites.len() + sites.len() / 64);
    for p in 0..sites.len() as u32 {
        for names in [&first, &half] {
            let q = names[p as usize];
            if q != NONE && (p < q || names[q as usize] != p) {
                edges.push([p, q]);
            }
        }
    }
    Ok(edges)
}
