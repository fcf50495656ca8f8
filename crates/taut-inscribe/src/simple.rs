//! Decides whether rings meet themselves or each other.
//!
//! *Problem.* Find two edges with a common point, other than neighbors at their common vertex.
//! *Idea.* The bounding box is split at the middle, along the axis that puts fewer edges into both halves, until a cell has few
//! edges or splitting no longer parts them; then pairs of edges are tested by exact signs, in the order of their left ends.
//! *Guarantee.* No pair is missed: two edges that meet are both in a cell that holds the point where they do. The pair that is
//! returned depends on the rings alone.
//! *Cost.* O(n log n) for rings whose edges crowd nowhere.
//! *Trap.* Neighbors can fold back on each other: three points on a line, the middle one at the end.

use taut_points::{Cancelled, Monitor};
use taut_predicates::plane::{lexicographic, orient};

use crate::polygon::{Loops, Segment};

/// Edges that are tested in pairs without splitting their cell.
const LEAF_EDGES_MAX: usize = 12;

/// Splits of a cell that follow each other; beyond that a cell is as small as rounding lets it be.
const DEPTH_MAX: usize = 100;

/// A split is worthwhile if its halves together have fewer edges than this share of the cell, in sixteenths.
const SPLIT_SHARE: usize = 28;

struct Cell {
    low: [f64; 2],
    high: [f64; 2],
    edges: Vec<u32>,
    depth: usize,
}

/// Returns two edges that meet though they must not, the lower number first. Each ring has at least three edges.
pub(crate) fn crossing(
    loops: &Loops,
    monitor: &Monitor<'_>,
) -> Result<Option<[usize; 2]>, Cancelled> {
    let segments = &loops.segments;
    let (mut low, mut high) = (segments[0][0], segments[0][0]);
    for [p, _] in segments {
        for k in 0..2 {
            (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
        }
    }
    let mut pending =
        vec![Cell { low, high, edges: (0..segments.len() as u32).collect(), depth: 0 }];
    while let Some(cell) = pending.pop() {
        monitor.check()?;
        let halves = match cell.edges.len() <= LEAF_EDGES_MAX || cell.depth == DEPTH_MAX {
            true => None,
            false => split(segments, &cell),
        };
        match halves {
            Some([lower, upper]) => pending.extend([upper, lower]),
            None => {
                if let Some(found) = in_pairs(loops, cell.edges) {
                    return Ok(Some(found));
                }
            }
        }
    }
    Ok(None)
}

/// The halves of a cell; `None` where both would have most of its edges.
fn split(segments: &[Segment], cell: &Cell) -> Option<[Cell; 2]> {
    let of_axis = |axis: usize| {
        let middle = 0.5 * cell.low[axis] + 0.5 * cell.high[axis];
        let (mut below, mut above) = (cell.high, cell.low);
        (below[axis], above[axis]) = (middle, middle);
        [(cell.low, below), (above, cell.high)].map(|(low, high)| {
            let meets = |&&edge: &&u32| meets_cell(segments[edge as usize], low, high);
            let edges = cell.edges.iter().filter(meets).copied().collect();
            Cell { low, high, edges, depth: cell.depth + 1 }
        })
    };
    let size = |halves: &[Cell; 2]| halves[0].edges.len() + halves[1].edges.len();
    let (one, other) = (of_axis(0), of_axis(1));
    let best = if size(&other) < size(&one) { other } else { one };
    (16 * size(&best) < SPLIT_SHARE * cell.edges.len()).then_some(best)
}

/// The first pair of edges that meet, in the order of their left ends.
fn in_pairs(loops: &Loops, mut edges: Vec<u32>) -> Option<[usize; 2]> {
    let left = |edge: u32| {
        let [a, b] = loops.segments[edge as usize];
        a[0].min(b[0])
    };
    edges.sort_by(|&one, &other| left(one).total_cmp(&left(other)).then(one.cmp(&other)));
    for (place, &one) in edges.iter().enumerate() {
        let [a, b] = loops.segments[one as usize];
        let right = a[0].max(b[0]);
        for &other in edges[place + 1..].iter().take_while(|&&other| left(other) <= right) {
            let (one, other) = (one.min(other) as usize, one.max(other) as usize);
            if meet_wrongly(loops, one, other) {
                return Some([one, other]);
            }
        }
    }
    None
}

/// Whether two edges, the first of a lower number, have a point in common that they may not have.
fn meet_wrongly(loops: &Loops, one: usize, other: usize) -> bool {
    let ([a, b], [c, d]) = (loops.segments[one], loops.segments[other]);
    // Edges of a ring of two would be neighbors at both ends, but a ring has three.
    match () {
        () if loops.after[one] as usize == other => folds(a, b, d),
        () if loops.after[other] as usize == one => folds(c, d, b),
        () => meet([a, b], [c, d]),
    }
}

/// Tests whether the edge from b to c leads back along the edge from a to b.
fn folds(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> bool {
    orient(a, b, c).is_zero() && lexicographic(a, b) == lexicographic(c, b)
}

/// Returns true if two segments have a point in common.
pub(crate) fn meet([a, b]: Segment, [c, d]: Segment) -> bool {
    if (0..2).any(|k| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k])) {
        return false;
    }
    // The boxes meet: segments on one line meet, then, as well.
    let on_one_side = |[a, b]: Segment, [c, d]: Segment| {
        let (left, right) = (orient(a, b, c), orient(a, b, d));
        left == right && !left.is_zero()
    };
    !on_one_side([a, b], [c, d]) && !on_one_side([c, d], [a, b])
}

