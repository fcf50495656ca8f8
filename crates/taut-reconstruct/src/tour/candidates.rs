//! The edges among which tours and trees are sought.
//!
//! *Problem.* Of all pairs of sites, O(n) that short tours are made of, the same for any order of the input.
//! *Idea.* Edges of the Delaunay triangulation, of which optimal tours of points of the plane mostly consist, and from each site to
//! the nearest that can be reached by two of them.
//! *Guarantee.* The edges connect all sites, also without any one of them.
//! *Trap.* A hub has many neighbors: the second step only goes to the few nearest of each, or stars would cost their square.

use taut_delaunay::{Complex, DelaunayOptions, Plane};
use taut_points::parallel::IntoParallel;
use taut_points::{Monitor, Points};

use super::metric::Metric;
use crate::Error;

/// Moves try this many neighbors of a site.
const CANDIDATES_TRIED: usize = 8;
/// Of these neighbors this many are the nearest, the others Delaunay edges.
const NEAREST_CANDIDATES: usize = 5;
/// Sites a task has.
const TASK: usize = 1 << 10;

/// For each site its neighbors by distance.
pub(super) struct Candidates {
    starts: Vec<u32>,
    neighbors: Vec<u32>,
    lengths: Vec<f64>,
}

impl Candidates {
    /// The edges of the graph, to trees; symmetric.
    pub(super) fn of(
        sites: &[[f64; 2]],
        metric: &Metric,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        let triangulated = Self::sorted(sites.len(), &delaunay_edges(sites, monitor)?, metric);
        let mut all: Vec<[u32; 2]> = (0..sites.len() as u32)
            .into_par_iter()
            .with_min_len(TASK)
            .flat_map_iter(|v| {
                let far = triangulated.nearest_by_two(v, metric);
                far.into_iter().flat_map(move |u| [[v, u], [u, v]])
            })
            .collect();
        for v in 0..sites.len() as u32 {
            all.extend(triangulated.neighbors(v).iter().map(|&u| [v, u]));
        }
        Ok(Self::sorted(sites.len(), &all, metric))
    }

    /// From directed edges.
    fn sorted(n: usize, edges: &[[u32; 2]], metric: &Metric) -> Self {
        let mut starts = vec![0u32; n + 1];
        for &[from, _] in edges {
            starts[from as usize + 1] += 1;
        }
        for v in 0..n {
            starts[v + 1] += starts[v];
        }
        let mut filled = starts.clone();
        let mut rows = vec![(0.0f64, 0u32); edges.len()];
        for &[from, to] in edges {
            let at = &mut filled[from as usize];
            rows[*at as usize] = (metric.distance(from, to), to);
            *at += 1;
        }
        let mut kept = Self {
            starts: vec![0],
            neighbors: Vec::with_capacity(rows.len()),
            lengths: Vec::with_capacity(rows.len()),
        };
        for v in 0..n {
            let row = &mut rows[starts[v] as usize..starts[v + 1] as usize];
            row.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let mut last = None;
            for &(length, to) in row.iter() {
                if last != Some(to) {
                    kept.neighbors.push(to);
                    kept.lengths.push(length);
                }
                last = Some(to);
            }
            kept.starts.push(kept.neighbors.len() as u32);
        }
        kept
    }

    /// The sites nearest to one among those that two short edges lead to.
    fn nearest_by_two(&self, v: u32, metric: &Metric) -> Vec<u32> {
        let near = |v: u32| self.neighbors(v).iter().take(CANDIDATES_TRIED);
        let reached = near(v).flat_map(|&u| near(u)).filter(|&&w| w != v);
        let mut found: Vec<(f64, u32)> = reached.map(|&w| (metric.distance(v, w), w)).collect();
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.dedup();
        found.iter().take(NEAREST_CANDIDATES).map(|&(_, w)| w).collect()
    }

    #[inline(always)]
    fn neighbors(&self, v: u32) -> &[u32] {
        &self.neighbors[self.range(v)]
    }

    /// The neighbors of a site with their distances.
    #[inline(always)]
    pub(super) fn edges(&self, v: u32) -> impl Iterator<Item = (u32, f64)> {
        let range = self.range(v);
        self.neighbors[range.clone()].iter().copied().zip(self.lengths[range].iter().copied())
    }

    pub(super) fn length(&self, v: u32, u: u32) -> f64 {
        self.edges(v).find(|&(w, _)| w == u).map_or(0.0, |(_, length)| length)
    }

    /// Those that moves try.
    #[inline(always)]
    pub(super) fn tried(&self, v: u32) -> impl Iterator<Item = (u32, f64)> {
        self.edges(v).take(CANDIDATES_TRIED)
    }

    /// Returns true if moves try the edge from the first site to the second.
    pub(super) fn tries(&self, v: u32, u: u32) -> bool {
        self.neighbors(v).iter().take(CANDIDATES_TRIED).any(|&w| w == u)
    }

    #[inline(always)]
    fn range(&self, v: u32) -> std::ops::Range<usize> {
        self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize
    }
}

/// The edges of the Delaunay triangulation, each both ways; of points on a line those between neighbors.
pub(super) fn delaunay_edges(
    sites: &[[f64; 2]],
    monitor: &Monitor<'_>,
) -> Result<Vec<[u32; 2]>, Error> {
    let Ok(points) = Points::new(sites.as_flattened(), 2) else { return Ok(Vec::new()) };
    let plane = Plane::build(
        &points,
        &DelaunayOptions { monitor: *monitor, ..DelaunayOptions::default() },
    )?;
    let edge = |a: u32, b: u32| [plane.row(a), plane.row(b)];
    if let Complex::Line(along) = plane.complex() {
        return Ok(along.windows(2).flat_map(|w| [edge(w[0], w[1]), edge(w[1], w[0])]).collect());
    }
    // A triangle has each of its edges one way, the one across the other way; across the hull there is none.
    let inner = plane.simplices().flat_map(|t| {
        let [a, b, c] = plane.vertices(t);
        [edge(a, b), edge(b, c), edge(c, a)]
    });
    Ok(inner.chain(plane.hull().map(|[a, b]| edge(b, a))).collect())
}
