//! Upper bounds of the areas of the triangles of a cell.
//!
//! *Sides.* Let p, q, r be the corners. If a point w of an edge is surely left of two sides, it cannot be left of the third one, say pq,
//! as it would be in the triangle: (p − w) × (q − w) ≤ 0.
//! *Half-planes.* A corner is in the polygon, so that n·p ≤ h for the largest h = n·v over the points v of the polygon in its box.
//! *Bound.* The doubled area is p × q + q × r + r × p. Less λ(p − w) × (q − w) and plus λ(h − n·p) it is not smaller, for λ ≥ 0. That sum
//! is linear in each of the six coordinates alone, so that it is largest at corners of the boxes, of which there are 64. It has a
//! part for each side and one for each corner, which are tabled.
//! *Rounding.* Coordinates are between −1 and 3. A point w is off by e and less than 2⁻⁵⁰ in each coordinate, which changes
//! (p − w) × (q − w) by less than 8e + 2⁻⁴⁷, as p − q is at most 4 in each. Rounding of a term changes it by less than 2⁻⁴⁶, and the
//! sum of at most 70 terms of at most 32 in size, and λ times that, by less than 2⁻⁴²·(1 + Σλ): [`row_error`] bounds all of these.

use super::tile::{Tile, Tiles};

/// Bound of the rounding errors of a term, for a weight of 1: 2⁻⁴¹.
const TERM_ERROR: f64 = f64::from_bits((1023 - 41) << 52);

/// Most parts of a leaf, as [`TERM_ERROR`] supposes.
pub(super) const PARTS_MAX: usize = 16;

/// A condition that all triangles of a cell obey that are in the polygon, with its weight.
pub(super) enum Row {
    /// The point is not left of the side that begins at a corner.
    Side { side: usize, point: [f64; 2], weight: f64 },
    /// The corner is in a half-plane n·p ≤ h.
    Half { corner: usize, normal: [f64; 2], offset: f64, weight: f64 },
}

/// The error of a condition with a weight of 1, where vertices are off by e.
pub(super) fn row_error(tiles: &Tiles<'_>) -> f64 {
    8.0 * tiles.units.error() + TERM_ERROR
}

fn cross(p: [f64; 2], q: [f64; 2]) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}

fn minus(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    [p[0] - q[0], p[1] - q[1]]
}

/// Whether a point is left of all lines from a point of a box to one of another, by more than an error.
pub(super) fn is_surely_left(w: [f64; 2], from: &Tile, to: &Tile, error: f64) -> bool {
    let ends = to.corners().map(|q| minus(q, w));
    from.corners().iter().all(|&p| {
        let p = minus(p, w);
        ends.iter().all(|&q| cross(p, q) > error)
    })
}

/// A bound of the doubled areas of the triangles of a cell that obey the conditions.
pub(super) fn doubled_area(corners: [&Tile; 3], rows: &[Row], error: f64) -> f64 {
    let boxes = corners.map(Tile::corners);
    let (mut sides, mut halves, mut sum) = ([[[0.0f64; 4]; 4]; 3], [[0.0f64; 4]; 3], 1.0f64);
    for (side, table) in sides.iter_mut().enumerate() {
        for (row, &p) in table.iter_mut().zip(&boxes[side]) {
            for (value, &q) in row.iter_mut().zip(&boxes[(side + 1) % 3]) {
                *value = cross(p, q);
            }
        }
    }
    for row in rows {
        match *row {
            Row::Side { side, point, weight } => {
                sum += weight;
                for (row, &p) in sides[side].iter_mut().zip(&boxes[side]) {
                    for (value, &q) in row.iter_mut().zip(&boxes[(side + 1) % 3]) {
                        *value -= weight * cross(minus(p, point), minus(q, point));
                    }
                }
            }
            Row::Half { corner, normal, offset, weight } => {
                sum += weight;
                for (value, p) in halves[corner].iter_mut().zip(&boxes[corner]) {
                    *value += weight * (offset - (normal[0] * p[0] + normal[1] * p[1]));
                }
            }
        }
    }
    let mut most = f64::NEG_INFINITY;
    for i in 0..4 {
        for j in 0..4 {
            for k in 0..4 {
                let value = sides[0][i][j] + sides[1][j][k] + sides[2][k][i];
                most = most.max(value + (halves[0][i] + halves[1][j] + halves[2][k]));
            }
        }
    }
    most + sum * error
}
