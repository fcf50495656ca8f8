//! Cells of the bounding box, and on which side of the edges their lower corners lie.
//!
//! A point is moved by (δ, δ²) for an infinitely small δ > 0, so that it lies on no edge. The edges are crossed as often on any
//! path between two moved points as parity says; a path within a cell crosses only edges that meet the cell.

use taut_predicates::plane::orient;

use super::distance::Edges;

/// A rectangle, in coordinates of the input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
    /// True if the moved lower corner is inside.
    pub(super) is_inside: bool,
}

impl Cell {
    /// The bounding box of the rings.
    pub(super) fn root(edges: &Edges) -> Self {
        let (mut low, mut high) = (edges.exact[0][0], edges.exact[0][0]);
        for [p, _] in &edges.exact {
            for k in 0..2 {
                (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
            }
        }
        let crossed = (0..edges.len()).filter(|&edge| is_left(edges.segment(edge), low));
        Cell { low, high, is_inside: crossed.count() % 2 == 1 }
    }

    pub(super) fn corners(&self) -> [[f64; 2]; 4] {
        let (low, high) = (self.low, self.high);
        [low, [high[0], low[1]], [low[0], high[1]], high]
    }

    pub(super) fn center(&self) -> [f64; 2] {
        [0, 1].map(|k| 0.5 * self.low[k] + 0.5 * self.high[k])
    }

    /// Tests whether the moved p, a point of the cell, is inside. `list` has all edges that meet the cell.
    pub(super) fn is_inside(&self, p: [f64; 2], edges: &Edges, list: &[u32]) -> bool {
        let turn = [p[0], self.low[1]];
        let changes = |edge: &&u32| {
            let segment = edges.segment(**edge);
            let level = is_left(segment, self.low) != is_left(segment, turn);
            level != (is_below(segment, turn) != is_below(segment, p))
        };
        self.is_inside != (list.iter().filter(changes).count() % 2 == 1)
    }

    /// Returns true if rounding leaves a middle along an axis.
    pub(super) fn has_middle(&self, axis: usize) -> bool {
        let middle = self.center()[axis];
        self.low[axis] < middle && middle < self.high[axis]
    }

    /// The halves at the middle along an axis.
    pub(super) fn halves(&self, axis: usize, edges: &Edges, list: &[u32]) -> [Cell; 2] {
        let (low, high) = (self.low, self.high);
        let middle = self.center()[axis];
        let (mut below, mut above) = (high, low);
        (below[axis], above[axis]) = (middle, middle);
        let is_inside = self.is_inside(above, edges, list);
        [Cell { high: below, ..*self }, Cell { low: above, high, is_inside }]
    }
}

/// Tests whether an edge crosses the horizontal line through the moved p, to the left of it.
fn is_left([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> bool {
    if (a[1] <= p[1]) == (b[1] <= p[1]) {
        return false;
    }
    let (low, high) = if a[1] <= p[1] { (a, b) } else { (b, a) };
    !orient(low, high, p).is_positive()
}

/// Tests whether an edge crosses the vertical line through the moved p, below it.
fn is_below([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> bool {
    if (a[0] <= p[0]) == (b[0] <= p[0]) {
        return false;
    }
    let (left, right) = if a[0] <= p[0] { (a, b) } else { (b, a) };
    let side = orient(left, right, p);
    side.is_positive() || side.is_zero() && right[1] <= left[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_on_edges_and_vertices_have_a_side() {
        // A diamond whose vertices and center are corners of cells.
        let edges = Edges::of_ring(&[[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]);
        let list = [0, 1, 2, 3];
        let root = Cell::root(&edges);
        assert_eq!((root.low, root.high, root.is_inside), ([-1.0; 2], [1.0; 2], false));
        for (p, expected) in [
            ([0.0, 0.0], true),
            ([0.25, 0.5], true),
            ([0.75, 0.75], false),
            ([-0.75, -0.75], false),
            // On the ring a point is moved to the right.
            ([-0.5, -0.5], true),
            ([-0.5, 0.5], true),
            ([0.5, 0.5], false),
            ([-1.0, 0.0], true),
            ([1.0, 0.0], false),
        ] {
            assert_eq!(root.is_inside(p, &edges, &list), expected, "{p:?}");
        }
        let [left, right] = root.halves(0, &edges, &list);
        assert!(left.high == [0.0, 1.0] && right.low == [0.0, -1.0] && !left.is_inside);
        let [_, top] = left.halves(1, &edges, &list);
        assert!(top.low == [-1.0, 0.0] && top.is_inside);
    }
}
