//! All edges of all curves in one list, with a tree over them.

use super::super::CurveComponent;
use super::tree::Tree;

/// The edges, curve after curve, each in its order.
pub(super) struct Edges {
    /// The vertices of all curves, as they are given.
    pub(super) exact: Vec<[f64; 2]>,
    /// The same times `scale`.
    pub(super) points: Vec<[f64; 2]>,
    /// A power of two that keeps squares in range; 1 for all but extreme inputs.
    pub(super) scale: f64,
    /// What scaling may have taken of a coordinate: 0 where all scaled coordinates of vertices and rows are exact.
    pub(super) lost: f64,
    /// The vertices of each edge; of a curve of one vertex, twice the same.
    pub(super) ends: Vec<[usize; 2]>,
    /// Where the vertices of each curve begin; one more entry at the end.
    pub(super) first_vertex: Vec<usize>,
    /// Where the edges of each curve begin; one more entry at the end.
    pub(super) first_edge: Vec<usize>,
    pub(super) tree: Tree,
}

impl Edges {
    pub(super) fn of(curves: &[CurveComponent], rows: &[[f64; 2]]) -> Self {
        let (mut exact, mut ends) = (vec![], vec![]);
        let (mut first_vertex, mut first_edge) = (vec![0], vec![0]);
        for one in curves {
            let (base, count) = (exact.len(), one.vertices.len());
            exact.extend_from_slice(&one.vertices);
            ends.extend((1..count).map(|k| [base + k - 1, base + k]));
            if one.closed || count == 1 {
                ends.push([base + count - 1, base]);
            }
            first_vertex.push(exact.len());
            first_edge.push(ends.len());
        }
        // Rows far from every vertex are no reason to lose the curve among them.
        let size =
            |points: &[[f64; 2]]| points.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        let largest = match size(&exact) {
            0.0 => size(rows),
            largest => largest,
        };
        let scale = match largest {
            largest if largest > 1e-100 && largest < 1e100 || largest == 0.0 => 1.0,
            largest => 2f64.powi(-(largest.log2() as i32).clamp(-1000, 1000)),
        };
        // Coordinates far smaller than the largest underflow beside it.
        let is_exact = |x: &f64| x * scale / scale == *x || (x * scale).is_infinite();
        let all_exact = exact.iter().chain(rows).flatten().all(is_exact);
        let lost = if all_exact { 0.0 } else { f64::from_bits(1) };
        let points: Vec<[f64; 2]> = exact.iter().map(|p| p.map(|x| x * scale)).collect();
        let tree = Tree::of(ends.iter().map(|&[a, b]| [points[a], points[b]]));
        Edges { exact, points, scale, lost, ends, first_vertex, first_edge, tree }
    }

    /// A scaled length in units of the input, rounded up.
    pub(super) fn unscaled(&self, length: f64) -> f64 {
        let found = length / self.scale;
        if found * self.scale < length { found.next_up() } else { found }
    }

    /// The curve of an edge, and the vertex that it begins at, counted within the curve.
    pub(super) fn name(&self, edge: usize) -> (usize, usize) {
        let curve = self.first_edge.partition_point(|&first| first <= edge) - 1;
        (curve, edge - self.first_edge[curve])
    }

    #[inline(always)]
    pub(super) fn segment(&self, edge: usize) -> [[f64; 2]; 2] {
        let [from, to] = self.ends[edge];
        [self.points[from], self.points[to]]
    }
}
