//! The convex hull in the plane.
//!
//! *Idea.* The extreme points in eight directions span an octagon; nothing strictly inside it is extreme, and in most sets that is
//! almost everything. The rest goes through the monotone chain: from left to right along the lower side, and back along the upper.
//! *Guarantee.* All turns are exact; points within edges are left out.
//! *Reference.* Andrew, *Another efficient algorithm for convex hulls in two dimensions*, 1979; Akl and Toussaint, *A fast convex
//! hull algorithm*, 1978.

use taut_points::parallel::{IntoParallel, ParallelSlice};
use taut_points::{Monitor, Scalar};
use taut_predicates::Sign;
use taut_predicates::plane::{lexicographic, orient};

use super::{ConvexHull, Scaled};
use crate::Error;
use crate::vector::difference;

/// Fewer points than this are sorted as they are.
const FILTER_MIN: usize = 256;
/// Points of one task.
const TASK: usize = 1 << 14;

/// Directions whose extreme points, on both sides, span the octagon.
const DIRECTIONS: [[f64; 2]; 4] = [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [-1.0, 1.0]];

pub(super) fn hull<T: Scalar>(
    points: &Scaled<'_, T, 2>,
    monitor: &Monitor<'_>,
) -> Result<ConvexHull, Error> {
    let candidates = candidates(points, monitor)?;
    let corners = chain(candidates.into_iter().map(|i| (points.at(i as usize), i)).collect());
    Ok(match corners[..] {
        [] => ConvexHull::of_point(2, None),
        [row] => ConvexHull::of_point(2, Some(row)),
        [a, b] => ConvexHull::of_segment(2, [a, b]),
        _ => ConvexHull::of_polygon(2, corners),
    })
}

/// The corners of the hull, counter-clockwise; one or two if all points are equal or on a line. Of equal points the lowest number
/// counts.
pub(super) fn chain(mut points: Vec<([f64; 2], u32)>) -> Vec<u32> {
    points.sort_unstable_by(|(p, i), (q, j)| lexicographic(*p, *q).then(i.cmp(j)));
    points.dedup_by(|next, kept| next.0 == kept.0);
    if points.len() < 3 {
        return points.into_iter().map(|(_, i)| i).collect();
    }
    let mut corners: Vec<([f64; 2], u32)> = Vec::new();
    let mut half = |order: &mut dyn Iterator<Item = ([f64; 2], u32)>| {
        let base = corners.len();
        for (p, i) in order {
            while corners.len() >= base + 2 {
                let [(a, _), (b, _)] = [corners[corners.len() - 2], corners[corners.len() - 1]];
                if orient(a, b, p) == Sign::Positive {
                    break;
                }
                corners.pop();
            }
            corners.push((p, i));
        }
        // The last is the first of the other half.
        corners.pop();
    };
    half(&mut points.iter().copied());
    half(&mut points.iter().rev().copied());
    corners.into_iter().map(|(_, i)| i).collect()
}

/// The points that are not certainly inside the octagon, ascending.
fn candidates<T: Scalar>(
    points: &Scaled<'_, T, 2>,
    monitor: &Monitor<'_>,
) -> Result<Vec<u32>, Error> {
    let all = || (0..points.len() as u32).collect();
    if points.len() < FILTER_MIN || !points.filtered {
        return Ok(all());
    }
    let along = |p: [f64; 2]| DIRECTIONS.map(|d| d[0] * p[0] + d[1] * p[1]);
    let tasks: Vec<std::ops::Range<usize>> = (0..points.len())
        .step_by(TASK)
        .map(|begin| begin..points.len().min(begin + TASK))
        .collect();
    // The lowest and the highest of each direction, of equal ones the first.
    let extremes = tasks
        .par_iter()
        .map(|task| -> Result<_, Error> {
            monitor.check()?;
            let mut found = [[(f64::INFINITY, 0u32), (f64::NEG_INFINITY, 0u32)]; 4];
            for i in task.clone() {
                for (value, [low, high]) in along(points.at(i)).into_iter().zip(&mut found) {
                    if value < low.0 {
                        *low = (value, i as u32);
                    }
                    if value > high.0 {
                        *high = (value, i as u32);
                    }
                }
            }
            Ok(found)
        })
        .collect::<Result<Vec<_>, Error>>()?;
    let mut best = extremes[0];
    for found in &extremes[1..] {
        for ([low, high], [other_low, other_high]) in best.iter_mut().zip(found) {
            if other_low.0 < low.0 {
                *low = *other_low;
            }
            if other_high.0 > high.0 {
                *high = *other_high;
            }
        }
    }
    let rows: Vec<u32> = best.iter().flatten().map(|&(_, i)| i).collect();
    let octagon = chain(rows.iter().map(|&i| (points.at(i as usize), i)).collect());
    if octagon.len() < 3 {
        return Ok(all());
    }
    let corners: Vec<[f64; 2]> = octagon.iter().map(|&i| points.at(i as usize)).collect();
    let extent = [best[0], best[2]].map(|[low, high]| high.0 - low.0);
    let edges: Vec<Edge> = (0..corners.len())
        .map(|i| Edge::new(corners[i], corners[(i + 1) % corners.len()], extent))
        .collect();
    let kept = tasks
        .into_par_iter()
        .map(|task| -> Result<_, Error> {
            monitor.check()?;
            let outside = |i: &u32| {
                let p = points.at(*i as usize);
                !edges.iter().all(|edge| edge.height(p) < -edge.margin)
            };
            Ok((task.start as u32..task.end as u32).filter(outside).collect::<Vec<u32>>())
        })
        .collect::<Result<Vec<_>, Error>>()?;
    Ok(kept.concat())
}

/// An edge of the octagon.
struct Edge {
    at: [f64; 2],
    outward: [f64; 2],
    /// No computed height is off by more.
    margin: f64,
}

impl Edge {
    fn new(a: [f64; 2], b: [f64; 2], extent: [f64; 2]) -> Self {
        let u = difference(b, a);
        let outward = [u[1], -u[0]];
        // As of the filter of `orient`: three roundings of differences and products, and one of the sum, of this permanent.
        let permanent = outward[0].abs() * extent[0] + outward[1].abs() * extent[1];
        Self { at: a, outward, margin: 8.0 * f64::EPSILON * permanent + f64::MIN_POSITIVE }
    }

    #[inline(always)]
    fn height(&self, p: [f64; 2]) -> f64 {
        let w = difference(p, self.at);
        self.outward[0] * w[0] + self.outward[1] * w[1]
    }
}
