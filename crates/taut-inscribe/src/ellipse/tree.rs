//! The tree of a search, and its form in the certificate.

use super::cell::Axis;

/// Why no ellipse of a cell is larger than a bound.
#[derive(Clone, Debug)]
pub(super) enum Reason {
    /// The widths of the polygon.
    Widths,
    /// All centers are outside.
    Outside,
    /// Edges with whole weights.
    Edges(Vec<(u32, u64)>),
}

/// The tree, in the form of the certificate.
#[derive(Default)]
pub(super) struct Log {
    pub(super) tree: String,
    pub(super) leaves: Vec<Vec<(u32, u64)>>,
}

/// A node of the tree.
pub(super) enum Node {
    Leaf(Reason),
    Split(Axis, [usize; 2]),
    Framed(usize),
}

/// The tree depth first, and the edges and weights of its leaves.
pub(super) fn log(nodes: &[Node]) -> Log {
    let mut log = Log::default();
    let mut pending = if nodes.is_empty() { vec![] } else { vec![0] };
    while let Some(node) = pending.pop() {
        match &nodes[node] {
            Node::Leaf(Reason::Widths) => log.tree.push('n'),
            Node::Leaf(Reason::Outside) => log.tree.push('o'),
            Node::Leaf(Reason::Edges(parts)) => {
                log.tree.push('b');
                log.leaves.push(parts.clone());
            }
            Node::Framed(child) => {
                log.tree.push('f');
                pending.push(*child);
            }
            Node::Split(axis, [below, above]) => {
                log.tree.push(match axis {
                    Axis::S => 's',
                    Axis::T => 't',
                    Axis::X => 'x',
                    Axis::Y => 'y',
                });
                pending.extend([*above, *below]);
            }
        }
    }
    log
}
