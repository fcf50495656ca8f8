//! Replays the subdivision and returns the upper bound of sizes that it proves.
//!
//! *Idea.* Each node with a frame has the edges that may meet its box of centers, out of those of its parent. A box that no edge meets
//! lies on one side, which its middle tells.
//! *Guarantee.* Halves cover their parent; a frame has all centers; what lies beyond the root is bounded by the extents.
//! *Rounding.* An edge counts as meeting a box unless it is apart by more than [`SIDE_ERROR`], which is more than the errors of
//! coordinates and of the middle: moved to their exact places, no edges cross the middle.

use taut_points::{Cancelled, Monitor, ReadError};

use super::super::{EllipseCertificate, EllipseViolation};
use super::bounds::{Cell, EDGES_MAX, Frame, Part, Width};
use crate::arithmetic::{U, two_sum};
use crate::polygon::{COORDINATE_ERROR, Levels, Units};
use crate::{CheckError, Violation};

/// Nodes between two looks at the monitor.
const NODES_BETWEEN_LOOKS: usize = 1 << 10;

/// Largest sum of the weights of a leaf, so that sums of them are exact: 2⁵³.
const WEIGHT_SUM_MAX: u64 = 1 << 53;

/// Largest exponent of the root in size, so that forms do not overflow.
const EXPONENT_MAX: i32 = 200;

/// Most directions.
const DIRECTIONS_MAX: usize = 16;

/// Bound of the errors by which a box of centers is enlarged, per 1 + |m|: 2⁻⁴⁶.
const BOX_ERROR: f64 = f64::from_bits((1023 - 46) << 52);

/// Bound of the errors of coordinates in a frame and of cross products of their differences, per 1 + |m|: 2⁻⁴².
///
/// Differences are below 8 and 8·(1 + |m|) in size and off by less than 2⁻⁴⁸·(1 + |m|), so that a cross product is off by less than
/// 2⁻⁴³·(1 + |m|).
const SIDE_ERROR: f64 = f64::from_bits((1023 - 42) << 52);

/// A cell whose turn has not come yet.
struct Pending {
    cell: Cell,
    /// The edges that may meet its centers are `lists[list]`.
    list: usize,
}

/// Returns an upper bound of the sizes of all ellipses in the polygon, in units; `size` is that of the answer.
pub(super) fn replay(
    certificate: &EllipseCertificate,
    units: &Units,
    size: f64,
    monitor: &Monitor<'_>,
) -> Result<f64, CheckError> {
    let wrong = |position, problem| CheckError::from(EllipseViolation::Tree { position, problem });
    let widths = widths(certificate, units)?;
    let (root, beyond) = root(certificate, &widths)?;
    let levels = Levels::of(units);
    let mut lists: Vec<Vec<u32>> = vec![(0..units.len() as u32).collect()];
    let mut pending = vec![Pending { cell: root, list: 0 }];
    let (mut upper, mut leaves) = (beyond.sqrt(), certificate.leaves.iter().enumerate());
    let mut letters = certificate.tree.bytes().enumerate();
    while let Some(Pending { cell, list }) = pending.pop() {
        let Some((position, letter)) = letters.next() else {
            return Err(wrong(certificate.tree.len(), "is missing: cells are left over"));
        };
        if position % NODES_BETWEEN_LOOKS == 0 {
            monitor.check().map_err(|cancelled: Cancelled| ReadError::from(cancelled))?;
        }
        let mut bounded = |bound: f64| {
            // What is no number proves nothing.
            upper = if bound >= 0.0 { upper.max(bound) } else { f64::INFINITY };
        };
        match (letter, cell.frame) {
            (b'n', _) => {
                let all = widths.iter().map(|width| cell.width_bound(width));
                bounded(all.fold(f64::INFINITY, f64::min).sqrt() * (1.0 + 4.0 * U));
            }
            (b'b', Some(frame)) => {
                let Some((leaf, reason)) = leaves.next() else {
                    return Err(wrong(position, "has no entry in the leaves"));
                };
                let (parts, sum) = parts(leaf, reason, units)?;
                bounded(cell.edge_bound(&frame, &parts, sum, size));
            }
            (b'o', Some(frame)) => {
                if lists[list].iter().any(|&edge| may_meet(units.edge(edge as usize), &frame)) {
                    return Err(wrong(position, "calls centers outside that an edge may meet"));
                }
                let middle = [0, 1].map(|k| 0.5 * frame.low[k] + 0.5 * frame.high[k]);
                if levels.is_inside(units, [middle[0], middle[1] - frame.skew * middle[0]]) {
                    return Err(wrong(position, "calls centers outside that are inside"));
                }
            }
            (b'f', None) => {
                let Some(framed) = framed(&cell, units) else {
                    return Err(wrong(position, "frames shapes that have no middle"));
                };
                pending.push(Pending { cell: framed, list: 0 });
            }
            (b's' | b't', _) | (b'x' | b'y', Some(_)) => {
                let Some([below, above]) = halves(&cell, letter) else {
                    return Err(wrong(position, "splits a cell that has no middle"));
                };
                let mut own = list;
                if let Some(frame) = cell.frame {
                    own += 1;
                    if lists.len() == own {
                        lists.push(vec![]);
                    }
                    let (parents, rest) = lists.split_at_mut(own);
                    let meets = |edge: &&u32| may_meet(units.edge(**edge as usize), &frame);
                    rest[0].clear();
                    rest[0].extend(parents[list].iter().filter(meets));
                }
                pending.extend([above, below].map(|cell| Pending { cell, list: own }));
            }
            (b'b' | b'o' | b'x' | b'y', None) => {
                return Err(wrong(position, "speaks of centers before there is a frame"));
            }
            (b'f', Some(_)) => return Err(wrong(position, "is a second frame")),
            _ => return Err(wrong(position, "is none of s, t, x, y, f, n, o and b")),
        }
    }
    if let Some((position, _)) = letters.next() {
        return Err(wrong(position, "comes after the last cell"));
    }
    match leaves.next() {
        Some((leaf, _)) => {
            Err(EllipseViolation::Leaf { leaf, problem: "belongs to no cell" }.into())
        }
        None => Ok(upper),
    }
}

