//! Replays the subdivision and returns the upper bound of doubled areas that it proves.
//!
//! *Guarantee.* Halves cover their parent. The root holds the polygon, and with it all corners. Each triangle has counterclockwise
//! corners of which the first is a lowest one.

use std::rc::Rc;

use taut_points::{Cancelled, Monitor, ReadError};

use super::super::{TriangleCertificate, TriangleViolation};
use super::bounds::{self, PARTS_MAX, Row, is_surely_left, row_error};
use super::tile::{Tile, Tiles, point};
use crate::CheckError;
use crate::polygon::Units;

/// Nodes between two looks at the monitor.
const NODES_BETWEEN_LOOKS: usize = 1 << 10;

/// Shares of the way along an edge are whole multiples of 1 over this.
const SHARES: i64 = 1 << 16;

/// Largest coordinate of a normal in size.
const NORMAL_MAX: i64 = 1 << 30;

/// Largest exponent of the denominator of weights.
const BITS_MAX: i64 = 60;

/// Largest numerator of a weight, which is a number in double precision.
const WEIGHT_MAX: i64 = 1 << 53;

/// The range of coordinates of the root, which bounds of errors suppose.
const ROOT_RANGE: [f64; 2] = [-1.0, 3.0];

/// The boxes of the three corners.
type Cell = [Rc<Tile>; 3];

/// Returns an upper bound of the doubled areas of all triangles in the polygon, in units.
pub(super) fn replay(
    certificate: &TriangleCertificate,
    units: &Units,
    monitor: &Monitor<'_>,
) -> Result<f64, CheckError> {
    let wrong =
        |position, problem| Err(CheckError::from(TriangleViolation::Tree { position, problem }));
    let mut tiles = Tiles::of(units);
    let root = tiles.root(root(certificate, units)?);
    let mut pending: Vec<Cell> = vec![[root.clone(), root.clone(), root]];
    let (mut upper, mut leaves) = (0.0f64, certificate.leaves.iter().enumerate());
    let mut letters = certificate.tree.bytes().enumerate();
    while let Some(cell) = pending.pop() {
        let Some((position, letter)) = letters.next() else {
            return wrong(certificate.tree.len(), "is missing: cells are left over");
        };
        if position % NODES_BETWEEN_LOOKS == 0 {
            monitor.check().map_err(|cancelled: Cancelled| ReadError::from(cancelled))?;
        }
        let corners = cell.each_ref().map(|tile| &**tile);
        let error = row_error(&tiles);
        match letter {
            b'0'..=b'5' => {
                let (corner, axis) = ((letter - b'0') as usize / 2, (letter - b'0') as usize % 2);
                let Some(halves) = tiles.halves(&cell[corner], axis) else {
                    return wrong(position, "splits a box that has no middle");
                };
                let [mut below, mut above] = [cell.clone(), cell];
                [below[corner], above[corner]] = halves;
                pending.extend([above, below]);
            }
            b'a' => upper = upper.max(bounds::doubled_area(corners, &[], error)),
            b'b' | b'e' => {
                let Some((leaf, reason)) = leaves.next() else {
                    return wrong(position, "has no entry in the leaves");
                };
                let refused = |problem| TriangleViolation::Leaf { leaf, problem };
                if letter == b'b' {
                    let rows = rows(corners, reason, &tiles).map_err(refused)?;
                    // With a box that is surely outside a cell holds no triangle. The solver may not be as sure of that.
                    if !corners.iter().any(|tile| tile.is_outside) {
                        upper = upper.max(bounds::doubled_area(corners, &rows, error));
                    }
                } else {
                    has_edge_inside(corners, reason, &tiles).map_err(refused)?;
                }
            }
            b'c' => {
                let middles = corners.map(Tile::middle);
                let mean = [0, 1].map(|k| (middles[0][k] + middles[1][k] + middles[2][k]) / 3.0);
                if !(0..3).all(|side| is_left_of(mean, corners, side, error)) {
                    return wrong(position, "names a point that may not be in the triangle");
                }
                if tiles.levels.is_inside(units, mean) {
                    return wrong(position, "calls a point outside that is inside");
                }
            }
            b'l' => {
                let lowest = corners[0].low[1];
                if lowest <= corners[1].high[1] && lowest <= corners[2].high[1] {
                    return wrong(position, "speaks of a corner 0 that may be a lowest one");
                }
            }
            b'o' => {
                if !corners.iter().any(|tile| tile.is_outside) {
                    return wrong(position, "calls a box outside, but none surely is");
                }
            }
            _ => return wrong(position, "is none of 0 to 5, a, b, c, e, l and o"),
        }
    }
    if let Some((position, _)) = letters.next() {
        return wrong(position, "comes after the last cell");
    }
    match leaves.next() {
        Some((leaf, _)) => {
            Err(TriangleViolation::Leaf { leaf, problem: "belongs to no cell" }.into())
        }
        None => Ok(upper),
    }
}

