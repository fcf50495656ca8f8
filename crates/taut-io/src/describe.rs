//! What a file of points holds, column by column: for people who have not seen it yet.
//!
//! *Idea.* Points are read with NaN where a value is missing. Of a text all rows are looked at before, so that columns of words are told
//! as well. Rows are equal if all their numbers are; they are sorted to be counted.

use std::path::Path;

use taut_points::{Blocks, Scratch};

use crate::input::text_columns;
use crate::{Error, Format, Missing, ReadOptions, open};

/// Numbers of all rows that are held to count those that are equal: 1 GiB.
const NUMBERS_HELD_MAX: u64 = 1 << 27;

/// The contents of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// The format.
    pub format: Format,
    /// Rows of data.
    pub rows: u64,
    /// Columns of numbers, then those of words.
    pub columns: Vec<ColumnDescription>,
    /// Rows that equal an earlier one in all columns of numbers; `None` of more numbers than are held to tell.
    pub duplicates: Option<u64>,
    /// Rows that lack a value in a column of numbers.
    pub incomplete: u64,
}

/// The contents of a column.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnDescription {
    /// Its name, or its number from 0 in the file where it has none.
    pub name: String,
    /// The kind of its values.
    pub kind: ColumnKind,
    /// Rows that lack the value.
    pub missing: u64,
    /// The least and the largest number, where there is one.
    pub range: Option<[f64; 2]>,
}

/// The kind of the values of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// Whole numbers.
    Whole,
    /// Real numbers.
    Real,
    /// Anything else.
    Text,
}

impl ColumnKind {
    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            ColumnKind::Whole => "whole",
            ColumnKind::Real => "real",
            ColumnKind::Text => "text",
        }
    }
}

/// Describes the file at `path`; `-` is standard input, of which columns of words are passed over.
///
/// ```
/// use taut_io::{ColumnKind, ReadOptions, describe};
///
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("towns.csv");
/// std::fs::write(&path, "town,x,y\nUlm,1,2.5\nHof,3,NA\n")?;
/// let found = describe(&path, &ReadOptions::default())?;
/// assert_eq!((found.rows, found.incomplete, found.duplicates), (2, 1, Some(0)));
/// let kinds: Vec<_> = found.columns.iter().map(|column| (&*column.name, column.kind)).collect();
/// assert_eq!(kinds, [("x", ColumnKind::Whole), ("y", ColumnKind::Real), ("town", ColumnKind::Text)]);
/// assert_eq!(found.columns[0].range, Some([1.0, 3.0]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`open`].
pub fn describe(path: &Path, options: &ReadOptions) -> Result<Description, Error> {
    let numeric = options.columns.is_none();
    let options = ReadOptions { numeric, missing: Missing::Keep, ..options.clone() };
    let input = open(path, &options)?;
    let (source, dim) = (&*input.source, input.source.dim());
    let mut columns = vec![Counts::default(); dim];
    let (mut incomplete, mut row, mut values) = (0, vec![0.0; dim], vec![]);
    let is_held = source.len().saturating_mul(dim as u64) <= NUMBERS_HELD_MAX;
    let (blocks, mut scratch) = (Blocks::of(source), Scratch::new());
    for block in 0..blocks.count() {
        let rows = source.read(blocks.range(block), &mut scratch)?;
        for at in 0..rows.len() {
            rows.copy_row(at, &mut row);
            columns.iter_mut().zip(&row).for_each(|(column, &value)| column.add(value));
            incomplete += u64::from(row.iter().any(|value| value.is_nan()));
            if is_held {
                values.extend_from_slice(&row);
            }
        }
    }
    let name = |at: usize| match input.columns.get(at) {
        Some(name) => name.clone(),
        None => input.describe_cell(0, at).column.to_string(),
    };
    let mut columns: Vec<ColumnDescription> =
        columns.into_iter().enumerate().map(|(at, counts)| counts.describe(name(at))).collect();
    if numeric && input.format.is_delimited() && path.as_os_str() != "-" && !path.is_dir() {
        columns.extend(text_columns(path, &options, input.format)?);
    }
    let duplicates = is_held.then(|| duplicates(&values, dim));
    Ok(Description { format: input.format, rows: source.len(), columns, duplicates, incomplete })
}

/// What is counted of a column of numbers.
#[derive(Clone, Debug)]
struct Counts {
    is_whole: bool,
    missing: u64,
    range: [f64; 2],
}

impl Default for Counts {
    fn default() -> Self {
        Counts { is_whole: true, missing: 0, range: [f64::INFINITY, f64::NEG_INFINITY] }
    }
}

impl Counts {
    fn add(&mut self, value: f64) {
        if value.is_nan() {
            self.missing += 1;
            return;
        }
        self.is_whole &= value.fract() == 0.0;
        self.range = [self.range[0].min(value), self.range[1].max(value)];
    }

    fn describe(self, name: String) -> ColumnDescription {
        let has_numbers = self.range[0] <= self.range[1];
        let is_whole = self.is_whole && has_numbers;
        let kind = if is_whole { ColumnKind::Whole } else { ColumnKind::Real };
        let range = has_numbers.then_some(self.range);
        ColumnDescription { name, kind, missing: self.missing, range }
    }
}

/// The rows that equal an earlier one: as many as there are but for one of each kind.
fn duplicates(values: &[f64], dim: usize) -> u64 {
    let order = |one: &&[f64], other: &&[f64]| {
        let pairs = one.iter().zip(*other);
        // Zeros of both signs are one number.
        let order = pairs.map(|(a, b)| (a + 0.0).total_cmp(&(b + 0.0)));
        order.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
    };
    let mut rows: Vec<&[f64]> = values.chunks_exact(dim.max(1)).collect();
    rows.sort_unstable_by(order);
    rows.windows(2).filter(|pair| order(&pair[0], &pair[1]).is_eq()).count() as u64
}
