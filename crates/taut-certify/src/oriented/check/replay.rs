//! Replays the subdivision for a bound of the area.
//!
//! *Guarantee.* Halves cover their parent. Each rectangle has a side with a slope from −1 to 1, and its offsets are heights of points in
//! the polygon, so that it is in the root. The rectangles of interest have more than the bound, are not entered by an edge and lie
//! inside; a reason shows that a cell has none.
//! *Corners.* Let the corner be p, between sides k and k + 1, and n·p > h with n·uₖ > 0 and n·uₖ₊₁ > 0. A point q of the boundary that is
//! below the two other sides is not below both of these. If it is beyond both, then n·q ≥ n·p > h. So a part of the boundary with
//! n·q ≤ h that is connected is below one and beyond the other everywhere, always the same, while its ends differ.

use std::collections::HashMap;

use taut_points::{Cancelled, Monitor, ReadError};

use super::super::{OrientedRectangleCertificate, OrientedRectangleViolation};
use super::bounds::{PARTS_MAX, Terms};
use super::cell::{Cell, MARGIN, OFFSET_MAX};
use crate::CheckError;
use crate::polygon::{Levels, Units};

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

/// Most edges of a part of the boundary, among them those of no length between repeated rows.
const EDGES_MAX: usize = 1024;

/// The polygon about the pivot.
struct Boundary<'a> {
    units: &'a Units,
    pivot: [f64; 2],
    levels: Levels,
    /// The largest heights of vertices above the sides, by the range of slopes.
    extents: HashMap<[u64; 2], [f64; 4]>,
}

/// A cell whose turn has not come yet.
struct Pending {
    cell: Cell,
    /// The edges that may meet its hull are among `lists[list]`.
    list: usize,
}

/// Checks that no rectangle in the polygon has more than an area, in units.
pub(super) fn replay(
    certificate: &OrientedRectangleCertificate,
    units: &Units,
    area: f64,
    monitor: &Monitor<'_>,
) -> Result<(), CheckError> {
    let wrong = |position, problem| {
        CheckError::from(OrientedRectangleViolation::Tree { position, problem })
    };
    let levels = Levels::of(units);
    let mut boundary =
        Boundary { units, pivot: certificate.pivot, levels, extents: HashMap::new() };
    let is_held =
        boundary.extents(&Cell::root()).iter().all(|&extent| extent < OFFSET_MAX - MARGIN);
    if !is_held {
        return Err(wrong(0, "is a root that does not hold all rectangles about the pivot"));
    }
    let mut pending = vec![Pending { cell: Cell::root(), list: 0 }];
    let mut lists: Vec<Vec<u32>> = vec![edges_with_length(units)];
    let mut leaves = certificate.leaves.iter().enumerate();
    let mut letters = certificate.tree.bytes().enumerate();
    while let Some(Pending { cell: given, list }) = pending.pop() {
        let Some((position, letter)) = letters.next() else {
            return Err(wrong(certificate.tree.len(), "is missing: cells are left over"));
        };
        if position % NODES_BETWEEN_LOOKS == 0 {
            monitor.check().map_err(|cancelled: Cancelled| ReadError::from(cancelled))?;
        }
        // A cell that is empty needs no other reason than the one given.
        let cell = given.contracted(&boundary.extents(&given), area);
        match letter {
            b'0'..=b'3' | b'm' => {
                let coordinate = if letter == b'm' { 4 } else { (letter - b'0') as usize };
                let Some([below, above]) = given.halves(coordinate) else {
                    return Err(wrong(position, "splits a range that has no middle"));
                };
                let own = list + 1;
                if lists.len() == own {
                    lists.push(vec![]);
                }
                let (parents, rest) = lists.split_at_mut(own);
                rest[0].clear();
                if let Some(cell) = cell {
                    let hull = cell.hull();
                    let may_meet = |edge: &&u32| !cell.is_apart(&hull, boundary.edge(**edge));
                    rest[0].extend(parents[list].iter().filter(may_meet));
                }
                pending.extend([above, below].map(|cell| Pending { cell, list: own }));
            }
            b's' => {
                let is_bounded = cell.is_none_or(|cell| Terms::default().bound(&cell, area));
                if !is_bounded {
                    return Err(wrong(position, "calls a cell small that is not"));
                }
            }
            b'b' | b'e' => {
                let Some((leaf, reason)) = leaves.next() else {
                    return Err(wrong(position, "has no entry in the leaves"));
                };
                if let Some(cell) = cell {
                    let checked = match letter {
                        b'b' => boundary.is_bounded(&cell, reason, area),
                        _ => boundary.is_entered(&cell, reason),
                    };
                    checked
                        .map_err(|problem| OrientedRectangleViolation::Leaf { leaf, problem })?;
                }
            }
            b'w'..=b'z' | b'c' => {
                let point = if letter == b'c' { 4 } else { (letter - b'w') as usize };
                if let Some(cell) = cell {
                    let place = cell.place(point);
                    let is_apart = |edge: &u32| cell.is_apart(&place, boundary.edge(*edge));
                    if !lists[list].iter().all(is_apart) {
                        return Err(wrong(position, "calls a point outside that an edge may meet"));
                    }
                    if boundary.is_inside(cell.point_of(&place)) {
                        return Err(wrong(position, "calls a point outside that is inside"));
                    }
                }
            }
            _ => return Err(wrong(position, "is none of 0 to 3, m, s, b, e, w, x, y, z and c")),
        }
    }
    if let Some((position, _)) = letters.next() {
        return Err(wrong(position, "comes after the last cell"));
    }
    match leaves.next() {
        Some((leaf, _)) => {
            Err(OrientedRectangleViolation::Leaf { leaf, problem: "belongs to no cell" }.into())
        }
        None => Ok(()),
    }
}

