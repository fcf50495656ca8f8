//! The tree of the search in the form of a certificate.

use super::cell::Axis;

/// Why a cell is done, or how it is split.
#[derive(Clone, Copy, Debug)]
pub(super) enum Node {
    /// The numbers of the halves.
    Split(Axis, [usize; 2]),
    /// The hull is no larger than the bound.
    Small,
    /// The edge enters the core.
    Entered(u32),
    /// All positions of this corner are outside.
    Outside(usize),
}

/// Letters depth first, and the edges named.
pub(super) struct Log {
    pub(super) tree: String,
    pub(super) edges: Vec<u32>,
}

/// Letters of the corners, counterclockwise from the lower left one.
const CORNERS: [char; 4] = ['1', '2', '3', '4'];

/// Writes the tree below node 0.
pub(super) fn log(nodes: &[Node]) -> Log {
    let mut log = Log { tree: String::with_capacity(nodes.len()), edges: vec![] };
    let mut pending = vec![0];
    while let Some(number) = pending.pop() {
        let letter = match nodes[number] {
            Node::Split(axis, [below, above]) => {
                pending.extend([above, below]);
                axis.letter()
            }
            Node::Small => 'm',
            Node::Entered(edge) => {
                log.edges.push(edge);
                'e'
            }
            Node::Outside(corner) => CORNERS[corner],
        };
        log.tree.push(letter);
    }
    log
}
