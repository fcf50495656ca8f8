//! Replays the subdivision and returns the upper bound that it proves.
//!
//! *Idea.* Each node has the edges that meet its closed cell, out of those of its parent, and the parity of its lower corner.
//! The straight path from the lower corner of a cell to that of its upper half stays in the cell, so that only edges of the cell
//! change the parity on the way. Corners are moved by an infinitely small amount into their cell: [`crate::polygon`].
//! *Guarantee.* Cells cover their parent. A cell without edges lies on one side, which its lower corner tells.

use std::cmp::Ordering;

use taut_points::{Cancelled, Monitor, ReadError};

use super::distance::{distance, rounded_up};
use crate::arithmetic::U;
use crate::circle::{CircleCertificate, CircleViolation};
use crate::polygon::{Polygon, crosses_below, crosses_left_of, orientation};
use crate::{CheckError, Violation};

/// Nodes between two looks at the monitor.
const NODES_BETWEEN_LOOKS: usize = 1 << 10;

/// Largest sum of the weights of a leaf, so that sums of them are exact: 2⁵³.
const WEIGHT_SUM_MAX: u64 = 1 << 53;

/// A cell whose turn has not come yet.
struct Pending {
    low: [f64; 2],
    high: [f64; 2],
    /// True if the lower corner is inside.
    is_inside: bool,
    /// The list of the parent is `lists[depth]`.
    depth: usize,
}

/// Returns an upper bound of the clearance of all points inside, in scaled units; 0 where there is no such point.
pub(super) fn replay(
    certificate: &CircleCertificate,
    polygon: &Polygon,
    monitor: &Monitor<'_>,
) -> Result<f64, CheckError> {
    let wrong = |position, problem| CheckError::from(CircleViolation::Tree { position, problem });
    let Some([low, high]) = polygon.bounding_box() else { return Ok(0.0) };
    let mut lists: Vec<Vec<u32>> = vec![(0..polygon.len() as u32).collect()];
    let mut pending = vec![Pending { low, high, is_inside: polygon.is_inside(low), depth: 0 }];
    let (mut upper, mut leaves) = (0.0f64, certificate.leaves.iter().enumerate());
    let mut letters = certificate.tree.bytes().enumerate();
    while let Some(cell) = pending.pop() {
        let Some((position, letter)) = letters.next() else {
            return Err(wrong(certificate.tree.len(), "is missing: cells are left over"));
        };
        if position % NODES_BETWEEN_LOOKS == 0 {
            monitor.check().map_err(|cancelled: Cancelled| ReadError::from(cancelled))?;
        }
        match letter {
            b'b' => {
                let Some((leaf, reason)) = leaves.next() else {
                    return Err(wrong(position, "has no entry in the leaves"));
                };
                let bound = bound(leaf, reason, &cell, polygon)?;
                // An overflow proves nothing.
                upper = if bound >= 0.0 { upper.max(bound) } else { f64::INFINITY };
            }
            b'o' => {
                if cell.is_inside {
                    return Err(wrong(position, "calls a cell outside that has a corner inside"));
                }
                let parents = &lists[cell.depth];
                if parents.iter().any(|&edge| meets(polygon.edge(edge as usize), &cell)) {
                    return Err(wrong(position, "calls a cell outside that an edge meets"));
                }
            }
            b'x' | b'y' => {
                let axis = usize::from(letter == b'y');
                let depth = cell.depth + 1;
                if lists.len() == depth {
                    lists.push(vec![]);
                }
                let (parents, own) = lists.split_at_mut(depth);
                own[0].clear();
                let is_here = |edge: &&u32| meets(polygon.edge(**edge as usize), &cell);
                own[0].extend(parents[depth - 1].iter().filter(is_here));
                let Some(halves) = halves(&cell, axis, depth, &own[0], polygon) else {
                    return Err(wrong(position, "splits a cell that has no middle"));
                };
                let [lower, upper] = halves;
                pending.extend([upper, lower]);
            }
            _ => return Err(wrong(position, "is none of x, y, o and b")),
        }
    }
    if let Some((position, _)) = letters.next() {
        return Err(wrong(position, "comes after the last cell"));
    }
    match leaves.next() {
        Some((leaf, _)) => {
            Err(CircleViolation::Leaf { leaf, problem: "belongs to no cell" }.into())
        }
        None => Ok(upper),
    }
}

