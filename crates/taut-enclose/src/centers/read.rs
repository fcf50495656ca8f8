//! Rows as items, about an origin near them and in units in which squares neither overflow nor vanish.
//!
//! *Idea.* A center has no more digits than its coordinates, which are few where all rows are far from the origin. A column whose
//! values differ by little is therefore moved by the least of them, which is exact: both are within a factor of 2 (Sterbenz).
//! *Guarantee.* Moved and scaled rows are the rows, without rounding; what cannot be is refused.

use taut_points::{exponent_of, two_to};

use super::item_rows::ItemRows;
use super::items::{ItemSet, Position, Shape};
use crate::Error;

/// Numbers between 2⁻²⁰⁰ and 2²⁰⁰ stay as they are: squares of their differences are at least 2⁻⁵⁰⁶.
const SAFE_EXPONENT: i32 = 200;
/// Where there are others, the largest coordinate or radius gets this exponent, so that squares of what is 2⁻⁹⁸⁰ of it keep
/// their digits.
const EXPONENT_MAX: i32 = 500;
/// A column whose values differ by at most this part of the least is moved.
const COLUMN_SPREAD_MAX: f64 = 1.0 / 16.0;

/// All rows, as they are, and the units of the search.
pub(super) struct Table {
    pub(super) rows: ItemRows,
    /// The vector that is subtracted from each coordinate, without rounding.
    shift: Vec<f64>,
    /// The factor that coordinates and radii are then multiplied with, a power of two.
    pub(super) scale: f64,
    /// The factor that weights are multiplied with, a power of two.
    pub(super) weight_scale: f64,
}

impl Table {
    /// Finds units in which no row loses digits.
    pub(super) fn of(rows: ItemRows) -> Result<Self, Error> {
        let shift = |column: usize| shift_of(&rows.values[column..], rows.columns);
        let shift = (0..rows.dim).map(shift).collect();
        let mut table = Table { rows, shift, scale: 1.0, weight_scale: 1.0 };
        table.set_scales();
        if table.loses_digits() { Err(Error::Overflow) } else { Ok(table) }
    }

    /// Coordinates and radii in the units of the rows, but about the origin of the search.
    fn lengths(&self) -> impl Iterator<Item = f64> {
        let is_length = self.rows.shape == Shape::Balls;
        self.rows.values.chunks_exact(self.rows.columns).flat_map(move |row| {
            let moved = row.iter().zip(&self.shift).map(|(x, shift)| x - shift);
            moved.chain(row[self.rows.dim..].iter().copied().filter(move |_| is_length))
        })
    }

    fn set_scales(&mut self) {
        let weights =
            self.rows.values.chunks_exact(self.rows.columns).flat_map(|row| &row[self.rows.dim..]);
        let weights =
            Exponents::of(weights.copied().filter(|_| self.rows.shape == Shape::Weighted));
        let lengths = Exponents::of(self.lengths());
        if lengths.are_safe() && weights.are_safe() {
            return;
        }
        self.scale = lengths.scale(EXPONENT_MAX);
        self.weight_scale = weights.scale(0);
    }

    /// Returns true if numbers so small beside the largest are there that they cannot be scaled with it.
    fn loses_digits(&self) -> bool {
        let is_lost = |value: f64, scale: f64| value * scale / scale != value;
        let weights =
            self.rows.values.chunks_exact(self.rows.columns).flat_map(|row| &row[self.rows.dim..]);
        self.lengths().any(|x| is_lost(x, self.scale))
            || self.rows.shape == Shape::Weighted
                && weights.copied().any(|w| is_lost(w, self.weight_scale))
    }

    /// The items in the units of the search.
    pub(super) fn items<P: Position>(&self) -> ItemSet<P> {
        let mut items = ItemSet::new(self.rows.shape, self.rows.dim);
        let mut position = vec![0.0; self.rows.dim];
        for row in self.rows.values.chunks_exact(self.rows.columns) {
            self.bring_in(row, &mut position);
            let extra = row.get(self.rows.dim).copied().unwrap_or(0.0);
            let unit =
                if self.rows.shape == Shape::Weighted { self.weight_scale } else { self.scale };
            items.push(&position, extra * unit);
        }
        items
    }

    /// A place in the units of the search.
    pub(super) fn bring_in(&self, place: &[f64], position: &mut [f64]) {
        for ((p, x), shift) in position.iter_mut().zip(place).zip(&self.shift) {
            *p = (x - shift) * self.scale;
        }
    }

    /// A position of the search in the units of the rows, rounded.
    pub(super) fn bring_out(&self, position: &[f64]) -> Vec<f64> {
        position.iter().zip(&self.shift).map(|(p, shift)| p / self.scale + shift).collect()
    }
}

/// Returns the shift of a column: its least value in size, or 0.
fn shift_of(values: &[f64], columns: usize) -> f64 {
    let column = || values.iter().step_by(columns);
    let low = column().copied().fold(f64::INFINITY, f64::min);
    let high = column().copied().fold(f64::NEG_INFINITY, f64::max);
    let (least, most) = if low > 0.0 { (low, high) } else { (high, low) };
    let is_narrow = low > 0.0 || high < 0.0;
    if is_narrow && (most - least).abs() <= COLUMN_SPREAD_MAX * least.abs() { least } else { 0.0 }
}

/// Of numbers that are not 0, the exponents of the least and the largest.
struct Exponents(Option<(i32, i32)>);

impl Exponents {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let sizes = values.map(f64::abs).filter(|&size| size > 0.0);
        let range = sizes.fold(None, |range: Option<(f64, f64)>, size| {
            let (least, most) = range.unwrap_or((size, size));
            Some((least.min(size), most.max(size)))
        });
        Exponents(range.map(|(least, most)| (exponent_of(least), exponent_of(most))))
    }

    fn are_safe(&self) -> bool {
        self.0.is_none_or(|(least, most)| -SAFE_EXPONENT <= least && most <= SAFE_EXPONENT)
    }

    /// The power of two that brings the largest to about this exponent.
    fn scale(&self, wanted: i32) -> f64 {
        self.0.map_or(1.0, |(_, most)| two_to((wanted - most).clamp(-1000, 1000)))
    }
}
