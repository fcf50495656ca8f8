//! The points of a node: distinct, normalized, numbered along the Hilbert curve.
//!
//! *Problem.* Points come to a node in any order and more than once. What the node does must be a function of the set.
//! *Idea.* Order them along the curve, in which equal points are side by side; the least row of a run of equal points
//! stands for it. As equal points come to one leaf, that is the least row of all.
//! *Guarantee.* Sites, their numbers and their rows are a function of the set of (point, row).

use taut_oblivious::hilbert_order;
use taut_oblivious::machine::prefetch;
use taut_points::InputError;

use crate::Error;
use crate::sites::Scale;

/// Points that are asked for ahead of their use, as they are not in the order of the curve: about the time memory takes.
pub(super) const FETCH_AHEAD: usize = 16;

/// Points with their rows, as they come.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodePoints<const D: usize> {
    /// Coordinates as given, −0 as 0.
    pub coordinates: Vec<[f64; D]>,
    /// The row of each point.
    pub rows: Vec<u64>,
}

impl<const D: usize> NodePoints<D> {
    /// No points, and room for so many.
    pub fn with_capacity(points: usize) -> Self {
        Self { coordinates: Vec::with_capacity(points), rows: Vec::with_capacity(points) }
    }

    /// Refuses coordinates that are not finite.
    pub(super) fn check(&self) -> Result<(), Error> {
        let wrong = |p: &[f64; D]| p.iter().position(|x| !x.is_finite());
        let found = self.coordinates.iter().zip(&self.rows);
        match found.filter_map(|(p, &row)| Some((row, wrong(p)?, p))).next() {
            None => Ok(()),
            Some((row, column, p)) => {
                Err(Error::Input(InputError::NonFinite { row, column, value: p[column] }))
            }
        }
    }

    /// Adds a point.
    pub fn push(&mut self, p: [f64; D], row: u64) {
        self.coordinates.push(p);
        self.rows.push(row);
    }
}

/// The distinct points of a node in order, as places among the points that came.
pub(super) struct OrderedSites {
    /// The place of each site.
    pub(super) places: Vec<u32>,
    /// The smallest row of each site.
    pub(super) rows: Vec<u64>,
    /// Every other row with the smallest row it equals; by row.
    pub(super) duplicates: Vec<[u64; 2]>,
}

/// Orders the points of a node and merges equal ones.
pub(super) fn order_sites<const D: usize>(points: &NodePoints<D>, scale: Scale) -> OrderedSites {
    let at = |i: usize| points.coordinates[i].map(|x| scale.apply(x));
    let mut places = hilbert_order(points.rows.len(), at);
    let mut rows: Vec<u64> = Vec::with_capacity(places.len());
    let mut duplicates = Vec::new();
    let mut kept = 0;
    for i in 0..places.len() {
        if let Some(&soon) = places.get(i + FETCH_AHEAD) {
            prefetch(&points.coordinates, soon as usize);
            prefetch(&points.rows, soon as usize);
        }
        let place = places[i] as usize;
        let row = points.rows[place];
        let last = kept - usize::from(kept > 0);
        let is_new =
            kept == 0 || points.coordinates[places[last] as usize] != points.coordinates[place];
        if is_new {
            places[kept] = place as u32;
            rows.push(row);
            kept += 1;
        } else {
            duplicates.push([rows[last].max(row), 0]);
            rows[last] = rows[last].min(row);
            // Which site it equals is known when its smallest row is.
            let end = duplicates.len() - 1;
            duplicates[end][1] = last as u64;
        }
    }
    places.truncate(kept);
    for pair in &mut duplicates {
        pair[1] = rows[pair[1] as usize];
    }
    duplicates.sort_unstable();
    OrderedSites { places, rows, duplicates }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sites::Magnitudes;

    #[test]
    fn the_least_row_stands_for_equal_points_whatever_their_order() {
        let mut points = NodePoints::with_capacity(6);
        for (p, row) in
            [([1.0, 2.0], 9), ([0.0, 0.0], 7), ([1.0, 2.0], 3), ([1.0, 2.0], 5), ([0.0, 0.0], 8)]
        {
            points.push(p, row);
        }
        let (scale, _) = Magnitudes { largest: 2.0, lowest: 0 }.normalization(true);
        let found = order_sites(&points, scale);
        assert_eq!(found.duplicates, [[5, 3], [8, 7], [9, 3]]);
        let mut rows = found.rows.clone();
        rows.sort_unstable();
        assert_eq!(rows, [3, 7]);
        for (&place, &row) in found.places.iter().zip(&found.rows) {
            let expected = if row == 3 { [1.0, 2.0] } else { [0.0, 0.0] };
            assert_eq!(points.coordinates[place as usize], expected);
        }
    }
}
