//! On which side of the edges a point in units lies.
//!
//! *Idea.* A segment tree over heights: each edge is kept at the few nodes that together make up the heights that it spans. The edges
//! that a horizontal line can cross are at the nodes above one leaf.

use super::crosses_left_of;
use super::units::Units;

/// Most leaves of the tree.
const LEAVES_MAX: usize = 1 << 12;

/// Heights are below this.
const HEIGHT_MAX: f64 = 2.0;

/// The edges by height.
pub(crate) struct Levels {
    /// The edges of each node; node 1 is the root, and node i has the children 2i and 2i + 1.
    nodes: Vec<Vec<u32>>,
}

impl Levels {
    pub(crate) fn of(units: &Units) -> Self {
        let leaves = units.len().next_power_of_two().min(LEAVES_MAX);
        let mut levels = Levels { nodes: vec![vec![]; 2 * leaves] };
        for edge in 0..units.len() {
            let [a, b] = units.edge(edge);
            let mut first = levels.leaf(a[1].min(b[1]));
            let mut last = levels.leaf(a[1].max(b[1]));
            // From the leaves up: a node that its parent does not stand for is kept, and the range shrinks past it.
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

    /// The leaf of a height: monotone, so that a height between two others has a leaf between theirs.
    fn leaf(&self, y: f64) -> usize {
        let leaves = self.nodes.len() / 2;
        leaves + ((y * (leaves as f64 / HEIGHT_MAX)) as usize).min(leaves - 1)
    }

    /// Whether an odd number of edges cross the line to the left of p, by exact signs.
    pub(crate) fn is_inside(&self, units: &Units, p: [f64; 2]) -> bool {
        let (mut node, mut crossed) = (self.leaf(p[1]), 0);
        while node > 0 {
            let edges = self.nodes[node].iter();
            crossed += edges.filter(|&&edge| crosses_left_of(units.edge(edge as usize), p)).count();
            node /= 2;
        }
        crossed % 2 == 1
    }
}
