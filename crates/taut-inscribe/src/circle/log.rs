//! The subdivision, in the form of the certificate.

/// Edges with whole weights.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Leaf(pub(super) Vec<(u32, u64)>);

impl Leaf {
    /// The numbers of the certificate, with edges by the rows at which they begin.
    pub(super) fn numbers(self, rows: &[u64]) -> Vec<u64> {
        match self.0[..] {
            [(edge, _)] => vec![rows[edge as usize]],
            _ => self.0.iter().flat_map(|&(edge, w)| [rows[edge as usize], w]).collect(),
        }
    }
}

/// A cell of a tree that is kept; the first is the root.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// Edges that bound the clearance in the cell, and the bound; `None` if no edge meets the cell, which is outside.
    pub(super) bound: Option<(Leaf, f64)>,
    /// The axis across which the cell is split, and its halves.
    pub(super) split: Option<(usize, [usize; 2])>,
}

/// The splits and leaves, depth first, the lower half before the upper one.
#[derive(Default)]
pub(super) struct Log {
    pub(super) tree: String,
    pub(super) leaves: Vec<Leaf>,
}

impl Log {
    /// Writes down a tree, without cells in one that has a bound as wanted; also returns the largest bound of a leaf.
    pub(super) fn of(nodes: &[Node], wanted: f64) -> (Self, f64) {
        let (mut log, mut upper) = (Log::default(), 0.0f64);
        let mut pending = vec![0];
        while let Some(node) = pending.pop() {
            let Node { bound, split } = &nodes[node];
            match (bound, split) {
                (None, _) => log.outside(),
                (Some((_, bound)), &Some((axis, [below, above]))) if *bound > wanted => {
                    log.split(axis);
                    pending.extend([above, below]);
                }
                (Some((leaf, bound)), _) => {
                    log.close(leaf.clone());
                    upper = upper.max(*bound);
                }
            }
        }
        (log, upper)
    }

    /// The next cell is outside, and no edge meets it.
    pub(super) fn outside(&mut self) {
        self.tree.push('o');
    }

    /// The next cell is split; its halves follow.
    pub(super) fn split(&mut self, axis: usize) {
        self.tree.push(if axis == 0 { 'x' } else { 'y' });
    }

    /// The next cell has a bound by some edges.
    pub(super) fn close(&mut self, leaf: Leaf) {
        self.tree.push('b');
        self.leaves.push(leaf);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_within_the_bound_are_not_split() {
        let bound = |edge, bound| Some((Leaf(vec![(edge, 1)]), bound));
        let nodes = [
            Node { bound: bound(0, 4.0), split: Some((0, [1, 2])) },
            Node { bound: bound(1, 2.0), split: Some((1, [3, 4])) },
            Node { bound: None, split: None },
            Node { bound: bound(3, 1.0), split: None },
            Node { bound: bound(4, 1.5), split: None },
        ];
        for (wanted, tree, leaves, most) in
            [(1.5, "xybbo", vec![3, 4], 1.5), (2.0, "xbo", vec![1], 2.0), (4.0, "b", vec![0], 4.0)]
        {
            let (log, upper) = Log::of(&nodes, wanted);
            let edges: Vec<u32> = log.leaves.iter().map(|leaf| leaf.0[0].0).collect();
            assert_eq!((&log.tree[..], edges, upper), (tree, leaves, most));
        }
    }
}
