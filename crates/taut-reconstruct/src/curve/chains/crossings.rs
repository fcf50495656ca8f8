//! Edges that meet, found and removed with exact signs.
//!
//! *Idea.* Edges sorted by their smaller site are in Hilbert order, nearly: the tree of boxes over them answers, for a leaf of
//! eight edges at a time, which other leaves come into question.

use taut_points::OrderBy;
use taut_points::parallel::IntoParallel;
use taut_predicates::plane::{in_diametral_circle, orient};

use crate::curve::boxes::{Bounds, Boxes, FAN_OUT};

/// Edges with the tree over them.
pub(super) struct EdgeTree<'a> {
    sites: &'a [[f64; 2]],
    edges: &'a [[u32; 2]],
    boxes: Boxes,
}

impl<'a> EdgeTree<'a> {
    pub(super) fn new(sites: &'a [[f64; 2]], edges: &'a [[u32; 2]]) -> Self {
        let boxes = Boxes::over(edges.len(), |i| bounds(sites, edges[i]));
        Self { sites, edges, boxes }
    }

    /// Whether an edge meets another one of the tree but in a common end.
    pub(super) fn meets(&self, edge: [u32; 2]) -> bool {
        let (own, mut found) = (bounds(self.sites, edge), false);
        self.boxes.meeting(&own, |leaf| {
            found = found
                || self.boxes.leaf(leaf).any(|i| {
                    let other = self.edges[i];
                    other != edge
                        && bounds(self.sites, other).meets(&own)
                        && meet(self.sites, edge, other)
                });
        });
        found
    }

    /// The boxes of the edges of a leaf.
    fn leaf_bounds(&self, leaf: usize) -> [Bounds; FAN_OUT] {
        let mut all = [Bounds::EMPTY; FAN_OUT];
        for (bounds_of, i) in all.iter_mut().zip(self.boxes.leaf(leaf)) {
            *bounds_of = bounds(self.sites, self.edges[i]);
        }
        all
    }

    /// All pairs of edges that meet but in a common end, as numbers.
    fn pairs(&self) -> Vec<[u32; 2]> {
        let around = |leaf: usize| {
            let (mut pairs, own) = (Vec::new(), self.leaf_bounds(leaf));
            self.boxes.meeting(self.boxes.leaf_bounds(leaf), |other| {
                // Each pair of leaves once, from the smaller one.
                if other < leaf {
                    return;
                }
                let others = if other == leaf { own } else { self.leaf_bounds(other) };
                for (i, a) in self.boxes.leaf(leaf).zip(&own) {
                    if !a.meets(self.boxes.leaf_bounds(other)) {
                        continue;
                    }
                    for (k, b) in self.boxes.leaf(other).zip(&others) {
                        if k > i && a.meets(b) && meet(self.sites, self.edges[i], self.edges[k]) {
                            pairs.push([i as u32, k as u32]);
                        }
                    }
                }
            });
            pairs
        };
        (0..self.boxes.leaves())
            .into_par_iter()
            .with_min_len(1 << 9)
            .flat_map_iter(around)
            .collect()
    }
}

/// Drops edges until no two meet but in a common end, the longer first. Tells how many.
pub(super) fn remove(sites: &[[f64; 2]], edges: &mut Vec<[u32; 2]>) -> u64 {
    if edges.is_empty() {
        return 0;
    }
    let pairs = EdgeTree::new(sites, edges).pairs();
    if pairs.is_empty() {
        return 0;
    }
    let length = |edge: u32| {
        let [[x, y], [u, v]] = edges[edge as usize].map(|site| sites[site as usize]);
        (u - x).hypot(v - y)
    };
    let mut meetings: Vec<[u32; 2]> = pairs.iter().flat_map(|&[a, b]| [[a, b], [b, a]]).collect();
    meetings.sort_unstable();
    let mut involved: Vec<u32> = meetings.iter().map(|pair| pair[0]).collect();
    involved.dedup();
    involved.order_by(&|&a, &b| length(a).total_cmp(&length(b)).then(a.cmp(&b)));
    let mut dropped = vec![false; edges.len()];
    let mut kept = vec![false; edges.len()];
    for edge in involved {
        let first = meetings.partition_point(|pair| pair[0] < edge);
        let others = meetings[first..].iter().take_while(|pair| pair[0] == edge);
        let clear = others.clone().all(|pair| !kept[pair[1] as usize]);
        (if clear { &mut kept } else { &mut dropped })[edge as usize] = true;
    }
    let before = edges.len();
    let mut flags = dropped.iter();
    edges.retain(|_| flags.next() == Some(&false));
    (before - edges.len()) as u64
}

#[inline(always)]
fn bounds(sites: &[[f64; 2]], edge: [u32; 2]) -> Bounds {
    let [a, b] = edge.map(|site| Bounds::of(sites[site as usize]));
    a.join(b)
}

/// Whether two different edges have more in common than an end of both.
fn meet(sites: &[[f64; 2]], [a, b]: [u32; 2], [c, d]: [u32; 2]) -> bool {
    let at = |site: u32| sites[site as usize];
    let shared = if a == c {
        Some((a, b, d))
    } else if a == d {
        Some((a, b, c))
    } else if b == c {
        Some((b, a, d))
    } else if b == d {
        Some((b, a, c))
    } else {
        None
    };
    if let Some((v, x, y)) = shared {
        // On one line, and to the same side.
        let (v, x, y) = (at(v), at(x), at(y));
        let (along, across) = ((x[0] - v[0]) * (y[0] - v[0]), (x[1] - v[1]) * (y[1] - v[1]));
        if along + across < -1e-15 * (along.abs() + across.abs()) {
            return false;
        }
        return orient(v, x, y).is_zero() && in_diametral_circle(x, y, v).is_negative();
    }
    let [p, q, r, s] = [a, b, c, d].map(at);
    let turns = [orient(p, q, r), orient(p, q, s), orient(r, s, p), orient(r, s, q)];
    let apart = |i: usize, k: usize| {
        turns[i].is_positive() && turns[k].is_negative()
            || turns[i].is_negative() && turns[k].is_positive()
    };
    if apart(0, 1) && apart(2, 3) {
        return true;
    }
    // An end on the other edge: on its line, and not outside its smallest circle.
    let on = |i: usize, u, v, w| turns[i].is_zero() && !in_diametral_circle(u, v, w).is_negative();
    on(0, p, q, r) || on(1, p, q, s) || on(2, r, s, p) || on(3, r, s, q)
}
