//! The edges of triangles that are not between two of them.
//!
//! *Idea.* All edges, sorted: one that stands alone is of the boundary, one that stands there more than twice is where the surface
//! branches. Boundary edges are chained for drawing, as far as one can walk over unused ones, and counted as loops: largest sets of
//! them that hang together.

use std::collections::BTreeMap;

/// The properties of the edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Edges {
    /// Chains of vertices along the boundary.
    pub(super) boundary: Vec<Vec<u32>>,
    pub(super) boundary_edges: u64,
    /// Sets of boundary edges that hang together.
    pub(super) loops: u64,
    /// Edges of more than two triangles, two vertices each.
    pub(super) branching: Vec<Vec<u32>>,
}

impl Edges {
    pub(super) fn of(triangles: &[[u32; 3]]) -> Edges {
        let sides = |t: &[u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
        let mut all: Vec<[u32; 2]> = triangles
            .iter()
            .flat_map(sides)
            .filter(|[a, b]| a != b)
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        all.sort_unstable();
        let mut single = Vec::new();
        let mut edges = Edges::default();
        for same in all.chunk_by(|a, b| a == b) {
            match same.len() {
                1 => single.push(same[0]),
                2 => {}
                _ => edges.branching.push(same[0].to_vec()),
            }
        }
        edges.boundary_edges = single.len() as u64;
        edges.chain(&single);
        edges
    }

    /// Walks along edges, each once, beginning at the smallest vertex that is left.
    fn chain(&mut self, single: &[[u32; 2]]) {
        let mut ways: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (i, edge) in single.iter().enumerate() {
            for end in edge {
                ways.entry(*end).or_default().push(i);
            }
        }
        let mut walked = vec![false; single.len()];
        let mut met: BTreeMap<u32, ()> = BTreeMap::new();
        // A walk can end before its set of edges does: what hangs on it is walked before another set is begun.
        for &start in ways.keys() {
            if met.contains_key(&start) {
                continue;
            }
            self.loops += 1;
            let mut open = vec![start];
            met.insert(start, ());
            while let Some(from) = open.pop() {
                loop {
                    let mut chain = vec![from];
                    let mut at = from;
                    while let Some(&edge) = ways[&at].iter().find(|&&edge| !walked[edge]) {
                        walked[edge] = true;
                        at = if single[edge][0] == at { single[edge][1] } else { single[edge][0] };
                        chain.push(at);
                        if met.insert(at, ()).is_none() {
                            open.push(at);
                        }
                    }
                    if chain.len() == 1 {
                        break;
                    }
                    self.boundary.push(chain);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_is_one_loop_and_a_tetrahedron_none() {
        let one = Edges::of(&[[5, 7, 9]]);
        assert_eq!((one.loops, one.boundary_edges), (1, 3));
        assert_eq!(one.boundary, [vec![5, 7, 9, 5]]);
        let closed = Edges::of(&[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
        assert_eq!(closed, Edges::default());
        assert_eq!(Edges::of(&[]), Edges::default());
    }

    #[test]
    fn loops_that_meet_in_a_vertex_are_one() {
        let bow = Edges::of(&[[0, 1, 2], [2, 3, 4]]);
        assert_eq!((bow.loops, bow.boundary_edges), (1, 6));
        let drawn: usize = bow.boundary.iter().map(|chain| chain.len() - 1).sum();
        assert_eq!(drawn, 6);
        let apart = Edges::of(&[[0, 1, 2], [3, 4, 5]]);
        assert_eq!((apart.loops, apart.boundary.len()), (2, 2));
    }

    #[test]
    fn an_edge_of_three_triangles_branches_and_equal_corners_are_no_edge() {
        let book = Edges::of(&[[0, 1, 2], [0, 1, 3], [1, 0, 4]]);
        assert_eq!(book.branching, [vec![0, 1]]);
        assert_eq!(book.boundary_edges, 6);
        assert_eq!(Edges::of(&[[3, 3, 3]]), Edges::default());
        assert_eq!(Edges::of(&[[3, 3, 4]]).boundary_edges, 0);
    }
}
