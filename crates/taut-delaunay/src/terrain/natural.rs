//! Sibson's natural-neighbor interpolant.
//!
//! *Idea.* A place takes its Voronoi cell from those of its natural neighbors; the shares are the weights of their heights. The
//! neighbors are the corners of all triangles whose circle holds the place, and these are connected: from the triangle with
//! the place one walks across facets, from tile to tile where it must be.
//! *Idea.* The weights reproduce each linear function. So the plane through the triangle with the place is taken off before, and
//! its value added after: what is left to rounding is the part of the heights that is not linear.
//! *Guarantee.* The neighbors are exact; a plane is reproduced as by [`linear`](super::linear). At a corner the value is its
//! height, on an edge of the hull, where cells have no end, the limit: linear along the edge.
//! *Reference.* Sibson, *A brief description of natural neighbour interpolation*, 1981.

use std::collections::HashSet;

use taut_points::OrderBy;
use taut_predicates::{Sign, plane};

use super::linear::{Corner, Plane, Within, on_edge, within};
use crate::Error;
use crate::outofcore::{Corners, Place, View};
use crate::query::sibson_weights;

/// Finds heights of rows.
pub(super) type HeightsOfRows<'a> = dyn Fn(&[u64]) -> Result<Vec<f64>, Error> + Sync + 'a;

/// The value at `q`, which lies in this triangle of the view.
pub(super) fn natural(
    view: &View<'_, 2>,
    triangle: u32,
    q: [f64; 2],
    heights: &HeightsOfRows<'_>,
) -> Result<f64, Error> {
    let here = view.place(triangle);
    let corners = view.corners::<3>(here)?;
    let found =
        |corners: &Corners<2, 3>, i: usize, z: &[f64]| Corner { at: corners.at[i], height: z[i] };
    // On an edge of two triangles there are two planes: the one of the smaller third corner is taken.
    let mut base = corners;
    match within(&corners.at, q) {
        Some(Within::Corner(i)) => return Ok(heights(&corners.rows[i..=i])?[0]),
        Some(Within::Edge(i)) => {
            let Some(across) = view.across(here, &corners, i) else {
                let z = heights(&corners.rows)?;
                let (a, b) = ((i + 1) % 3, (i + 2) % 3);
                return Ok(on_edge(found(&corners, a, &z), found(&corners, b, &z), q));
            };
            let other = view.corners::<3>(across)?;
            let apex = |of: &Corners<2, 3>, than: &Corners<2, 3>| {
                of.at.into_iter().find(|p| !than.at.contains(p)).unwrap_or(of.at[0])
            };
            if plane::lexicographic(apex(&other, &corners), apex(&corners, &other)).is_lt() {
                base = other;
            }
        }
        _ => {}
    }
    let neighbors = neighbors(view, here, corners, q)?;
    let rows: Vec<u64> = neighbors.iter().map(|&(_, row)| row).collect();
    let z = heights(&rows)?;
    let height_of = |row: u64| rows.iter().position(|&known| known == row).map_or(0.0, |k| z[k]);
    let base = std::array::from_fn(|i| Corner { at: base.at[i], height: height_of(base.rows[i]) });
    let base = Plane::through(base);
    let relative: Vec<[f64; 2]> =
        neighbors.iter().map(|&(p, _)| [p[0] - q[0], p[1] - q[1]]).collect();
    let mut value = base.at(q);
    let (mut low, mut high) = (value, value);
    for ((weight, &(at, _)), &height) in
        sibson_weights(&relative).into_iter().zip(&neighbors).zip(&z)
    {
        value += weight * base.excess(Corner { at, height });
        (low, high) = (low.min(height), high.max(height));
    }
    Ok(value.max(low).min(high))
}

/// The natural neighbors of a place that is no site, with their rows, in lexicographic order.
fn neighbors(
    view: &View<'_, 2>,
    first: Place,
    corners: Corners<2, 3>,
    q: [f64; 2],
) -> Result<Vec<([f64; 2], u64)>, Error> {
    let mut cavity = vec![(first, corners)];
    let mut seen = HashSet::from([first]);
    let mut next = 0;
    while next < cavity.len() {
        let (place, corners) = cavity[next];
        for i in 0..3 {
            let Some(other) = view.across(place, &corners, i) else { continue };
            if !seen.insert(other) {
                continue;
            }
            let there = view.corners::<3>(other)?;
            let [a, b, c] = there.at;
            if plane::in_circle(a, b, c, q) == Sign::Positive {
                cavity.push((other, there));
            }
        }
        next += 1;
    }
    let mut neighbors: Vec<([f64; 2], u64)> =
        cavity.iter().flat_map(|(_, corners)| corners.at.into_iter().zip(corners.rows)).collect();
    neighbors.order_by(&|a, b| plane::lexicographic(a.0, b.0));
    neighbors.dedup_by_key(|neighbor| neighbor.1);
    Ok(neighbors)
}
