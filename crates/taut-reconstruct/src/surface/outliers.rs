//! Points that lie on no sheet.
//!
//! *Problem.* Outliers are few or many, anywhere, alone or in clusters. They vouch for each other: the neighbors of one far from all sheets
//! are others, as far from their neighbors as it is. Samples of sheets can be uneven, ten times as dense in one place as in another.
//! *Idea.* Two points are linked if each is among the nearest few of the other. A density that changes slowly keeps a sheet linked; the
//! points of a sheet do not name an outlier beside it. A component of links is on a sheet if it has enough points, and these are as near
//! to each other as most points are, or lie along planes. Other components are kept if they are as near to such a component as its own
//! points to each other. Of what is kept, points far from the sheet that the points around them fit are outliers, if they are alone there.
//! *Guarantee.* A function of the points. O(n log n).
//! *Trap.* An outlier within 0.3 spacings of a sheet, or four deviations of its noise, is a point of the sheet; so are large clusters.
//! A fit's own estimate of noise is rough, and of a thousand points with noise, two lay beyond four of its deviations; with the median of
//! the estimates around it, one in 10⁴.

use std::collections::BTreeMap;

use taut_points::Monitor;

use super::neighbors::{nearest_of, of_neighbors, of_neighbors_by};
use super::sheet_fit::{Fitting, covariance, principal};
use super::spheres::{Point, dot, minus};
use crate::Error;
use crate::tour::union::Union;

/// Nearest points, without itself, that a point can be linked to.
const LINKS: usize = 8;
/// A component has at least one point in so many on a sheet, within the next two bounds.
const POINTS_PER_COMPONENT_POINT: usize = 500;
/// Components of fewer points are on no sheet, however few points there are.
const SIZE_MIN: usize = 8;
/// Components of this many points can be on a sheet, however many points there are.
const SIZE_MAX: usize = 40;
/// Components of less than this many times the points of the smallest also have to lie along planes, as clusters of outliers do not.
const PLANE_SIZE_RATIO: usize = 4;
/// Points are as near to each other as most are, up to this factor.
const SPARSE_RATIO: f64 = 3.0;
/// Nearest points that show whether a component lies along planes.
const PLANE_NEIGHBORS: usize = 16;
/// The least variance over the sum of all three, below which points lie along a plane. (Of points all through space it is 0.18 on average.)
const PLANE_VARIANCE: f64 = 0.08;
/// A point is beside a component within this factor of the distance of links there.
const BESIDE_RATIO: f64 = 3.0;
/// Bits of a number below the bins of a histogram, which are eight for each power of two.
const BITS_BELOW_BIN: u32 = 49;
/// A point so many spacings from the sheet of its neighbors can be an outlier,
const HEIGHT_OVER_SPACING: f64 = 0.3;
/// if it is this many standard deviations of the neighbors from it, the larger of its own estimate and the median of those around,
const HEIGHT_OVER_DEVIATION: f64 = 4.0;
/// and at most this share of the neighbors are more than half as far on the same side.
const COMPANY_SHARE: f64 = 0.1;
/// Rounds of each fit.
const FIT_ROUNDS: u32 = 4;

