//! Replays the subdivision and returns the upper bound of areas that it proves.
//!
//! *Guarantee.* Halves cover their parent, as both contain the middle. A rectangle inside whose corners are in a cell is inside the hull
//! and contains the core; its corners are inside or on edges, as they are limits of points inside.

use taut_points::{Cancelled, Monitor, ReadError};

use super::super::{RectangleCertificate, RectangleViolation};
use super::Rectangle;
use crate::CheckError;
use crate::polygon::Polygon;

/// Nodes between two looks at the monitor.
const NODES_BETWEEN_LOOKS: usize = 1 << 10;

/// All rectangles with their lower left corner in one rectangle and their upper right corner in another.
#[derive(Clone, Copy)]
struct Cell {
    lower: Rectangle,
    upper: Rectangle,
}

/// A cell whose turn has not come yet.
struct Pending {
    cell: Cell,
    /// The edges that may meet its hull are among `lists[list]`.
    list: usize,
}

/// Returns an upper bound of the areas of all rectangles along the axes in the polygon.
pub(super) fn replay(
    certificate: &RectangleCertificate,
    polygon: &Polygon,
    monitor: &Monitor<'_>,
) -> Result<f64, CheckError> {
    let wrong =
        |position, problem| CheckError::from(RectangleViolation::Tree { position, problem });
    let mut pending = vec![];
    if let Some([low, high]) = polygon.bounding_box() {
        let whole = Rectangle { low, high };
        pending.push(Pending { cell: Cell { lower: whole, upper: whole }, list: 0 });
    }
    let mut lists: Vec<Vec<u32>> = vec![(0..polygon.len() as u32).collect()];
    let (mut upper, mut edges) = (0.0f64, certificate.edges.iter().enumerate());
    let mut letters = certificate.tree.bytes().enumerate();
    while let Some(Pending { cell, list }) = pending.pop() {
        let Some((position, letter)) = letters.next() else {
            return Err(wrong(certificate.tree.len(), "is missing: cells are left over"));
        };
        if position % NODES_BETWEEN_LOOKS == 0 {
            monitor.check().map_err(|cancelled: Cancelled| ReadError::from(cancelled))?;
        }
        let edge = |number: u32| polygon.edge(number as usize);
        match letter {
            b'm' => {
                let area = cell.hull().area_up();
                // What is no number proves nothing.
                upper = if area >= 0.0 { upper.max(area) } else { f64::INFINITY };
            }
            b'e' => {
                let Some((_, &row)) = edges.next() else {
                    return Err(wrong(position, "has no entry in the edges"));
                };
                if row >= polygon.len() as u64 {
                    return Err(wrong(position, "names an edge that does not exist"));
                }
                if !cell.core().is_entered(polygon.edge(row as usize)) {
                    return Err(wrong(position, "names an edge that does not enter the core"));
                }
            }
            b'1'..=b'4' => {
                let corner = cell.corner(letter - b'1');
                if lists[list].iter().any(|&number| corner.may_meet(edge(number))) {
                    return Err(wrong(position, "calls a corner outside that an edge may meet"));
                }
                if polygon.is_inside(corner.low) {
                    return Err(wrong(position, "calls a corner outside that is inside"));
                }
            }
            b'l' | b'b' | b'r' | b't' => {
                let Some([below, above]) = cell.halves(letter) else {
                    return Err(wrong(position, "splits a range that has no middle"));
                };
                let own = list + 1;
                if lists.len() == own {
                    lists.push(vec![]);
                }
                let (parents, rest) = lists.split_at_mut(own);
                let hull = cell.hull();
                rest[0].clear();
                rest[0].extend(parents[list].iter().filter(|number| hull.may_meet(edge(**number))));
                pending.extend([above, below].map(|cell| Pending { cell, list: own }));
            }
            _ => return Err(wrong(position, "is none of l, b, r, t, m, e, 1, 2, 3 and 4")),
        }
    }
    if let Some((position, _)) = letters.next() {
        return Err(wrong(position, "comes after the last cell"));
    }
    match edges.next() {
        Some((position, _)) => Err(RectangleViolation::Edge { position }.into()),
        None => Ok(upper),
    }
}

impl Cell {
    /// All rectangles of the cell lie in this.
    fn hull(&self) -> Rectangle {
        Rectangle { low: self.lower.low, high: self.upper.high }
    }

    /// All rectangles of the cell contain this; nothing is in it where its ends are not in order.
    fn core(&self) -> Rectangle {
        Rectangle { low: self.lower.high, high: self.upper.low }
    }

    /// Where a corner of the rectangles is: 0 to 3, counterclockwise from the lower left.
    ///
    /// The ranges of two opposite sides may overlap, so that the corner's own ranges reach beyond the hull. There no rectangle has its
    /// corner, and the lists do not have all edges.
    fn corner(&self, number: u8) -> Rectangle {
        let x = if matches!(number, 1 | 2) { &self.upper } else { &self.lower };
        let y = if number >= 2 { &self.upper } else { &self.lower };
        let hull = self.hull();
        Rectangle {
            low: [x.low[0].max(hull.low[0]), y.low[1].max(hull.low[1])],
            high: [x.high[0].min(hull.high[0]), y.high[1].min(hull.high[1])],
        }
    }

    /// The two halves of a cell; `None` where rounding leaves no middle.
    fn halves(&self, letter: u8) -> Option<[Cell; 2]> {
        let k = usize::from(matches!(letter, b'b' | b't'));
        let (mut below, mut above) = (*self, *self);
        let (of_below, of_above) = match letter {
            b'l' | b'b' => (&mut below.lower, &mut above.lower),
            _ => (&mut below.upper, &mut above.upper),
        };
        let middle = 0.5 * of_below.low[k] + 0.5 * of_below.high[k];
        if !(of_below.low[k] < middle && middle < of_below.high[k]) {
            return None;
        }
        (of_below.high[k], of_above.low[k]) = (middle, middle);
        Some([below, above])
    }
}
