//! The noise of points, and the number of neighbors that average it out.
//!
//! *Problem.* Few neighbors of a point with noise lie in a ball rather than along a sheet, and tell no normal. Too many span features.
//! *Idea.* A paraboloid is fitted to more and more neighbors, until they reach several times as far as their standard deviation from it.
//! The number is then the median of those of the nearest points.
//! *Guarantee.* A function of the points. O(n log n) for noise up to a few spacings.
//! *Trap.* Where features are as small as the noise, no number of neighbors is right: such points are named.

use taut_oblivious::kdtree::Nearest;
use taut_points::Monitor;

use super::neighbors::{of_neighbors, of_neighbors_by};
use super::sheet_fit::Fitting;
use super::spheres::Point;
use crate::Error;

/// Numbers of neighbors that are tried, each about √2 times the one before; those of a row are searched for at once.
const COUNTS: [&[usize]; 3] = [&[COUNT_MIN], &[34, 48, 68, 96], &[136, 192, 272]];
/// The number of neighbors where there is little noise.
pub(super) const COUNT_MIN: usize = 24;
/// Neighbors are enough if they reach this many standard deviations from their sheet.
const REACH_OVER_DEVIATION: f64 = 5.0;
/// Rounds of each fit.
const FIT_ROUNDS: u32 = 2;

/// What was found of the noise around a point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Level {
    /// The number of nearest points, itself among them, that show its sheet.
    pub(super) neighbors: u32,
    /// The standard deviation of them from it.
    pub(super) deviation: f64,
    /// True if more neighbors were needed than where there is little noise.
    pub(super) is_large: bool,
    /// True if no number of neighbors tried was enough.
    pub(super) is_unsettled: bool,
}

/// The noise around each point; with this number of neighbors, if one is given. Points are distinct.
pub(super) fn levels(
    points: &[Point],
    given: Option<usize>,
    monitor: &Monitor<'_>,
) -> Result<Vec<Level>, Error> {
    let own = given.map(|count| [count]);
    let rounds = match &own {
        Some(count) => &[count.as_slice()][..],
        None => &COUNTS,
    };
    let mut found: Vec<Option<Level>> = vec![None; points.len()];
    for (round, counts) in rounds.iter().enumerate() {
        monitor.check()?;
        let most = counts[counts.len() - 1];
        let is_last = round + 1 == rounds.len();
        let open = |row: usize| if found[row].is_some() { 0 } else { most };
        let of = |row: usize, near: &[Nearest]| level(points, row, near, counts, is_last);
        let now = of_neighbors_by(points, open, of)?;
        found.iter_mut().zip(now).for_each(|(level, now)| *level = level.or(now));
    }
    let found: Vec<Level> = found.into_iter().map(Option::unwrap_or_default).collect();
    // The same number for all points around, nearly, so that they are moved alike; and deviations of single fits are rough.
    of_neighbors(points, COUNT_MIN, |row, near| {
        let around = || near.iter().map(|near| found[near.row as usize]);
        let mut counts: Vec<u32> = around().map(|level| level.neighbors).collect();
        let mut deviations: Vec<f64> = around().map(|level| level.deviation).collect();
        let middle = near.len() / 2;
        let neighbors = *counts.select_nth_unstable(middle).1;
        Level {
            neighbors,
            deviation: *deviations.select_nth_unstable_by(middle, f64::total_cmp).1,
            is_large: neighbors as usize > COUNT_MIN,
            is_unsettled: found[row].is_unsettled,
        }
    })
}

/// The noise around a point by the first of some numbers of neighbors that is enough; by the last of them, if there are no others.
fn level(
    points: &[Point],
    row: usize,
    near: &[Nearest],
    counts: &[usize],
    is_last: bool,
) -> Option<Level> {
    let some: Vec<Point> = near.iter().map(|near| points[near.row as usize]).collect();
    let mut fitting = Fitting::default();
    let mut found = None;
    for count in counts.iter().map(|&count| count.min(some.len())).filter(|&count| count > 0) {
        let sheet = fitting.fit(points[row], &some[..count], FIT_ROUNDS);
        let is_enough = sheet.reach >= REACH_OVER_DEVIATION * sheet.deviation;
        found = (is_enough || is_last).then_some(Level {
            neighbors: count as u32,
            deviation: sheet.deviation,
            is_large: count > COUNT_MIN,
            is_unsettled: !is_enough,
        });
        if is_enough {
            break;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of 60 × 60 even points with normal noise, nearly, of this many spacings across it.
    fn noisy_square(noise: f64) -> Vec<Point> {
        let mut state = 3u64;
        let mut number = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut high = || (0..12).map(|_| number()).sum::<f64>() - 6.0;
        let place = |k: u32| [f64::from(k % 60), f64::from(k / 60), noise * high()];
        (0..3600).map(place).collect()
    }

    #[test]
    fn more_noise_takes_more_neighbors_and_its_height_is_found() {
        let median = |mut values: Vec<f64>| {
            values.sort_unstable_by(f64::total_cmp);
            values[values.len() / 2]
        };
        let mut before = 0.0;
        for (noise, least, most) in [(0.0, 24.0, 24.0), (0.2, 24.0, 24.0), (1.0, 40.0, 136.0)] {
            let found =
                levels(&noisy_square(noise), None, &Monitor::silent()).expect("not stopped");
            let neighbors = median(found.iter().map(|one| f64::from(one.neighbors)).collect());
            let deviation = median(found.iter().map(|one| one.deviation).collect());
            assert!((least..=most).contains(&neighbors) && neighbors >= before, "{neighbors}");
            assert!((deviation - noise).abs() <= 0.25 * noise, "{deviation} for {noise}");
            before = neighbors;
        }
        let given = levels(&noisy_square(1.0), Some(50), &Monitor::silent()).expect("not stopped");
        assert!(given.iter().all(|one| one.neighbors == 50));
        // Medians of points around, which neighbors share: single fits give each point a value of its own.
        let mut deviations: Vec<u64> = given.iter().map(|one| one.deviation.to_bits()).collect();
        deviations.sort_unstable();
        deviations.dedup();
        assert!(deviations.len() < given.len() * 2 / 3, "{} values", deviations.len());
    }
}
