//! One pass that measures centers: how far the farthest point is from the nearest of them.

use taut_points::{Monitor, PointSource, Points, PointsHash, Rows, Scalar, map_blocks};

use crate::Error;
use crate::frame::{SQUARE_MIN, survey_and};
use crate::kernel::extremes::largest;
use crate::kernel::{Center, squared_distances};

use super::distance;

/// Rows that are measured together.
const CHUNK: usize = 512;

pub(super) struct Measured {
    /// The largest distance of a point to the center next to it, as evaluated.
    pub(super) radius: f64,
    pub(super) points_hash: PointsHash,
    /// One, or two where squares overflow or vanish.
    pub(super) passes: u64,
}

/// The largest distance of a point of `source` to the nearest of `centers`.
///
/// # Errors
/// [`Error::Empty`], [`Error::Input`], [`Error::Overflow`], [`Error::Input`].
pub(super) fn measure(
    source: &dyn PointSource,
    centers: &[Vec<f64>],
    monitor: &Monitor<'_>,
) -> Result<Measured, Error> {
    let centers: Vec<Center> =
        centers.iter().map(|c| Center { high: c.clone(), low: vec![] }).collect();
    let (frame_pass, blocks) = survey_and(source, monitor, |rows| match rows {
        Rows::F32(points) => farthest(points, &centers),
        Rows::F64(points) => farthest(points, &centers),
    })?;
    let square = blocks.into_iter().fold(0.0, f64::max);
    if (SQUARE_MIN..f64::INFINITY).contains(&square) {
        return Ok(Measured { radius: square.sqrt(), points_hash: frame_pass.hash, passes: 1 });
    }
    let blocks = map_blocks(source, monitor, |_, rows| {
        let (mut row, mut radius) = (vec![0.0; source.dim()], 0.0f64);
        for i in 0..rows.len() {
            rows.copy_row(i, &mut row);
            let mut nearest = f64::INFINITY;
            for center in &centers {
                // A center too far away for a number is not the nearest, unless all are.
                nearest = nearest.min(distance(&row, &center.high).unwrap_or(f64::INFINITY));
            }
            radius = radius.max(nearest);
        }
        if radius.is_finite() { Ok(radius) } else { Err(Error::Overflow) }
    })?;
    let radius = blocks.into_iter().fold(0.0, f64::max);
    Ok(Measured { radius, points_hash: frame_pass.hash, passes: 2 })
}

/// The largest squared distance of a point to the nearest center; not finite or tiny where squares leave the range.
fn farthest<T: Scalar>(points: &Points<'_, T>, centers: &[Center]) -> f64 {
    let (mut farthest, mut values, mut least) = (0.0, [0.0; CHUNK], [0.0; CHUNK]);
    for chunk in points.values().chunks(CHUNK * points.dim()) {
        let rows = chunk.len() / points.dim();
        let (values, least) = (&mut values[..rows], &mut least[..rows]);
        least.fill(f64::INFINITY);
        for center in centers {
            squared_distances(chunk, points.dim(), center, values);
            for (least, &value) in least.iter_mut().zip(values.iter()) {
                *least = if value < *least { value } else { *least };
            }
        }
        farthest = largest(least).max(farthest);
    }
    farthest
}
