//! Runs of edges with the boxes that hold them, as a binary tree.
//!
//! *Idea.* Edges that follow each other are near each other. What is true for the box of a run, such as being right of a side, holds for all of
//! its edges, so that most questions are answered without a look at single edges.

use std::ops::Range;

use crate::polygon::Segment;

/// Edges of a group without children.
const LEAF_EDGES: usize = 4;

/// A box, by its center and half its extents.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    pub(crate) center: [f64; 2],
    pub(crate) half: [f64; 2],
}

/// The groups of the edges of a polygon: group 1 holds all, and group i has the children 2i and 2i + 1.
pub(crate) struct Groups {
    edges: Vec<Segment>,
    extents: Vec<Extent>,
    leaves: usize,
}

impl Groups {
    pub(crate) fn of(edges: &[Segment]) -> Self {
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
    pub(crate) fn root(&self) -> u32 {
        1
    }

    pub(crate) fn edge(&self, edge: u32) -> Segment {
        self.edges[edge as usize]
    }

    pub(crate) fn extent(&self, group: u32) -> Extent {
        self.extents[group as usize]
    }

    /// The halves of a group; `None` for one without children.
    pub(crate) fn children(&self, group: u32) -> Option<[u32; 2]> {
        let has_children = (group as usize) < self.leaves;
        has_children.then(|| [2 * group, 2 * group + 1])
    }

    /// The edges of a group without children.
    pub(crate) fn range(&self, group: u32) -> Range<u32> {
        let first = (group as usize - self.leaves) * LEAF_EDGES;
        let clamped = |edge: usize| edge.min(self.edges.len()) as u32;
        clamped(first)..clamped(first + LEAF_EDGES)
    }

    /// Whether an edge passes a test, which no edge does whose box fails another one.
    pub(crate) fn any(
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

    /// The edges of groups whose boxes pass a test, ascending.
    pub(crate) fn among(&self, may_hold: impl Fn(&Extent) -> bool) -> Vec<Segment> {
        let (mut found, mut pending) = (vec![], vec![self.root()]);
        while let Some(group) = pending.pop() {
            let extent = self.extent(group);
            // The boxes of groups without edges are at infinity.
            if extent.half[0].is_infinite() || !may_hold(&extent) {
                continue;
            }
            match self.children(group) {
                Some([one, other]) => pending.extend([other, one]),
                None => found.extend(self.range(group).map(|edge| self.edge(edge))),
            }
        }
        found
    }
}
