//! A sample of points from all over a source, read in runs.
//!
//! *Trap.* The head of a file is no sample: rows are often sorted or tiled. Runs at even distances, each at a random place
//! of its share, meet every part.

use taut_points::{PointSource, ReadError, Scratch};

/// Points of a sample: cells of 2¹³ then have 16 each, and those of a bucket of 2⁷ are counted to 3 %.
pub(super) const SAMPLE_POINTS: u64 = 1 << 17;
/// Rows that are read at once: a page of the disk and more.
const RUN_ROWS: u64 = 32;

/// The points of a sample, −0 as 0; coordinates that are not finite are left out. Depends on the source alone.
pub(super) fn sample<const D: usize>(source: &dyn PointSource) -> Result<Vec<[f64; D]>, ReadError> {
    let n = source.len();
    let runs = (SAMPLE_POINTS / RUN_ROWS).min(n.div_ceil(RUN_ROWS));
    let mut points = Vec::with_capacity((runs * RUN_ROWS) as usize);
    let mut scratch = Scratch::new();
    let mut row = [0.0; D];
    let mut state = 0x9E37_79B9_7F4A_7C15u64 ^ n;
    for run in 0..runs {
        // Xorshift: any numbers do that are no part of a pattern in the rows.
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        let share = |k: u64| (u128::from(n) * u128::from(k) / u128::from(runs)) as u64;
        let (begin, end) = (share(run), share(run + 1));
        let room = (end - begin).saturating_sub(RUN_ROWS);
        let first = begin + state % (room + 1);
        let rows = source.read(first..end.min(first + RUN_ROWS), &mut scratch)?;
        for i in 0..rows.len() {
            rows.copy_row(i, &mut row);
            if row.iter().all(|x| x.is_finite()) {
                points.push(row.map(|x| x + 0.0));
            }
        }
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;
    use taut_points::Points;

    #[test]
    fn a_sample_of_sorted_rows_is_even_and_a_small_set_is_taken_whole() {
        let values: Vec<f64> = (0..1_000_000).map(f64::from).collect();
        let points = Points::new(&values, 2).unwrap();
        let found = sample::<2>(&points).unwrap();
        assert_eq!(found.len() as u64, SAMPLE_POINTS);
        let below = found.iter().filter(|p| p[0] < 250_000.0).count() as u64;
        assert!((below * 4).abs_diff(SAMPLE_POINTS) < SAMPLE_POINTS / 100, "{below}");
        let few = Points::new(&values[..100], 2).unwrap();
        assert_eq!(sample::<2>(&few).unwrap().len(), 50);
        assert!(sample::<3>(&Points::new(&values[..0], 3).unwrap()).unwrap().is_empty());
    }
}
