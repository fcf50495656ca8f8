//! NN-Crust: nearest neighbours, and nearest ones on the other side.
//!
//! *Problem.* The edges between samples that are neighbours on smooth closed curves.
//! *Idea.* A sample's nearest neighbour is its neighbour on the curve. Where that gives it one edge only, pq, the other one leads
//! to the nearest r with an angle qpr of more than 90°.
//! *Guarantee.* Exactly the edges of the curves, for samples with ε < 1/3 (every point of a curve has a sample within ε times its
//! distance from the medial axis). O(n log n), and no triangulation.
//! *Trap.* Degrees are those after *all* nearest edges, also the ones that others drew; ties go by coordinates, as on a grid all
//! four neighbours are nearest.
//! *Reference.* Dey and Kumar, SODA 1999.

use rayon::prelude::*;
use taut_points::Monitor;
use taut_predicates::plane::in_diametral_circle;

use super::near::Near;
use crate::Error;

/// Stands for no site.
const NONE: u32 = u32::MAX;

pub(super) fn edges(near: &Near<'_>, monitor: &Monitor<'_>) -> Result<Vec<[u32; 2]>, Error> {
    let sites = near.sites;
    let all = 0..sites.len() as u32;
    let first: Vec<u32> = all
        .clone()
        .into_par_iter()
        .with_min_len(1 << 12)
        .map(|p| near.nearest(p, |_| true).unwrap_or(NONE))
        .collect();
    monitor.check()?;
    // Whether somebody else drew an edge to it.
    let mut drawn = vec![false; sites.len()];
    for (p, &q) in (0u32..).zip(&first) {
        if q != NONE && first[q as usize] != p {
            drawn[q as usize] = true;
        }
    }
    let half: Vec<u32> = all
        .clone()
        .into_par_iter()
        .with_min_len(1 << 12)
        .map(|p| {
            let q = first[p as usize];
            if q == NONE || drawn[p as usize] {
                return NONE;
            }
            let (at, other) = (sites[p as usize], sites[q as usize]);
            let behind = |r: u32| in_diametral_circle(other, sites[r as usize], at).is_positive();
            near.nearest(p, behind).unwrap_or(NONE)
        })
        .collect();
    monitor.check()?;
    // Each edge once: of two sites that name each other the smaller one gives it.
    let mut edges = Vec::with_capacity(sites.len() + sites.len() / 64);
    for p in all {
        for names in [&first, &half] {
            let q = names[p as usize];
            if q != NONE && (p < q || names[q as usize] != p) {
                edges.push([p, q]);
            }
        }
    }
    Ok(edges)
}
