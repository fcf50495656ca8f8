//! Polylines that meet themselves or one another are cut where they do.
//!
//! *Problem.* Nodes nearer to each other than their error may come out of order along the curve: a knot of a few edges. Strands
//! that were joined wrongly may cross.
//! *Idea.* Of what two edges that meet leave to choose from, the loop between them, or the rest beyond it, or an end of an open curve,
//! the part of the fewest vertices goes, the smallest parts first; and again, until no two edges meet.
//! *Guarantee.* No two edges of what is left meet but at their common vertex, by exact signs. Each round takes vertices away.

use std::ops::Range;

use taut_certify::CurveComponent;
use taut_points::{Cancelled, Monitor};

use crate::curve::chains::meeting_edges;

/// Cuts the curves; one that has nothing left has no vertices.
pub(super) fn untangle(
    curves: &mut [CurveComponent],
    monitor: &Monitor<'_>,
) -> Result<(), Cancelled> {
    loop {
        monitor.check()?;
        let polylines = Polylines::of(curves);
        let pairs = meeting_edges(&polylines.vertices, &polylines.edges);
        if pairs.is_empty() {
            return Ok(());
        }
        let mut cuts: Vec<([u32; 2], [Range<usize>; 2])> =
            pairs.iter().map(|&pair| (pair, polylines.cut(curves, pair))).collect();
        cuts.sort_by_key(|(pair, parts)| (size(parts), *pair));
        let mut is_cut = vec![false; polylines.vertices.len()];
        for (pair, parts) in cuts {
            let mut ends = pair.iter().flat_map(|&edge| polylines.edges[edge as usize]);
            if ends.all(|end| !is_cut[end as usize]) {
                parts.into_iter().for_each(|part| is_cut[part].fill(true));
            }
        }
        for (one, &first) in curves.iter_mut().zip(&polylines.first_vertex) {
            let mut cut = is_cut[first..].iter();
            one.vertices.retain(|_| cut.next() == Some(&false));
            if one.vertices.len() < if one.closed { 3 } else { 2 } {
                one.vertices.clear();
            }
        }
    }
}

fn size(parts: &[Range<usize>; 2]) -> usize {
    parts.iter().map(ExactSizeIterator::len).sum()
}

/// All curves in one list.
struct Polylines {
    vertices: Vec<[f64; 2]>,
    edges: Vec<[u32; 2]>,
    curve_of_edge: Vec<u32>,
    first_vertex: Vec<usize>,
}

impl Polylines {
    fn of(curves: &[CurveComponent]) -> Self {
        let mut all = Self {
            vertices: Vec::new(),
            edges: Vec::new(),
            curve_of_edge: Vec::new(),
            first_vertex: Vec::new(),
        };
        for (curve, one) in curves.iter().enumerate() {
            let (base, count) = (all.vertices.len() as u32, one.vertices.len() as u32);
            all.first_vertex.push(base as usize);
            all.vertices.extend_from_slice(&one.vertices);
            all.edges.extend((1..count).map(|k| [base + k - 1, base + k]));
            if one.closed && count > 0 {
                all.edges.push([base + count - 1, base]);
            }
            all.curve_of_edge.resize(all.edges.len(), curve as u32);
        }
        all
    }

    /// The fewest vertices, in one part or two, without which two edges no longer meet.
    fn cut(&self, curves: &[CurveComponent], pair: [u32; 2]) -> [Range<usize>; 2] {
        let of = |edge: u32| {
            let curve = self.curve_of_edge[edge as usize] as usize;
            let first = self.first_vertex[curve];
            (curve, first..first + curves[curve].vertices.len())
        };
        let start = |edge: u32| self.edges[edge as usize][0] as usize;
        let [(one, all), (other, others)] = pair.map(of);
        let [i, j] = pair.map(start);
        let ends = |i: usize, all: Range<usize>| [(all.start..i + 1, 0..0), (i + 1..all.end, 0..0)];
        let mut choices: Vec<(Range<usize>, Range<usize>)> = Vec::new();
        if one == other {
            choices.push((i + 1..j + 1, 0..0));
            match curves[one].closed {
                true => choices.push((all.start..i + 1, j + 1..all.end)),
                false => choices.extend([(all.start..i + 1, 0..0), (j + 1..all.end, 0..0)]),
            }
        } else {
            for (curve, at, all) in [(one, i, all), (other, j, others)] {
                match curves[curve].closed {
                    true => choices.push((all, 0..0)),
                    false => choices.extend(ends(at, all)),
                }
            }
        }
        let least = choices.into_iter().min_by_key(|(a, b)| a.len() + b.len());
        least.map_or([0..0, 0..0], |(a, b)| [a, b])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(vertices: &[[f64; 2]], closed: bool) -> CurveComponent {
        CurveComponent { vertices: vertices.to_vec(), closed, rows: vec![] }
    }

    fn left(mut curves: Vec<CurveComponent>) -> Vec<usize> {
        untangle(&mut curves, &Monitor::silent()).unwrap();
        assert!({
            let all = Polylines::of(&curves);
            meeting_edges(&all.vertices, &all.edges).is_empty()
        });
        curves.iter().map(|one| one.vertices.len()).collect()
    }

    #[test]
    fn knots_and_crossings_are_cut() {
        let knot =
            [[0.0, 0.0], [2.0, 0.0], [1.0, 0.1], [1.5, -0.1], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        assert!(left(vec![one(&knot, true)])[0] >= 5);
        let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
        assert_eq!(left(vec![one(&square, true)]), [4]);
        // An end that goes back on itself, and an open curve that reaches into a closed one.
        assert_eq!(left(vec![one(&[[0.0, 0.0], [2.0, 0.0], [1.0, 0.0]], false)]), [2]);
        let across = [[9.0, 1.0], [7.0, 1.0], [5.0, 1.0], [2.0, 1.0]];
        assert_eq!(left(vec![one(&square, true), one(&across, false)]), [4, 3]);
        // Two closed curves: one goes.
        let moved = square.map(|[x, y]| [x + 1.0, y + 1.0]);
        let mut both = left(vec![one(&square, true), one(&moved, true)]);
        both.sort_unstable();
        assert_eq!(both, [0, 4]);
    }
}
