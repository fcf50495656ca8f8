//! The convex hull in space.
//!
//! *Idea.* First a [`sieve`](super::sieve) of two comparisons for each point. Then the extreme points in 26 directions span a polytope;
//! nothing strictly inside it is extreme, and in most sets that is almost everything. The rest goes to [`quickhull`](super::quickhull).
//! *Degenerate sets* are found by exact signs. Points of a plane are projected along an axis to where the plane is not flat, which
//! changes no turn, and the hull of the plane is taken.

use std::ops::Range;

use taut_points::parallel::ParallelSlice;
use taut_points::{Monitor, Scalar};
use taut_predicates::space::lexicographic;
use taut_predicates::{Sign, plane::orient};

use super::faces::finish;
use super::plane::chain;
use super::quickhull::QuickHull;
use super::sieve::candidates;
use super::{ConvexHull, Scaled};
use crate::Error;
use crate::affine::{Span, span_of_space};

/// Fewer points than this are not filtered.
const FILTER_MIN: usize = 512;
/// Points of one task.
const TASK: usize = 1 << 14;
/// Points whose extremes are sought together: only a block that holds a new extreme is searched for it.
const BLOCK: usize = 256;

/// One of each pair of opposite directions to the faces, edges and corners of a cube.
const AXES: usize = 13;

#[inline(always)]
fn along([x, y, z]: [f64; 3]) -> [f64; AXES] {
    let (sum, difference) = (x + y, x - y);
    [
        x,
        y,
        z,
        sum,
        difference,
        x + z,
        x - z,
        y + z,
        y - z,
        sum + z,
        sum - z,
        difference + z,
        difference - z,
    ]
}

pub(super) fn hull<T: Scalar>(
    points: &Scaled<'_, T, 3>,
    monitor: &Monitor<'_>,
) -> Result<ConvexHull, Error> {
    if points.len() >= FILTER_MIN && points.filtered {
        let tasks: Vec<Range<usize>> = (0..points.len())
            .step_by(TASK)
            .map(|begin| begin..points.len().min(begin + TASK))
            .collect();
        let candidates = candidates(points, &tasks, monitor)?;
        let rows = extremes(points, &candidates, monitor)?;
        let corners: Vec<[f64; 3]> = rows.iter().map(|&i| points.at(i as usize)).collect();
        if let Span::Full(start) = span_of_space(&corners) {
            let mut quick = QuickHull::new(corners, rows, start, true);
            quick.run(monitor)?;
            let rest = beyond(points, &candidates, &quick, monitor)?;
            quick.add(rest.into_iter().map(|(i, facet)| (points.at(i as usize), i, facet)));
            quick.run(monitor)?;
            return Ok(finish(&quick));
        }
    }
    // Few points, or points of a plane: sorted, so that equal ones are side by side.
    let mut sites: Vec<([f64; 3], u32)> =
        (0..points.len()).map(|i| (points.at(i), i as u32)).collect();
    sites.sort_unstable_by(|(p, i), (q, j)| lexicographic(*p, *q).then(i.cmp(j)));
    sites.dedup_by(|next, kept| next.0 == kept.0);
    let (corners, rows): (Vec<[f64; 3]>, Vec<u32>) = sites.into_iter().unzip();
    match span_of_space(&corners) {
        Span::Nothing => Ok(ConvexHull::of_point(3, None)),
        Span::Point => Ok(ConvexHull::of_point(3, Some(rows[0]))),
        // In lexicographic order the ends of a line are the first and the last.
        Span::Line => Ok(ConvexHull::of_segment(3, [rows[0], rows[rows.len() - 1]])),
        Span::Plane(on) => Ok(in_plane(&corners, &rows, on)),
        Span::Full(start) => {
            let mut quick = QuickHull::new(corners, rows, start, points.filtered);
            quick.run(monitor)?;
            Ok(finish(&quick))
        }
    }
}

/// The hull of points of a plane, in which those of `on` are not on a line.
fn in_plane(corners: &[[f64; 3]], rows: &[u32], on: [u32; 3]) -> ConvexHull {
    let project = |p: [f64; 3], [i, j]: [usize; 2]| [p[i], p[j]];
    let is_flat = |axes: &[usize; 2]| {
        let [a, b, c] = on.map(|i| project(corners[i as usize], *axes));
        orient(a, b, c) == Sign::Zero
    };
    let axes = [[0, 1], [0, 2], [1, 2]].into_iter().find(|axes| !is_flat(axes)).unwrap_or([0, 1]);
    let shadow = corners.iter().zip(rows).map(|(&p, &row)| (project(p, axes), row));
    ConvexHull::of_polygon(3, chain(shadow.collect()))
}

/// Which of these rows are extreme in some direction, ascending; of equally extreme ones the first.
pub(super) fn extremes<T: Scalar>(
    points: &Scaled<'_, T, 3>,
    rows: &[u32],
    monitor: &Monitor<'_>,
) -> Result<Vec<u32>, Error> {
    type Best = [[(f64, u32); AXES]; 2];
    let of_task = |task: &[u32]| -> Result<Best, Error> {
        monitor.check()?;
        let mut best: Best = [[(f64::NEG_INFINITY, 0); AXES]; 2];
        let mut places = [[0.0; 3]; BLOCK];
        for block in task.chunks(BLOCK) {
            let (mut high, mut low) = ([f64::NEG_INFINITY; AXES], [f64::INFINITY; AXES]);
            for (&i, p) in block.iter().zip(&mut places) {
                *p = points.at(i as usize);
                let values = along(*p);
                for axis in 0..AXES {
                    high[axis] = if values[axis] > high[axis] { values[axis] } else { high[axis] };
                    low[axis] = if values[axis] < low[axis] { values[axis] } else { low[axis] };
                }
            }
            for axis in 0..AXES {
                for (side, extreme) in [(0, high[axis]), (1, -low[axis])] {
                    if extreme > best[side][axis].0 {
                        let sign = if side == 0 { 1.0 } else { -1.0 };
                        let is_extreme = |p: &[f64; 3]| sign * along(*p)[axis] == extreme;
                        let place = places[..block.len()].iter().position(is_extreme);
                        best[side][axis] = (extreme, block[place.unwrap_or(0)]);
                    }
                }
            }
        }
        Ok(best)
    };
    let found = rows.par_chunks(TASK).map(of_task).collect::<Result<Vec<Best>, Error>>()?;
    let mut rows: Vec<u32> = (0..2)
        .flat_map(|side| (0..AXES).map(move |axis| (side, axis)))
        .map(|(side, axis)| {
            let mut best = found[0][side][axis];
            for other in &found[1..] {
                if other[side][axis].0 > best.0 {
                    best = other[side][axis];
                }
            }
            best.1
        })
        .collect();
    rows.sort_unstable();
    rows.dedup();
    Ok(rows)
}

/// Which of these rows are beyond some facet of a polytope, each with the first such facet; ascending.
fn beyond<T: Scalar>(
    points: &Scaled<'_, T, 3>,
    rows: &[u32],
    polytope: &QuickHull,
    monitor: &Monitor<'_>,
) -> Result<Vec<(u32, u32)>, Error> {
    let planes = polytope.planes();
    let of_task = |task: &[u32]| -> Result<Vec<(u32, u32)>, Error> {
        monitor.check()?;
        let found = task
            .iter()
            .filter_map(|&i| Some((i, polytope.beyond_some(&planes, points.at(i as usize))?)));
        Ok(found.collect())
    };
    Ok(rows.par_chunks(TASK).map(of_task).collect::<Result<Vec<_>, Error>>()?.concat())
}