/// The two halves of a cell at the middle of its extent along an axis; `None` where rounding leaves no middle.
fn halves(
    cell: &Pending,
    axis: usize,
    depth: usize,
    edges: &[u32],
    polygon: &Polygon,
) -> Option<[Pending; 2]> {
    let (low, high) = (cell.low, cell.high);
    // Halved first, so that the sum does not overflow.
    let middle = 0.5 * low[axis] + 0.5 * high[axis];
    let is_between = low[axis] < middle && middle < high[axis];
    if !is_between {
        return None;
    }
    let (mut below, mut above) = (high, low);
    (below[axis], above[axis]) = (middle, middle);
    let crosses = if axis == 0 { crosses_left_of } else { crosses_below };
    let crossed = edges.iter().filter(|&&edge| {
        let edge = polygon.edge(edge as usize);
        crosses(edge, low) != crosses(edge, above)
    });
    let changes = crossed.count() % 2 == 1;
    Some([
        Pending { low, high: below, is_inside: cell.is_inside, depth },
        Pending { low: above, high, is_inside: cell.is_inside != changes, depth },
    ])
}

/// Tests whether an edge meets a closed cell, exactly: neither its box nor the line through it is apart from the cell.
fn meets([a, b]: [[f64; 2]; 2], cell: &Pending) -> bool {
    let (low, high) = (cell.low, cell.high);
    if (0..2).any(|k| a[k].max(b[k]) < low[k] || a[k].min(b[k]) > high[k]) {
        return false;
    }
    let side = orientation(a, b, low);
    let others = [[high[0], low[1]], [low[0], high[1]], high];
    side == Ordering::Equal || others.iter().any(|&corner| orientation(a, b, corner) != side)
}

/// Returns the largest Σ λᵢ·dist(corner, eᵢ) of the corners of a cell, rounded up.
fn bound(leaf: usize, reason: &[u64], cell: &Pending, polygon: &Polygon) -> Result<f64, Violation> {
    let wrong = |problem| Violation::from(CircleViolation::Leaf { leaf, problem });
    let alone = |&[edge]: &[u64; 1]| [edge, 1];
    let single = reason.first_chunk::<1>().filter(|_| reason.len() == 1).map(alone);
    let pairs = match &single {
        Some(pair) => std::slice::from_ref(pair),
        None => match reason.as_chunks::<2>() {
            (pairs, []) if !pairs.is_empty() => pairs,
            _ => return Err(wrong("is neither one edge nor edges with weights")),
        },
    };
    let mut sum = 0u64;
    for &[edge, weight] in pairs {
        if edge >= polygon.len() as u64 {
            return Err(wrong("names a row that does not exist"));
        }
        let total = sum.checked_add(weight).filter(|&sum| weight > 0 && sum <= WEIGHT_SUM_MAX);
        sum = total
            .ok_or_else(|| wrong("has a weight of 0, or weights that sum to more than 2^53"))?;
    }
    let corners = [cell.low, [cell.high[0], cell.low[1]], [cell.low[0], cell.high[1]], cell.high];
    let mut upper = 0.0f64;
    for corner in corners.map(|corner| polygon.scaled_point(corner)) {
        let terms = pairs.iter().map(|&[edge, weight]| {
            weight as f64 * rounded_up(distance(corner, polygon.scaled_edge(edge as usize)))
        });
        // k products and k − 1 sums of numbers of one sign, and a quotient.
        let mean = terms.sum::<f64>() / sum as f64 * (1.0 + (2 * pairs.len() + 8) as f64 * U);
        upper = if mean >= 0.0 { upper.max(mean) } else { f64::INFINITY };
    }
    Ok(upper)
}
