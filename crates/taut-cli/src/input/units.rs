//! Units for columns: what is measured in euros and what in meters gets a length of its own each.
//!
//! *Idea.* Each column is divided by its unit, as rows are read. The units are kept with the answer, so that whoever verifies or draws
//! it divides by the same numbers.

use std::ops::Range;

use anyhow::bail;
use taut::PointSource;
use taut::certify::ScaleChoice;
use taut::points::{Blocks, Points, ReadError, Rows, ScalarKind, Scratch};

use super::reading::Opened;
use crate::output::numbers::short;
use crate::reports::Field;

/// Columns whose ranges differ by more than this are told to be in different units.
const RANGE_RATIO_MAX: f64 = 100.0;

/// Rows that are looked at to tell whether columns are in different units.
const ROWS_LOOKED_AT: u64 = 100_000;

/// The rule for the unit of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unit {
    Std,
    Range,
    Robust,
}

taut::points::choice! { "scale", Unit {
    Std = "std", "the standard deviation";
    Range = "range", "the largest value less the least";
    Robust = "robust", "the upper quartile less the lower, which few outliers hardly change";
}}

/// The option for units, of subcommands on distances between rows of a table.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct UnitOptions {
    /// Divide each column by a unit of its own; lengths are in these units [default: as they are]
    #[arg(long, value_name = "UNIT", value_parser = super::choice::choice::<Unit>(), help_heading = "Reading")]
    scale: Option<Unit>,
}

impl UnitOptions {
    /// Refuses units where a row is more than a point.
    pub(crate) fn check(&self, others: &[(&str, bool)]) -> anyhow::Result<()> {
        match others.iter().find(|(_, is_given)| self.scale.is_some() && *is_given) {
            Some((name, _)) => bail!(
                "--scale is for points, whose columns have units: leave out one of --scale and {name}"
            ),
            None => Ok(()),
        }
    }

    /// The points in units, or with a note where columns differ much.
    pub(crate) fn apply(&self, points: Opened) -> anyhow::Result<Opened> {
        match self.scale {
            Some(unit) => {
                let units = units_of(&points, unit)?;
                points.in_units(ScaleChoice { method: unit.name().to_owned(), units })
            }
            None => Ok(match different_units(&points)? {
                Some(note) => points.noted(note),
                None => points,
            }),
        }
    }
}

/// The unit of each column; 1 of a column that is constant.
fn units_of(points: &Opened, unit: Unit) -> anyhow::Result<Vec<f64>> {
    let units: Vec<f64> = match unit {
        Unit::Std => deviations(points)?,
        Unit::Range => ranges(points, u64::MAX)?,
        Unit::Robust => {
            let ranges = ranges(points, u64::MAX)?;
            let quartiles = quartiles(points)?;
            // Where half of a column is one value, its range is the unit.
            let both = quartiles.into_iter().zip(ranges);
            both.map(|(span, range)| if span > 0.0 { span } else { range }).collect()
        }
    };
    if let Some(column) = units.iter().position(|unit| !unit.is_finite()) {
        bail!(
            "{}: the {} of column {column} is too large for double precision: leave out --scale, or choose other columns with \
             --columns",
            points.name(),
            match unit {
                Unit::Std => "standard deviation",
                Unit::Range => "range",
                Unit::Robust => "span of the quartiles",
            }
        );
    }
    Ok(units.into_iter().map(|unit| if unit > 0.0 { unit } else { 1.0 }).collect())
}

/// Hands each of the first rows to `visit`; all must be finite.
fn each_row(points: &Opened, most: u64, mut visit: impl FnMut(&[f64])) -> anyhow::Result<()> {
    let (blocks, mut scratch) = (Blocks::of(points.source()), Scratch::new());
    let mut row = vec![0.0; points.source().dim()];
    for block in 0..blocks.count() {
        let range = blocks.range(block);
        let first = range.start;
        if first >= most {
            break;
        }
        let rows = points.source().read(range, &mut scratch);
        let rows = rows.map_err(|error| points.reading_failed(error))?;
        if let Some((row, column, value)) = rows.first_non_finite() {
            return Err(points.not_finite(first + row as u64, column, value));
        }
        for at in 0..rows.len() {
            rows.copy_row(at, &mut row);
            visit(&row);
        }
    }
    Ok(())
}

/// The standard deviation of each column, about its first value and in units of its range, so that few digits are lost and no
/// square overflows or underflows.
fn deviations(points: &Opened) -> anyhow::Result<Vec<f64>> {
    let ranges = ranges(points, u64::MAX)?;
    let mut first: Option<Vec<f64>> = None;
    let mut sums = vec![[0.0; 2]; ranges.len()];
    each_row(points, u64::MAX, |row| {
        let first = first.get_or_insert_with(|| row.to_vec());
        for (column, [sum, squares]) in sums.iter_mut().enumerate() {
            let x = (row[column] - first[column]) / ranges[column];
            (*sum, *squares) = (*sum + x, *squares + x * x);
        }
    })?;
    let n = points.source().len() as f64;
    let deviation =
        |(&range, [sum, squares]): (&f64, [f64; 2])| match range > 0.0 && range.is_finite() {
            true => range * (squares / n - (sum / n).powi(2)).max(0.0).sqrt(),
            false => range,
        };
    Ok(ranges.iter().zip(sums).map(deviation).collect())
}

