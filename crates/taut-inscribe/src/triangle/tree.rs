//! The tree of a search, and its form in the certificate.

/// Why no triangle of a cell is larger than a bound.
#[derive(Clone, Debug)]
pub(super) enum Reason {
    /// The boxes alone.
    Area,
    /// Corner 0 is not a lowest one.
    Disordered,
    /// The box of some corner is outside.
    Outside,
    /// The mean of the middles of the boxes is outside.
    MeanOutside,
    /// An edge enters all triangles.
    Entered(Leaf),
    /// Conditions with weights.
    Rows(Leaf),
}

/// An entry of the leaves.
#[derive(Clone, Debug)]
pub(super) enum Leaf {
    /// A point of an edge, by a share of its length.
    Point(u32, u32),
    /// Conditions, with weights over a power of two.
    Rows { bits: u32, parts: Vec<Part> },
}

/// A condition with its weight.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// 0 to 2 for half-planes of a corner, 3 to 5 for points and sides.
    pub(super) kind: u8,
    /// The normal, or an edge and a share of its length.
    pub(super) named: [i64; 2],
    pub(super) weight: i64,
}

impl Leaf {
    /// The numbers of the certificate, with edges by the rows at which they begin.
    pub(super) fn numbers(&self, rows: &[u64]) -> Vec<i64> {
        let row = |edge: usize| rows[edge] as i64;
        match self {
            Leaf::Point(edge, share) => vec![row(*edge as usize), i64::from(*share)],
            Leaf::Rows { bits, parts } => {
                let of_part = |part: &Part| {
                    let [x, y] = part.named;
                    let first = if part.kind < 3 { x } else { row(x as usize) };
                    [i64::from(part.kind), first, y, part.weight]
                };
                let parts = parts.iter().flat_map(of_part);
                [i64::from(*bits)].into_iter().chain(parts).collect()
            }
        }
    }
}

/// The tree, in the form of the certificate.
#[derive(Default)]
pub(super) struct Log {
    pub(super) tree: String,
    pub(super) leaves: Vec<Leaf>,
}

/// A node of the tree.
pub(super) enum Node {
    Leaf(Reason),
    /// The coordinate that is split, and both halves.
    Split(u8, [usize; 2]),
}

/// The tree depth first, and the entries of its leaves.
pub(super) fn log(nodes: &[Node]) -> Log {
    let mut log = Log::default();
    let mut pending = if nodes.is_empty() { vec![] } else { vec![0] };
    while let Some(node) = pending.pop() {
        match &nodes[node] {
            Node::Leaf(Reason::Area) => log.tree.push('a'),
            Node::Leaf(Reason::Disordered) => log.tree.push('l'),
            Node::Leaf(Reason::Outside) => log.tree.push('o'),
            Node::Leaf(Reason::MeanOutside) => log.tree.push('c'),
            Node::Leaf(Reason::Entered(leaf)) => {
                log.tree.push('e');
                log.leaves.push(leaf.clone());
            }
            Node::Leaf(Reason::Rows(leaf)) => {
                log.tree.push('b');
                log.leaves.push(leaf.clone());
            }
            Node::Split(coordinate, [below, above]) => {
                log.tree.push(char::from(b'0' + coordinate));
                pending.extend([*above, *below]);
            }
        }
    }
    log
}
