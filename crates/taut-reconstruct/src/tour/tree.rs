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
    ends: [u32; 2],
    /// Their components.
    of: [u32; 2],
}

impl Edge {
    #[inline(always)]
    fn is_before(&self, other: &Edge) -> bool {
        self.weight < other.weight || (self.weight == other.weight && self.ends < other.ends)
    }
}

/// A search for least trees, which keeps its memory from one to the next.
pub(super) struct LeastTree<'a> {
    candidates: &'a Candidates,
    /// The site that is left out.
    without: u32,
    edges: Vec<Edge>,
    /// For each component its least edge out.
    least: Vec<Edge>,
}

const UNKNOWN: Edge = Edge { weight: f64::INFINITY, ends: [NONE; 2], of: [NONE; 2] };

impl<'a> LeastTree<'a> {
    pub(super) fn new(candidates: &'a Candidates, n: usize, without: Option<u32>) -> Self {
        let without = without.unwrap_or(NONE);
        Self { candidates, without, edges: Vec::new(), least: vec![UNKNOWN; n] }
    }

    /// The sum of its weights; each edge is told.
    pub(super) fn find(&mut self, potentials: &[f64], mut tell: impl FnMut(u32, u32)) -> f64 {
        let Self { candidates, without, edges, least } = self;
        let (n, without) = (potentials.len() as u32, *without);
        let mut union = Union::of(n as usize);
        let mut total = 0.0;
        let mut take = |union: &mut Union, edge: &Edge| {
            if union.join(edge.ends[0], edge.ends[1]) {
                total += edge.weight;
                tell(edge.ends[0], edge.ends[1]);
            }
        };
        let of_row = |v: u32| {
            let of_v = potentials[v as usize];
            candidates.edges(v).filter(move |&(u, _)| u != without).map(move |(u, length)| Edge {
                weight: length + (of_v + potentials[u as usize]),
                ends: [v.min(u), v.max(u)],
                of: [v, u],
            })
        };
        for v in (0..n).filter(|&v| v != without) {
            let first = of_row(v).fold(UNKNOWN, |a, b| if b.is_before(&a) { b } else { a });
            if first.ends[0] != NONE {
                take(&mut union, &first);
            }
        }
        edges.clear();
        for v in (0..n).filter(|&v| v != without) {
            let root = union.root(v);
            for edge in of_row(v).filter(|edge| edge.ends[0] == v) {
                let other = union.root(edge.ends[1]);
                if root != other {
                    edges.push(Edge { of: [root, other], ..edge });
                }
            }
        }
        while !edges.is_empty() {
            for edge in edges.iter() {
                for component in edge.of {
                    let least = &mut least[component as usize];
                    if edge.is_before(least) {
                        *least = *edge;
                    }
                }
            }
            for edge in edges.iter() {
                for component in edge.of {
                    let edge = std::mem::replace(&mut least[component as usize], UNKNOWN);
                    if edge.ends[0] != NONE {
                        take(&mut union, &edge);
                    }
                }
            }
            edges.retain_mut(|edge| {
                edge.of = edge.of.map(|c| union.root(c));
                edge.of[0] != edge.of[1]
            });
        }
        total
    }
}
