//! On which side of the edges a point in units lies.
//!
//! *Idea.* A segment tree over heights: an edge is kept at the few nodes that make up the heights it spans, and the edges that a
//! horizontal line can cross are at the nodes above one leaf.

use taut_predicates::plane::orient;

use crate::polygon::Segment;

/// Most leaves of the tree.
const LEAVES_MAX: usize = 1 << 12;

/// The edges by height.
pub(crate) struct Levels {
    /// Of each node the edges that span all of its heights; node 1 is the root, and node i has the children 2i and 2i + 1.
    nodes: Vec<Vec<u32>>,
    /// Leaves per unit of height.
    density: f64,
}

impl Levels {
    pub(crate) fn of(edges: &[Segment], height: f64) -> Self {
        let leaves = edges.len().next_power_of_two().min(LEAVES_MAX);
        let mut levels =
            Levels { nodes: vec![vec![]; 2 * leaves], density: leaves as f64 / height };
        for (edge, [a, b]) in edges.iter().enumerate() {
            let mut first = leaves + levels.leaf(a[1].min(b[1]));
            let mut last = leaves + levels.leaf(a[1].max(b[1]));
            // The nodes between both ends, from the leaves up.
            while first <= last {
                if first % 2 == 1 {
                    levels.nodes[first].push(edge as u32);
                    first += 1;
                }
                if last.is_multiple_of(2) {
                    levels.nodes[last].push(edge as u32);
                    last -= 1;
                }
                (first, last) = (first / 2, last / 2);
            }
        }
        levels
    }

    /// The leaf of a height; monotone, so that every height that an edge spans is between the leaves of its ends.
    fn leaf(&self, y: f64) -> usize {
        ((y * self.density) as usize).min(self.nodes.len() / 2 - 1)
    }

    /// The edges that cross the horizontal line at a height.
    pub(crate) fn crossing<'a>(
        &'a self,
        edges: &'a [Segment],
        y: f64,
    ) -> impl Iterator<Item = Segment> + 'a {
        let leaf = self.nodes.len() / 2 + self.leaf(y);
        std::iter::successors(Some(leaf), |&node| (node > 1).then_some(node / 2))
            .flat_map(|node| &self.nodes[node])
            .map(|&edge| edges[edge as usize])
            .filter(move |[a, b]| (a[1] <= y) != (b[1] <= y))
    }

    /// Whether an odd number of edges cross the line to the left of p.
    pub(crate) fn is_inside(&self, edges: &[Segment], p: [f64; 2]) -> bool {
        let mut node = self.nodes.len() / 2 + self.leaf(p[1]);
        let mut is_inside = false;
        while node > 0 {
            let crossed = self.nodes[node].iter().filter(|&&edge| is_left(edges[edge as usize], p));
            is_inside ^= crossed.count() % 2 == 1;
            node /= 2;
        }
        is_inside
    }
}

/// Whether an edge crosses the horizontal line through p to the left of it.
pub(crate) fn is_left([a, b]: Segment, p: [f64; 2]) -> bool {
    if (a[1] <= p[1]) == (b[1] <= p[1]) {
        return false;
    }
    let (low, high) = if a[1] <= p[1] { (a, b) } else { (b, a) };
    !orient(low, high, p).is_positive()
}
