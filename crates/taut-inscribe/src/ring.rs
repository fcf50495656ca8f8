//! The ring of a polygon: its vertices without repetitions, and the rows that they come from.

use taut_points::{InputError, Monitor, PointSource, PointsHash, hash_block, map_blocks};

use crate::Error;
use crate::simple;

/// Most rows of a ring, so that edges have 32-bit numbers.
const ROWS_MAX: u64 = u32::MAX as u64;

/// The vertices of a simple polygon. Edge k leads from vertex k to the next one.
pub(crate) struct Ring {
    /// The coordinates as given.
    pub(crate) exact: Vec<[f64; 2]>,
    /// The row at which edge k begins: of equal rows that follow each other, the last.
    pub(crate) rows: Vec<u64>,
    pub(crate) points_hash: PointsHash,
}

impl Ring {
    /// Reads the rows and refuses rings that are not simple.
    pub(crate) fn read(source: &dyn PointSource, monitor: &Monitor<'_>) -> Result<Self, Error> {
        if source.dim() != 2 {
            let (dim, expected) = (source.dim(), "2, as the vertices of a polygon have");
            return Err(InputError::Dimension { dim, expected }.into());
        }
        let points = source.len();
        if points > ROWS_MAX {
            return Err(InputError::TooManyPoints { points, most: ROWS_MAX }.into());
        }
        let (all, points_hash) = rows(source, monitor)?;
        let after = |row: usize| if row + 1 == all.len() { 0 } else { row + 1 };
        let kept: Vec<usize> = (0..all.len()).filter(|&row| all[row] != all[after(row)]).collect();
        if kept.len() < 3 {
            // Two vertices there and back have two edges; a single point has none.
            return Err(Error::TooFewVertices { distinct: kept.len().max(all.len().min(1)) });
        }
        let exact: Vec<[f64; 2]> = kept.iter().map(|&row| all[row]).collect();
        if let Some(edges) = simple::crossing(&exact, monitor)? {
            let [edge, other] = edges.map(|edge| [kept[edge] as u64, after(kept[edge]) as u64]);
            return Err(Error::NotSimple { edge, other });
        }
        let rows = kept.into_iter().map(|row| row as u64).collect();
        Ok(Ring { exact, rows, points_hash })
    }
}

/// All rows, which must be finite, and their hash.
fn rows(
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<(Vec<[f64; 2]>, PointsHash), Error> {
    monitor.pass(1, source.len());
    let blocks = map_blocks(source, monitor, |first, rows| {
        if let Some((row, column, value)) = rows.first_non_finite() {
            return Err(Error::Input(InputError::NonFinite {
                row: first + row as u64,
                column,
                value,
            }));
        }
        let mut point = [0.0; 2];
        let points = (0..rows.len()).map(|row| {
            rows.copy_row(row, &mut point);
            point
        });
        Ok((hash_block(&rows), points.collect::<Vec<_>>()))
    })?;
    let hashes = blocks.iter().map(|block| block.0);
    let hash = PointsHash::of_blocks(source.len(), source.dim(), hashes);
    Ok((blocks.into_iter().flat_map(|block| block.1).collect(), hash))
}