/// Tests whether a segment meets a closed cell.
pub(crate) fn meets_cell([a, b]: Segment, low: [f64; 2], high: [f64; 2]) -> bool {
    if (0..2).any(|k| a[k].max(b[k]) < low[k] || a[k].min(b[k]) > high[k]) {
        return false;
    }
    let side = orient(a, b, low);
    let others = [[high[0], low[1]], [low[0], high[1]], high];
    side.is_zero() || others.iter().any(|&corner| orient(a, b, corner) != side)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn loops(rings: &[&[[f64; 2]]]) -> Loops {
        let mut loops = Loops::default();
        rings.iter().for_each(|ring| loops.push(ring));
        loops
    }

    fn found(ring: &[[f64; 2]]) -> Option<[usize; 2]> {
        crossing(&loops(&[ring]), &Monitor::silent()).unwrap()
    }

    #[test]
    fn rings_that_meet_each_other_are_found() {
        let square = |x: f64, y: f64, side: f64| {
            [[x, y], [x + side, y], [x + side, y + side], [x, y + side]]
        };
        let of = |one: &[[f64; 2]], other: &[[f64; 2]]| {
            crossing(&loops(&[one, other]), &Monitor::silent()).unwrap()
        };
        let outer = square(0.0, 0.0, 4.0);
        assert_eq!(of(&outer, &square(1.0, 1.0, 1.0)), None);
        assert_eq!(of(&outer, &square(5.0, 5.0, 1.0)), None);
        for (x, y) in [(3.5, 1.0), (0.0, 1.0), (-1.0, -1.0), (4.0, 4.0), (0.0, 0.0)] {
            let [one, other] = of(&outer, &square(x, y, 1.0)).unwrap();
            assert!(one < 4 && other >= 4, "{x}, {y}");
        }
        assert!(of(&outer, &outer).is_some());
    }

    #[test]
    fn rings_that_meet_themselves_are_found() {
        let bow = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
        assert_eq!(found(&bow), Some([0, 2]));
        let spike = [[0.0, 0.0], [4.0, 0.0], [2.0, 0.0], [2.0, 3.0]];
        assert_eq!(found(&spike), Some([0, 1]));
        let closing_spike = [[4.0, 0.0], [2.0, 0.0], [2.0, 3.0], [0.0, 0.0]];
        assert_eq!(found(&closing_spike), Some([0, 3]));
        let touching = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 0.0], [0.0, 4.0]];
        assert!(found(&touching).is_some_and(|[one, _]| one == 0));
        let line = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]];
        assert!(found(&line).is_some());
    }

    #[test]
    fn simple_rings_pass() {
        assert_eq!(found(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0]]), None);
        // A comb of long parallel edges, which no horizontal split parts.
        let comb: Vec<[f64; 2]> = (0..4000)
            .map(|i| [f64::from(i / 2), if (i + 1) % 4 < 2 { 0.0 } else { 1e3 }])
            .chain([[1999.0, -1.0], [0.0, -1.0]])
            .collect();
        assert_eq!(found(&comb), None);
    }

    #[test]
    fn pairs_agree_with_a_test_of_all() {
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 60) as f64
        };
        let (mut simple, mut crossed) = (0, 0);
        for size in 3..40 {
            for _ in 0..20 {
                let mut ring: Vec<[f64; 2]> = (0..size).map(|_| [next(), next()]).collect();
                ring.dedup();
                while ring.len() > 1 && ring.first() == ring.last() {
                    ring.pop();
                }
                if ring.len() < 3 {
                    continue;
                }
                let pairs = (0..ring.len()).flat_map(|i| (i + 1..ring.len()).map(move |j| (i, j)));
                let expected = pairs.into_iter().any(|(i, j)| meet_wrongly(&loops(&[&ring]), i, j));
                assert_eq!(found(&ring).is_some(), expected, "{ring:?}");
                *(if expected { &mut crossed } else { &mut simple }) += 1;
            }
        }
        assert!(simple > 5 && crossed > 100, "{simple} simple, {crossed} crossed");
    }
}
