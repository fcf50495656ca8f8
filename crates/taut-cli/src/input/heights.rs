//! Points of which one column is a height: the others are their places in the plane.

use std::sync::Arc;

use anyhow::{anyhow, bail};
use taut::PointSource;
use taut::points::{Blocks, PickedColumns, Scratch};

use super::reading::Opened;

/// The points with their heights, beside the places of the plane that they are read as.
pub(crate) struct HeightColumn {
    /// The points as they were read.
    pub(crate) points: Arc<dyn PointSource>,
    /// The two others, then the height.
    pub(crate) solid: PickedColumns,
    /// The column that is the height.
    pub(crate) column: usize,
    /// The two others.
    pub(crate) axes: [usize; 2],
    /// The least and the largest height.
    pub(crate) range: [f64; 2],
}

impl Opened {
    /// The column that an option names, by its name or its number from 0 among those that were read.
    pub(crate) fn column(&self, option: &str, name: &str) -> anyhow::Result<usize> {
        let dim = self.source().dim();
        let names = self.names(dim);
        names
            .iter()
            .position(|known| known == name)
            .or_else(|| name.parse().ok().filter(|&number: &usize| number < dim))
            .ok_or_else(|| {
                let known = match dim {
                    _ if !names.is_empty() => names.join(", "),
                    1 => "0".to_owned(),
                    _ => format!("0 to {}", dim - 1),
                };
                anyhow!(
                    "{}: {option} {name} is no column that was read: expected {known}",
                    self.name()
                )
            })
    }

    /// The places of the plane that all columns but `name` are; one pass checks the heights.
    pub(crate) fn with_height(self, name: &str) -> anyhow::Result<Self> {
        let dim = self.source().dim();
        if dim != 3 {
            bail!(
                "{}: points have {dim} coordinate{}: --height needs two and a height; choose them with --columns",
                self.name(),
                if dim == 1 { "" } else { "s" }
            );
        }
        let column = self.column("--height", name)?;
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        let (blocks, mut scratch) = (Blocks::of(self.source()), Scratch::new());
        let mut point = [0.0; 3];
        for block in 0..blocks.count() {
            let range_of_rows = blocks.range(block);
            let rows = self.source().read(range_of_rows.clone(), &mut scratch);
            let rows = rows.map_err(|error| self.reading_failed(error))?;
            for i in 0..rows.len() {
                rows.copy_row(i, &mut point);
                let z = point[column];
                if !z.is_finite() {
                    return Err(self.not_finite(range_of_rows.start + i as u64, column, z));
                }
                range = [range[0].min(z), range[1].max(z)];
            }
        }
        let axes = [[1, 2], [0, 2], [0, 1]][column];
        Ok(self.picked(|points| {
            let places = PickedColumns::new(points.clone(), axes.to_vec());
            let solid = PickedColumns::new(points.clone(), vec![axes[0], axes[1], column]);
            (Box::new(places), HeightColumn { points, solid, column, axes, range })
        }))
    }
}
