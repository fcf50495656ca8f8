//! One pass that measures centers: how far the farthest point is from the nearest of them.

use taut_kernels::extremes::largest;
use taut_kernels::{Center, squared_distances};
use taut_points::{BlockHash, Monitor, PointSource, Points, PointsHash, Rows, Scalar, map_blocks};

use super::distance;
use crate::Error;
use crate::frame::{SQUARE_MIN, survey_blocks};
use crate::passes::ask_reach;

/// Rows that are measured together.
const CHUNK: usize = 512;

pub(super) struct Measured {
    /// The largest distance of a point to the center next to it, as evaluated.
    pub(super) radius: f64,
    pub(super) points_hash: PointsHash,
    /// One, or two where squares overflow or vanish.
    pub(super) passes: u64,
}

/// The way to measure how far the farthest point is from the nearest center.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reach {
    /// Squared, by the kernels; not finite or tiny where squares leave the range. Rows are hashed, and refused if they are no points.
    Square,
    /// As a distance, for coordinates of any size; infinite where it is no `f64`.
    Distance,
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
    if source.is_empty() {
        return Err(Error::Empty);
    }
    monitor.pass(1, source.len());
    let (square, points_hash) = match source.elsewhere() {
        Some(elsewhere) => ask_reach(elsewhere, source, centers, Reach::Square)?,
        None => {
            let (square, hashes) = Reach::Square.of(source, centers, monitor)?;
            (square, PointsHash::of_blocks(source.len(), source.dim(), hashes))
        }
    };
    if (SQUARE_MIN..f64::INFINITY).contains(&square) {
        return Ok(Measured { radius: square.sqrt(), points_hash, passes: 1 });
    }
    let radius = match source.elsewhere() {
        Some(elsewhere) => ask_reach(elsewhere, source, centers, Reach::Distance)?.0,
        None => Reach::Distance.of(source, centers, monitor)?.0,
    };
    if radius.is_finite() {
        Ok(Measured { radius, points_hash, passes: 2 })
    } else {
        Err(Error::Overflow)
    }
}

impl Reach {
    /// That of some rows; with squares also the hashes of their blocks.
    pub(crate) fn of(
        self,
        source: &dyn PointSource,
        centers: &[Vec<f64>],
        monitor: &Monitor<'_>,
    ) -> Result<(f64, Vec<BlockHash>), Error> {
        match self {
            Reach::Square => squares(source, centers, monitor),
            Reach::Distance => Ok((distances(source, centers, monitor)?, vec![])),
        }
    }
}

fn squares(
    source: &dyn PointSource,
    centers: &[Vec<f64>],
    monitor: &Monitor<'_>,
) -> Result<(f64, Vec<BlockHash>), Error> {
    let centers: Vec<Center> =
        centers.iter().map(|c| Center { high: c.clone(), low: vec![] }).collect();
    let blocks = survey_blocks(source, monitor, |rows| match rows {
        Rows::F32(points) => farthest(points, &centers),
        Rows::F64(points) => farthest(points, &centers),
    })?;
    let square = blocks.iter().map(|block| block.more).fold(0.0, f64::max);
    Ok((square, blocks.into_iter().map(|block| block.hash).collect()))
}

fn distances(
    source: &dyn PointSource,
    centers: &[Vec<f64>],
    monitor: &Monitor<'_>,
) -> Result<f64, Error> {
    let blocks = map_blocks(source, monitor, |_, rows| {
        let (mut row, mut radius) = (vec![0.0; source.dim()], 0.0f64);
        for i in 0..rows.len() {
            rows.copy_row(i, &mut row);
            let mut nearest = f64::INFINITY;
            for center in centers {
                // A center too far away for a number is not the nearest, unless all are.
                nearest = nearest.min(distance(&row, center).unwrap_or(f64::INFINITY));
            }
            radius = radius.max(nearest);
        }
        Ok::<_, Error>(radius)
    })?;
    Ok(blocks.into_iter().fold(0.0, f64::max))
}

/// The largest squared distance of a point to the nearest center; not finite or tiny where squares leave the range.
fn farthest<T: Scalar>(points: &Points<'_, T>, centers: &[Center]) -> f64 {
    let mut farthest = 0.0;
    nearest_squares(points.values(), points.dim(), centers, |_, least| {
        farthest = largest(least).max(farthest);
    });
    farthest
}

/// Calls `take` with the number of a row, from 0, and the squared distances of it and rows after it to the nearest center.
pub(crate) fn nearest_squares<T: Scalar>(
    values: &[T],
    dim: usize,
    centers: &[Center],
    mut take: impl FnMut(usize, &[f64]),
) {
    let (mut squares, mut least) = ([0.0; CHUNK], [0.0; CHUNK]);
    for (number, chunk) in values.chunks(CHUNK * dim).enumerate() {
        let rows = chunk.len() / dim;
        let (squares, least) = (&mut squares[..rows], &mut least[..rows]);
        least.fill(f64::INFINITY);
        for center in centers {
            squared_distances(chunk, dim, center, squares);
            for (least, &value) in least.iter_mut().zip(squares.iter()) {
                *least = if value < *least { value } else { *least };
            }
        }
        take(number * CHUNK, least);
    }
}