/// By point, whether it is on no sheet as far as links tell. Points are distinct.
pub(super) fn unlinked(points: &[Point], monitor: &Monitor<'_>) -> Result<Vec<bool>, Error> {
    let near: Vec<(f64, Vec<u32>)> = of_neighbors(points, LINKS + 1, |_, near| {
        let far = near.last().map_or(0.0, |last| last.distance2.sqrt());
        (far, near.iter().map(|near| near.row).collect())
    })?;
    monitor.check()?;
    let mut union = Union::of(points.len());
    for (row, (_, list)) in (0u32..).zip(&near) {
        for &other in list {
            if other > row && near[other as usize].1.contains(&row) {
                union.join(row, other);
            }
        }
    }
    let mut components = BTreeMap::<u32, Vec<u32>>::new();
    for row in 0..points.len() as u32 {
        components.entry(union.root(row)).or_default().push(row);
    }
    let components: Vec<Vec<u32>> = components.into_values().collect();
    let usual = mode(near.iter().map(|(far, _)| *far));
    let size = (points.len() / POINTS_PER_COMPONENT_POINT).clamp(SIZE_MIN, SIZE_MAX);
    let largest = components.iter().map(Vec::len).max().unwrap_or(0);
    let is_on_sheet = |component: &Vec<u32>| -> Result<bool, Error> {
        if component.len() < size {
            return Ok(component.len() == largest);
        }
        let far = median(component.iter().map(|&row| near[row as usize].0));
        let own = || component.iter().map(|&row| points[row as usize]).collect::<Vec<_>>();
        let is_usual = far <= SPARSE_RATIO * usual && component.len() >= PLANE_SIZE_RATIO * size;
        Ok(is_usual || is_along_planes(&own())?)
    };
    let on: Vec<bool> = components.iter().map(is_on_sheet).collect::<Result<_, _>>()?;
    let mut is_out = vec![false; points.len()];
    let off = components.iter().zip(&on).filter(|(_, on)| !**on);
    off.flat_map(|(component, _)| component).for_each(|&row| is_out[row as usize] = true);
    let kept: Vec<u32> = (0..points.len() as u32).filter(|&row| !is_out[row as usize]).collect();
    let left: Vec<u32> = (0..points.len() as u32).filter(|&row| is_out[row as usize]).collect();
    if kept.is_empty() || left.is_empty() {
        return Ok(vec![false; points.len()]);
    }
    let sheet: Vec<Point> = kept.iter().map(|&row| points[row as usize]).collect();
    let asked: Vec<Point> = left.iter().map(|&row| points[row as usize]).collect();
    for (&row, near_sheet) in left.iter().zip(nearest_of(&sheet, &asked)?) {
        let Some(nearest) = near_sheet else { continue };
        let links = near[kept[nearest.row as usize] as usize].0;
        is_out[row as usize] = nearest.distance2.sqrt() > BESIDE_RATIO * links;
    }
    Ok(is_out)
}

/// By point, whether it is alone far from the sheet that so many of its neighbors fit, given the noise around each.
pub(super) fn off_sheets(
    points: &[Point],
    neighbors: &[u32],
    deviations: &[f64],
) -> Result<Vec<bool>, Error> {
    // The point itself comes first, as points are distinct.
    of_neighbors_by(
        points,
        |row| neighbors[row] as usize + 1,
        |row, near| {
            let place = points[row];
            let others: Vec<Point> =
                near.iter().skip(1).map(|near| points[near.row as usize]).collect();
            let mut fitting = Fitting::default();
            let sheet = fitting.fit(place, &others, FIT_ROUNDS);
            let within = others.iter().map(|&other| minus(other, place));
            let lateral = |off: Point| {
                let high = dot(off, sheet.normal);
                (dot(off, off) - high * high).max(0.0)
            };
            // As if they filled a disk.
            let wide = within.clone().map(lateral).fold(0.0, f64::max);
            let spacing = (std::f64::consts::PI * wide / others.len().max(1) as f64).sqrt();
            let bound = (HEIGHT_OVER_SPACING * spacing)
                .max(HEIGHT_OVER_DEVIATION * deviations[row].max(sheet.deviation));
            if sheet.height.abs() <= bound {
                return false;
            }
            // The sheet is at `height`, so company of the point is at less than half of that.
            let is_company = |off: &Point| dot(*off, sheet.normal) / sheet.height < 0.5;
            let company = within.filter(is_company).count();
            company as f64 <= COMPANY_SHARE * others.len() as f64
        },
    )
}

