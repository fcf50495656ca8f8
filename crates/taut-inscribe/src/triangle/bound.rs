//! Upper bounds of the areas of the triangles of a cell.
//!
//! *Bound.* The doubled area p × q + q × r + r × p, less λ(p − w) × (q − w) for points w that are not left of the side pq, and plus λ(h − n·p) for
//! half-planes n·p ≤ h that hold p, is linear in each of the six coordinates alone: largest at one of the 64 choices of corners
//! of the boxes. It has a part for each side and one for each corner, which are tabled.

use taut_points::two_to;

use super::cell::Cell;
use super::gauge::{cross, turn};

/// Bound of the rounding errors of a term, as a checker may bound them: 2⁻⁴⁰.
const TERM_ERROR: f64 = two_to(-40);

/// A condition with its weight.
#[derive(Clone, Copy, Debug)]
pub(super) enum Row {
    /// The point is not left of the side that begins at a corner.
    Side { side: usize, point: [f64; 2], weight: f64 },
    /// The corner is in a half-plane n·p ≤ h.
    Half { corner: usize, normal: [f64; 2], offset: f64, weight: f64 },
}

/// The error of a condition with a weight of 1, as a checker may bound it, where coordinates are off by an error.
pub(super) fn row_error(error: f64) -> f64 {
    16.0 * error + TERM_ERROR
}

/// A bound of the doubled areas of the triangles of a cell that obey the conditions.
pub(super) fn doubled_area(cell: &Cell, rows: &[Row], error: f64) -> f64 {
    let boxes = cell.each_ref().map(|tile| tile.corners());
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
                        *value -= weight * turn(p, q, point);
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
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let mut most = f64::NEG_INFINITY;
    for i in 0..4 {
        for j in 0..4 {
            let part = sides[0][i][j] + halves[0][i] + halves[1][j];
            for k in 0..4 {
                most = larger(most, part + (sides[1][j][k] + sides[2][k][i] + halves[2][k]));
            }
        }
    }
    most + sum * error
}