/// The largest value less the least of each column.
fn ranges(points: &Opened, most: u64) -> anyhow::Result<Vec<f64>> {
    let mut ends = vec![[f64::INFINITY, f64::NEG_INFINITY]; points.source().dim()];
    each_row(points, most, |row| {
        for (ends, &x) in ends.iter_mut().zip(row) {
            *ends = [ends[0].min(x), ends[1].max(x)];
        }
    })?;
    Ok(ends.into_iter().map(|[least, largest]| largest - least).collect())
}

/// The upper quartile less the lower, each the value of a row.
fn quartiles(points: &Opened) -> anyhow::Result<Vec<f64>> {
    let mut columns = vec![vec![]; points.source().dim()];
    each_row(points, u64::MAX, |row| {
        columns.iter_mut().zip(row).for_each(|(column, &x)| column.push(x));
    })?;
    let span = |mut column: Vec<f64>| {
        let at = |share: usize| (column.len() - 1) * share / 4;
        let (low, high) = (at(1), at(3));
        column.sort_unstable_by(f64::total_cmp);
        column[high] - column[low]
    };
    Ok(columns.into_iter().map(span).collect())
}

/// Says that columns are in different units, where their ranges differ much.
fn different_units(points: &Opened) -> anyhow::Result<Option<Field>> {
    let dim = points.source().dim();
    if dim < 2 {
        return Ok(None);
    }
    let ranges = ranges(points, ROWS_LOOKED_AT)?;
    let by_range = |one: &&usize, other: &&usize| ranges[**one].total_cmp(&ranges[**other]);
    let varying: Vec<usize> = (0..dim).filter(|&column| ranges[column] > 0.0).collect();
    let (Some(&least), Some(&largest)) =
        (varying.iter().min_by(by_range), varying.iter().max_by(by_range))
    else {
        return Ok(None);
    };
    let ratio = ranges[largest] / ranges[least];
    if ratio <= RANGE_RATIO_MAX {
        return Ok(None);
    }
    let names = points.names(dim);
    let name = |column: usize| names.get(column).cloned().unwrap_or_else(|| column.to_string());
    let remark = format!(
        "the range of {} is {} times that of {}, which hardly counts in distances; --scale std brings columns to one unit",
        name(largest),
        short(ratio.round()),
        name(least)
    );
    Ok(Some(Field::new("units", "differ").remark(remark)))
}

/// Says which units were taken.
pub(super) fn note(scale: &ScaleChoice, names: &[String]) -> Field {
    /// Units of more columns are in the JSON alone.
    const SHOWN_UNITS_MAX: usize = 6;
    let name = |column: usize| names.get(column).cloned().unwrap_or_else(|| column.to_string());
    let units = scale.units.iter().enumerate().take(SHOWN_UNITS_MAX);
    let units: Vec<String> =
        units.map(|(column, &unit)| format!("{} by {}", name(column), short(unit))).collect();
    let more = if scale.units.len() > SHOWN_UNITS_MAX { ", …" } else { "" };
    Field::new("scale", &*scale.method)
        .remark(format!("columns are divided: {}{more}", units.join(", ")))
}

/// Points whose columns are divided by units.
pub(super) struct Scaled {
    source: Box<dyn PointSource>,
    units: Vec<f64>,
}

impl Scaled {
    /// Divides the columns of a source; there must be a positive unit for each.
    pub(super) fn new(source: Box<dyn PointSource>, units: Vec<f64>) -> Result<Self, String> {
        if units.len() != source.dim() {
            return Err(format!(
                "the answer has units for {} columns, but there are {}",
                units.len(),
                source.dim()
            ));
        }
        match units.iter().find(|unit| !(**unit > 0.0 && unit.is_finite())) {
            Some(unit) => Err(format!("the answer has the unit {unit}, which is not positive")),
            None => Ok(Scaled { source, units }),
        }
    }
}

impl PointSource for Scaled {
    fn len(&self) -> u64 {
        self.source.len()
    }

    fn dim(&self) -> usize {
        self.source.dim()
    }

    fn scalar(&self) -> ScalarKind {
        ScalarKind::F64
    }

    fn read<'a>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        let (mut own, dim) = (Scratch::new(), self.dim());
        let rows = self.source.read(range, &mut own)?;
        let values = scratch.values::<f64>(rows.len() as u64, dim)?;
        for (at, row) in values.chunks_exact_mut(dim).enumerate() {
            rows.copy_row(at, row);
            row.iter_mut().zip(&self.units).for_each(|(x, unit)| *x /= unit);
        }
        Ok(Rows::F64(Points::new(values, dim)?))
    }
}
