//! Edges that were found beside those that are true, both as pairs of rows.

/// The numbers of edges in one of two sets and in both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EdgeScore {
    /// True edges that were found.
    pub true_found: usize,
    /// Found edges that are not true.
    pub false_found: usize,
    /// True edges that were not found.
    pub missing: usize,
}

impl EdgeScore {
    /// Returns true if the two sets are the same.
    pub fn exact(&self) -> bool {
        self.false_found == 0 && self.missing == 0
    }
}

/// Compares two sets of edges; the direction of an edge does not count, nor does it how often it is given.
///
/// ```
/// let score = taut_mesh::edge_score(&[[0, 1], [1, 2], [2, 3]], &[[1, 0], [2, 1], [1, 3]]);
/// assert_eq!((score.true_found, score.false_found, score.missing), (2, 1, 1));
/// ```
pub fn edge_score(truth: &[[u64; 2]], found: &[[u64; 2]]) -> EdgeScore {
    let sorted = |edges: &[[u64; 2]]| {
        let mut edges: Vec<[u64; 2]> = edges.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    };
    let (truth, found) = (sorted(truth), sorted(found));
    let true_found = found.iter().filter(|edge| truth.binary_search(edge).is_ok()).count();
    EdgeScore {
        true_found,
        false_found: found.len() - true_found,
        missing: truth.len() - true_found,
    }
}
