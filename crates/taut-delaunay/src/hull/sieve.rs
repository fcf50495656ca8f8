//! Points of space that are certainly within the hull, found by two comparisons each.
//!
//! *Idea.* A few of the points span a polytope already. An ellipsoid along the axes and a box, as large as fit into it around the
//! middle of its box, hold most points of most sets; these are inside the polytope, and no corner of the hull.
//! *Guarantee.* What is left out is strictly inside the hull. A height over the plane of a facet is computed to within the facet's
//! margin. For p in the box of the corners, whose middle is c, the height of p is at most that of c plus n·(p − c), with n the
//! computed normal, up to another margin; and n·(p − c) is at most the norm of n, or its sum, in units of the half box, times the norm
//! of p − c, or its largest coordinate. Roundings of these few operations are below what [`SHRINK`] leaves.

use std::ops::Range;

use taut_points::parallel::ParallelSlice;
use taut_points::{Monitor, Scalar};

use super::Scaled;
use super::quickhull::QuickHull;
use super::space::extremes;
use crate::Error;
use crate::affine::{Span, span_of_space};
use crate::geometry::Bounds;

/// Of so many points one is in the sample, at least [`SAMPLE_MIN`] in all.
const SAMPLE_STEP: usize = 64;
const SAMPLE_MIN: usize = 4096;

/// By this the ellipsoid and the box are made smaller: far more than all roundings of their sizes and of the comparisons.
const SHRINK: f64 = 1.0 - 1e-9;

/// An ellipsoid and a box along the axes around one center, inside a polytope.
struct Core {
    center: [f64; 3],
    /// One over half the extent of the polytope along each axis.
    unit: [f64; 3],
    /// The square of the radius of the ellipsoid in these units.
    radius_squared: f64,
    /// Half the side of the box in these units.
    half_side: f64,
}

impl Core {
    /// The core of a finished hull; none if it has no room for one.
    fn of(polytope: &QuickHull) -> Option<Self> {
        let Bounds { low, high } = Bounds::of(polytope.sites.iter().copied());
        let center: [f64; 3] = std::array::from_fn(|i| 0.5 * (low[i] + high[i]));
        let half: [f64; 3] = std::array::from_fn(|i| 0.5 * (high[i] - low[i]));
        let (mut radius, mut half_side) = (1.0f64, 1.0f64);
        for (_, facet) in polytope.facets() {
            let plane = facet.plane;
            let depth = -(plane.height(center) + 2.0 * plane.margin);
            let reach: [f64; 3] = std::array::from_fn(|i| (plane.normal[i] * half[i]).abs());
            let norm = reach.iter().map(|x| x * x).sum::<f64>().sqrt();
            radius = radius.min(depth / norm);
            half_side = half_side.min(depth / reach.iter().sum::<f64>());
        }
        let unit = half.map(|x| 1.0 / x);
        let (radius, half_side) = (SHRINK * radius, SHRINK * half_side);
        let is_sound = radius > 0.0 && half_side > 0.0 && unit.iter().all(|x| x.is_finite());
        is_sound.then_some(Self { center, unit, radius_squared: radius * radius, half_side })
    }

    /// True only for points strictly inside the polytope.
    #[inline(always)]
    fn holds(&self, p: [f64; 3]) -> bool {
        let q: [f64; 3] = std::array::from_fn(|i| (p[i] - self.center[i]) * self.unit[i]);
        let in_ellipsoid = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] < self.radius_squared;
        let in_box = (q[0].abs() < self.half_side)
            & (q[1].abs() < self.half_side)
            & (q[2].abs() < self.half_side);
        in_ellipsoid | in_box
    }
}

/// The rows of points that are not certainly inside the hull, ascending.
pub(super) fn candidates<T: Scalar>(
    points: &Scaled<'_, T, 3>,
    tasks: &[Range<usize>],
    monitor: &Monitor<'_>,
) -> Result<Vec<u32>, Error> {
    let all = || (0..points.len() as u32).collect();
    let step = SAMPLE_STEP.min(points.len() / SAMPLE_MIN);
    if step < 2 {
        return Ok(all());
    }
    let sample: Vec<u32> = (0..points.len() as u32).step_by(step).collect();
    let rows = extremes(points, &sample, monitor)?;
    let corners: Vec<[f64; 3]> = rows.iter().map(|&i| points.at(i as usize)).collect();
    let Span::Full(start) = span_of_space(&corners) else { return Ok(all()) };
    let mut polytope = QuickHull::new(corners, rows, start, true);
    polytope.run(monitor)?;
    let Some(core) = Core::of(&polytope) else { return Ok(all()) };
    let of_task = |task: &Range<usize>| -> Result<Vec<u32>, Error> {
        monitor.check()?;
        // Written without a branch, as which points stay is nothing a processor could foresee.
        let (mut kept, mut count) = (vec![0; task.len()], 0);
        for i in task.clone() {
            kept[count] = i as u32;
            count += usize::from(!core.holds(points.at(i)));
        }
        kept.truncate(count);
        Ok(kept)
    };
    Ok(tasks.par_iter().map(of_task).collect::<Result<Vec<_>, Error>>()?.concat())
}

#[cfg(test)]
mod tests {
    use taut_points::Points;

    use super::*;
    use crate::numbers::numbers;
    use crate::sites::{largest_magnitude, normalization};

    type Map<'a> = &'a dyn Fn(&[f64; 3]) -> [f64; 3];

    /// Most points are left out, also far from the origin; of thin and skew sets, where extremes in 26 directions span little,
    /// perhaps few. Of the hull none is.
    #[test]
    fn no_corner_of_the_hull_is_left_out() {
        let uniform = numbers(90_000, 1);
        let sums = numbers(12 * 90_000, 2);
        let normal: Vec<f64> = sums.chunks_exact(12).map(|x| x.iter().sum::<f64>() - 6.0).collect();
        let thin = |x: &[f64; 3]| [x[0] * 1e6, x[1], x[2] * 1e-6];
        let far = |x: &[f64; 3]| [x[0] + 1e7, x[1] - 1e7, x[2] + 1e7];
        let skew = |x: &[f64; 3]| [x[0], x[0] + 0.1 * x[1], x[1] + 0.1 * x[2]];
        for (values, share) in [(&uniform, 0.6), (&normal, 0.9)] {
            let maps: [(Map<'_>, f64); 3] = [(&thin, 0.0), (&far, share), (&skew, 0.0)];
            for (map, share) in maps {
                let values: Vec<f64> = values.as_chunks::<3>().0.iter().flat_map(map).collect();
                let points = Points::new(&values, 3).expect("whole rows");
                let largest = largest_magnitude(&points).expect("finite");
                let (scale, _, filtered) = normalization(&points, largest);
                assert!(filtered);
                let scaled = Scaled { points: &points, scale, filtered };
                let tasks = [0..10_000, 10_000..30_000];
                let kept = candidates(&scaled, &tasks, &Monitor::silent()).expect("not stopped");
                assert!(kept.len() <= ((1.0 - share) * 30_000.0) as usize, "{}", kept.len());
                let sites: Vec<[f64; 3]> = kept.iter().map(|&i| scaled.at(i as usize)).collect();
                let Span::Full(start) = span_of_space(&sites) else { panic!("a volume") };
                let mut hull = QuickHull::new(sites, kept.clone(), start, true);
                hull.run(&Monitor::silent()).expect("not stopped");
                for i in (0..30_000u32).filter(|i| kept.binary_search(i).is_err()) {
                    assert_eq!(hull.beyond(scaled.at(i as usize)), None);
                }
            }
        }
    }
}
