//! Where polylines meet themselves or one another.
//!
//! *Problem.* Count the pairs of edges with a point in common that they may not have: neighbors along a curve may share their
//! vertex and nothing else, all others nothing at all.
//! *Idea.* Pairs that share a cell of a grid, in each cell by a sweep over x; exact signs decide.
//! *Guarantee.* No pair is missed or counted twice, and rounding plays no part. Repeated vertices in a row count as one.
//! *Trap.* Neighbors can fold back on each other: three points on a line, the middle one at the end.

use taut_points::OrderBy;
use taut_predicates::Sign;
use taut_predicates::plane::{lexicographic, orient};

use crate::Polyline;
use crate::grid::{Grid, Segment};

/// The number of pairs of edges that meet though they are not neighbors, or overlap though they are.
///
/// ```
/// use taut_mesh::{Polyline, crossings};
/// let eight = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
/// assert_eq!(crossings(&[Polyline { vertices: &eight, closed: true }]), 1);
/// assert_eq!(crossings(&[Polyline { vertices: &eight[..3], closed: true }]), 0);
/// ```
pub fn crossings(curves: &[Polyline<'_>]) -> usize {
    let mut segments: Vec<Segment> = Vec::new();
    // Of each curve the first edge, one past the last, and whether it closes.
    let mut curve_of: Vec<u32> = Vec::new();
    let mut ranges: Vec<(u32, u32, bool)> = Vec::new();
    for (number, curve) in curves.iter().enumerate() {
        let first = segments.len() as u32;
        segments.extend(curve.edges().filter(|(a, b)| a != b));
        curve_of.resize(segments.len(), number as u32);
        ranges.push((first, segments.len() as u32, curve.closed));
    }
    let Some(grid) = Grid::new(&segments) else { return 0 };
    let neighbors = |i: u32, j: u32| {
        let (first, end, closed) = ranges[curve_of[i as usize] as usize];
        let after = |i: u32, j: u32| j == i + 1 || (closed && i + 1 == end && j == first);
        // Two edges that close are neighbors at both ends; either view sees them overlap.
        if curve_of[i as usize] != curve_of[j as usize] {
            None
        } else if after(i, j) {
            Some((i, j))
        } else {
            after(j, i).then_some((j, i))
        }
    };
    let mut meeting: Vec<(u32, u32)> = Vec::new();
    let mut here: Vec<(f64, f64, u32)> = Vec::new();
    for list in grid.lists() {
        here.clear();
        here.extend(list.iter().map(|&i| {
            let (a, b) = segments[i as usize];
            (a[0].min(b[0]), a[0].max(b[0]), i)
        }));
        here.order_by(&|a, b| a.0.total_cmp(&b.0));
        for (place, &(_, right, i)) in here.iter().enumerate() {
            for &(_, _, j) in here[place + 1..].iter().take_while(|other| other.0 <= right) {
                let bad = match neighbors(i, j) {
                    Some((before, after)) => {
                        folds(segments[before as usize], segments[after as usize])
                    }
                    None => meet(segments[i as usize], segments[j as usize]),
                };
                if bad {
                    meeting.push((i.min(j), i.max(j)));
                }
            }
        }
    }
    meeting.sort_unstable();
    meeting.dedup();
    meeting.len()
}

/// Returns true if the second edge, which begins where the first ends, leads back along it.
fn folds((a, b): Segment, (_, c): Segment) -> bool {
    orient(a, b, c).is_zero() && lexicographic(a, b) == lexicographic(c, b)
}

/// Returns true if two segments have a point in common.
pub(crate) fn meet((a, b): Segment, (c, d): Segment) -> bool {
    if (0..2).any(|k| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k])) {
        return false;
    }
    // Boxes meet: what is on one line meets then as well.
    let apart = |a, b, c, d| {
        let (left, right): (Sign, Sign) = (orient(a, b, c), orient(a, b, d));
        left == right && !left.is_zero()
    };
    !apart(a, b, c, d) && !apart(c, d, a, b)
}