/// The edges whose union is the boundary: an edge of no length after another edge is the end of that one. A ring without any length
/// keeps its edges.
fn edges_with_length(units: &Units) -> Vec<u32> {
    let has_length = |edge: u32| {
        let [a, b] = units.edge(edge as usize);
        a != b
    };
    let all = 0..units.len() as u32;
    let mut is_end = vec![false; units.len()];
    for edge in all.clone().filter(|&edge| has_length(edge)) {
        let mut next = units.end(edge);
        while !has_length(next) {
            is_end[next as usize] = true;
            next = units.end(next);
        }
    }
    all.filter(|&edge| !is_end[edge as usize]).collect()
}

impl Boundary<'_> {
    fn edge(&self, edge: u32) -> [[f64; 2]; 2] {
        self.units.edge(edge as usize).map(|w| [0, 1].map(|k| w[k] - self.pivot[k]))
    }

    fn is_inside(&self, p: [f64; 2]) -> bool {
        self.levels.is_inside(self.units, [0, 1].map(|k| p[k] + self.pivot[k]))
    }

    /// The largest height of a vertex above each side for the slopes of a cell.
    fn extents(&mut self, cell: &Cell) -> [f64; 4] {
        let (units, pivot) = (self.units, self.pivot);
        *self.extents.entry(cell.slopes.map(f64::to_bits)).or_insert_with(|| {
            let mut most = [f64::NEG_INFINITY; 4];
            for w in units.points() {
                let w = [0, 1].map(|k| w[k] - pivot[k]);
                for (side, most) in most.iter_mut().enumerate() {
                    *most = most.max(cell.heights(side, w)[1]);
                }
            }
            most
        })
    }

    /// The number of an edge that begins at a row.
    fn named(&self, row: i64) -> Result<u32, &'static str> {
        let edge = usize::try_from(row).ok().filter(|&row| row < self.units.len());
        edge.map(|edge| edge as u32).ok_or("names a row that does not exist")
    }

    /// The point of an edge that a share names.
    fn point(&self, edge: u32, share: i64) -> Result<[f64; 2], &'static str> {
        if !(0..=SHARES).contains(&share) {
            return Err("names a point beyond the ends of its edge");
        }
        let ([a, b], share) = (self.edge(edge), share as f64 / SHARES as f64);
        Ok([0, 1].map(|k| a[k] + share * (b[k] - a[k])))
    }

    /// Checks that a point of an edge is in all rectangles of a cell.
    fn is_entered(&self, cell: &Cell, reason: &[i64]) -> Result<(), &'static str> {
        let &[row, share] = reason else { return Err("is not an edge and a share of its length") };
        let w = self.point(self.named(row)?, share)?;
        match cell.has_core() && (0..4).all(|side| cell.is_below(side, w)) {
            true => Ok(()),
            false => Err("names a point that may not be in the rectangle"),
        }
    }

    /// Checks that the conditions of a leaf hold and bound the area.
    fn is_bounded(&self, cell: &Cell, reason: &[i64], area: f64) -> Result<(), &'static str> {
        let malformed = "is not an exponent and 1 to 16 conditions with weights";
        let Some((&bits, mut rest)) = reason.split_first() else { return Err(malformed) };
        if !(0..=BITS_MAX).contains(&bits) {
            return Err("has an exponent that is not from 0 to 60");
        }
        let weight_of = |named: i64| match (1..=WEIGHT_MAX).contains(&named) {
            true => Ok(named as f64 / (1u64 << bits) as f64),
            false => Err("has a weight that is not from 1 to 2^53"),
        };
        let (mut terms, mut parts) = (Terms::default(), 0);
        while !rest.is_empty() {
            rest = match *rest {
                [side @ 0..=3, row, share, weight, ..] => {
                    let (side, w) = (side as usize, self.point(self.named(row)?, share)?);
                    if !(1..4).all(|k| cell.is_below((side + k) % 4, w)) {
                        return Err("names a point that may be beyond two sides");
                    }
                    terms.add_point(side, w, weight_of(weight)?);
                    &rest[4..]
                }
                [kind @ 4..=7, row, share, last_row, last_share, x, y, weight, ..] => {
                    let (corner, ends) =
                        (kind as usize - 4, [(row, share), (last_row, last_share)]);
                    let (normal, offset) = self.corner(cell, corner, ends, [x, y])?;
                    terms.add_corner(corner, normal, offset, weight_of(weight)?);
                    &rest[8..]
                }
                _ => return Err(malformed),
            };
            parts += 1;
        }
        if parts == 0 || parts > PARTS_MAX {
            return Err(malformed);
        }
        match terms.bound(cell, area) {
            true => Ok(()),
            false => Err("does not bound the area"),
        }
    }

    /// The half-plane of a corner, given by a part of the boundary.
    fn corner(
        &self,
        cell: &Cell,
        corner: usize,
        [first, last]: [(i64, i64); 2],
        named: [i64; 2],
    ) -> Result<([f64; 2], f64), &'static str> {
        let is_moderate = |x: &i64| (-NORMAL_MAX..=NORMAL_MAX).contains(x);
        if !named.iter().all(is_moderate) || named == [0, 0] {
            return Err("has a normal that is 0 or has a coordinate beyond 2^30");
        }
        let size = named[0].abs().max(named[1].abs()) as f64;
        let normal = named.map(|x| x as f64 / size);
        let (one, other) = (corner, (corner + 1) % 4);
        if [one, other].iter().any(|&side| cell.heights(side, normal)[0] <= MARGIN) {
            return Err("has a normal that may not point away from the rectangle");
        }
        let (from, to) = (self.named(first.0)?, self.named(last.0)?);
        if from == to && first.1 > last.1 {
            return Err("has a part of the boundary that runs backward");
        }
        let ends = [self.point(from, first.1)?, self.point(to, last.1)?];
        let mut part = ends.to_vec();
        let mut edge = from;
        while edge != to {
            if part.len() > EDGES_MAX {
                return Err("has a part of the boundary of more than 1024 edges");
            }
            edge = self.units.end(edge);
            part.push(self.edge(edge)[0]);
        }
        let is_around = |w: &[f64; 2]| {
            cell.is_below((corner + 2) % 4, *w) && cell.is_below((corner + 3) % 4, *w)
        };
        if !part.iter().all(is_around) {
            return Err("has a part of the boundary that may be beyond an opposite side");
        }
        let parted = |[p, q]: [[f64; 2]; 2]| {
            (cell.is_below(one, p) || cell.is_beyond(other, p))
                && (cell.is_below(other, q) || cell.is_beyond(one, q))
        };
        if !(parted(ends) || parted([ends[1], ends[0]])) {
            return Err("has a part of the boundary that may not lead around its corner");
        }
        let heights = part.iter().map(|w| normal[0] * w[0] + normal[1] * w[1]);
        Ok((normal, heights.fold(f64::NEG_INFINITY, f64::max) + MARGIN))
    }
}
