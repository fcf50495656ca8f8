//! The tree of a search, and its form in the certificate.

/// Why no rectangle of a cell is larger than a bound.
#[derive(Clone, Debug)]
pub(super) enum Reason {
    /// The ranges alone.
    Small,
    /// A corner, or the center with number 4, is outside.
    Outside(usize),
    /// A point of an edge, by a share of its length, is in all rectangles.
    Entered(u32, u32),
    /// Conditions with weights over a power of two.
    Weighted { bits: u32, parts: Vec<(Part, i64)> },
}

/// What names a condition.
#[derive(Clone, Copy, Debug)]
pub(super) enum Part {
    /// A point of an edge that is not below a side.
    Point { side: u8, edge: u32, share: u32 },
    /// A corner that is not beyond a part of the boundary, from a point of an edge to one of another.
    Corner { corner: u8, first: (u32, u32), last: (u32, u32), normal: [i64; 2] },
}

/// A node of the tree.
pub(super) enum Node {
    Leaf(Reason),
    /// The coordinate that is split, and both halves.
    Split(usize, [usize; 2]),
}

/// The tree, in the form of the certificate.
#[derive(Default)]
pub(super) struct Log {
    pub(super) tree: String,
    pub(super) leaves: Vec<Vec<i64>>,
}

/// Letters of the corners and of the center.
const PLACES: [char; 5] = ['w', 'x', 'y', 'z', 'c'];

/// Letters of the coordinates that are split.
const SPLITS: [char; 5] = ['0', '1', '2', '3', 'm'];

/// The tree depth first, and the entries of its leaves with edges by the rows at which they begin.
pub(super) fn log(nodes: &[Node], rows: &[u64]) -> Log {
    let row = |edge: u32| rows[edge as usize] as i64;
    let mut log = Log::default();
    let mut pending = if nodes.is_empty() { vec![] } else { vec![0] };
    while let Some(node) = pending.pop() {
        match &nodes[node] {
            Node::Leaf(Reason::Small) => log.tree.push('s'),
            Node::Leaf(Reason::Outside(place)) => log.tree.push(PLACES[*place]),
            Node::Leaf(Reason::Entered(edge, share)) => {
                log.tree.push('e');
                log.leaves.push(vec![row(*edge), i64::from(*share)]);
            }
            Node::Leaf(Reason::Weighted { bits, parts }) => {
                log.tree.push('b');
                let mut leaf = vec![i64::from(*bits)];
                for (part, weight) in parts {
                    match *part {
                        Part::Point { side, edge, share } => {
                            leaf.extend([i64::from(side), row(edge), i64::from(share)]);
                        }
                        Part::Corner { corner, first, last, normal } => {
                            leaf.push(4 + i64::from(corner));
                            for (edge, share) in [first, last] {
                                leaf.extend([row(edge), i64::from(share)]);
                            }
                            leaf.extend(normal);
                        }
                    }
                    leaf.push(*weight);
                }
                log.leaves.push(leaf);
            }
            Node::Split(coordinate, [below, above]) => {
                log.tree.push(SPLITS[*coordinate]);
                pending.extend([*above, *below]);
            }
        }
    }
    log
}
