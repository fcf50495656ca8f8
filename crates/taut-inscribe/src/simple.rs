//! Decides whether rings meet themselves or each other.
//!
//! *Problem.* Find two edges with a common point, other than neighbors at their common vertex.
//! *Idea.* The tree of boxes around runs of edges is joined with itself, and edges of runs whose boxes meet are tested by exact
//! signs. Where too many boxes meet, the bounding box is split instead at the middle, along the axis that puts fewer edges into
//! both halves, until a cell has few edges or splitting no longer parts them; then pairs of edges are tested in the order of their
//! left ends.
//! *Guarantee.* No pair is missed: the boxes around two edges that meet do so as well, and both edges are in a cell that holds the
//! point where they meet. The pair that is returned depends on the rings alone.
//! *Cost.* About O(n) for outlines, and O(n log n) for other rings whose edges crowd nowhere.
//! *Trap.* Neighbors can fold back on each other: three points on a line, the middle one at the end.

use taut_points::{Cancelled, Monitor, OrderBy};
use taut_predicates::plane::{lexicographic, orient};

use crate::polygon::{Loops, Segment};
use crate::runs::{Run, Runs, bounds, overlap};

/// Pairs of runs that are looked at, per run of the lowest level, before cells are split instead. Outlines take about ten.
const RUN_PAIRS_MAX: usize = 64;

/// Pairs of runs between two looks at the monitor.
const PAIRS_BETWEEN_CHECKS: usize = 4096;

/// Edges that are tested in pairs without splitting their cell.
const LEAF_EDGES_MAX: usize = 12;

/// Splits of a cell that follow each other; beyond that a cell is as small as rounding lets it be.
const DEPTH_MAX: usize = 100;

/// A split is worthwhile if its halves together have fewer edges than this share of the cell, in sixteenths.
const SPLIT_SHARE: usize = 28;

/// A cell of the bounding box, with the edges that meet it.
struct Cell {
    low: [f64; 2],
    high: [f64; 2],
    edges: Vec<u32>,
    depth: usize,
}

/// Returns two edges that meet though they must not, the lower number first. Each ring has at least three edges.
pub(crate) fn crossing(
    loops: &Loops,
    runs: &Runs,
    monitor: &Monitor<'_>,
) -> Result<Option<[usize; 2]>, Cancelled> {
    let left = RUN_PAIRS_MAX * (runs.lowest() + 1);
    let mut join = Join { loops, runs, monitor, left };
    match join.within(runs.whole()) {
        Ok(()) => Ok(None),
        Err(End::Found(pair)) => Ok(Some(pair)),
        Err(End::Cancelled(cancelled)) => Err(cancelled),
        Err(End::Crowded) => crossing_in_cells(loops, monitor),
    }
}

/// Reasons for which the join of runs ends early.
enum End {
    Found([usize; 2]),
    Crowded,
    Cancelled(Cancelled),
}

/// The join of the runs with themselves.
struct Join<'a> {
    loops: &'a Loops,
    runs: &'a Runs,
    monitor: &'a Monitor<'a>,
    /// Pairs of runs that may still be looked at.
    left: usize,
}

impl Join<'_> {
    /// Tests all pairs of edges within a run.
    fn within(&mut self, run: Run) -> Result<(), End> {
        let children: Vec<Run> = self.runs.children(run).collect();
        if children.is_empty() {
            let edges = self.runs.edges(run);
            return edges.clone().try_for_each(|one| {
                (one + 1..edges.end).try_for_each(|other| self.test(one, other))
            });
        }
        for (i, &one) in children.iter().enumerate() {
            self.within(one)?;
            for &other in &children[i + 1..] {
                self.between(one, other)?;
            }
        }
        Ok(())
    }

    /// Tests all pairs of an edge of one run and one of a later run of the same level.
    fn between(&mut self, one: Run, other: Run) -> Result<(), End> {
        let (around, around_other) = (self.runs.bounds(one), self.runs.bounds(other));
        if !overlap(&around, &around_other) {
            return Ok(());
        }
        self.left = self.left.checked_sub(1).ok_or(End::Crowded)?;
        if self.left.is_multiple_of(PAIRS_BETWEEN_CHECKS) {
            self.monitor.check().map_err(End::Cancelled)?;
        }
        let mut is_lowest = true;
        for first in self.runs.children(one) {
            is_lowest = false;
            if overlap(&self.runs.bounds(first), &around_other) {
                for second in self.runs.children(other) {
                    self.between(first, second)?;
                }
            }
        }
        if is_lowest {
            let segments = &self.loops.segments;
            for first in self.runs.edges(one) {
                if overlap(&bounds(segments[first]), &around_other) {
                    for second in self.runs.edges(other) {
                        self.test(first, second)?;
                    }
                }
            }
        }
        Ok(())
    }

    fn test(&self, one: usize, other: usize) -> Result<(), End> {
        match meet_wrongly(self.loops, one, other) {
            true => Err(End::Found([one, other])),
            false => Ok(()),
        }
    }
}

/// Returns two edges that meet, by splitting cells.
fn crossing_in_cells(
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
    edges.order_by(&|&one, &other| left(one).total_cmp(&left(other)).then(one.cmp(&other)));
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
    lexicographic(a, b) == lexicographic(c, b) && orient(a, b, c).is_zero()
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

    /// What both methods find; they must agree on whether edges meet.
    fn found_in(rings: &[&[[f64; 2]]]) -> Option<[usize; 2]> {
        let loops = loops(rings);
        let found = crossing(&loops, &Runs::of(&loops.segments), &Monitor::silent()).unwrap();
        let in_cells = crossing_in_cells(&loops, &Monitor::silent()).unwrap();
        assert_eq!(found.is_some(), in_cells.is_some(), "{rings:?}");
        found
    }

    fn found(ring: &[[f64; 2]]) -> Option<[usize; 2]> {
        found_in(&[ring])
    }

    #[test]
    fn rings_that_meet_each_other_are_found() {
        let square = |x: f64, y: f64, side: f64| {
            [[x, y], [x + side, y], [x + side, y + side], [x, y + side]]
        };
        let of = |one: &[[f64; 2]], other: &[[f64; 2]]| found_in(&[one, other]);
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
    fn crowded_boxes_are_split_into_cells() {
        // A comb of slanted teeth, whose boxes all overlap.
        let tooth = |i: i32| {
            let (x, far) = (f64::from(i / 2), (i + 1) % 4 >= 2);
            if far { [x + 1200.0, 1200.0] } else { [x, 0.0] }
        };
        let comb: Vec<[f64; 2]> =
            (0..1200).map(tooth).chain([[599.0, -1.0], [0.0, -1.0]]).collect();
        let loops = loops(&[&comb]);
        let (runs, monitor) = (Runs::of(&loops.segments), &Monitor::silent());
        let left = RUN_PAIRS_MAX * (runs.lowest() + 1);
        let mut join = Join { loops: &loops, runs: &runs, monitor, left };
        assert!(matches!(join.within(runs.whole()), Err(End::Crowded)));
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