/// The box of all positions, which must hold the polygon.
fn root(
    certificate: &TriangleCertificate,
    units: &Units,
) -> Result<[[f64; 2]; 2], TriangleViolation> {
    let [low, high] = certificate.root;
    let error = units.error();
    let [least, most] = ROOT_RANGE;
    let is_held = (0..2).all(|k| {
        // Twice the error, for the rounding of the sums.
        let holds = |p: &[f64; 2]| low[k] + 2.0 * error < p[k] && p[k] < high[k] - 2.0 * error;
        low[k] >= least && high[k] <= most && units.points().iter().all(holds)
    });
    match is_held {
        true => Ok([low, high]),
        false => Err(TriangleViolation::Range { what: "the root" }),
    }
}

/// Whether a point is surely left of the side that begins at a corner.
fn is_left_of(w: [f64; 2], corners: [&Tile; 3], side: usize, error: f64) -> bool {
    is_surely_left(w, corners[side], corners[(side + 1) % 3], error)
}

/// The point of an edge that a row and a share name.
fn named_point(row: i64, share: i64, tiles: &Tiles<'_>) -> Result<[f64; 2], &'static str> {
    let edge = usize::try_from(row).ok().filter(|&row| row < tiles.units.len());
    let edge = edge.ok_or("names a row that does not exist")?;
    match (0..=SHARES).contains(&share) {
        true => Ok(point(tiles.units, edge as u32, share as f64 / SHARES as f64)),
        false => Err("names a point beyond the ends of its edge"),
    }
}

/// Checks that a point of an edge is in all triangles of a cell.
fn has_edge_inside(
    corners: [&Tile; 3],
    reason: &[i64],
    tiles: &Tiles<'_>,
) -> Result<(), &'static str> {
    let &[row, share] = reason else { return Err("is not an edge and a share of its length") };
    let w = named_point(row, share, tiles)?;
    match (0..3).all(|side| is_left_of(w, corners, side, row_error(tiles))) {
        true => Ok(()),
        false => Err("names a point that may not be in the triangle"),
    }
}

/// The conditions of a leaf, each of which must hold.
fn rows(corners: [&Tile; 3], reason: &[i64], tiles: &Tiles<'_>) -> Result<Vec<Row>, &'static str> {
    let malformed = "is not an exponent and 1 to 16 parts of four numbers";
    let Some((&bits, parts)) = reason.split_first() else { return Err(malformed) };
    let (parts, rest) = parts.as_chunks::<4>();
    if !rest.is_empty() || parts.is_empty() || parts.len() > PARTS_MAX {
        return Err(malformed);
    }
    if !(0..=BITS_MAX).contains(&bits) {
        return Err("has an exponent that is not from 0 to 60");
    }
    let error = row_error(tiles);
    let of_part = |&[kind, x, y, weight]: &[i64; 4]| {
        if !(1..=WEIGHT_MAX).contains(&weight) {
            return Err("has a weight that is not from 1 to 2^53");
        }
        let weight = weight as f64 / (1u64 << bits) as f64;
        match kind {
            0..=2 => {
                let corner = kind as usize;
                let is_moderate = |x: i64| (-NORMAL_MAX..=NORMAL_MAX).contains(&x);
                if !(is_moderate(x) && is_moderate(y)) || x == 0 && y == 0 {
                    return Err("has a normal that is 0 or has a coordinate beyond 2^30");
                }
                let largest = x.abs().max(y.abs()) as f64;
                let normal = [x as f64 / largest, y as f64 / largest];
                let offset = tiles.support(corners[corner], normal) + error;
                match offset.is_finite() || corners[corner].is_outside {
                    true => Ok(Row::Half { corner, normal, offset, weight }),
                    false => Err("names a half-plane of a box without a point of the polygon"),
                }
            }
            3..=5 => {
                let side = kind as usize - 3;
                let point = named_point(x, y, tiles)?;
                match (1..3).all(|k| is_left_of(point, corners, (side + k) % 3, error)) {
                    true => Ok(Row::Side { side, point, weight }),
                    false => Err("names a point that may be right of two sides"),
                }
            }
            _ => Err("has a part of a kind other than 0 to 5"),
        }
    };
    parts.iter().map(of_part).collect()
}
