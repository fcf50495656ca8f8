//! Runs of edges with the boxes that hold them, as a binary tree.
//!
//! *Idea.* Edges that follow each other are near each other. What is true for the box of a run, such as being right of a side, holds for all of
//! its edges, so that most questions are answered without a look at single edges.

use std::ops::Range;

use super::gauge::Gauge;
use crate::polygon::Segment;

/// Edges of a group without children.
const LEAF_EDGES: usize = 4;

/// A box, by its center and half its extents.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) center: [f64; 2],
    pub(super) half: [f64; 2],
}

/// The groups of the edges of a polygon: group 1 holds all, and group i has the children 2i and 2i + 1.
pub(super) struct Groups {
    edges: Vec<Segment>,
    extents: Vec<Extent>,
    leaves: usize,
}

impl Groups {
    pub(super) fn of(edges: &[Segment]) -> Self {
        let leaves = edges.len().div_ceil(LEAF_EDGES).next_power_of_two();
        let mut boxes = vec![([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]); 2 * leaves];
        for (i, edge) in edges.iter().enumerate() {
            let (low, high) = &mut boxes[leaves + i / LEAF_EDGES];
            for p in edge {
                for k in 0..2 {
                    (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
                }
            }
        }
        for i in (1..leaves).rev() {
            let ((low, high), (lower, higher)) = (boxes[2 * i], boxes[2 * i + 1]);
            boxes[i] =
                ([0, 1].map(|k| low[k].min(lower[k])), [0, 1].map(|k| high[k].max(higher[k])));
        }
        let extent = |(low, high): ([f64; 2], [f64; 2])| Extent {
            center: [0, 1].map(|k| 0.5 * low[k] + 0.5 * high[k]),
            half: [0, 1].map(|k| 0.5 * (high[k] - low[k])),
        };
        Groups { edges: edges.to_vec(), extents: boxes.into_iter().map(extent).collect(), leaves }
    }

    /// The group of all edges.
    pub(super) fn root(&self) -> u32 {
        1
    }

    pub(super) fn edge(&self, edge: u32) -> Segment {
        self.edges[edge as usize]
    }

    pub(super) fn extent(&self, group: u32) -> Extent {
        self.extents[group as usize]
    }

    /// The halves of a group; `None` for one without children.
    pub(super) fn children(&self, group: u32) -> Option<[u32; 2]> {
        let has_children = (group as usize) < self.leaves;
        has_children.then(|| [2 * group, 2 * group + 1])
    }

    /// The edges of a group without children.
    pub(super) fn range(&self, group: u32) -> Range<u32> {
        let first = (group as usize - self.leaves) * LEAF_EDGES;
        let clamped = |edge: usize| edge.min(self.edges.len()) as u32;
        clamped(first)..clamped(first + LEAF_EDGES)
    }

    /// Calls `visit` with the edges that the triangle of a gauge may reach at a scale; `visit` returns the scale for the others.
    fn within(&self, gauge: &Gauge, mut most: f64, mut visit: impl FnMut(u32, f64) -> f64) {
        let mut pending = vec![self.root()];
        while let Some(group) = pending.pop() {
            let Extent { center, half } = self.extent(group);
            // The boxes of groups without edges are at infinity, which is no number times 0.
            if half[0].is_infinite() || gauge.least_over(center, half) >= most {
                continue;
            }
            match self.children(group) {
                Some([one, other]) => pending.extend([other, one]),
                None => self.range(group).for_each(|edge| most = visit(edge, most)),
            }
        }
    }

    /// Whether an edge passes a test, which no edge does whose box fails another one.
    pub(super) fn any(
        &self,
        may_hold: impl Fn(&Extent) -> bool,
        holds: impl Fn(Segment) -> bool,
    ) -> bool {
        let mut pending = vec![self.root()];
        while let Some(group) = pending.pop() {
            let extent = self.extent(group);
            // The boxes of groups without edges are at infinity.
            if extent.half[0].is_infinite() || !may_hold(&extent) {
                continue;
            }
            match self.children(group) {
                Some([one, other]) => pending.extend([other, one]),
                None if self.range(group).any(|edge| holds(self.edge(edge))) => return true,
                None => {}
            }
        }
        false
    }

    /// The least scale at which the triangle of a gauge reaches an edge, or `most` if that is less.
    pub(super) fn least_scale(&self, gauge: &Gauge, most: f64) -> f64 {
        let mut least = most;
        self.within(gauge, most, |edge, most| {
            least = gauge.scale(self.edge(edge), most);
            least
        });
        least
    }

    /// The edges that the triangle of a gauge reaches below a scale, ascending.
    pub(super) fn reached(&self, gauge: &Gauge, scale: f64) -> Vec<u32> {
        let mut found = vec![];
        self.within(gauge, scale, |edge, most| {
            if gauge.scale(self.edge(edge), most) < most {
                found.push(edge);
            }
            most
        });
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_find_what_all_edges_show() {
        let point = |i: usize| {
            let angle = i as f64 * 0.37;
            [angle.cos() * (1.0 + 0.3 * (3.0 * angle).sin()), angle.sin()]
        };
        for size in [3, 4, 5, 17, 64, 100] {
            let edges: Vec<Segment> = (0..size).map(|i| [point(i), point(i + 1)]).collect();
            let groups = Groups::of(&edges);
            for turn in 0..9 {
                let at = |k: usize| point(turn + 5 * k).map(|x| 0.5 * x);
                let mut triangle = [at(0), at(1), at(2)];
                if super::super::gauge::doubled_area(&triangle) < 0.0 {
                    triangle.swap(0, 1);
                }
                let gauge = Gauge::of(&triangle);
                let scales: Vec<f64> = edges.iter().map(|&edge| gauge.scale(edge, 9.0)).collect();
                let least = scales.iter().copied().fold(9.0, f64::min);
                assert_eq!(groups.least_scale(&gauge, 9.0), least);
                let near = (0..size as u32).filter(|&edge| scales[edge as usize] < 3.0);
                assert_eq!(groups.reached(&gauge, 3.0), near.collect::<Vec<_>>());
            }
        }
    }
}
