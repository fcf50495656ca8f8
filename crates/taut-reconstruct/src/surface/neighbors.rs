//! The k nearest of a set of points.
//!
//! *Idea.* The kd-tree of `taut-oblivious`, searched along a Hilbert curve, so that each search finds in the caches what the one before
//! it needed.
//! *Guarantee.* Equal distances are ordered by coordinates, so what is found depends on the points alone. O(n log n).

use std::cmp::Ordering;
use taut_points::InputError;

use taut_oblivious::hilbert_order;
use taut_oblivious::kdtree::{KdTree, Nearest};
use taut_points::parallel::ParallelSlice;

use super::spheres::Point;
use crate::Error;

/// For each point something of its nearest neighbors, the nearest first and itself among them, on all threads.
pub(super) fn of_neighbors<R: Send>(
    points: &[Point],
    count: usize,
    of: impl Fn(usize, &[Nearest]) -> R + Sync,
) -> Result<Vec<R>, Error> {
    of_neighbors_by(points, |_| count, of)
}

/// The same with a number of neighbors for each point; none are sought where that is 0.
pub(super) fn of_neighbors_by<R: Send>(
    points: &[Point],
    count: impl Fn(usize) -> usize + Sync,
    of: impl Fn(usize, &[Nearest]) -> R + Sync,
) -> Result<Vec<R>, Error> {
    let tree = KdTree::new(points).map_err(|error| refused(error, points.len()))?;
    let at = |row: u32| points[row as usize];
    // Finite, so that there is an order.
    let by_place =
        |a: u32, b: u32| at(a).partial_cmp(&at(b)).unwrap_or(Ordering::Equal).then(a.cmp(&b));
    let each = |&row: &u32| {
        let near = tree.nearest_k_by(at(row), count(row as usize), by_place);
        of(row as usize, &near)
    };
    let order = hilbert_order(points.len(), |row| points[row]);
    let found: Vec<R> = order.par_iter().with_min_len(1 << 8).map(each).collect();
    let mut by_row: Vec<Option<R>> = points.iter().map(|_| None).collect();
    order.iter().zip(found).for_each(|(&row, found)| by_row[row as usize] = Some(found));
    Ok(by_row.into_iter().flatten().collect())
}

/// For each place the nearest of some points; none if there are none.
pub(super) fn nearest_of(
    points: &[Point],
    places: &[Point],
) -> Result<Vec<Option<Nearest>>, Error> {
    let tree = KdTree::new(points).map_err(|error| refused(error, points.len()))?;
    let at = |row: u32| points[row as usize];
    let by_place =
        |a: u32, b: u32| at(a).partial_cmp(&at(b)).unwrap_or(Ordering::Equal).then(a.cmp(&b));
    let each = |&place: &Point| tree.nearest_k_by(place, 1, by_place).first().copied();
    Ok(places.par_iter().with_min_len(1 << 8).map(each).collect())
}

/// Returns what the tree refuses, as a surface says it.
fn refused(error: taut_oblivious::Error, points: usize) -> Error {
    match error {
        taut_oblivious::Error::NonFinite { row, column, value } => {
            Error::Input(InputError::NonFinite { row, column, value })
        }
        _ => {
            Error::Input(InputError::TooManyPoints { points: points as u64, most: u32::MAX.into() })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::spheres::{dot, minus};
    use super::*;

    #[test]
    fn the_nearest_are_found() {
        let mut state = 1u64;
        let mut number = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            // Few places, so that distances are often equal.
            (state >> 60) as f64
        };
        let mut points: Vec<Point> = (0..600).map(|_| [number(), number(), number()]).collect();
        points.sort_unstable_by(|a, b| a.partial_cmp(b).expect("numbers"));
        points.dedup();
        // Rows in another order than places.
        let turned: Vec<Point> = points.iter().rev().copied().collect();
        let found = of_neighbors(&turned, 9, |row, near| {
            (row, near.iter().map(|near| turned[near.row as usize]).collect::<Vec<_>>())
        });
        for (row, (own, near)) in found.expect("finite").into_iter().enumerate() {
            assert_eq!(row, own);
            let to = turned[row];
            let square = |point: &Point| dot(minus(*point, to), minus(*point, to));
            let mut all = points.clone();
            // Points are sorted, so the stable sort leaves equal distances in the order of coordinates.
            all.sort_by(|a, b| square(a).total_cmp(&square(b)));
            assert_eq!(near, all[..9]);
        }
    }
}
