//! Edges of simplices, each once.

use super::Picture;

impl Picture<'_> {
    /// The edges of the simplices that `wanted` names by their vertices, each once, ascending.
    pub(super) fn edges(&self, wanted: impl Fn(&[u32]) -> bool) -> Vec<[u32; 2]> {
        let mut edges = Vec::new();
        for simplex in self.answer().rows().filter(|simplex| wanted(simplex)) {
            for (i, &a) in simplex.iter().enumerate() {
                edges.extend(simplex[i + 1..].iter().map(|&b| [a.min(b), a.max(b)]));
            }
        }
        edges.sort_unstable();
        edges.dedup();
        edges
    }
}
