//! The rows of a source as items in memory, in units in which squares neither overflow nor vanish.

use taut_certify::Items;
use taut_points::{Monitor, PointSource, PointsHash, Rows, hash_block, map_blocks};

use super::items::{ItemSet, Position, Shape};
use crate::Error;

/// Numbers between 2⁻²⁰⁰ and 2²⁰⁰ stay as they are.
const SAFE_EXPONENT: i32 = 200;

/// All rows, as they are.
pub(super) struct Table {
    pub(super) shape: Shape,
    pub(super) dim: usize,
    columns: usize,
    values: Vec<f64>,
    pub(super) hash: PointsHash,
    /// What coordinates and radii are multiplied with, a power of two.
    pub(super) scale: f64,
    /// What weights are multiplied with, a power of two.
    pub(super) weight_scale: f64,
}

/// What one block has to say.
struct Block {
    hash: taut_points::BlockHash,
    values: Vec<f64>,
    /// The largest coordinate or radius, and the largest weight.
    largest: (f64, f64),
}

impl Table {
    /// Reads all rows once, and refuses what is no point, weight or ball.
    pub(super) fn read(
        source: &dyn PointSource,
        items: Items,
        weights: bool,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        let columns = source.dim();
        let shape = match (items, weights) {
            (Items::Points, false) => Shape::Points,
            (Items::Points, true) => Shape::Weighted,
            (Items::Balls, false) => Shape::Balls,
            (Items::Balls, true) => {
                let (name, value) = ("weights", "true".into());
                return Err(Error::Option { name, value, expected: "false for balls" });
            }
            (Items::Ellipsoids, _) => {
                let (name, value) = ("items", "ellipsoids".into());
                return Err(Error::Option { name, value, expected: "points or balls" });
            }
        };
        match shape {
            Shape::Balls if columns < 2 => return Err(Error::NoRadius { columns }),
            Shape::Weighted if columns < 2 => return Err(Error::NoWeight { columns }),
            _ => {}
        }
        if source.is_empty() {
            return Err(Error::Empty);
        }
        if source.len() > u64::from(u32::MAX) {
            let (rows, dim) = (source.len(), columns);
            return Err(taut_points::ReadError::TooLarge { rows, dim }.into());
        }
        monitor.pass(1, source.len());
        let blocks = map_blocks(source, monitor, |first, rows| Block::read(shape, first, &rows))?;
        let hash = PointsHash::of_blocks(source.len(), columns, blocks.iter().map(|b| b.hash));
        let largest = blocks.iter().fold((0.0f64, 0.0f64), |(x, w), block| {
            (x.max(block.largest.0), w.max(block.largest.1))
        });
        let values = blocks.into_iter().flat_map(|block| block.values).collect();
        let dim = if shape == Shape::Points { columns } else { columns - 1 };
        let (scale, weight_scale) = (scale_of(largest.0), scale_of(largest.1));
        let table = Table { shape, dim, columns, values, hash, scale, weight_scale };
        if table.loses_digits() { Err(Error::Overflow) } else { Ok(table) }
    }

    /// Whether numbers so small beside the largest are there that they cannot be scaled with it.
    fn loses_digits(&self) -> bool {
        let is_lost = |value: f64, scale: f64| value * scale / scale != value;
        self.values.chunks_exact(self.columns).any(|row| {
            let (place, extra) = row.split_at(self.dim);
            let unit = if self.shape == Shape::Weighted { self.weight_scale } else { self.scale };
            place.iter().any(|&x| is_lost(x, self.scale)) || extra.iter().any(|&x| is_lost(x, unit))
        })
    }

    pub(super) fn len(&self) -> usize {
        self.values.len() / self.columns
    }

    /// A row as it was given.
    pub(super) fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.columns..][..self.columns]
    }

    /// The items in the units of the search.
    pub(super) fn items<P: Position>(&self) -> ItemSet<P> {
        let mut items = ItemSet::new(self.shape, self.dim);
        let mut position = vec![0.0; self.dim];
        for row in self.values.chunks_exact(self.columns) {
            position.iter_mut().zip(row).for_each(|(p, x)| *p = x * self.scale);
            let extra = row.get(self.dim).copied().unwrap_or(0.0);
            let unit = if self.shape == Shape::Weighted { self.weight_scale } else { self.scale };
            items.push(&position, extra * unit);
        }
        items
    }
}

impl Block {
    fn read(shape: Shape, first: u64, rows: &Rows<'_>) -> Result<Self, Error> {
        if let Some((row, column, value)) = rows.first_non_finite() {
            return Err(Error::NonFinite { row: first + row as u64, column, value });
        }
        let (values, columns): (Vec<f64>, usize) = match rows {
            Rows::F32(points) => {
                (points.values().iter().map(|&v| v.into()).collect(), points.dim())
            }
            Rows::F64(points) => (points.values().to_vec(), points.dim()),
        };
        let mut largest = (0.0f64, 0.0f64);
        for (id, row) in (first..).zip(values.chunks_exact(columns)) {
            let (coordinates, extra) = match shape {
                Shape::Weighted => (&row[..columns - 1], row[columns - 1]),
                Shape::Points | Shape::Balls => (row, 0.0),
            };
            largest.0 = coordinates.iter().fold(largest.0, |most, x| most.max(x.abs()));
            largest.1 = largest.1.max(extra);
            match shape {
                Shape::Weighted if extra <= 0.0 => {
                    return Err(Error::NonPositiveWeight { row: id, value: extra });
                }
                Shape::Balls if row[columns - 1] < 0.0 => {
                    return Err(Error::NegativeRadius { row: id, value: row[columns - 1] });
                }
                _ => {}
            }
        }
        Ok(Block { hash: hash_block(rows), values, largest })
    }
}

/// 1, or for numbers whose squares are in danger the power of two that brings the largest to about 1.
fn scale_of(largest: f64) -> f64 {
    if largest == 0.0 {
        return 1.0;
    }
    let exponent = largest.log2().floor() as i32;
    if exponent.abs() <= SAFE_EXPONENT { 1.0 } else { 2f64.powi((-exponent).clamp(-1000, 1000)) }
}
