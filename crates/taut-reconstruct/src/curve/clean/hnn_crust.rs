//! HNN-Crust: nearest neighbors and half neighbors, kept where both ends agree.
//!
//! *Problem.* The edges between neighbors on smooth curves, from fewer samples than NN-Crust needs.
//! *Idea.* Beside the nearest neighbor n₁ a sample p takes n₂, the first by distance that is nearer to p than to n₁ and farther
//! from n₁ than p is: the angle n₁ p n₂ is the largest of the three, more than 60°. An edge stays if each end names the other.
//! *Guarantee.* Exactly the edges of smooth closed curves for samples with ε < 0.47, or a reach-relative spacing below 0.9.
//! *Trap.* Looking among a fixed number of neighbors only loses edges where the density jumps; here the search has no cap.
//! *Reference.* Ohrhallinger, Mitchell and Wimmer, Computer Graphics Forum 35(5), 2016.

use taut_points::Monitor;

use super::near::{NONE, Near, distance2};
use crate::Error;
use crate::curve::boxes::Bounds;

pub(super) fn edges(near: &Near<'_>, monitor: &Monitor<'_>) -> Result<Vec<[u32; 2]>, Error> {
    let at = |site: u32| near.sites[site as usize];
    let first = near.nearest(|_| true, |_| |_, d2| d2, |_| |_: &Bounds| true);
    monitor.check()?;
    let widest = |p: u32| {
        let [p, n] = [p, first[p as usize]].map(at);
        let apart = distance2(p, n);
        move |s: [f64; 2], d2: f64| {
            if distance2(n, s) > apart.max(d2) { d2 } else { f64::INFINITY }
        }
    };
    let second = near.nearest(|p| first[p as usize] != NONE, widest, |_| |_: &Bounds| true);
    monitor.check()?;
    let named = |p: u32| [first[p as usize], second[p as usize]];
    let mut edges = Vec::with_capacity(near.sites.len());
    for p in 0..near.sites.len() as u32 {
        // The smaller end gives the edge.
        let mutual = |&q: &u32| q != NONE && p < q && named(q).contains(&p);
        edges.extend(named(p).into_iter().filter(mutual).map(|q| [p, q]));
    }
    Ok(edges)
}
