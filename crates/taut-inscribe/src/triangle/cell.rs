//! Cells: a box for each corner of the triangle. Corner 0 is a lowest one, and corners are counterclockwise.

use std::sync::Arc;

use super::gauge::{Triangle, minus};
use super::lines::Lines;
use super::tile::Tile;

/// Share of the length of the opposite side that counts besides its component that changes the area, so that boxes are also split
/// along directions in which the area does not change.
const NEUTRAL_SHARE: f64 = 0.3;

/// Unknowns of the linear program: six coordinates, and the products of the changes of two corners for three sides.
pub(super) const ROWS: usize = 9;

/// The boxes of the three corners.
pub(super) type Cell = [Arc<Tile>; 3];

/// The triangle of the middles of the boxes.
pub(super) fn middle(cell: &Cell) -> Triangle {
    cell.each_ref().map(|tile| tile.middle())
}

/// Whether corner 0 of no triangle is a lowest one.
pub(super) fn is_disordered(cell: &Cell) -> bool {
    let lowest = cell[0].low[1];
    lowest > cell[1].high[1] || lowest > cell[2].high[1]
}

/// The lines of each side, which begins at the corner of its number.
pub(super) fn lines(cell: &Cell) -> [Lines; 3] {
    [0, 1, 2].map(|side| Lines::of(&cell[side], &cell[(side + 1) % 3]))
}

/// How the doubled area changes across a cell: for each coordinate its gradient in the middle times half the extent of the box, and
/// for each side the largest cross product of the changes of its ends.
pub(super) fn changes(cell: &Cell) -> [f64; ROWS] {
    let p = middle(cell);
    let half = cell.each_ref().map(|tile| tile.half());
    let mut changes = [0.0; ROWS];
    for corner in 0..3 {
        let (one, other) = ((corner + 1) % 3, (corner + 2) % 3);
        let side = minus(p[other], p[one]);
        changes[2 * corner] = -side[1] * half[corner][0];
        changes[2 * corner + 1] = side[0] * half[corner][1];
        changes[6 + corner] = product(half, corner);
    }
    changes
}

/// The largest cross product of changes of both ends of the side that begins at a corner.
pub(super) fn product(half: [[f64; 2]; 3], side: usize) -> f64 {
    let (one, other) = (half[side], half[(side + 1) % 3]);
    one[0] * other[1] + one[1] * other[0]
}

/// How much is gained by splitting each coordinate.
pub(super) fn influences(cell: &Cell) -> [f64; 6] {
    let p = middle(cell);
    let half = cell.each_ref().map(|tile| tile.half());
    let mut found = [0.0; 6];
    for corner in 0..3 {
        let (one, other) = ((corner + 1) % 3, (corner + 2) % 3);
        let side = minus(p[other], p[one]);
        let reach = side[0].hypot(side[1])
            + half[one][0].max(half[one][1])
            + half[other][0].max(half[other][1]);
        for axis in 0..2 {
            let across = side[1 - axis].abs();
            found[2 * corner + axis] = half[corner][axis] * (across + NEUTRAL_SHARE * reach);
        }
    }
    found
}
