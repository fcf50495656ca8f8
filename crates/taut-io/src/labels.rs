//! A column of labels beside those of coordinates, in formats that hold numbers only.

use taut_points::{Blocks, OwnedPoints, Scratch, shown_number};

use crate::read::Decoded;
use crate::{Columns, Error, Format, ReadOptions};

/// The options with the label as last column, where columns are selected and the reader does not know of labels.
pub(crate) fn selecting(
    options: &ReadOptions,
    label: Option<&Columns>,
    format: Format,
) -> Option<ReadOptions> {
    let (columns, label) = options.columns.as_ref().zip(label)?;
    let columns = Some(columns.with(label));
    (!format.reads_labels()).then(|| ReadOptions { columns, ..options.clone() })
}

/// Refuses a selection that leaves no column beside the label.
pub(crate) fn check_others(others: usize, label: &Columns) -> Result<(), Error> {
    match others {
        0 => Err(Error::Columns {
            text: label.to_string(),
            expected: "columns beside that of the label",
        }),
        _ => Ok(()),
    }
}

/// Takes the column of labels out of points; it is the last one where it was added to a selection.
pub(crate) fn split(
    decoded: Decoded,
    label: &Columns,
    path: &str,
    is_last: bool,
) -> Result<Decoded, Error> {
    let Decoded { source, mut columns, numbers, .. } = decoded;
    let width = source.dim();
    let column = match is_last {
        true => width - 1,
        false => label.resolve(path, &columns, width)?[0],
    };
    check_others(width - 1, label)?;
    let (mut values, mut labels): (Vec<f64>, Vec<String>) = (vec![], vec![]);
    let mut scratch = Scratch::new();
    let mut row = vec![0.0; width];
    let blocks = Blocks::of(&*source);
    for block in 0..blocks.count() {
        let rows = source.read(blocks.range(block), &mut scratch)?;
        for i in 0..rows.len() {
            rows.copy_row(i, &mut row);
            labels.push(shown_number(row[column]));
            values.extend(row.iter().enumerate().filter(|other| other.0 != column).map(|v| v.1));
        }
    }
    let mut numbers = numbers.unwrap_or_else(|| (0..width).collect());
    numbers.remove(column);
    if column < columns.len() {
        columns.remove(column);
    }
    let points = OwnedPoints::new(values, width - 1).map_err(taut_points::ReadError::from)?;
    Ok(Decoded { source: Box::new(points), columns, numbers: Some(numbers), labels })
}