/// Whether points lie along planes.
fn is_along_planes(points: &[Point]) -> Result<bool, Error> {
    let shares = of_neighbors(points, PLANE_NEIGHBORS, |_, near| {
        let some: Vec<Point> = near.iter().map(|near| points[near.row as usize]).collect();
        let variances = principal(covariance(&some)).map(|(variance, _)| variance);
        let sum: f64 = variances.iter().sum();
        if sum > 0.0 { variances[2].max(0.0) / sum } else { 0.0 }
    })?;
    Ok(median(shares.into_iter()) <= PLANE_VARIANCE)
}

/// The upper median, 0 of nothing.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    let middle = sorted.len() / 2;
    if sorted.is_empty() { 0.0 } else { *sorted.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

/// The most frequent of positive numbers, by a histogram over their exponents and first digits, smoothed; of several the least.
fn mode(values: impl Iterator<Item = f64>) -> f64 {
    let mut bins = BTreeMap::<u64, u64>::new();
    for value in values.filter(|&value| value > 0.0) {
        *bins.entry(value.to_bits() >> BITS_BELOW_BIN).or_default() += 1;
    }
    let count = |bin: u64| bins.get(&bin).copied().unwrap_or(0);
    let smooth = |bin: u64| count(bin.saturating_sub(1)) + 2 * count(bin) + count(bin + 1);
    let mut best = (0, 0.0);
    for &bin in bins.keys() {
        if smooth(bin) > best.0 {
            let middle = (bin << BITS_BELOW_BIN) + (1 << (BITS_BELOW_BIN - 1));
            best = (smooth(bin), f64::from_bits(middle));
        }
    }
    best.1
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Even points of a unit square in the plane of x and y.
    fn square(side: u32) -> Vec<Point> {
        let at = |k: u32| f64::from(k) / f64::from(side);
        (0..side * side).map(|k| [at(k % side), at(k / side), 0.0]).collect()
    }

    #[test]
    fn the_mode_is_that_of_the_many() {
        let values = (0..90).map(|k| 1.0 + 1e-3 * f64::from(k)).chain((0..40).map(|_| 50.0));
        let found = mode(values);
        assert!((1.0..1.2).contains(&found), "{found}");
        assert_eq!(mode([0.0].into_iter()), 0.0);
    }

    #[test]
    fn what_hangs_together_alone_is_out_and_a_sparse_sheet_stays() {
        let mut points = square(60);
        // Five times as far apart, beyond a gap of ten spacings.
        points.extend(square(12).iter().map(|[x, y, _]| [1.2 + x, *y, 0.0]));
        let sheets = points.len();
        // Seven that are near each other, and one alone.
        points.extend(
            (0..7).map(|k| [0.5 + 1e-3 * f64::from(k), 0.5, 0.4 + 1e-3 * f64::from(k % 2)]),
        );
        points.push([0.3, 0.3, -2.0]);
        let found = unlinked(&points, &Monitor::silent()).expect("not stopped");
        let out: Vec<usize> = (0..points.len()).filter(|&row| found[row]).collect();
        assert_eq!(out, (sheets..points.len()).collect::<Vec<_>>());
    }

    #[test]
    fn what_is_alone_beside_a_sheet_is_out_and_a_second_sheet_is_not() {
        let side = 30;
        let mut points = square(side);
        let spacing = 1.0 / f64::from(side);
        points.extend(square(side).iter().map(|[x, y, _]| [*x, *y, 1.5 * spacing]));
        points.push([0.51, 0.51, -3.0 * spacing]);
        let found =
            off_sheets(&points, &vec![24; points.len()], &vec![0.0; points.len()]).expect("finite");
        let out: Vec<usize> = (0..points.len()).filter(|&row| found[row]).collect();
        assert_eq!(out, [points.len() - 1]);
        // Where points around are as far off as that, it is one of them.
        let level = spacing;
        let noisy = vec![level; points.len()];
        let found = off_sheets(&points, &vec![24; points.len()], &noisy).expect("finite");
        assert!(found.iter().all(|&is_off| !is_off));
    }
}
