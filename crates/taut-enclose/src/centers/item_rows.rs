//! The rows of a source in memory, as they are.

use std::collections::HashMap;

use taut_certify::Items;
use taut_points::{
    InputError, Monitor, PointSource, PointsHash, ReadError, Rows, hash_block, map_blocks,
};

use super::items::Shape;
use crate::Error;

pub(super) struct ItemRows {
    pub(super) shape: Shape,
    pub(super) dim: usize,
    /// Numbers of an item, without that of its group.
    pub(super) columns: usize,
    pub(super) values: Vec<f64>,
    /// For each row the number of its group, from 0 by first appearance; empty where each row stands for itself.
    pub(super) groups: Vec<u32>,
    pub(super) hash: PointsHash,
}

impl ItemRows {
    /// Reads all rows once, and refuses what is no point, weight or ball.
    pub(super) fn read(
        source: &dyn PointSource,
        items: Items,
        weights: bool,
        group: Option<usize>,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        let all_columns = source.dim();
        if let Some(group) = group
            && !(all_columns > 1 && group < all_columns)
        {
            return Err(Error::Input(InputError::Option {
                name: "group",
                value: group.to_string(),
                expected: "a column of the rows, beside which there is another",
            }));
        }
        let columns = all_columns - usize::from(group.is_some());
        let refused = |name, value: &str, expected| {
            Err(Error::Input(InputError::Option { name, value: value.into(), expected }))
        };
        let shape = match (items, weights) {
            (Items::Points, true) if columns < 2 => return Err(Error::NoWeight { columns }),
            (Items::Balls, false) if columns < 2 => return Err(Error::NoRadius { columns }),
            (Items::Points, false) => Shape::Points,
            (Items::Points, true) => Shape::Weighted,
            (Items::Balls, false) => Shape::Balls,
            (Items::Balls, true) => return refused("weights", "true", "false for balls"),
            (Items::Ellipsoids, _) => return refused("inputs", "ellipsoids", "points or balls"),
        };
        if source.is_empty() {
            return Err(Error::Empty);
        }
        if u32::try_from(source.len()).is_err() {
            return Err(ReadError::TooLarge { rows: source.len(), dim: all_columns }.into());
        }
        monitor.pass(1, source.len());
        let blocks = map_blocks(source, monitor, |first, rows| {
            Ok::<_, Error>((hash_block(&rows), values_of(shape, first, &rows, group)?))
        })?;
        let hashes = blocks.iter().map(|(hash, _)| *hash);
        let hash = PointsHash::of_blocks(source.len(), all_columns, hashes);
        let (mut values, mut numbers, mut groups) = (vec![], HashMap::new(), vec![]);
        for (_, (of_items, of_groups)) in blocks {
            values.extend(of_items);
            groups.extend(of_groups.iter().map(|group: &f64| {
                let next = numbers.len() as u32;
                // −0 is 0.
                *numbers.entry((group + 0.0).to_bits()).or_insert(next)
            }));
        }
        if numbers.len() == groups.len() {
            // Groups of one row are rows.
            groups.clear();
        }
        let dim = if shape == Shape::Points { columns } else { columns - 1 };
        Ok(ItemRows { shape, dim, columns, values, groups, hash })
    }

    pub(super) fn len(&self) -> usize {
        self.values.len() / self.columns
    }

    /// Number of groups; of rows where each stands for itself.
    pub(super) fn group_count(&self) -> usize {
        self.groups.iter().max().map_or(self.len(), |&last| last as usize + 1)
    }

    pub(super) fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.columns..][..self.columns]
    }

    /// The coordinates of a row.
    pub(super) fn place(&self, row: usize) -> &[f64] {
        &self.row(row)[..self.dim]
    }

    /// Returns true if no item is a ball of a radius above 0.
    pub(super) fn are_points(&self) -> bool {
        self.shape != Shape::Balls || (0..self.len()).all(|row| self.row(row)[self.dim] == 0.0)
    }
}

/// The values of a block of items, and the groups of its rows if a column names them.
fn values_of(
    shape: Shape,
    first: u64,
    rows: &Rows<'_>,
    group: Option<usize>,
) -> Result<(Vec<f64>, Vec<f64>), Error> {
    rows.check_finite(first)?;
    let (values, columns): (Vec<f64>, usize) = match rows {
        Rows::F32(points) => (points.values().iter().map(|&v| v.into()).collect(), points.dim()),
        Rows::F64(points) => (points.values().to_vec(), points.dim()),
    };
    let (values, columns, groups) = match group {
        None => (values, columns, vec![]),
        Some(group) => {
            let of_item = |(column, value)| (column % columns != group).then_some(value);
            let items = values.iter().copied().enumerate().filter_map(of_item).collect();
            (items, columns - 1, values.iter().skip(group).step_by(columns).copied().collect())
        }
    };
    for (row, values) in (first..).zip(values.chunks_exact(columns)) {
        let value = values[columns - 1];
        match shape {
            Shape::Weighted if value <= 0.0 => return Err(Error::NonPositiveWeight { row, value }),
            Shape::Balls if value < 0.0 => return Err(Error::NegativeRadius { row, value }),
            _ => {}
        }
    }
    Ok((values, groups))
}
