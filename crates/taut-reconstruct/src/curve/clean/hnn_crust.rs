//! HNN-Crust: nearest neighbours and half neighbours, kept where both ends agree.
//!
//! *Problem.* The edges between neighbours on smooth curves, from fewer samples than NN-Crust needs.
//! *Idea.* Beside the nearest neighbour n₁ a sample p takes n₂, the first by distance that is nearer to p than to n₁ and farther
//! from n₁ than p is: the angle n₁ p n₂ is the largest of the three, more than 60°. An edge stays if each end names the other.
//! *Guarantee.* Exactly the edges of smooth closed curves for samples with ε < 0.47, or a reach-relative spacing below 0.9.
//! *Trap.* Looking among a fixed number of neighbours only loses edges where the density jumps; here the search has no cap.
//! *Reference.* Ohrhallinger, Mitchell and Wimmer, Computer Graphics Forum 35(5), 2016.

use rayon::prelude::*;
use taut_points::Monitor;

use super::near::{Near, distance2};
use crate::Error;

pub(super) fn edges(near: &Near<'_>, monitor: &Monitor<'_>) -> Result<Vec<[u32; 2]>, Error> {
    let at = |site: u32| near.sites[site as usize];
    let named: Vec<[Option<u32>; 2]> = (0..near.sites.len() as u32)
        .into_par_iter()
        .with_min_len(1 << 12)
        .map(|p| {
            let first = near.nearest(p, |_| true);
            let second = first.and_then(|n| {
                let d2 = distance2(at(p), at(n));
                near.nearest(p, |s| {
                    let opposite = distance2(at(n), at(s));
                    opposite > d2 && opposite > distance2(at(p), at(s))
                })
            });
            [first, second]
        })
        .collect();
    monitor.check()?;
    let mut edges = Vec::with_capacity(near.sites.len());
    for (p, names) in (0u32..).zip(&named) {
        for q in names.iter().flatten().copied() {
            if p < q && named[q as usize].contains(&Some(p)) {
                edges.push([p, q]);
            }
        }
    }
    Ok(edges)
}