/// The widths of the polygon along the axes and in the directions given.
fn widths(certificate: &EllipseCertificate, units: &Units) -> Result<Vec<Width>, EllipseViolation> {
    let given = &certificate.directions;
    let largest = |n: &[f64; 2]| n[0].abs().max(n[1].abs());
    let is_moderate =
        |n: &[f64; 2]| n.iter().all(|x| x.is_finite()) && (0.5..=1.0).contains(&largest(n));
    if given.len() > DIRECTIONS_MAX || !given.iter().all(is_moderate) {
        return Err(EllipseViolation::Range { what: "a direction, or their number," });
    }
    let width = |&direction: &[f64; 2]| {
        let [n1, n2] = direction;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in units.points() {
            let at = n1 * p[0] + n2 * p[1];
            (low, high) = (low.min(at), high.max(at));
        }
        // Both ends are off by the errors of two coordinates and of three operations on numbers below 4.
        let half = 0.5 * (high - low) + 8.0 * COORDINATE_ERROR;
        Width { direction, square: half * half * (1.0 + 4.0 * U) }
    };
    Ok([[1.0, 0.0], [0.0, 1.0]].iter().chain(given).map(width).collect())
}

/// The root, and a bound of the squares of sizes beyond it.
///
/// The form of the first axis is 1/t, that of the second t + s²/t, which is at least t and at least 2|s|.
fn root(
    certificate: &EllipseCertificate,
    widths: &[Width],
) -> Result<(Cell, f64), EllipseViolation> {
    let [s, low, high] = certificate.root;
    let is_moderate = certificate.root.iter().all(|x| (-EXPONENT_MAX..=EXPONENT_MAX).contains(x));
    if !is_moderate || low >= high {
        return Err(EllipseViolation::Range { what: "the root" });
    }
    let [s, low, high] = [s, low, high].map(|power| f64::from_bits(((1023 + power) as u64) << 52));
    let beyond = [widths[0].square * low, widths[1].square / high, widths[1].square / (2.0 * s)];
    let cell = Cell { s: [-s, s], t: [low, high], frame: None };
    Ok((cell, beyond.into_iter().fold(0.0, f64::max)))
}

