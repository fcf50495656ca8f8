//! The heights of sites by their rows.
//!
//! *Trap.* The rows of a tile are spread over the whole input. They are asked for in ascending order, many at a time where
//! they are close.

use taut_points::{InputError, PointSource, Scratch};

use crate::Error;

/// Most rows between two wanted ones that are read together with them.
const GAP_ROWS: u64 = 32;

/// Most wanted rows that are read at once.
const ROWS_AT_ONCE: usize = 1 << 10;

/// A height for each row of the input.
#[derive(Clone, Copy)]
pub enum Heights<'a> {
    /// One for each row; with fewer, work on a row beyond them panics.
    Values(&'a [f64]),
    /// A column of points, by its number from 0.
    Column(&'a dyn PointSource, usize),
}

impl Heights<'_> {
    /// The heights of these rows.
    pub(crate) fn of(&self, rows: &[u64]) -> Result<Vec<f64>, Error> {
        let heights = match *self {
            Heights::Values(values) => rows.iter().map(|&row| values[row as usize]).collect(),
            Heights::Column(source, column) => read_column(source, column, rows)?,
        };
        match heights.iter().position(|z| !z.is_finite()) {
            None => Ok(heights),
            Some(place) => {
                let column = if let Heights::Column(_, column) = self { *column } else { 0 };
                let (row, value) = (rows[place], heights[place]);
                Err(InputError::NonFinite { row, column, value }.into())
            }
        }
    }
}

fn read_column(source: &dyn PointSource, column: usize, rows: &[u64]) -> Result<Vec<f64>, Error> {
    let mut order: Vec<(u64, u32)> = rows.iter().copied().zip(0..).collect();
    order.sort_unstable();
    let mut heights = vec![0.0; rows.len()];
    let (mut scratch, mut point) = (Scratch::new(), vec![0.0; source.dim()]);
    let mut rest = &order[..];
    while let Some(&(first, _)) = rest.first() {
        let gap = rest[..rest.len().min(ROWS_AT_ONCE + 1)]
            .windows(2)
            .position(|pair| pair[1].0 - pair[0].0 > GAP_ROWS);
        let count = gap.map_or(rest.len(), |last| last + 1).min(ROWS_AT_ONCE);
        let (window, behind) = rest.split_at(count);
        let last = window[count - 1].0;
        let read = source.read(first..last.saturating_add(1), &mut scratch)?;
        for &(row, place) in window {
            read.copy_row((row - first) as usize, &mut point);
            heights[place as usize] = point[column];
        }
        rest = behind;
    }
    Ok(heights)
}
