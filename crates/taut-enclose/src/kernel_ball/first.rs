//! The first pass over all points: whether they are numbers, their hash, and whether they are all the same.

use taut_points::{
    BlockHash, Monitor, PointSource, PointsHash, Rows, Scalar, hash_block, map_blocks,
};

use crate::Error;

/// What a first pass finds.
pub(super) struct First {
    pub(super) hash: PointsHash,
    /// Whether all points are the same.
    pub(super) is_one_point: bool,
}

/// Checks and hashes all rows.
pub(super) fn first_pass(source: &dyn PointSource, monitor: &Monitor<'_>) -> Result<First, Error> {
    monitor.pass(1, source.len());
    let dim = source.dim();
    let first = taut_points::gather(source, &[0])?;
    let blocks = map_blocks(source, monitor, |number, rows| {
        rows.check_finite(number)?;
        let extent = match rows {
            Rows::F32(points) => farthest_coordinate(points.values(), &first),
            Rows::F64(points) => farthest_coordinate(points.values(), &first),
        };
        Ok::<(BlockHash, f64), Error>((hash_block(&rows), extent))
    })?;
    let extent = blocks.iter().map(|block| block.1).fold(0.0, f64::max);
    // Two rows are at most twice as far apart as one is from the first.
    if !(4.0 * extent * extent * dim as f64).is_finite() {
        return Err(Error::Overflow);
    }
    let hash = PointsHash::of_blocks(source.len(), dim, blocks.iter().map(|block| block.0));
    Ok(First { hash, is_one_point: extent == 0.0 })
}

/// The largest |xⱼ − yⱼ| of any row x.
fn farthest_coordinate<T: Scalar>(values: &[T], y: &[f64]) -> f64 {
    // Coordinate by coordinate, so that the compiler takes several at a time.
    let mut extents = vec![0.0; y.len()];
    for row in values.chunks_exact(y.len()) {
        for ((extent, &x), y) in extents.iter_mut().zip(row).zip(y) {
            let way = (Into::<f64>::into(x) - y).abs();
            *extent = if way > *extent { way } else { *extent };
        }
    }
    extents.into_iter().fold(0.0, f64::max)
}
