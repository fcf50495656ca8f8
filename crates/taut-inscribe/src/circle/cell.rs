//! Cells of the bounding box.

use super::distance::Edges;

/// A rectangle, in coordinates of the input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
}

impl Cell {
    /// The bounding box of the rings.
    pub(super) fn root(edges: &Edges<'_>) -> Self {
        let [low, high] = edges.runs.bounds(edges.runs.whole());
        Cell { low, high }
    }

    pub(super) fn corners(&self) -> [[f64; 2]; 4] {
        let (low, high) = (self.low, self.high);
        [low, [high[0], low[1]], [low[0], high[1]], high]
    }

    pub(super) fn center(&self) -> [f64; 2] {
        [0, 1].map(|k| 0.5 * self.low[k] + 0.5 * self.high[k])
    }

    /// Returns true if rounding leaves a middle along an axis.
    pub(super) fn has_middle(&self, axis: usize) -> bool {
        let middle = self.center()[axis];
        self.low[axis] < middle && middle < self.high[axis]
    }

    /// The halves at the middle along an axis.
    pub(super) fn halves(&self, axis: usize) -> [Cell; 2] {
        let (low, high) = (self.low, self.high);
        let middle = self.center()[axis];
        let (mut below, mut above) = (high, low);
        (below[axis], above[axis]) = (middle, middle);
        [Cell { low, high: below }, Cell { low: above, high }]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Loops;
    use crate::runs::Runs;

    #[test]
    fn halves_share_the_middle() {
        let loops = Loops::of_ring(&[[1.0, 0.0], [0.0, 2.0], [-1.0, 0.0], [0.0, -1.0]]);
        let runs = Runs::of(&loops.segments);
        let root = Cell::root(&Edges::of(&loops.segments, &runs));
        assert_eq!((root.low, root.high), ([-1.0; 2], [1.0, 2.0]));
        let [left, right] = root.halves(0);
        assert!(left.low == root.low && left.high == [0.0, 2.0]);
        assert!(right.low == [0.0, -1.0] && right.high == root.high);
        let [_, top] = left.halves(1);
        assert!(top.low == [-1.0, 0.5] && top.high == left.high && top.has_middle(0));
    }
}
