//! A first tour, from fragments that grow together.
//!
//! *Idea.* The shortest edge first, each is taken whose ends have room and are not of one fragment: greedy matching. It gives dense
//! samples of a curve that curve. When no candidate is left, the ends of fragments are triangulated, and so on among them, until
//! there is one fragment.
//! *Guarantee.* Each round joins at least two fragments, as a Delaunay triangulation connects all ends; in practice most of them.
//! *Reference.* Bentley, Fast algorithms for geometric traveling salesman problems, ORSA J. Computing 4, 1992: greedy starts.

use taut_points::Monitor;

use super::candidates::{Candidates, delaunay_edges};
use super::metric::Metric;
use super::union::Union;
use crate::Error;

/// No neighbor yet.
const NONE: u32 = u32::MAX;

/// A path through all sites, as the order they have in it.
pub(super) fn path(
    sites: &[[f64; 2]],
    metric: &Metric,
    candidates: &Candidates,
    monitor: &Monitor<'_>,
) -> Result<Vec<u32>, Error> {
    let n = sites.len();
    let mut fragments = Fragments { neighbors: vec![[NONE; 2]; n], union: Union::of(n), joined: 0 };
    let edges = (0..n as u32).flat_map(|v| {
        candidates
            .tried(v)
            .filter(move |&(u, _)| v < u || !candidates.tries(u, v))
            .map(move |(u, length)| (length, v.min(u), v.max(u)))
    });
    fragments.join(edges.collect());
    while fragments.joined + 1 < n {
        monitor.check()?;
        let ends: Vec<u32> = (0..n as u32).filter(|&v| fragments.has_room(v)).collect();
        let at: Vec<[f64; 2]> = ends.iter().map(|&v| sites[v as usize]).collect();
        let edges = delaunay_edges(&at, monitor)?.into_iter().filter(|[a, b]| a < b);
        let edges = edges.map(|[a, b]| (ends[a as usize], ends[b as usize]));
        fragments.join(edges.map(|(a, b)| (metric.distance(a, b), a, b)).collect());
    }
    Ok(fragments.walk())
}

struct Fragments {
    neighbors: Vec<[u32; 2]>,
    union: Union,
    /// Edges taken.
    joined: usize,
}

impl Fragments {
    fn has_room(&self, v: u32) -> bool {
        self.neighbors[v as usize][1] == NONE
    }

    /// Takes edges as they come by length, ties by site.
    fn join(&mut self, mut edges: Vec<(f64, u32, u32)>) {
        edges.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        for (_, a, b) in edges {
            if self.has_room(a) && self.has_room(b) && self.union.join(a, b) {
                for (v, u) in [(a, b), (b, a)] {
                    let [first, second] = &mut self.neighbors[v as usize];
                    *(if *first == NONE { first } else { second }) = u;
                }
                self.joined += 1;
            }
        }
    }

    /// From the end that comes first to the other.
    fn walk(&self) -> Vec<u32> {
        let n = self.neighbors.len();
        let mut order = Vec::with_capacity(n);
        let Some(first) = (0..n as u32).find(|&v| self.has_room(v)) else { return order };
        let (mut before, mut v) = (NONE, first);
        while v != NONE && order.len() < n {
            order.push(v);
            let [a, b] = self.neighbors[v as usize];
            (before, v) = (v, if a == before { b } else { a });
        }
        order
    }
}
