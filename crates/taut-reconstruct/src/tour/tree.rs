//! Least trees of the candidates under potentials.
//!
//! *Problem.* With weights |ij| + πᵢ + πⱼ, the spanning tree of least weight of all sites, or of all but one.
//! *Idea.* Borůvka: each component takes its least edge out, all at once; edges within a component are dropped and the rest goes on.
//! The first round, which has most of the work, reads rows of candidates one after another.
//! *Guarantee.* Weights tie by the numbers of their sites, so the tree is unique and no cycle closes.
//! *Reference.* Nešetřil, Milková, Nešetřilová, Otakar Borůvka on minimum spanning tree problem, 2001.

use super::candidates::Candidates;
use super::union::Union;

/// No edge yet.
const NONE: u32 = u32::MAX;

/// An edge between two components.
#[derive(Clone, Copy)]
struct Edge {
    weight: f64,
    /// The sites.
    ends: [u32; 2],
    /// Their components.
    of: [u32; 2],
}

impl Edge {
    #[inline(always)]
    fn is_before(&self, other: &Edge) -> bool {
        (self.weight, self.ends) < (other.weight, other.ends)
    }
}

/// The least spanning tree of all sites but one (`NONE`-like numbers leave out none): the sum of its weights, and each edge told.
pub(super) fn least_tree(
    candidates: &Candidates,
    potentials: &[f64],
    without: Option<u32>,
    mut tell: impl FnMut(u32, u32),
) -> f64 {
    let n = potentials.len() as u32;
    let without = without.unwrap_or(NONE);
    let weight =
        |v: u32, u: u32, length: f64| length + (potentials[v as usize] + potentials[u as usize]);
    let mut union = Union::of(n as usize);
    let mut total = 0.0;
    let mut take = |union: &mut Union, edge: &Edge| {
        if union.join(edge.ends[0], edge.ends[1]) {
            total += edge.weight;
            tell(edge.ends[0], edge.ends[1]);
        }
    };
    let none = Edge { weight: f64::INFINITY, ends: [NONE; 2], of: [NONE; 2] };
    let of_row = |v: u32| {
        candidates.edges(v).filter(move |&(u, _)| u != without).map(move |(u, length)| Edge {
            weight: weight(v, u, length),
            ends: [v.min(u), v.max(u)],
            of: [v, u],
        })
    };
    for v in (0..n).filter(|&v| v != without) {
        let mut least = none;
        of_row(v).for_each(|edge| {
            if edge.is_before(&least) {
                least = edge;
            }
        });
        if least.ends[0] != NONE {
            take(&mut union, &least);
        }
    }
    let mut edges: Vec<Edge> = Vec::new();
    for v in (0..n).filter(|&v| v != without) {
        let root = union.root(v);
        for edge in of_row(v).filter(|edge| edge.ends[0] == v) {
            let other = union.root(edge.ends[1]);
            if root != other {
                edges.push(Edge { of: [root, other], ..edge });
            }
        }
    }
    let mut least = vec![none; if edges.is_empty() { 0 } else { n as usize }];
    while !edges.is_empty() {
        for edge in &edges {
            for component in edge.of {
                let least = &mut least[component as usize];
                if edge.is_before(least) {
                    *least = *edge;
                }
            }
        }
        let mut taken = 0;
        for at in 0..edges.len() {
            for component in edges[at].of {
                let edge = std::mem::replace(&mut least[component as usize], none);
                if edge.ends[0] != NONE {
                    take(&mut union, &edge);
                    taken += 1;
                }
            }
        }
        debug_assert!(taken > 0);
        edges.retain_mut(|edge| {
            edge.of = edge.of.map(|c| union.root(c));
            edge.of[0] != edge.of[1]
        });
    }
    total
}
