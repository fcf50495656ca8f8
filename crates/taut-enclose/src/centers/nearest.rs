//! Which center is nearest to a point, whatever the size of numbers.

use taut_points::{Monitor, PointSource, map_blocks};

use super::items::distance;
use crate::Error;

/// Distances whose squares have all their digits.
pub(crate) const EXACT_DISTANCES: std::ops::RangeInclusive<f64> = 1e-140..=1e150;

/// The first of the centers that are nearest.
pub(super) fn nearest(position: &[f64], centers: &[Vec<f64>]) -> u32 {
    let mut nearest = (f64::INFINITY, 0);
    for (number, center) in (0..).zip(centers) {
        let length = length(position, center);
        if length < nearest.0 {
            nearest = (length, number);
        }
    }
    nearest.1
}

/// The same for each point of a source, in one pass.
pub(super) fn assignment(
    source: &dyn PointSource,
    centers: &[Vec<f64>],
    monitor: &Monitor<'_>,
) -> Result<Vec<u32>, Error> {
    monitor.pass(2, source.len());
    let blocks = map_blocks(source, monitor, |_, rows| {
        let mut row = vec![0.0; source.dim()];
        let number = |i| {
            rows.copy_row(i, &mut row);
            nearest(&row, centers)
        };
        Ok::<_, Error>((0..rows.len()).map(number).collect::<Vec<u32>>())
    })?;
    Ok(blocks.concat())
}

/// |a − b|, infinite only where it is no number.
pub(super) fn length(a: &[f64], b: &[f64]) -> f64 {
    let plain = distance(a, b);
    if EXACT_DISTANCES.contains(&plain) {
        return plain;
    }
    let largest = a.iter().zip(b).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
    if largest == 0.0 || largest == f64::INFINITY {
        return largest;
    }
    let squares = a.iter().zip(b).map(|(a, b)| ((a - b) / largest).powi(2));
    largest * squares.sum::<f64>().sqrt()
}
