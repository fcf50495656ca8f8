//! Polygons as the checkers of the shapes in them read them.

mod levels;
mod rings;
mod signs;
mod units;
mod violation;

use taut_points::{Monitor, PointSource, PointsHash};

use crate::CheckError;
use crate::hashed_pass::{WantedRows, all_finite, hashed_pass};

pub(crate) use levels::Levels;
pub(crate) use rings::Polygon;
pub(crate) use signs::{crosses_below, crosses_left_of, orientation};
pub(crate) use units::{COORDINATE_ERROR, Units};
pub use violation::PolygonViolation;

/// Reads all rows, which must be finite, those of the hash, and rings.
pub(crate) fn read(
    source: &dyn PointSource,
    claimed: PointsHash,
    monitor: &Monitor<'_>,
) -> Result<Polygon, CheckError> {
    let dim = source.dim();
    if dim != 2 && dim != 3 {
        return Err(PolygonViolation::Plane { dim }.into());
    }
    monitor.pass(1, source.len());
    let (blocks, _) = hashed_pass(source, claimed, WantedRows::none(), monitor, |first, rows| {
        all_finite(first, rows)?;
        // Rows of two numbers are all of ring 0.
        let mut row = [0.0; 3];
        let all = (0..rows.len()).map(|number| {
            rows.copy_row(number, &mut row[..dim]);
            row
        });
        Ok(all.collect::<Vec<_>>())
    })?;
    Ok(Polygon::of(&blocks.concat())?)
}
