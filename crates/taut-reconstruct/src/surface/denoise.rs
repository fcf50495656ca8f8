//! Noise taken out of points before a surface is sought: outliers left out, the others moved onto the sheets they are around.
//!
//! *Idea.* Points that links leave apart are outliers (`outliers`). The noise around each other one tells how many neighbors show its sheet
//! (`noise`); what is alone far from the sheet of its neighbors is an outlier, too. The others are moved along the normal of their
//! neighbors onto the paraboloid that fits them best (`sheet_fit`), a few times over. Points that end nearer to each other than they
//! are exact are put into one place (`merge`).
//! *Guarantee.* A function of the points: neighbors come in the order of their distances, equal ones in that of their coordinates.
//! O(n log n).
//! *Trap.* Edges are rounded by about the distance of the neighbors, and thin plates pulled together; hence never by default. Planes
//! in the place of paraboloids, motion by mean curvature, shrink the bunny by two thousandths of its diagonal in four rounds: more
//! than the noise. The scale space of Digne, Morel, Souzani and Lartigue, Comput. Graph. Forum 30(6), 2011, is the plane's.

use std::cmp::Ordering;

use taut_points::parallel::ParallelSlice;
use taut_points::{InputError, Monitor};

use super::Denoise;
use super::merge::takers;
use super::neighbors::of_neighbors_by;
use super::noise::{COUNT_MIN, Level, levels};
use super::outliers::{off_sheets, unlinked};
use super::sheet_fit::Fitting;
use super::spheres::Point;
use crate::Error;

/// Rounds of each fit that moves a point.
const FIT_ROUNDS: u32 = 4;
/// Standard deviation of a fitted height, over that of the points over the root of their number.
const ERROR_OVER_MEAN: f64 = 2.0;
/// Points are put into one place within this many standard deviations of their heights.
const MERGE_RATIO: f64 = 3.0;
/// The averaging neighbors of a point reach at most this many radii of curvature.
const REACH_OVER_CURVATURE_RADIUS: f64 = 1.0;
/// At most this share of the neighbors of a point is on other sheets.
const OTHER_SHEETS_SHARE: f64 = 0.25;

/// Points after the pre-pass.
pub(super) struct Denoised {
    /// Those that are no outliers, moved.
    pub(super) points: Vec<Point>,
    pub(super) rows: Vec<u32>,
    /// The rows of the others.
    pub(super) outliers: Vec<u32>,
    /// Rows where the noise is as large as what is around.
    pub(super) unclear: Vec<u32>,
}

/// Takes out noise. Coordinates are of a magnitude whose squares are numbers.
///
/// # Errors
/// [`Error::Input`].
pub(super) fn denoise(
    all: &[Point],
    options: &Denoise,
    monitor: &Monitor<'_>,
) -> Result<Denoised, Error> {
    if u32::try_from(all.len()).is_err() {
        return Err(Error::Input(InputError::TooManyPoints {
            points: all.len() as u64,
            most: u32::MAX.into(),
        }));
    }
    // Equal points are one: each is where its first is moved, or left out with it.
    let first = firsts(all);
    let mut place = vec![0; all.len()];
    let distinct: Vec<u32> = (0..all.len() as u32).filter(|&r| first[r as usize] == r).collect();
    (0u32..).zip(&distinct).for_each(|(k, &row)| place[row as usize] = k);
    let mut moved: Vec<Point> = distinct.iter().map(|&row| all[row as usize]).collect();
    let mut is_outlier = unlinked(&moved, monitor)?;
    let kept = |is_outlier: &[bool]| -> Vec<u32> {
        (0..is_outlier.len() as u32).filter(|&k| !is_outlier[k as usize]).collect()
    };
    let at = |all: &[Point], some: &[u32]| -> Vec<Point> {
        some.iter().map(|&k| all[k as usize]).collect()
    };
    let linked = kept(&is_outlier);
    let points = at(&moved, &linked);
    let mut noise = levels(&points, options.neighbors, monitor)?;
    let counts: Vec<u32> = noise.iter().map(|level| level.neighbors).collect();
    let deviations: Vec<f64> = noise.iter().map(|level| level.deviation).collect();
    let is_off = off_sheets(&points, &counts, &deviations)?;
    linked.iter().zip(&is_off).for_each(|(&k, &is_off)| is_outlier[k as usize] = is_off);
    let mut stays = is_off.iter().map(|is_off| !is_off);
    noise.retain(|_| stays.next() == Some(true));
    let sheet = kept(&is_outlier);
    let (points, is_unclear) = onto_sheets(at(&moved, &sheet), &noise, options, monitor)?;
    let mut unclear = vec![false; moved.len()];
    sheet.iter().zip(&is_unclear).for_each(|(&k, &is)| unclear[k as usize] = is);
    sheet.iter().zip(points).for_each(|(&k, point)| moved[k as usize] = point);
    let of_row = |row: u32| place[first[row as usize] as usize] as usize;
    let rows = 0..all.len() as u32;
    let (outliers, rows): (Vec<u32>, Vec<u32>) = rows.partition(|&row| is_outlier[of_row(row)]);
    Ok(Denoised {
        points: rows.iter().map(|&row| moved[of_row(row)]).collect(),
        unclear: rows.iter().copied().filter(|&row| unclear[of_row(row)]).collect(),
        rows,
        outliers,
    })
}