/// The cell with all centers, skewed as the middle of its shapes; `None` where rounding would move a shape.
fn framed(cell: &Cell, units: &Units) -> Option<Cell> {
    let [from, to] = cell.s;
    let skew = 0.5 * from + 0.5 * to;
    let ((from, one), (to, other)) = (two_sum(from, -skew), two_sum(to, -skew));
    if one != 0.0 || other != 0.0 {
        return None;
    }
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for p in units.points() {
        let p = [p[0], p[1] + skew * p[0]];
        for k in 0..2 {
            (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
        }
    }
    let error = BOX_ERROR * (1.0 + skew.abs());
    let frame = Frame { skew, low: low.map(|x| x - error), high: high.map(|x| x + error) };
    Some(Cell { s: [from, to], t: cell.t, frame: Some(frame) })
}

/// The two halves of a cell; `None` where rounding leaves no middle.
fn halves(cell: &Cell, letter: u8) -> Option<[Cell; 2]> {
    let (mut below, mut above) = (*cell, *cell);
    let middle = |low: f64, high: f64| {
        let middle = 0.5 * low + 0.5 * high;
        (low < middle && middle < high).then_some(middle)
    };
    match (letter, &mut below.frame, &mut above.frame) {
        (b's', ..) => {
            let at = middle(cell.s[0], cell.s[1])?;
            (below.s[1], above.s[0]) = (at, at);
        }
        (b't', ..) => {
            let [low, high] = cell.t;
            let at = match high > 2.0 * low {
                true => power_between(low, high),
                false => middle(low, high)?,
            };
            (below.t[1], above.t[0]) = (at, at);
        }
        (b'x' | b'y', Some(lower), Some(upper)) => {
            let k = usize::from(letter == b'y');
            let at = middle(lower.low[k], lower.high[k])?;
            (lower.high[k], upper.low[k]) = (at, at);
        }
        _ => return None,
    }
    Some([below, above])
}

/// The power of two whose exponent is the mean of those of two others, rounded down.
fn power_between(low: f64, high: f64) -> f64 {
    let exponent = |x: f64| x.to_bits() >> 52;
    f64::from_bits(((exponent(low) + exponent(high)) / 2) << 52)
}

/// The edges and weights of a leaf, and their sum.
fn parts(leaf: usize, reason: &[u64], units: &Units) -> Result<(Vec<Part>, f64), Violation> {
    let wrong = |problem| Violation::from(EllipseViolation::Leaf { leaf, problem });
    let single = reason.first_chunk::<1>().filter(|_| reason.len() == 1).map(|&[edge]| [edge, 1]);
    let pairs = match &single {
        Some(pair) => std::slice::from_ref(pair),
        None => match reason.as_chunks::<2>() {
            (pairs, []) if !pairs.is_empty() && pairs.len() <= EDGES_MAX => pairs,
            _ => return Err(wrong("is neither one edge nor at most 32 edges with weights")),
        },
    };
    let mut sum = 0u64;
    let mut found = Vec::with_capacity(pairs.len());
    for &[edge, weight] in pairs {
        if edge >= units.len() as u64 {
            return Err(wrong("names a row that does not exist"));
        }
        let total = sum.checked_add(weight).filter(|&sum| weight > 0 && sum <= WEIGHT_SUM_MAX);
        sum = total
            .ok_or_else(|| wrong("has a weight of 0, or weights that sum to more than 2^53"))?;
        found.push((units.edge(edge as usize), weight as f64));
    }
    Ok((found, sum as f64))
}

/// Whether an edge may meet a box of centers: neither its own box nor the line through it is surely apart.
fn may_meet(edge: [[f64; 2]; 2], frame: &Frame) -> bool {
    let error = SIDE_ERROR * frame.reach();
    let [a, b] = edge.map(|p| frame.skewed(p));
    let (low, high) = (frame.low.map(|x| x - error), frame.high.map(|x| x + error));
    if (0..2).any(|k| a[k].max(b[k]) < low[k] || a[k].min(b[k]) > high[k]) {
        return false;
    }
    let corners = Frame { skew: frame.skew, low, high }.corners();
    let sides = corners.map(|c| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    let is_apart =
        sides.iter().all(|&side| side > error) || sides.iter().all(|&side| side < -error);
    !is_apart
}