/// Points moved onto their sheets, those within their errors of each other into one place; and which of them are unclear.
fn onto_sheets(
    mut points: Vec<Point>,
    noise: &[Level],
    options: &Denoise,
    monitor: &Monitor<'_>,
) -> Result<(Vec<Point>, Vec<bool>), Error> {
    let mut is_unclear: Vec<bool> = noise.iter().map(|level| level.is_unsettled).collect();
    if options.iterations == 0 {
        return Ok((points, vec![false; noise.len()]));
    }
    for _ in 0..options.iterations {
        monitor.check()?;
        let count = |row: usize| noise[row].neighbors as usize;
        let moved = of_neighbors_by(&points, count, |row, near| {
            let place = points[row];
            let some: Vec<Point> = near.iter().map(|near| points[near.row as usize]).collect();
            let sheet = Fitting::default().fit(place, &some, FIT_ROUNDS);
            let is_bent = sheet.reach * sheet.curvature > REACH_OVER_CURVATURE_RADIUS;
            let is_hard = is_bent || sheet.rejected > OTHER_SHEETS_SHARE;
            (sheet.onto(place), is_hard && noise[row].is_large)
        })?;
        for (k, (point, is_hard)) in moved.into_iter().enumerate() {
            points[k] = point;
            is_unclear[k] |= is_hard;
        }
    }
    monitor.check()?;
    // What few points, or points all around, are off their sheet is no noise.
    let radius = |level: &Level| match level.neighbors {
        few if (few as usize) < COUNT_MIN || level.is_unsettled => 0.0,
        count => MERGE_RATIO * ERROR_OVER_MEAN * level.deviation / f64::from(count).sqrt(),
    };
    let radii: Vec<f64> = noise.iter().map(radius).collect();
    let takers = takers(&points, &radii)?;
    let points = takers.iter().map(|&taker| points[taker as usize]).collect();
    Ok((points, is_unclear))
}

/// For each point the first one that equals it.
pub(super) fn firsts(points: &[Point]) -> Vec<u32> {
    // −0 equals 0, but is another pattern of bits.
    let plain = |row: u32| points[row as usize].map(|x| x + 0.0);
    let by_place = |&a: &u32, &b: &u32| {
        let (a_place, b_place) = (plain(a), plain(b));
        let pairs = a_place.iter().zip(&b_place);
        pairs.fold(Ordering::Equal, |order, (x, y)| order.then(x.total_cmp(y))).then(a.cmp(&b))
    };
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.par_sort_unstable_by(by_place);
    let mut first = vec![0; points.len()];
    for same in order.chunk_by(|&a, &b| plain(a) == plain(b)) {
        same.iter().for_each(|&row| first[row as usize] = same[0]);
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bump_is_flattened_and_an_outlier_left_out() {
        let mut points: Vec<Point> =
            (0..400).map(|k| [f64::from(k % 20), f64::from(k / 20), 0.0]).collect();
        points[210][2] = 0.2;
        points.push([10.0, 10.0, 30.0]);
        let found = denoise(&points, &Denoise::default(), &Monitor::silent()).expect("not stopped");
        assert_eq!(found.outliers, [400]);
        assert!(found.points[210][2].abs() < 0.1, "{:?}", found.points[210]);
    }
}
